"""Terzaghi's column: a sudden load on saturated ground that drains at its top, flow and skeleton coupled both ways.

Terzaghi (1925), with the water's own compressibility as in Biot (1941): the load is carried by skeleton and water in the ratio of
their stiffness at first, then the excess pressure diffuses out.
"""

import numpy
from rows import Clock, engine_of, first_step_rows, read_scene, row

TIMES = (0.01, 0.1, 0.5, 1.0)  # T_v = c_v t / H^2
FIRST_STEPS = (1e-9, 1e-6, 1e-3)  # T_v of a first step
TERMS = 500


class Column:
    """The scene's numbers and the closed solution."""

    def __init__(self, scene):
        soil = scene["soils"][0]
        young, poisson = soil["solid"]["youngModulus"], soil["solid"]["poissonRatio"]
        skeleton = (1 + poisson) * (1 - 2 * poisson) / (young * (1 - poisson))  # 1/Pa: m_v, in one dimension
        water = soil["porosity"] / 2e9  # 1/Pa: n / K_l
        self.height = scene["ground"]["column"]["height"]
        self.load = -scene["boundaries"][2]["motionY"]["value"][-1]
        self.initial = self.load * skeleton / (skeleton + water)  # Pa: the undrained pressure
        self.duration = self.height**2 * 9810.0 * (skeleton + water) / soil["hydraulics"]["conductivity"]["along"]  # s: T_v = 1

    def excess(self, y, time):
        """Pressure above the hydrostatic one, over the initial one."""
        root = (numpy.arange(TERMS) + 0.5) * numpy.pi
        modes = numpy.cos(numpy.outer(y / self.height, root)) * numpy.exp(-(root**2) * time)
        return modes @ (2 * numpy.where(numpy.arange(TERMS) % 2, -1, 1) / root)


def rows():
    scene = read_scene("terzaghi")
    column = Column(scene)
    source = "Terzaghi 1925, compressible water"
    with Clock() as clock:
        engine = engine_of("terzaghi")
        y = engine.read("node_position").ravel()
        start = engine.read("pressure")
        profiles = []
        for time in TIMES:
            engine.advance_to(time * column.duration)
            profiles.append((engine.read("pressure") - start) / column.initial)
    for time, profile in zip(TIMES, profiles):
        error = numpy.max(numpy.abs(profile - column.excess(y, time)))
        yield row("terzaghi", f"excess pressure at T = {time:g}", "max", error, 0.01, "1", source, clock)
    for time in FIRST_STEPS:
        with Clock() as clock:
            engine = engine_of("terzaghi")
            engine.push_motion_value("load", 1, [0], [-column.load])
            engine.step(time * column.duration)
            profile = (engine.read("pressure") - start) / column.initial
        yield from first_step_rows("terzaghi", f"T = {time:g}", [profile[::-1]], clock)
