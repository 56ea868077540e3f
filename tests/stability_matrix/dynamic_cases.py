"""Ground that moves by its momentum: stiff phases, fast and slow water, flight, impact, fragments and long run-outs."""

from case import Case, Sweep
from scenes import dry, earth, rain_zone, section

SLIDE = [["step", 0.1, 10]]


def dynamic(ground, soils, walls, cell_size, water=None, rain=0.0, table=1.0):
    """Plane ground between walls (side, motion, friction angle); dry where `water` is None, else its bulk modulus, Pa."""
    boundaries = [{"name": side, "side": side, "motion": motion, **({"frictionAngle": angle} if motion == "friction" else {})}
                  for side, motion, angle in walls]
    scene = {"name": "stability", "physics": {"regime": "dynamic", "water": water is not None}, "soils": soils, "ground": ground,
             "boundaries": boundaries, "dynamics": {"cellSize": cell_size}}
    if water is None:
        return {**scene, "initial": {"stress": "elastic" if walls else "zero"}}
    return {**scene, "water": {"bulkModulus": water}, "surface": rain_zone(rain),
            "initial": {"flow": "hydrostatic", "waterTable": table, "stress": "elastic"}}


def bank(scale=1.0, right=8.0):
    """A steep bank, 4 m by 2 m times `scale`, above a floor that goes on to `right`."""
    terrain = [[0, 2], [2, 2], [4, 0.5], [right, 0.5]]
    return section([[scale * x, scale * y] for x, y in terrain], [[0, 0], [scale * right, 0]], scale, 0.5 * scale, scale,
                   [{"soil": "earth"}])


HELD = (("base", "fixed", 0), ("left", "roller", 0), ("right", "roller", 0))
RUBBING = (("base", "friction", 20), ("left", "roller", 0))
ROUGH = (("base", "friction", 20), ("left", "friction", 20), ("right", "friction", 20))


def dry_bank(scale=1.0, cell_size=0.25, walls=HELD, **numbers):
    return dynamic(bank(scale), [dry(earth(**{"cohesion": 500, "friction": 20, **numbers}))], walls, cell_size * scale)


def wet_bank(water=1e7, rain=0.0, table=1.0, walls=HELD, **numbers):
    soil = earth(**{"cohesion": 500, "friction": 20, "conductivity": 1e-4, **numbers})
    return dynamic(bank(), [soil], walls, 0.25, water, rain, table)


def block(width, height, walls, cell_size, **numbers):
    ground = section([[0, height], [width, height]], [[0, 0], [width, 0]], width / 4, height / 8, height / 8, [{"soil": "earth"}])
    return dynamic(ground, [dry(earth(**numbers))], walls, cell_size)


SWEEPS = (
    Sweep("dynamic_drag", ("K, m/s", "water, Pa"), ((1e-4, 1e-18, 1e-13, 1e-9, 1e-2, 0.3), (1e7, 1e5, 2e9)),
          lambda conductivity, water: wet_bank(water, conductivity=conductivity), SLIDE, monotone=False),
    Sweep("dynamic_stiffness", ("Young's modulus, Pa", "Poisson ratio"), ((1e7, 1e5, 1e6, 1e9, 1e11), (0.3, 0, 0.49, 0.499)),
          lambda young, poisson: dry_bank(young=young, poisson=poisson), [["step", 0.05, 4]], monotone=False),  # a second of the stiffest is a minute of waves
    Sweep("dynamic_strength", ("cohesion, Pa", "friction, degrees"), ((500, 0, 50, 1e4, 1e9), (20, 1, 40, 60)),
          lambda cohesion, friction: dry_bank(cohesion=cohesion, friction=friction), SLIDE, monotone=False),
    Sweep("dynamic_scale", ("scale", "cell over scale"), ((1, 1e-2, 100, 1000), (0.25, 1, 0.1)), dry_bank, [["step", 0.05, 4]], monotone=False),
    Sweep("dynamic_retention", ("alpha, 1/Pa", "N"), ((4e-5, 1e-7, 1e-2), (1.2, 1.03, 2, 6)),
          lambda alpha, n: wet_bank(alpha=alpha, n=n, rain=1e-3, table=-1.0), SLIDE, monotone=False),
)


