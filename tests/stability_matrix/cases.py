"""The cases of the matrix: a scene, what a host does with it, what is expected. The first case of a sweep is its benign one."""

import random
from dataclasses import dataclass, replace

from scenes import MM_PER_HOUR, WATER_WEIGHT, column, loaded_column, small_slope, soil

HOUR = 3600.0
DAY = 24 * HOUR
YEAR = 365.25 * DAY
QUICK = ("n_alpha/2_0.1", "n_alpha/1.03_0.0001", "fill/beyond", "rain/on_off_on", "time/tiny_steps", "time/zero_step")


@dataclass(frozen=True)
class Case:
    name: str  # sweep/values
    scene: dict
    steps: list  # ["step", s, times], ["rain", m/s], ["flow", boundary, value]
    monotone: bool = False  # no peak inside the column, of saturation or pressure
    refusal: str = ""  # text of the only refusal that is right; the case must be refused so
    why: str = ""  # why that refusal is right
    place: tuple = ()  # its two parameters on the map of the sweep
    bound: float = 20.0  # s of wall time
    tightened: bool = False  # run again with a tenth of the tolerance

    @property
    def sweep(self):
        return self.name.split("/")[0]


@dataclass(frozen=True)
class Sweep:
    """Two parameters, their benign values first; `scene_of` takes one of each."""
    name: str
    labels: tuple
    values: tuple
    scene_of: object
    steps: list
    monotone: bool = True

    def cases(self):
        for first in self.values[0]:
            for second in self.values[1]:
                yield Case(f"{self.name}/{first:g}_{second:g}", self.scene_of(first, second), self.steps, self.monotone,
                           place=(first, second))


SWEEPS = (
    Sweep("n_alpha", ("N", "alpha, 1/kPa"), ((2, 1.03, 1.1, 1.2, 1.5, 3, 6, 12), (0.1, 1e-4, 1e-3, 1e-2, 1, 10)),
          lambda n, alpha: column([soil(n=n, alpha=alpha * 1e-3)], suction=1e4, rain=1e-6), [["step", HOUR, 24]]),
    Sweep("k_rain", ("K, m/s", "rain, mm/h"), ((1e-5, 1e-13, 1e-11, 1e-9, 1e-7, 1e-3, 1e-1), (10, 0.1, 1, 100, 1000)),
          lambda k, rain: column([soil(conductivity=k)], suction=1e4, rain=rain * MM_PER_HOUR), [["step", HOUR, 24]]),
    Sweep("suction_n", ("initial suction, Pa", "N"), ((1e4, 0, 1e2, 1e3, 1e5, 1e6), (2, 1.03, 1.2, 4, 12)),
          lambda suction, n: column([soil(n=n)], suction=suction), [["step", HOUR, 24]]),
    Sweep("layers", ("K of the upper half, m/s", "K of the lower half, m/s"), ((1e-5, 1e-10, 1e-7, 1e-2),) * 2,
          lambda upper, lower: two_layers(upper, lower), [["step", HOUR, 48]], monotone=False),
    Sweep("porosity_residual", ("porosity", "residual saturation"), ((0.4, 0.05, 0.2, 0.9), (0, 0.1, 0.5, 0.95)),
          lambda porosity, residual: column([soil(porosity=porosity, residual=residual)]), [["step", HOUR, 24]]),
)


def two_layers(upper, lower):
    """Coarse soils have a low air entry: alpha follows K."""
    def layer(name, conductivity):
        return soil(name, alpha=1e-4 * (conductivity / 1e-5) ** 0.25, conductivity=conductivity)
    return column([layer("upper", upper), layer("lower", lower)],
                  [{"soil": "upper"}, {"soil": "lower", "top": 0.5}], suction=1e4, base=0.0)


# --- cases of their own ---

def seam(thickness):
    return column([soil(), soil("clay", alpha=1e-5, conductivity=1e-11)],
                  [{"soil": "soil"}, {"soil": "clay", "top": 0.5}, {"soil": "soil", "top": 0.5 - thickness}])


