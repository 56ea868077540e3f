"""The paper's slope in weaker soil, from the storm through failure and run-out to rest, and the rest of the storm: what may not be lost on the way."""

import numpy
import talus
from rows import Clock, read_scene, row

CASE = "slope_run_out"


def mass(engine, grain_density):
    """Of the grains, from the views: kg per metre of thickness."""
    return grain_density * numpy.sum(engine.read("point_volume") * (1 - engine.read("porosity")))


def follow(threads):
    """Reports, masses and hashes of each step, and the events."""
    scene = read_scene(CASE)
    soil = scene["soils"][0]
    grain_density = soil["dryDensity"] / (1 - soil["porosity"])
    duration, step = scene["schedule"]["duration"], scene["schedule"]["step"]
    reports, masses, hashes = [], [], []
    with talus.Engine(talus.Scene.from_json(scene), threads=threads, stop_at_motion=True) as engine:
        masses.append(mass(engine, grain_density))
        while engine.time < duration:
            reports.append(engine.advance_to(min(duration, step * (engine.time // step + 1))))
            masses.append(mass(engine, grain_density))
            hashes.append(engine.hash())
        return reports, numpy.array(masses), hashes, [event["kind"] for event in engine.events()]


def rows():
    with Clock() as clock:
        reports, masses, hashes, events = follow(threads=1)
    starts = events.count("motion_started")
    ended = min(events.count("came_to_rest"), events.count("settled"))
    slid = max(report["sliding_volume"] for report in reports)
    farthest = reports[-1]["largest_displacement"]
    yield row(CASE, f"motions that do not rest and settle, of {starts}; {slid:.0f} m3/m slide, by {farthest:.1f} m at most", "count",
              starts - ended if starts and slid > 100 else numpy.inf, 0, "1", "call sequence", clock)
    missed = max(abs(report["water_residual"]) for report in reports) / reports[-1]["water_rain"]
    yield row(CASE, "water missed, over the rain", "max", missed, 1e-8, "1", "conservation", clock)
    yield row(CASE, "mass", "max rel", numpy.max(numpy.abs(masses / masses[0] - 1)), 1e-12, "1", "conservation", clock)
    with Clock() as clock:
        _, _, others, _ = follow(threads=2)
    differing = abs(len(hashes) - len(others)) + sum(a != b for a, b in zip(hashes, others))
    yield {**row(CASE, "steps that end in other bits with 2 threads", "count", differing, 0, "1", "1 thread", clock), "threads": 2}
