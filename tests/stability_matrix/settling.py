"""Whether ground under a steady load comes to rest: its increments from step to step must not grow, whatever the step."""

import numpy
from scenes import WATER_WEIGHT
from settings import DEFAULT_TOLERANCE


def growth(increments, negligible):
    """The largest ratio of an increment to the one before it, which counts at least what the tolerance lets stand."""
    return max((after / max(before, negligible) for before, after in zip(increments, increments[1:])), default=0.0)


class Settling:
    """Watches displacement and pressure after every step; the first step, with the load, does not count."""

    def __init__(self, engine):
        self.engine = engine
        self.last, self.increments, self.largest = None, {"displacement": [], "pressure": []}, 0.0
        self.started = False

    def look(self):
        now = {name: self.engine.read(name).copy() for name in self.increments}
        self.largest = max(self.largest, abs(now["displacement"]).max())
        if self.started:
            for name, values in self.increments.items():
                values.append(float(abs(now[name] - self.last[name]).max()))
        self.started = self.engine.time > 0
        self.last = now

    def growth(self):
        height = numpy.ptp(self.engine.read("node_position"))
        negligible = {"displacement": DEFAULT_TOLERANCE * self.largest, "pressure": DEFAULT_TOLERANCE * WATER_WEIGHT * height}
        return max(growth(values, negligible[name]) for name, values in self.increments.items())
