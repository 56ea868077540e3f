"""The paper's slopes under 36 h of rain against the independent FEM."""

import numpy
from rows import Clock, engine_of, read_csv, row

HOUR = 3600.0
DISPLACEMENT_BOUNDS = {"crest": 0.11e-3, "face": 0.11e-3, "toe": 0.3e-3}  # m, slope_gentle
WALL_BOUNDS = {"slope_gentle": 10.0, "slope": 20.0}  # s


def rows(case):
    reference = read_csv(f"{case}.csv")
    source = f"{case}.csv, independent FEM"
    with Clock() as clock:
        engine = engine_of(case)
        for hour in range(1, 37):
            engine.advance_to(hour * HOUR)
        report = engine.report()

    def history(probe, quantity):
        return numpy.asarray(engine.history(probe, quantity)[1])

    for probe in "ABC":
        p_ref, s_ref = reference[f"pressure_{probe}_Pa"], reference[f"saturation_{probe}"]
        error = numpy.max(numpy.abs(history(probe, "pressure") - p_ref))
        yield row(case, f"pressure at {probe}", "max", error, 350.0, "Pa", source, clock)
        yield row(case, f"pressure at {probe}, relative", "max", error / numpy.max(numpy.abs(p_ref)), 0.011, "1", source, clock)
        yield row(case, f"saturation at {probe}", "max", numpy.max(numpy.abs(history(probe, "saturation") - s_ref)), 0.002, "1", source, clock)
    for probe, bound in DISPLACEMENT_BOUNDS.items():
        x = history(probe, "displacement.x") - reference[f"ux_{probe}_m"]
        y = history(probe, "displacement.y") - reference[f"uy_{probe}_m"]
        if case == "slope_gentle":
            yield row(case, f"displacement at {probe}", "max", numpy.max(numpy.hypot(x, y)), bound, "m", source, clock)
    if case == "slope":
        for probe, paper in (("crest", 0.016), ("toe", 0.018)):
            moved = numpy.hypot(history(probe, "displacement.x")[-1], history(probe, "displacement.y")[-1])
            yield row(case, f"displacement at {probe} after 36 h", "rel", abs(moved / paper - 1.0), 0.2, "1", f"paper: {paper} m", clock)
        below = history("below the crest", "pressure")[-1]
        yield row(case, "pressure 0.5 m below the crest", "abs", abs(below + 12e3), 500.0, "Pa", "paper: -12 kPa", clock)
    yield row(case, "water balance", "rel", abs(report["water_residual"]) / report["water_rain"], 1e-8, "1", "mass balance", clock)
    yield row(case, "wall seconds", "abs", clock.wall, WALL_BOUNDS[case], "s", "requirement", clock)
