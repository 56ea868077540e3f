"""Dynamic ground: columns of dry sand that collapse, against experiments; a cohesive slope that softens, over three cell sizes."""

import column_collapse as experiments
import numpy
from rows import Clock, engine_from, read_scene, row

# --- columns of sand ---

THINNEST = 0.01  # of the column's length: ground thinner than that is no front; a grain of the experiments'
COLUMN_CELLS = 20  # in the column's length


def thickness(engine):
    """Places along x, a cell apart, and the thickness of the ground there: its volume per width."""
    cell_size = engine.describe()["cell_size"]
    x = engine.read("point_position")[:, 0]
    columns = numpy.floor(x / cell_size).astype(int)
    volume = numpy.bincount(columns, weights=engine.read("point_volume"))
    return cell_size * (numpy.arange(len(volume)) + 0.5), volume / cell_size


def come_to_rest(engine, height):
    """Steps until the ground has come to rest: some times that of a fall from its height."""
    engine.advance_to(10 * numpy.sqrt(2 * height / 9.81))
    report = engine.advance_to(12 * numpy.sqrt(2 * height / 9.81))
    assert report["largest_velocity"] < 0.02 * numpy.sqrt(2 * 9.81 * height), "it still moves"


def collapse(length, height, soil, friction_angle):
    """The engine after the collapse of a column between a smooth wall and nothing, on a base with friction."""
    scene = read_scene("column_collapse")
    scene["ground"]["section"].update(terrain=[[0, height], [length, height]], base=[[0, 0], [length, 0]])
    scene["boundaries"][0]["frictionAngle"] = friction_angle
    scene["dynamics"]["cellSize"] = length / COLUMN_CELLS
    scene["initial"]["k0"] = 1 - numpy.sin(numpy.radians(friction_angle))
    scene["soils"][0].update(soil)
    del scene["probes"]
    engine = engine_from(scene)
    come_to_rest(engine, height)
    return engine


def front(x, height, length):
    """Where the ground ends: the edge of the last column of cells in which it is no thinner than a grain."""
    return x[height > THINNEST * length][-1] + 0.5 * (x[1] - x[0])


def lube_rows():
    length = 0.1
    for aspect in (0.5, 1, 2, 4):
        with Clock() as clock:
            engine = collapse(length, aspect * length, {}, 31)
            x, height = thickness(engine)
        run_out = front(x, height, length) / length - 1
        for quantity, found, wanted in (("run-out", run_out, experiments.run_out(aspect)),
                                        ("height", height.max() / length, experiments.final_height(aspect))):
            yield row("column_collapse", f"{quantity}, a = {aspect:g}: {found:.3g}, not {wanted:.3g}", "rel",
                      abs(found / wanted - 1), 0.1, "1", "Lube and others 2005", clock)


def bui_rows():
    rods = experiments.BUI_SOIL
    solid = {"model": "mohrCoulomb", "youngModulus": rods["young"], "poissonRatio": rods["poisson"],
             "strength": {"model": "constant", "cohesion": rods["cohesion"], "frictionAngle": rods["friction_angle"]}}
    with Clock() as clock:
        engine = collapse(rods["length"], rods["height"], {"dryDensity": rods["density"], "solid": solid}, rods["friction_angle"])
        x, height = thickness(engine)
    surface = numpy.interp(experiments.BUI_SURFACE[:, 0], x, height, right=0)
    worst = numpy.max(numpy.abs(surface - experiments.BUI_SURFACE[:, 1]))
    found = front(x, height, rods["length"]) - rods["length"]
    wanted = experiments.BUI_SURFACE[-1, 0] - rods["length"]
    source = "Bui and others 2008"
    yield row("column_collapse", "surface of rods, over their height", "max", worst / rods["height"], 0.1, "1", source, clock)
    yield row("column_collapse", f"run-out of rods: {found:.3g}, not {wanted:.3g} m", "rel", abs(found / wanted - 1), 0.1, "1",
              source, clock)


def collapse_rows():
    yield from bui_rows()
    yield from lube_rows()


# --- a cohesive slope that softens ---

SLOPE_CELLS = (0.25, 0.125, 0.0625)  # m


def slide(cell_size):
    """Step report after the slope has come to rest, and its final profile."""
    scene = read_scene("cohesive_slope")
    scene["dynamics"]["cellSize"] = cell_size
    with engine_from(scene) as engine:
        report = engine.advance_to(scene["schedule"]["duration"])
        assert report["largest_velocity"] < 0.1, "it still moves"
        return report, thickness(engine)


def slope_rows():
    case, source = "cohesive_slope", "twice the cell's size"
    reports, profiles, clocks = [], [], []
    for cell_size in SLOPE_CELLS:
        with Clock() as clock:
            report, profile = slide(cell_size)
        reports.append(report)
        profiles.append(profile)
        clocks.append(clock)
    for name, quantity in (("run_out", "run-out"), ("dissipated_energy", "dissipated energy")):
        values = [report[name] for report in reports]
        listed = ", ".join(f"{value:.4g}" for value in values)
        yield row(case, f"{quantity}: {listed}", "rel", abs(values[-1] / values[-2] - 1), 0.05, "1", source, clocks[-1])
    (x, coarse), (finer_x, fine) = profiles[-2:]
    difference = numpy.abs(numpy.interp(x, finer_x, fine, right=0) - coarse)
    yield row(case, "profile, mean, over the height", "L1", numpy.mean(difference) / 5, 0.05, "1", source, clocks[-1])
