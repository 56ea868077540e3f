"""The paper's column: rain fills a closed, rigid column. Profiles against the independent reference, the filling against mass balance."""

import numpy
from rows import Clock, engine_of, read_csv, row

TIMES = (20.0, 80.0, 160.0, 320.0)
FILLED = 600.0
GAMMA_WATER = 9810.0  # Pa/m


def centres(engine):
    height = numpy.asarray(engine.read("node_position")).ravel()
    return 0.5 * (height[1:] + height[:-1]), numpy.diff(height)


def front(y, saturation, start):
    """Height of the steepest rise of saturation: the wetting front."""
    slope = numpy.abs(numpy.diff(saturation - start)) / numpy.diff(y)
    k = int(numpy.argmax(slope))
    return 0.5 * (y[k] + y[k + 1]), k


def rows(case):
    reference = read_csv(f"{case}.csv")
    source = f"{case}.csv, independent finite volumes on 1600 cells"
    with Clock() as clock:
        engine = engine_of(case)
        profiles = []
        for time in TIMES:
            engine.advance_to(time)
            y, height = centres(engine)
            profiles.append((engine.sample("point_pressure", y), engine.sample("saturation", y)))
        engine.advance_to(FILLED + 1.0)
        report = engine.report()
    filled = [event["time"] for event in engine.events() if event["kind"] == "saturated"]
    yield row(case, "time of full saturation", "abs", abs(filled[0] - FILLED) if filled else numpy.inf, 1.0, "s", "mass balance", clock)
    node_y = numpy.asarray(engine.read("node_position")).ravel()
    engine.advance_to(FILLED + 60.0)
    pressure = numpy.asarray(engine.read("pressure"))
    yield row(case, "pressure when full", "max", numpy.max(numpy.abs(pressure - GAMMA_WATER * (1.0 - node_y))), 10.0, "Pa", "hydrostatic", clock)
    yield row(case, "water balance", "rel", abs(report["water_residual"]) / report["water_rain"], 1e-9, "1", "mass balance", clock)
    for time, (p, s) in zip(TIMES, profiles):
        at = reference["time_s"] == time
        y_ref, p_ref, s_ref = (reference[name][at] for name in ("y_m", "pressure_Pa", "saturation"))
        p_at, s_at = numpy.interp(y, y_ref, p_ref), numpy.interp(y, y_ref, s_ref)
        yield row(case, f"saturation at {time:g} s", "mean", numpy.sum(height * numpy.abs(s - s_at)), 0.003, "1", source, clock)
        place, cell = front(y, s_at, s_at.min())
        yield row(case, f"front at {time:g} s", "abs", abs(front(y, s, s.min())[0] - place), height.max(), "m", source, clock)
        outside = numpy.abs(numpy.arange(len(y)) - cell) > 1
        yield row(case, f"pressure off the front at {time:g} s", "max", numpy.max(numpy.abs(p - p_at)[outside]), 200.0, "Pa", source, clock)
