"""Second opinion on ../saturated_wave.py: the same column by leapfrog in solid velocity and effective stress.

    mass dv/dt = d sigma'/dx - drag v,    d sigma'/dt = (lambda + 2 mu) dv/dx

on a staggered mesh with the time step that waves need for one cell, so that fronts stay sharp; drag by the trapezoidal rule. Mass and
drag come from the energies of the two phases with n_s v + n_l v_l = 0, and p from the water's own momentum, rho_l dv_l/dt = -dp/dx -
S_v / n_l (v_l - v). Fixed impermeable base. Nothing is shared with the closed solution but the numbers of the ground.
"""

import numpy


def simulate(ground, load, height, cells, steps):
    """(time, depth of nodes, displacement there, depth of cells, stress there, time of pressure, pressure at nodes) after `steps`."""
    spacing = height / cells
    inertia, resistance = of_the_solid(ground)
    interval = spacing / numpy.sqrt(ground.modulus / inertia)
    velocity, displacement, pressure = numpy.zeros(cells + 1), numpy.zeros(cells + 1), numpy.zeros(cells + 1)
    stress = numpy.zeros(cells)
    drag = 0.5 * interval * resistance / inertia
    mass = numpy.full(cells + 1, inertia * spacing)
    mass[0] *= 0.5
    for index in range(steps):
        applied = 0.5 * (load((index - 1e-9) * interval) + load((index + 1e-9) * interval))  # of a jump, its mean
        force = numpy.diff(stress, prepend=-applied, append=0.0)
        new = ((1 - drag) * velocity + interval * force / mass) / (1 + drag)
        new[-1] = 0.0
        acceleration, middle = (new - velocity) / interval, 0.5 * (new + velocity)
        velocity = new
        displacement += interval * velocity
        stress += interval * ground.modulus * numpy.diff(velocity) / spacing
        pressure = pressure_of(ground, acceleration, middle, spacing)
    depth = spacing * numpy.arange(cells + 1)
    return steps * interval, depth, displacement, depth[:-1] + 0.5 * spacing, stress, (steps - 1) * interval, pressure


def of_the_solid(ground):
    """Mass and drag per volume, as the solid feels them: twice the kinetic energy and the dissipation at unit solid velocity."""
    solid, fluid = 1 - ground.porosity, ground.porosity
    along = -solid / fluid  # velocity of the water
    inertia = solid * ground.solid_density + fluid * ground.fluid_density * along**2
    interaction = fluid**2 * ground.fluid_density * ground.gravity / ground.conductivity  # S_v, Pa s/m2
    return inertia, interaction * (along - 1) ** 2


def pressure_of(ground, acceleration, velocity, spacing):
    """From the water's momentum, trapezoidal rule from the drained surface downwards."""
    fluid = ground.porosity
    along = -(1 - fluid) / fluid
    interaction = fluid**2 * ground.fluid_density * ground.gravity / ground.conductivity
    gradient = -ground.fluid_density * along * acceleration - interaction / fluid * (along - 1) * velocity
    return numpy.concatenate([[0.0], numpy.cumsum(0.5 * spacing * (gradient[:-1] + gradient[1:]))])
