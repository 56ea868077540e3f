"""Ground that deforms: the undrained limit, strength, stiffness contrasts, ground near its limit load."""

import math

from block_scenes import compressive_strength, dry_block, heaving_column, wetted_block
from case import DAY, HOUR, Case, Sweep
from scenes import earth, elastic_soil, loaded_column, small_slope

STORM = [["step", HOUR, 12]]
LIMIT_SHARE = 0.6434  # of 3 kPa and tan 30 degrees, which the small slope just needs in a storm: by bisection with the engine
RATIOS = (0.98, 1.02)  # of the load to the limit load, or of the strength to that needed


def yielding_column(poisson, ramp):
    """Clay without friction that its own weight has brought to yield: there it is softer than the elastic ground of a split."""
    clay = earth(cohesion=1e4, friction=0, poisson=poisson, young=1e8, alpha=1e-5, conductivity=1e-9)
    return loaded_column(bulk_modulus=1e13, ramp=ramp, soils=[clay])


SWEEPS = (
    Sweep("split", ("K, m/s", "step, s"), ((1e-9, 1e-13, 1e-18), (1e4, 1e-6, 1e-4, 1e-2, 1, 1e2, 1e6, 1e8)),
          lambda conductivity, step: loaded_column(conductivity, bulk_modulus=1e13, ramp=step),
          lambda conductivity, step: [["step", step, 1]] * 30, monotone=False, settles=True),
    Sweep("split_yielding", ("Poisson ratio", "step, s"), ((0.3, 0, 0.1, 0.2, 0.45), (1e4, 1e-6, 1e-2, 1e2, 1e6, 1e8)),
          yielding_column,
          lambda poisson, step: [["step", step, 1]] * 30, monotone=False, settles=True),
)


def undrained_cases():
    yield Case("undrained/benign", loaded_column(), [["step", 8e4, 10]])
    for conductivity in (1e-9, 1e-13, 1e-18):
        for first in (1e-6, 1e-2, 1e4, 1e8):
            scene = loaded_column(conductivity, bulk_modulus=1e13)
            yield Case(f"undrained/{conductivity:g}_{first:g}", scene, [["step", first, 1], ["step", HOUR, 10]])
    for poisson in (0.0, 0.45, 0.49, 0.4999):
        yield Case(f"undrained/nu_{poisson:g}", loaded_column(poisson=poisson), [["step", 8e4, 10]])


def strength_cases():
    yield Case("solid/benign", small_slope(), STORM)
    yield Case("solid/no_cohesion", small_slope(cohesion=0), STORM)
    yield Case("solid/no_cohesion_steep", small_slope(cohesion=0, friction=27), STORM)
    yield Case("solid/no_friction", small_slope(friction=0), STORM)
    yield Case("solid/no_strength", small_slope(cohesion=0, friction=0), STORM, refusal="must have one",
               why="a soil of Mohr-Coulomb has cohesion or friction")
    yield Case("solid/friction_50", small_slope(friction=50), STORM)
    yield Case("solid/dilation_is_friction", small_slope(friction=50, dilation=50), STORM)
    yield Case("solid/no_tension", small_slope(tensile=0.0), STORM)
    yield Case("solid/nu_0.4999", small_slope(poisson=0.4999), STORM)
    yield Case("solid/stiff", small_slope(young=1e13), STORM)
    yield Case("solid/undrained", small_slope(conductivity=1e-18), STORM)
    yield Case("solid/bishop", small_slope(stress="bishop"), STORM)
    for model, entries in (("constant", {}), ("fredlund", {"suctionFrictionAngle": 15}),
                           ("exponential", {"cohesionGain": 2e4, "cohesionRate": 1000, "frictionGain": 60})):
        yield Case(f"solid/{model}", small_slope(strength={"model": model, **entries}), STORM)
    rising = small_slope(rain=0.0)
    rising["boundaries"][1].update(flow="hydrostatic", flowValue={"time": [0, DAY], "value": [1.0, 4.0]})
    yield Case("solid/water_table_to_the_surface", rising, [["step", HOUR, 240]])