def flight_cases():
    yield Case("dynamic/free_fall", block(1, 1, (), 0.1), [["step", 0.1, 20]])
    yield Case("dynamic/free_fall_of_one_cell", block(0.1, 0.1, (), 0.1), [["step", 0.1, 20]])
    yield Case("dynamic/against_a_wall", dynamic(bank(), [dry(earth(cohesion=0, friction=5))], HELD, 0.25), [["step", 0.5, 20]])
    yield Case("dynamic/fragments", block(0.5, 4, RUBBING, 0.125, cohesion=0, friction=10, young=1e7), [["step", 0.1, 40]], bound=60)
    yield Case("dynamic/through_100_cells", block(1, 2, (("base", "friction", 2), ("left", "roller", 0)), 0.1, cohesion=0, friction=3),
               [["step", 0.1, 40]], bound=60)
    yield from end_cases()
    yield Case("dynamic/tall", block(0.25, 10, RUBBING, 0.125, cohesion=2e3), SLIDE)
    yield Case("dynamic/one_cell_high", block(20, 0.25, RUBBING, 0.25), SLIDE)
    yield Case("dynamic/points_on_edges", block(1, 1, HELD, 0.5), SLIDE)


def stopped(scene, **ends):
    """By walls at the ends of its background."""
    scene["dynamics"].update(ends, atEnds="stop")
    return scene


def end_cases():
    steps = [["step", 0.1, 40]]
    box = {"xFrom": -0.5, "xTo": 2.0, "yFrom": -1.0, "yTo": 1.55}
    yield Case("dynamic/falls_into_a_box", stopped(block(1, 1, (), 0.1), **box), steps)
    yield Case("dynamic/fragments_in_a_box", stopped(block(0.5, 4, RUBBING, 0.125, cohesion=0, friction=10), xTo=1.7, yTo=4.0), steps, bound=60)
    yield Case("dynamic/wet_slide_against_an_end", stopped(wet_bank(rain=1e-3, cohesion=50, walls=RUBBING), xTo=8.3), steps)


def water_cases():
    yield Case("dynamic/wet_benign", wet_bank(), SLIDE)
    yield Case("dynamic/rain_on_a_slide", wet_bank(rain=1e-3), [["step", 0.1, 20]])
    yield Case("dynamic/rain_on_and_off", wet_bank(rain=1e-3), [["step", 0.1, 2], ["rain", 0.0], ["step", 0.1, 2], ["rain", 1e-4],
                                                               ["step", 0.1, 2]])
    yield Case("dynamic/full_to_the_surface", wet_bank(table=2.0), SLIDE)
    yield Case("dynamic/very_dry", wet_bank(table=-1e3), SLIDE)
    yield Case("dynamic/porous", wet_bank(porosity=0.9), SLIDE)
    yield Case("dynamic/dense", wet_bank(porosity=0.05), SLIDE)
    yield Case("dynamic/wet_and_stiff", wet_bank(2e9, young=1e11), SLIDE)
    yield Case("dynamic/wet_rubbing", wet_bank(rain=1e-3, walls=ROUGH), [["step", 0.1, 20]])
    yield Case("dynamic/wet_on_a_smooth_base", wet_bank(cohesion=50, walls=(("base", "friction", 1), ("left", "roller", 0))), [["step", 0.1, 20]])
    yield Case("dynamic/full_and_rubbing", wet_bank(2e9, table=2.0, conductivity=1e-9, walls=ROUGH), SLIDE)
    yield Case("dynamic/loose_and_rubbing", wet_bank(conductivity=0.3, walls=ROUGH), SLIDE)
    yield Case("dynamic/kozeny_carman", conducting_by_porosity(wet_bank(young=1e5, poisson=0)), SLIDE, may_be_refused="too soft for what it bears",
               why="its pores are closed")
    yield Case("dynamic/exponential", wet_bank(table=-5.0, strength={"model": "exponential", "cohesionGain": 2e4, "cohesionRate": 10.0, "frictionGain": 30.0}),
               SLIDE)
    yield Case("dynamic/bedded", bedded(wet_bank(rain=1e-3, table=-1.0)), [["step", 0.1, 20]])
    yield Case("dynamic/bedded_and_rubbing", bedded(wet_bank(2e9, walls=ROUGH), 1e-9, -60.0), SLIDE)
    yield Case("dynamic/one_way", bedded(wet_bank(conductivity=0.3), 1e-20, 45.0), SLIDE)
    yield Case("dynamic/undrained", wet_bank(2e9, conductivity=1e-13, poisson=0.4999), SLIDE)


def conducting_by_porosity(scene):
    scene["soils"][0]["hydraulics"]["conductivity"]["porosityDependence"] = "kozenyCarman"
    return scene


def bedded(scene, across=1e-7, dip=35.0):
    scene["soils"][0]["hydraulics"]["conductivity"].update(across=across, dip=dip)
    return scene


