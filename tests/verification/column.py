"""The paper's column: rain fills a closed, rigid column. Profiles against the independent reference, filling by mass balance."""

import numpy
from rows import Clock, engine_of, read_csv, row

TIMES = (20.0, 80.0, 160.0, 320.0)
FILLED = 600.0
GAMMA_WATER = 9810.0  # Pa/m


def cells(engine):
    """Centres and heights of the cells."""
    height = numpy.asarray(engine.read("node_position")).ravel()
    return 0.5 * (height[1:] + height[:-1]), numpy.diff(height)


def front(y, saturation, start):
    """Height of the steepest rise of saturation: the wetting front."""
    slope = numpy.abs(numpy.diff(saturation - start)) / numpy.diff(y)
    k = int(numpy.argmax(slope))
    return 0.5 * (y[k] + y[k + 1]), k


def simulate(make_engine):
    """Rain until the column is full: the engine, its profiles (y, height, p, S at TIMES), and the clock."""
    with Clock() as clock:
        engine = make_engine()
        profiles = []
        for time in TIMES:
            engine.advance_to(time)
            y, height = cells(engine)
            profiles.append((y, height, engine.sample("point_pressure", y), engine.sample("saturation", y)))
        engine.advance_to(FILLED + 1.0)
    return engine, profiles, clock


def profile_errors(case, profiles):
    """A dict for each of TIMES: mean error of saturation, errors of the front's place and of the pressure off the front."""
    reference = read_csv(f"{case}.csv")
    for time, (y, height, p, s) in zip(TIMES, profiles):
        at = reference["time_s"] == time
        p_at, s_at = (numpy.interp(y, reference["y_m"][at], reference[name][at]) for name in ("pressure_Pa", "saturation"))
        place, cell = front(y, s_at, s_at.min())
        outside = numpy.abs(numpy.arange(len(y)) - cell) > 1
        yield {"saturation": numpy.sum(height * numpy.abs(s - s_at)), "front_m": abs(front(y, s, s.min())[0] - place),
               "pressure_off_front_Pa": numpy.max(numpy.abs(p - p_at)[outside])}


def rows(case):
    source = f"{case}.csv, independent finite volumes on 1600 cells"
    engine, profiles, clock = simulate(lambda: engine_of(case))
    report = engine.report()
    filled = [event["time"] for event in engine.events() if event["kind"] == "saturated"]
    late = abs(filled[0] - FILLED) if filled else numpy.inf
    yield row(case, "time of full saturation", "abs", late, 1.0, "s", "mass balance", clock)
    node_y = numpy.asarray(engine.read("node_position")).ravel()
    engine.advance_to(FILLED + 60.0)
    at_rest = numpy.max(numpy.abs(engine.read("pressure") - GAMMA_WATER * (1.0 - node_y)))
    yield row(case, "pressure when full", "max", at_rest, 10.0, "Pa", "hydrostatic", clock)
    missed = abs(report["water_residual"]) / report["water_rain"]
    yield row(case, "water balance", "rel", missed, 1e-9, "1", "mass balance", clock)
    largest_cell = profiles[0][1].max()
    for time, error in zip(TIMES, profile_errors(case, profiles)):
        yield row(case, f"saturation at {time:g} s", "mean", error["saturation"], 0.003, "1", source, clock)
        yield row(case, f"front at {time:g} s", "abs", error["front_m"], largest_cell, "m", source, clock)
        pressure = error["pressure_off_front_Pa"]
        yield row(case, f"pressure off the front at {time:g} s", "max", pressure, 200.0, "Pa", source, clock)
