"""Published experiments of granular columns that collapse onto a horizontal plane, and what other continuum codes found.

a = h_0 / l_0; a column of height h_0 and length l_0 against a wall, or half of a symmetric one. Nothing here was checked against the
papers themselves, only against later works that quote them; reference/README.md says which, and where they disagree.
"""

import numpy

# Lube, Huppert, Sparks & Freundt, Phys. Rev. E 72, 041301 (2005): sand, rice, sugar, couscous in channels; half-way through the
# transition, a = 1.8 to 2.8.
LUBE_RUN_OUT = {"slope": 1.2, "factor": 1.9, "power": 2 / 3, "change": 2.3}
LUBE_HEIGHT = {"factor": 1.0, "power": 0.4, "change": 1.15}
# Lajeunesse, Monnier & Homsy, Phys. Fluids 17, 103302 (2005): glass beads of 1.15 mm, repose 22 degrees, in a channel 45 mm wide.
LAJEUNESSE_RUN_OUT = {"slope": 1.8, "factor": 2.3, "power": 2 / 3, "change": 3.0}
# "Failure Mechanism of True 2D Granular Flows" (2015): aluminium rods, no side walls; for a > 0.65, from its abstract.
RODS_RUN_OUT = {"slope": 3.25, "slope_power": 0.96, "factor": 3.80, "power": 0.73, "change": 1.5}
# Lagree, Staron & Popinet, J. Fluid Mech. 686 (2011): no experiment but a two-dimensional continuum with mu(I), without side walls.
CONTINUUM_RUN_OUT = {"slope": 2.2, "factor": 3.9, "power": 0.7, "change": 7.0}


def run_out(aspect, law=LUBE_RUN_OUT):
    """(l_inf - l_0) / l_0."""
    aspect = numpy.asarray(aspect, float)
    short = law["slope"] * aspect ** law.get("slope_power", 1.0)
    return numpy.where(aspect < law["change"], short, law["factor"] * aspect ** law["power"])


def final_height(aspect, law=LUBE_HEIGHT):
    """h_inf / l_0."""
    aspect = numpy.asarray(aspect, float)
    return numpy.where(aspect < law["change"], aspect, law["factor"] * aspect ** law["power"])


# Bui, Fukagawa, Sako & Ohno, Int. J. Numer. Anal. Meth. Geomech. 32, 1537-1570 (2008): aluminium bars, 0.2 m long, 0.1 m high.
BUI_SOIL = {
    "length": 0.2,  # m
    "height": 0.1,  # m
    "friction_angle": 19.8,  # degrees
    "cohesion": 0.0,  # Pa
    "dilation_angle": 0.0,  # degrees
    "young": 0.84e6,  # Pa: bulk modulus 0.7 MPa
    "poisson": 0.3,
    "density": 2650.0,  # kg/m3
}
# Final surface and failure line (between what moved and what did not), m from wall and floor: rounded to mm between points that
# others read off the paper's figure.
BUI_SURFACE = numpy.array([(0.00, 0.099), (0.02, 0.099), (0.05, 0.092), (0.10, 0.078), (0.15, 0.064), (0.20, 0.047), (0.25, 0.033),
                           (0.30, 0.022), (0.35, 0.013), (0.40, 0.004), (0.44, 0.002)])
BUI_FAILURE = numpy.array([(0.02, 0.099), (0.05, 0.085), (0.10, 0.054), (0.15, 0.018), (0.18, 0.000)])
BUI_READING = 0.002  # m: how far two readings of such a figure may be apart


def bui_surface(x):
    """Height of the final surface, m, at distances x from the wall."""
    return numpy.interp(x, *BUI_SURFACE.T)


def bui_area():
    """Under the final surface, m2; 0.020 before the collapse."""
    x, y = BUI_SURFACE.T
    return float(numpy.sum(0.5 * numpy.diff(x) * (y[1:] + y[:-1])))
