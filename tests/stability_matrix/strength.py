"""Mohr-Coulomb of docs/theory.md from a run's views alone: how far its stresses lie beyond the strength of its soils."""

import numpy

ATMOSPHERE = 101325.0  # Pa
LARGEST_FRICTION = 60.0  # degrees, of the exponential model
FLOOR = 1e-3  # of the ground's greatest strength: what a point's excess is at least compared with

GAUSS = 1 / numpy.sqrt(3)
CORNERS = numpy.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
SHARES = {  # of a cell's nodes in its points, by its number of nodes
    2: numpy.array([[1 + GAUSS, 1 - GAUSS], [1 - GAUSS, 1 + GAUSS]]) / 2,
    3: numpy.array([[4, 1, 1], [1, 4, 1], [1, 1, 4]]) / 6,
    4: numpy.array([numpy.prod(1 + GAUSS * point * CORNERS, axis=1) for point in CORNERS]) / 4,
}


def effective_saturation(soil, suction):
    """Of van Genuchten's curve."""
    retention = soil["hydraulics"]["retention"]
    n = retention["n"]
    return (1 + (retention["alpha"] * suction) ** n) ** -(1 - 1 / n)


def strength_of(entries, suction, saturation):
    """Cohesion (Pa) and friction angle (degrees) at suctions and effective saturations."""
    cohesion, friction = entries["cohesion"] + 0 * suction, entries["frictionAngle"] + 0 * suction
    model = entries.get("model", "vanapalli")
    if model == "vanapalli":
        cohesion = cohesion + suction * saturation * numpy.tan(numpy.radians(friction))
    elif model == "fredlund":
        cohesion = cohesion + suction * numpy.tan(numpy.radians(entries["suctionFrictionAngle"]))
    elif model == "exponential":
        gain, rate = entries.get("cohesionGain", 0.0), entries.get("cohesionRate", 0.0)
        cohesion = cohesion + gain * (1 - numpy.exp(-rate * suction / ATMOSPHERE))
        gained = friction + entries.get("frictionGain", 0.0) * suction / ATMOSPHERE
        friction = numpy.where(suction > 0, numpy.minimum(gained, LARGEST_FRICTION), friction)
    return cohesion, friction


def excess(stress, cohesion, friction, tensile):
    """Beyond the cone or the tensile strength at each point, and the strength there that it is to be compared with, Pa.

    Stress in rows of xx, yy, zz, xy, tension positive.
    """
    centre, radius = (stress[:, 0] + stress[:, 1]) / 2, numpy.hypot((stress[:, 0] - stress[:, 1]) / 2, stress[:, 3])
    largest, smallest = numpy.maximum(centre + radius, stress[:, 2]), numpy.minimum(centre - radius, stress[:, 2])
    sine, cosine = numpy.sin(numpy.radians(friction)), numpy.cos(numpy.radians(friction))
    shear = (1 + sine) * largest - (1 - sine) * smallest - 2 * cohesion * cosine
    scale = 2 * cohesion * cosine + (1 + sine) * abs(largest) + (1 - sine) * abs(smallest)
    return numpy.maximum(shear, largest - tensile), scale


def relative_excess(beyond, scale):
    """The largest over the ground, 0 where none is beyond."""
    floor = FLOOR * scale.max()
    return float(numpy.max(numpy.maximum(beyond, 0) / numpy.maximum(scale, max(floor, 1e-300))))


class YieldCheck:
    """Of one run; `soils` is the number of each point's soil."""

    def __init__(self, engine, scene, soils):
        self.engine, self.scene, self.soils = engine, scene, soils
        self.is_wet = "suction" in engine.fields
        self.is_bishop = self.is_wet and scene.get("physics", {}).get("stress", "net") == "bishop"
        laws = [soil["solid"].get("model", "mohrCoulomb") for soil in scene["soils"]]
        self.plastic = [number for number, law in enumerate(laws) if law == "mohrCoulomb"]

    def __call__(self):
        stress = self._skeleton_stress()
        parts = [self._excess_of(number, stress) for number in self.plastic if (self.soils == number).any()]
        return relative_excess(*map(numpy.concatenate, zip(*parts))) if parts else 0.0

    def _excess_of(self, number, stress):
        at = self.soils == number
        soil = self.scene["soils"][number]
        suction, saturation = numpy.zeros(at.sum()), numpy.ones(at.sum())
        if self.is_wet:
            retention = soil["hydraulics"]["retention"]
            least, most = retention.get("residualSaturation", 0.0), retention.get("maximumSaturation", 1.0)
            suction, saturation = self.engine.read("suction")[at], (self.engine.read("saturation")[at] - least) / (most - least)
        cohesion, friction = strength_of(soil["solid"]["strength"], suction, saturation)
        return excess(stress[at], cohesion, friction, soil["solid"].get("tensileStrength", numpy.inf))

    def _skeleton_stress(self):
        """Net stress, or Bishop's, whose pore pressure the engine takes from the cells' nodes."""
        if not self.is_bishop:
            return self.engine.read("net_stress")
        stress = self.engine.read("total_stress").copy()
        stress[:, :3] += self._pore_stress()[:, None]
        return stress

    def _pore_stress(self):
        starts, nodes = (self.engine.read(name).astype(int) for name in ("cell_start", "cell_nodes"))
        pressure, soils = self.engine.read("pressure"), self.engine.read("cell_soil").astype(int)
        parts = []
        for first, last, number in zip(starts, starts[1:], soils):
            at = pressure[nodes[first:last]]
            weighted = at * numpy.where(at < 0, effective_saturation(self.scene["soils"][number], numpy.maximum(-at, 0)), 1)
            parts.append(SHARES[last - first] @ weighted)
        return numpy.concatenate(parts)