def gassy_bank(**numbers):
    scene = wet_bank(**numbers)
    scene["physics"]["gas"] = True
    return scene


def moist_bank(**numbers):
    """With exchange between the fluids, under dry air."""
    scene = gassy_bank(**numbers)
    scene["physics"]["exchange"] = True
    scene["gas"] = {"humidity": 0.0}
    return scene


def gas_cases(sweep, bank):
    yield Case(f"{sweep}/benign", bank(), SLIDE)
    yield Case(f"{sweep}/soft", bank(young=1e5, poisson=0), SLIDE, may_be_refused="too soft for what it bears",
               why="its pores are closed")
    yield Case(f"{sweep}/dry", bank(table=-1e3), SLIDE)
    yield Case(f"{sweep}/full", bank(table=2.0), SLIDE)
    yield Case(f"{sweep}/rain", bank(rain=1e-3, table=-1.0), [["step", 0.1, 20]])
    for conductivity in (1e-18, 1e-9, 0.3):
        yield Case(f"{sweep}/K_{conductivity:g}", bank(conductivity=conductivity), SLIDE)
    for alpha, n in ((1e-7, 1.03), (1e-2, 6), (1e-7, 6)):
        yield Case(f"{sweep}/{alpha:g}_{n:g}", bank(alpha=alpha, n=n, table=-1.0), SLIDE)
    yield Case(f"{sweep}/soft_water", bank(water=1e5, conductivity=0.3), SLIDE)
    yield Case(f"{sweep}/rubbing", bank(walls=ROUGH), [["step", 0.1, 20]])
    yield Case(f"{sweep}/kozeny_carman", conducting_by_porosity(bank()), SLIDE)
    yield Case(f"{sweep}/bedded", bedded(bank(rain=1e-3, table=-1.0, walls=ROUGH)), [["step", 0.1, 20]])
    yield Case(f"{sweep}/one_way", bedded(bank(conductivity=0.3), 1e-20, 45.0), SLIDE)
    yield Case(f"{sweep}/porous", bank(porosity=0.9), SLIDE)
    yield Case(f"{sweep}/dense", bank(porosity=0.05), SLIDE)


def strength_cases():
    softening = {"residualCohesion": 0.0, "residualFrictionAngle": 1.0, "slip": 1e-4}
    soil = dry(earth(cohesion=2e3, friction=30))
    soil["solid"]["softening"] = softening
    yield Case("dynamic/softens_at_once", dynamic(bank(), [soil], HELD, 0.25), SLIDE)
    for diameter, number in ((1e-3, 0.279), (1e-6, 1e3), (0.25, 0.279), (10, 1e-3)):
        soil = dry(earth(cohesion=50, friction=20))
        soil["solid"]["inertialFriction"] = {"limitFrictionAngle": 80.0, "inertialNumber": number, "grainDiameter": diameter}
        yield Case(f"dynamic/inertial_{diameter:g}_{number:g}", dynamic(bank(), [soil], HELD, 0.25), SLIDE)
    yield Case("dynamic/dilation_is_friction", dry_bank(friction=40, dilation=40, cohesion=50), SLIDE)
    resting = dry_bank(walls=RUBBING)
    resting["dynamics"]["restSpeed"] = 0.05
    yield Case("dynamic/held_at_rest", resting, [["step", 0.1, 100]])
    resting = wet_bank(rain=1e-5)
    resting["dynamics"]["restSpeed"] = 0.05
    yield Case("dynamic/moist_held_at_rest", resting, [["step", 0.1, 100]])
    yield Case("dynamic/no_tension", dry_bank(tensile=0.0), SLIDE)


def time_cases():
    yield Case("dynamic/tiny_steps", dry_bank(), [["step", 1e-6, 2000]])
    yield Case("dynamic/step_of_nothing", dry_bank(), [["refused_step", 0.0, 3], ["step", 0.1, 2]])
    yield Case("dynamic/a_minute_at_once", dry_bank(), [["step", 60.0, 1]])
    yield Case("dynamic/uneven_steps", wet_bank(), [["step", seconds, 1] for seconds in (1e-6, 0.3, 1e-4, 0.2, 1e-5, 0.5)])


def cases():
    for sweep in SWEEPS:
        yield from sweep.cases()
    yield from flight_cases()
    yield from water_cases()
    yield from gas_cases("dynamic_gas", gassy_bank)
    yield from gas_cases("dynamic_exchange", moist_bank)
    yield from strength_cases()
    yield from time_cases()
