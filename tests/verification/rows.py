"""What every verification case shares: reading references, running scenes with a clock, making rows."""

import csv
import json
import pathlib
import resource
import time

import numpy
import talus

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SCENES = ROOT / "samples" / "scenes"
REFERENCES = ROOT / "tests" / "verification" / "reference"


def cpu_seconds():
    """Of this process and of those that it waited for."""
    waited_for = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + waited_for.ru_utime + waited_for.ru_stime


class Clock:
    """Wall and CPU seconds of the block it is used in."""

    def __enter__(self):
        self._start = time.perf_counter(), cpu_seconds()
        return self

    def __exit__(self, *exception):
        self.wall = time.perf_counter() - self._start[0]
        self.cpu = cpu_seconds() - self._start[1]


def read_csv(name):
    """Columns of a reference by their heading, as arrays."""
    with open(REFERENCES / name, newline="") as file:
        lines = list(csv.reader(file))
    values = numpy.array(lines[1:], dtype=float)
    return dict(zip(lines[0], values.T))


def read_scene(name):
    """The scene as its JSON says it."""
    return json.loads((SCENES / f"{name}.json").read_text())


def engine_of(name):
    return talus.Engine(talus.Scene.from_file(str(SCENES / f"{name}.json")))


def engine_from(scene):
    return talus.Engine(talus.Scene.from_json(scene))


def row(case, quantity, norm, error, bound, unit, reference, clock):
    """One row; met when the error is a number not above the bound."""
    return {"case": case, "quantity": quantity, "norm": norm, "error": float(error), "bound": bound, "unit": unit,
            "reference": reference, "wall_s": clock.wall, "cpu_s": clock.cpu, "threads": 1, "met": bool(error <= bound)}


def first_step_rows(case, when, profiles, clock):
    """That a sudden load makes no waves: excess pressures over the undrained one rise from the drain inwards, at most to 1."""
    overshoot = max(max(profile.max() - 1, 0) for profile in profiles)
    fall = max(numpy.max(numpy.maximum.accumulate(profile) - profile) for profile in profiles)
    yield row(case, f"overshoot, first step, {when}", "max", overshoot, 1e-3, "1", "undrained pressure", clock)
    yield row(case, f"fall inwards, first step, {when}", "max", fall, 1e-3, "1", "monotone", clock)
