"""Water in rigid columns: the sweeps, and cases of their own."""

from case import DAY, HOUR, Case, Sweep
from scenes import MM_PER_HOUR, WATER_WEIGHT, column, soil

RAINS = (10, 0.1, 1, 100, 1000)  # mm/h


def two_layers(upper, lower):
    """Coarse soils have a low air entry: alpha follows K."""
    return column([layer_soil("upper", upper), layer_soil("lower", lower)],
                  [{"soil": "upper"}, {"soil": "lower", "top": 0.5}], suction=1e4, base=0.0)


def layer_soil(name, conductivity):
    return soil(name, alpha=1e-4 * (conductivity / 1e-5) ** 0.25, conductivity=conductivity)


def many_layers(conductivities):
    """Layers of the same height from top to bottom."""
    soils = {conductivity: layer_soil(f"{conductivity:g}", conductivity) for conductivity in conductivities}
    count = len(conductivities)
    layers = [{"soil": f"{conductivity:g}", "top": 1 - index / count} for index, conductivity in enumerate(conductivities)]
    return column(list(soils.values()), layers, suction=1e4, base=0.0)


def alternating(count, conductivity):
    return many_layers([(1e-5, conductivity)[index % 2] for index in range(count)])


SWEEPS = (
    Sweep("n_alpha", ("N", "alpha, 1/kPa"), ((2, 1.03, 1.1, 1.2, 1.5, 3, 6, 12), (0.1, 1e-4, 1e-3, 1e-2, 1, 10)),
          lambda n, alpha: column([soil(n=n, alpha=alpha * 1e-3)], suction=1e4, rain=1e-6), [["step", HOUR, 24]]),
    Sweep("k_rain", ("K, m/s", "rain, mm/h"), ((1e-5, 1e-13, 1e-11, 1e-9, 1e-7, 1e-3, 1e-1), RAINS),
          lambda k, rain: column([soil(conductivity=k)], suction=1e4, rain=rain * MM_PER_HOUR), [["step", HOUR, 24]]),
    Sweep("n_rain", ("N", "rain, mm/h"), ((2, 1.03, 1.2, 4, 12), RAINS),
          lambda n, rain: column([soil(n=n)], suction=1e4, rain=rain * MM_PER_HOUR), [["step", HOUR, 24]]),
    Sweep("alpha_rain", ("alpha, 1/kPa", "rain, mm/h"), ((0.1, 1e-4, 1e-2, 1, 10), RAINS),
          lambda alpha, rain: column([soil(alpha=alpha * 1e-3)], suction=1e4, rain=rain * MM_PER_HOUR), [["step", HOUR, 24]]),
    Sweep("suction_rain", ("initial suction, Pa", "rain, mm/h"), ((1e4, 0, 1e2, 1e6, 1e9), RAINS),
          lambda suction, rain: column(suction=suction, rain=rain * MM_PER_HOUR), [["step", HOUR, 24]]),
    Sweep("suction_n", ("initial suction, Pa", "N"), ((1e4, 0, 1e2, 1e3, 1e5, 1e6, 1e7, 1e8, 1e9), (2, 1.03, 1.2, 4, 12)),
          lambda suction, n: column([soil(n=n)], suction=suction), [["step", HOUR, 24]]),
    Sweep("layers", ("K of the upper half, m/s", "K of the lower half, m/s"), ((1e-5, 1e-10, 1e-7, 1e-2),) * 2,
          two_layers, [["step", HOUR, 48]], monotone=False),
    Sweep("many_layers", ("layers", "K of every other layer, m/s"), ((2, 3, 5, 10, 20), (1e-5, 1e-13, 1e-10, 1e-7, 1e-2)),
          alternating, [["step", HOUR, 48]], monotone=False),
    Sweep("porosity_residual", ("porosity", "residual saturation"), ((0.4, 0.05, 0.2, 0.9), (0, 0.1, 0.5, 0.95)),
          lambda porosity, residual: column([soil(porosity=porosity, residual=residual)]), [["step", HOUR, 24]]),
)