def water_cases():
    rain = 1e-5
    yield Case("seam/one_cell", seam(0.025), [["step", HOUR, 48]])
    yield Case("seam/thinner_than_a_cell", seam(0.01), [["step", HOUR, 1]], refusal="cell",
               why="no layer may be thinner than a cell (docs/scenes.md)")
    full = {"flow": "saturation", "saturation": 0.85}
    yield Case("fill/before", column(rain=rain, initial=full), [["step", 500, 10]], monotone=True)
    yield Case("fill/last_pore", column(rain=rain, initial=full), [["step", 600, 10]], monotone=True)
    yield Case("fill/beyond", column(rain=rain, initial=full), [["step", 600, 30]], monotone=True)
    yield Case("fill/beyond_n_1.03", column([soil(n=1.03)], rain=rain, initial=full), [["step", 600, 30]], monotone=True)
    yield Case("fill/ponded", column(rain=rain, initial=full, ponding=0.05), [["step", 600, 30]], monotone=True)
    table = {"flow": "hydrostatic", "waterTable": 1.0}
    for name, seconds in (("slow", 10 * DAY), ("fast", 1.0), ("at_once", 1e-3)):
        scene = column(rain=0.0, base=WATER_WEIGHT, initial=table)
        scene["boundaries"][0]["flowValue"] = {"time": [0, seconds], "value": [WATER_WEIGHT, -5 * WATER_WEIGHT]}
        yield Case(f"drawdown/{name}", scene, [["step", seconds, 2], ["step", HOUR, 48]])
    for suction in (1e4, 1e6, 1e8):
        scene = column(rain=None, initial=table)
        scene["boundaries"] = [{"name": "air", "side": "surface", "flow": "pressure", "flowValue": {"value": [-suction]}}]
        yield Case(f"drying/{suction:g}", scene, [["step", HOUR, 48]])
    yield Case("rain/steady", column(rain=rain), [["step", 600, 60]], monotone=True)
    yield Case("rain/on_off_on", column(), [["rain", 1e-4], ["step", 300, 2], ["rain", 0.0], ["step", 300, 1]] * 20)
    yield Case("rain/ponding_on_off", column([soil(conductivity=1e-6)], ponding=0.02),
               [["rain", 2e-4], ["step", 120, 2], ["rain", 0.0], ["step", 1800, 4]] * 12)


def time_cases():
    yield Case("time/benign", column(), [["step", 60, 100]], monotone=True)
    yield Case("time/tiny_steps", column(), [["step", 1e-3, 1000]] * 10, monotone=True)
    yield Case("time/tiniest_steps", column(), [["step", 1e-6, 1000]], monotone=True)
    yield Case("time/year_at_once", column(), [["step", YEAR, 1]], monotone=True)
    yield Case("time/uneven", column(base=-1e4), [["step", dt, 1] for dt in (1e-6, YEAR, 1e-3, DAY, 1e-5, HOUR, 1.0, YEAR)])
    yield Case("time/drizzle_100_years", column(rain=1e-9, base=-1e4), [["step", YEAR, 100]])
    yield Case("time/late_clock", column(rain=1e-9, base=-1e4), [["step", 1e9, 1], ["rain", 1e-6], ["step", 1e-3, 100],
                                                                ["step", 60, 60]])
    yield Case("time/zero_step", column(), [["step", 60, 1], ["step", 0, 1]], refusal="must be positive",
               why="a step carries the run on (docs/api.md)")


def coupled_cases():
    yield Case("undrained/benign", loaded_column(), [["step", 8e4, 10]])
    for conductivity in (1e-9, 1e-13, 1e-18):
        for first in (1e-6, 1e-2, 1e4, 1e8):
            scene = loaded_column(conductivity, bulk_modulus=1e13)
            yield Case(f"undrained/{conductivity:g}_{first:g}", scene, [["step", first, 1], ["step", HOUR, 10]])
    for poisson in (0.0, 0.45, 0.49, 0.4999):
        yield Case(f"undrained/nu_{poisson:g}", loaded_column(poisson=poisson), [["step", 8e4, 10]])