def lens(inside, outside):
    """A slope with a lens that ends within it, of another stiffness."""
    layers = [{"soil": "outside"}, {"soil": "inside", "top": [[0, 1.2], [3, 1.2], [6, 2.2], [9, 1.2], [14, 1.2]]},
              {"soil": "outside", "top": [[0, 1.2], [14, 1.2]]}]
    return small_slope(soils=[earth("outside", young=outside), earth("inside", young=inside)], layers=layers)


def banded(inside, outside):
    """A loaded column with a band of another stiffness."""
    soils = [elastic_soil("outside", outside), elastic_soil("inside", inside)]
    return loaded_column(soils=soils, layers=[{"soil": "outside"}, {"soil": "inside", "top": 6}, {"soil": "outside", "top": 4}])


def stiffness_cases():
    """Contrasts of 1e6, either way round."""
    for name, scene_of, steps in (("lens", lens, STORM), ("band", banded, [["step", 8e4, 10]])):
        yield Case(f"stiffness_{name}/benign", scene_of(1e7, 1e7), steps)
        yield Case(f"stiffness_{name}/stiff", scene_of(1e13, 1e7), steps)
        yield Case(f"stiffness_{name}/soft", scene_of(1e7, 1e13), steps)


def near_failure(ratio):
    """The small slope with `ratio` times the strength that it needs to stand the storm."""
    friction = math.degrees(math.atan(ratio * LIMIT_SHARE * math.tan(math.radians(30))))
    return small_slope(cohesion=3e3 * ratio * LIMIT_SHARE, friction=round(friction, 6), rain=1e-5)


def limit_cases():
    """Loads just below and just above what the ground bears at most, which is known in closed form."""
    for ratio in RATIOS:
        yield Case(f"limit_slope/{ratio:g}", near_failure(ratio), [["step", HOUR, 48]], loses=ratio < 1)
    load = [["step", 0.1, 20]]
    for ratio in RATIOS:
        loses = ratio > 1
        for friction in (0, 30, 50):
            for dilation in sorted({0, friction}):
                soil = earth(cohesion=1e4, friction=friction, dilation=dilation, young=1e9)
                yield Case(f"limit_block/{friction}_{dilation}_{ratio:g}",
                           dry_block(soil, -ratio * compressive_strength(1e4, friction)), load, loses=loses)
        yield Case(f"limit_tension/{ratio:g}", dry_block(earth(tensile=2e3, young=1e9), ratio * 2e3), load, loses=loses)
        for stress in ("net", "bishop"):
            yield Case(f"limit_heave/{stress}_{ratio:g}", heaving_column(ratio, stress), [["step", HOUR, 48]], loses=loses)
        for seconds in (1e-3, 60.0):
            yield Case(f"suction_lost/{seconds:g}_{ratio:g}", wetted_block(ratio, seconds),
                       [["step", 0.5, 4], ["step", 10.0, 60]], loses=loses)


def weak_cases():
    """Ground that yields widely, some of it until it fails."""
    kinds = {"net": {}, "bishop": {"stress": "bishop"}, "tensile_100": {"tensile": 100.0}, "no_tension": {"tensile": 0.0},
             "dilation": {"dilation": 15},
             "constant": {"strength": {"model": "constant"}},
             "fredlund": {"strength": {"model": "fredlund", "suctionFrictionAngle": 15}},
             "exponential": {"strength": {"model": "exponential", "cohesionGain": 2e3, "cohesionRate": 10, "frictionGain": 10}}}
    for name, entries in kinds.items():
        for cohesion, friction in ((2500, 24), (1000, 18)):
            yield Case(f"weak/{name}_{cohesion}", small_slope(cohesion=cohesion, friction=friction, rain=1e-5, **entries),
                       [["step", HOUR, 1]] * 24)


def cases():
    for sweep in SWEEPS:
        yield from sweep.cases()
    yield from undrained_cases()
    yield from strength_cases()
    yield from weak_cases()
    yield from stiffness_cases()
    yield from limit_cases()
