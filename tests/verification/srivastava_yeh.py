"""Transient infiltration into a column of Gardner's soil above a water table, by the series of Srivastava & Yeh (1991).

K = K_s exp(alpha h) and theta - theta_r in proportion to exp(alpha h) make Richards' equation linear in k = exp(alpha h). The
scene is the paper's homogeneous soil: steady under 0.1 cm/h, then rain of 0.9 cm/h.
"""

import numpy
from rows import Clock, engine_of, read_scene, row
from scipy.optimize import brentq

HOURS = (1, 5, 10, 20, 50, 100)
TERMS = 200
GAMMA_WATER = 9810.0  # Pa/m


class Column:
    """The scene's numbers without dimension, and the closed solution."""

    def __init__(self, scene):
        soil = scene["soils"][0]
        hydraulics = soil["hydraulics"]
        self.alpha = hydraulics["retention"]["alpha"] * GAMMA_WATER  # 1/m
        conductivity = hydraulics["conductivity"]["along"]
        mobile = soil["porosity"] * (1 - hydraulics["retention"]["residualSaturation"])
        self.rate = self.alpha * conductivity / mobile  # 1/s: time without dimension per second
        self.length = self.alpha * scene["ground"]["column"]["height"]
        self.before = scene["initial"]["surfaceRain"] / conductivity
        self.after = scene["surface"]["zones"][0]["rate"][0] / conductivity
        lowest = numpy.pi * (numpy.arange(TERMS) + 0.5) / self.length  # tan(root length) = -2 root once in each half turn
        self.root = numpy.array([brentq(self._equation, low, low + 0.5 * numpy.pi / self.length, xtol=1e-14) for low in lowest])

    def _equation(self, root):
        return numpy.sin(root * self.length) + 2 * root * numpy.cos(root * self.length)

    def head(self, y, seconds):
        """Pressure head, m."""
        z = self.alpha * y
        time = self.rate * seconds
        weight = numpy.sin(self.root * self.length) / (1 + self.length / 2 + 2 * self.root**2 * self.length)
        series = numpy.sin(numpy.outer(z, self.root)) @ (weight * numpy.exp(-(self.root**2) * time))
        steady = self.after - (self.after - 1) * numpy.exp(-z)
        transient = 4 * (self.after - self.before) * numpy.exp((self.length - z) / 2 - time / 4) * series
        return numpy.log(steady - transient) / self.alpha


def rows():
    column = Column(read_scene("srivastava_yeh"))
    source = "Srivastava & Yeh 1991"
    with Clock() as clock:
        engine = engine_of("srivastava_yeh")
        y = engine.read("node_position").ravel()
        profiles = []
        for hour in HOURS:
            engine.advance_to(hour * 3600.0)
            profiles.append(engine.read("pressure") / GAMMA_WATER)
    driest = numpy.log(column.before + (1 - column.before) * numpy.exp(-column.length)) / column.alpha  # at the top, at first
    for hour, head in zip(HOURS, profiles):
        error = numpy.max(numpy.abs(head - column.head(y, hour * 3600.0))) / -driest
        yield row("srivastava_yeh", f"head after {hour} h, over its range", "max", error, 0.005, "1", source, clock)