def solid_cases():
    storm = [["step", HOUR, 12]]
    yield Case("solid/benign", small_slope(), storm)
    yield Case("solid/no_cohesion", small_slope(cohesion=0), storm)
    yield Case("solid/no_cohesion_steep", small_slope(cohesion=0, friction=27), storm)
    yield Case("solid/no_friction", small_slope(friction=0), storm)
    yield Case("solid/no_strength", small_slope(cohesion=0, friction=0), storm, refusal="must have one",
               why="a soil of Mohr-Coulomb has cohesion or friction")
    yield Case("solid/friction_50", small_slope(friction=50), storm)
    yield Case("solid/dilation_is_friction", small_slope(friction=50, dilation=50), storm)
    yield Case("solid/no_tension", small_slope(tensile=0.0), storm)
    yield Case("solid/nu_0.4999", small_slope(poisson=0.4999), storm)
    yield Case("solid/stiff", small_slope(young=1e13), storm)


# --- the random search ---

def random_case(number):
    """All ranges at once; the number is the seed."""
    draw = random.Random(number)

    def log_uniform(low, high):
        return float(f"{low * (high / low) ** draw.random():.4g}")

    def random_soil(name):
        return soil(name, alpha=log_uniform(1e-7, 1e-2), n=round(1 + log_uniform(0.03, 11), 4),
                    conductivity=log_uniform(1e-13, 1e-1), porosity=log_uniform(0.05, 0.9),
                    residual=draw.choice((0.0, log_uniform(1e-3, 0.9))))
    height = log_uniform(0.05, 20)
    layers = [{"soil": "upper"}, {"soil": "lower", "top": height / 2}]
    scene = column([random_soil("upper"), random_soil("lower")], layers, height=height, cells=2 * draw.randint(2, 20),
                   suction=draw.choice((0.0, log_uniform(1, 1e6))), rain=log_uniform(0.1, 1000) * MM_PER_HOUR,
                   base=draw.choice((None, 0.0, -log_uniform(1, 1e5))), ponding=draw.choice((0.0, log_uniform(1e-3, 1))))
    steps = []
    for _ in range(draw.randint(2, 6)):
        steps += [["rain", draw.choice((0.0, log_uniform(0.1, 1000) * MM_PER_HOUR))],
                  ["step", log_uniform(1e-3, 1e6), draw.randint(1, 4)]]
    return Case(f"random/{number}", scene, steps, tightened=True)


def coarse_over_fine(upper, lower, **others):
    """The reduced form of a random scene: two layers of a cell each."""
    return column([soil("upper", **upper), soil("lower", **lower)],
                  [{"soil": "upper"}, {"soil": "lower", "top": others["height"] / 2}], cells=2, **others)


def found_cases():
    """What the random search found, reduced where the failure let itself be."""
    scene = coarse_over_fine({"alpha": 5e-3, "n": 10.0, "conductivity": 1e-2, "residual": 0.04},
                             {"alpha": 4e-7, "conductivity": 3e-4}, height=8.638, suction=1.402, rain=1.298e-4, base=-1120.0)
    yield Case("found/698_reduced", scene, [["step", 909e3, 1]])
    scene = coarse_over_fine({"alpha": 6e-3, "n": 10.0, "residual": 0.04448},
                             {"alpha": 4.5e-7, "n": 1.239, "conductivity": 1.295e-9, "porosity": 0.7234, "residual": 0.027},
                             height=3.022, suction=147e3, rain=1.2675e-5)
    yield Case("found/916_reduced", scene, [["step", 2144, 1]], tightened=True)
    scene = coarse_over_fine(
        {"alpha": 2.922e-3, "n": 1.0784, "conductivity": 2.528e-4, "porosity": 0.09884, "residual": 0.006611},
        {"alpha": 6.503e-3, "n": 7.88, "conductivity": 1.628e-9, "porosity": 0.46, "residual": 0.2741},
        height=0.5136, suction=218.1e3, rain=6.631e-5, ponding=0.2945)
    yield Case("found/1863_reduced", scene, [["step", 101.2e3, 1]], tightened=True)
    for number in (5, 228, 655, 698, 916, 1863):
        yield replace(random_case(number), name=f"found/{number}")


def matrix():
    for sweep in SWEEPS:
        yield from sweep.cases()
    yield from water_cases()
    yield from time_cases()
    yield from coupled_cases()
    yield from solid_cases()
    yield from found_cases()
