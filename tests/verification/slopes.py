"""The paper's slopes under 36 h of rain against the independent FEM."""

import json

import numpy
from rows import REFERENCES, Clock, engine_from, engine_of, read_csv, read_scene, row
from settings import set_resolution, set_tolerance

HOUR = 3600.0
PRESSURE_BOUND = 350.0  # Pa
SATURATION_BOUND = 0.002
BALANCE_BOUND = 1e-8  # of the rain
DISPLACEMENT_BOUNDS = {"crest": 0.11e-3, "face": 0.11e-3, "toe": 0.3e-3}  # m, slope_gentle
WALL_BOUNDS = {"slope_gentle": 10.0, "slope": 20.0}  # s


def simulate(make_engine):
    """36 h of rain, watched every hour: the engine and the clock."""
    with Clock() as clock:
        engine = make_engine()
        watch_beside_toe(engine)
        for hour in range(1, 37):
            engine.advance_to(hour * HOUR)
    return engine, clock


def watch_beside_toe(engine):
    """The toe is a singular point, where every mesh has its own displacement; 1 m in front of it meshes agree."""
    toe = next(probe for probe in engine.describe()["probes"] if probe["name"] == "toe")
    engine.add_probe("beside_toe", toe["x"] + 1.0, toe["y"])


def history(engine, probe, quantity):
    return numpy.asarray(engine.history(probe, quantity)[1])


def history_errors(case, engine):
    """Largest errors of the hourly samples, by the names of the baseline (reference/baseline.py)."""
    reference = read_csv(f"{case}.csv")
    errors = {}
    for probe in "ABC":
        for name, unit in (("pressure", "_Pa"), ("saturation", "")):
            exact = reference[f"{name}_{probe}{unit}"]
            errors[f"{name}_{probe}{unit}"] = numpy.max(numpy.abs(history(engine, probe, name) - exact))
    for probe in ("crest", "face", "toe", "beside_toe"):
        x, y = (history(engine, probe, f"displacement.{axis}") - reference[f"u{axis}_{probe}_m"] for axis in "xy")
        errors[f"displacement_{probe}_m"] = numpy.max(numpy.hypot(x, y))
    return errors


def field_error(case, engine):
    """Root mean square of the pressure's error over the reference's raster at 36 h."""
    field = read_csv(f"{case}_field.csv")
    places = numpy.stack([field["x_m"], field["y_m"]], axis=1)
    return numpy.sqrt(numpy.mean((engine.sample("pressure", places) - field["pressure_Pa"]) ** 2))


def moved(engine, probe):
    """Displacement at the end, m."""
    return numpy.hypot(*(history(engine, probe, f"displacement.{axis}")[-1] for axis in "xy"))


def balance_error(engine):
    """Water that the balance misses, of the rain."""
    report = engine.report()
    return abs(report["water_residual"]) / report["water_rain"]


def losses(engine):
    return [event for event in engine.events() if event["kind"] == "loss_of_equilibrium"]


def triangles_rows():
    """The paper's triangles, no worse than its FEM of 1222 quads; both against the reference."""
    case = "slope_triangles"
    engine, clock = simulate(lambda: engine_of(case))
    baseline = json.loads((REFERENCES / "baseline_slope.json").read_text())["errors"]
    for name, error in history_errors("slope", engine).items():
        unit = "Pa" if name.endswith("_Pa") else "m" if name.endswith("_m") else "1"
        quantity = name.removesuffix(f"_{unit}").replace("_", " at ", 1)
        yield row(case, quantity, "max", error, baseline[name], unit, "the FEM of 1222 quads", clock)


def failure_rows():
    """With 8 kPa of cohesion the wet layer along the face has, as an infinite slope, a factor below one."""
    case = "slope_failure"
    engine, clock = simulate(lambda: engine_of(case))
    missing = float(not losses(engine))
    yield row(case, "loss of equilibrium reported", "abs", missing, 0.0, "1", "infinite slope: factor 0.9", clock)


def settling_rows():
    """Near a factor of one: with the mesh displacements settle; with tolerance and step neither they nor the answer change."""
    case = "slope"

    def coarser(factor):
        scene = read_scene(case)
        set_resolution(scene, factor)
        return simulate(lambda: engine_from(scene))

    meshes = [coarser(factor) for factor in (2.0, 1.0, 0.5)]
    for probe in ("crest", "toe"):
        each = [moved(engine, probe) for engine, _ in meshes]
        spread = (max(each) - min(each)) / each[1]
        yield row(case, f"three meshes: spread at {probe}", "rel", spread, 0.05, "1", "cells of 2, 1, 0.5 times the size", meshes[-1][1])
    usual = meshes[1][0]
    for name, tightening, step in (("tolerance / 10", 0.1, HOUR), ("step of 6 h", 1.0, 6 * HOUR)):
        with Clock() as clock:
            scene = read_scene(case)
            set_tolerance(scene, tightening)
            engine = engine_from(scene)
            for k in range(1, round(36 * HOUR / step) + 1):
                engine.advance_to(k * step)
        for probe in ("crest", "toe"):
            off = abs(moved(engine, probe) / moved(usual, probe) - 1.0)
            yield row(case, f"{name}: displacement at {probe}", "rel", off, 0.01, "1", "usual tolerance and step", clock)
        differ = abs(len(losses(engine)) - len(losses(usual)))
        yield row(case, f"{name}: stable or not", "abs", differ, 0.0, "1", "usual tolerance and step", clock)


def rows(case):
    source = f"{case}.csv, independent FEM"
    engine, clock = simulate(lambda: engine_of(case))
    errors = history_errors(case, engine)
    reference = read_csv(f"{case}.csv")
    for probe in "ABC":
        error = errors[f"pressure_{probe}_Pa"]
        relative = error / numpy.max(numpy.abs(reference[f"pressure_{probe}_Pa"]))
        yield row(case, f"pressure at {probe}", "max", error, PRESSURE_BOUND, "Pa", source, clock)
        yield row(case, f"pressure at {probe}, relative", "max", relative, 0.011, "1", source, clock)
        yield row(case, f"saturation at {probe}", "max", errors[f"saturation_{probe}"], SATURATION_BOUND, "1", source, clock)
    if case == "slope_gentle":
        for probe, bound in DISPLACEMENT_BOUNDS.items():
            yield row(case, f"displacement at {probe}", "max", errors[f"displacement_{probe}_m"], bound, "m", source, clock)
    if case == "slope":
        for probe, paper in (("crest", 0.016), ("toe", 0.018)):
            off = abs(moved(engine, probe) / paper - 1.0)
            yield row(case, f"displacement at {probe} after 36 h", "rel", off, 0.2, "1", f"paper: {paper} m", clock)
        below = history(engine, "below the crest", "pressure")[-1]
        yield row(case, "pressure 0.5 m below the crest", "abs", abs(below + 12e3), 500.0, "Pa", "paper: -12 kPa", clock)
    yield row(case, "water balance", "rel", balance_error(engine), BALANCE_BOUND, "1", "mass balance", clock)
    yield row(case, "wall seconds", "abs", clock.wall, WALL_BOUNDS[case], "s", "requirement", clock)
    if case == "slope":
        yield from settling_rows()