def seam(thickness):
    return column([soil(), soil("clay", alpha=1e-5, conductivity=1e-11)],
                  [{"soil": "soil"}, {"soil": "clay", "top": 0.5}, {"soil": "soil", "top": 0.5 - thickness}])


def stack_cases():
    """Contrasts up to 1e11 between neighbours, in more than two layers."""
    ladder = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10]
    wet = [["step", HOUR, 48]]
    yield Case("stack/benign", many_layers([1e-5, 3e-6, 1e-5]), wet)
    yield Case("stack/finer_downwards", many_layers(ladder), wet)
    yield Case("stack/coarser_downwards", many_layers(ladder[::-1]), wet)
    yield Case("stack/sand_clay_sand", many_layers([1e-2, 1e-13, 1e-2]), wet)
    yield Case("stack/clay_sand_clay", many_layers([1e-13, 1e-2, 1e-13]), wet)
    yield Case("stack/varved", many_layers([1e-2, 1e-10] * 10), wet)


def level_cases():
    """The water table goes up to the surface or falls away from it; the base's pressure says when."""
    def moving(seconds, first, last):
        scene = column(rain=0.0, base=first * WATER_WEIGHT, initial={"flow": "hydrostatic", "waterTable": first})
        scene["boundaries"][0]["flowValue"] = {"time": [0, seconds], "value": [first * WATER_WEIGHT, last * WATER_WEIGHT]}
        return scene
    for name, seconds in (("slow", 10 * DAY), ("fast", 1.0), ("at_once", 1e-3)):
        steps = [["step", seconds, 2], ["step", HOUR, 48]]
        yield Case(f"drawdown/{name}", moving(seconds, 1.0, -5.0), steps)
        yield Case(f"rise/{name}", moving(seconds, 0.2, 1.0), steps, monotone=True)
        yield Case(f"rise/{name}_artesian", moving(seconds, 0.2, 2.0), steps, monotone=True)


def fill_cases():
    rain = 1e-5
    full = {"flow": "saturation", "saturation": 0.85}
    yield Case("fill/before", column(rain=rain, initial=full), [["step", 500, 10]], monotone=True)
    yield Case("fill/last_pore", column(rain=rain, initial=full), [["step", 600, 10]], monotone=True)
    yield Case("fill/beyond", column(rain=rain, initial=full), [["step", 600, 30]], monotone=True)
    yield Case("fill/beyond_n_1.03", column([soil(n=1.03)], rain=rain, initial=full), [["step", 600, 30]], monotone=True)
    yield Case("fill/ponded", column(rain=rain, initial=full, ponding=0.05), [["step", 600, 30]], monotone=True)


def weather_cases():
    for suction in (1e4, 1e6, 1e8):
        scene = column(rain=None, initial={"flow": "hydrostatic", "waterTable": 1.0})
        scene["boundaries"] = [{"name": "air", "side": "surface", "flow": "pressure", "flowValue": {"value": [-suction]}}]
        yield Case(f"drying/{suction:g}", scene, [["step", HOUR, 48]])
    yield Case("rain/steady", column(rain=1e-5), [["step", 600, 60]], monotone=True)
    yield Case("rain/on_off_on", column(), [["rain", 1e-4], ["step", 300, 2], ["rain", 0.0], ["step", 300, 1]] * 20)
    yield Case("rain/ponding_on_off", column([soil(conductivity=1e-6)], ponding=0.02),
               [["rain", 2e-4], ["step", 120, 2], ["rain", 0.0], ["step", 1800, 4]] * 12)


def cases():
    for sweep in SWEEPS:
        yield from sweep.cases()
    yield Case("seam/one_cell", seam(0.025), [["step", HOUR, 48]])
    yield Case("seam/thinner_than_a_cell", seam(0.01), [["step", HOUR, 1]], refusal="cell",
               why="no layer may be thinner than a cell (docs/scenes.md)")
    yield from stack_cases()
    yield from fill_cases()
    yield from level_cases()
    yield from weather_cases()
