"""Mandel's plate: saturated ground between two rigid smooth plates drains at its sides, coupled both ways.

Mandel (1953); with compressible water Cheng & Detournay (1988), Abousleiman et al. (1996). The pressure at the centre first
rises above its undrained value (Mandel-Cryer): the drained sides soften and the load moves inwards. The scene is the upper right
quarter. The plate's settlement is prescribed as the closed solution has it; that the force which then acts on the plate is the
constant one of the problem is a row of its own. `mandel.py` as a program prints the settlement that the scene holds.
"""

import json

import numpy
import talus
from rows import Clock, engine_of, first_step_rows, read_scene, row
from scipy.optimize import brentq

TIMES = (0.001, 0.01, 0.05, 0.1, 0.5, 1.0)  # T = c t / a^2
HISTORY = numpy.round(numpy.geomspace(1e-3, 1.0, 61), 6)
FIRST_STEPS = (1e-9, 1e-6, 1e-3)
LOAD = 100e3  # Pa: force on the plate over its area
TERMS = 300


class Plate:
    """The scene's numbers and the closed solution."""

    def __init__(self, scene):
        soil = scene["soils"][0]
        young, self.drained = soil["solid"]["youngModulus"], soil["solid"]["poissonRatio"]
        self.shear = young / (2 * (1 + self.drained))
        bulk = young / (3 * (1 - 2 * self.drained))
        water = 2e9 / soil["porosity"]  # Pa: K_l / n, Biot's modulus where the grains keep their volume
        undrained_bulk = bulk + water
        self.undrained = (3 * undrained_bulk - 2 * self.shear) / (2 * (3 * undrained_bulk + self.shear))
        oedometric = bulk + 4 / 3 * self.shear
        conductivity = soil["hydraulics"]["conductivity"]["along"] / 9810.0  # m2/(Pa s)
        diffusivity = conductivity * water * oedometric / (water + oedometric)  # m2/s
        terrain = scene["ground"]["section"]["terrain"]
        self.width, self.height = terrain[1][0], terrain[0][1]
        self.duration = self.width**2 / diffusivity  # s: T = 1
        skempton = water / undrained_bulk
        self.initial = LOAD * skempton * (1 + self.undrained) / 3  # Pa: the undrained pressure

        slope = (1 - self.drained) / (self.undrained - self.drained)
        lowest = numpy.pi * numpy.arange(TERMS) + 1e-3  # tan(root) = slope root once in each half turn
        self.root = numpy.array([brentq(lambda root: numpy.sin(root) - slope * root * numpy.cos(root), low, high, xtol=1e-14)
                                 for low, high in zip(lowest, lowest + numpy.pi / 2)])
        self.weight = 1 / (self.root - numpy.sin(self.root) * numpy.cos(self.root))

    def excess(self, x, time):
        """Pressure above the hydrostatic one, over the initial one; x an array."""
        modes = numpy.cos(numpy.outer(x / self.width, self.root)) - numpy.cos(self.root)
        return modes @ (2 * numpy.sin(self.root) * self.weight * numpy.exp(-(self.root**2) * time))

    def settlement(self, time):
        """Of the plate, m, downwards."""
        decay = numpy.exp(-numpy.outer(time, self.root**2)) @ (numpy.sin(self.root) * numpy.cos(self.root) * self.weight)
        return LOAD * self.height / self.shear * ((1 - self.drained) / 2 - (1 - self.undrained) * decay)


def plate_stress(engine):
    """Mean vertical stress, Pa, tension positive."""
    volume = engine.read("point_volume").ravel()
    return volume @ engine.read("total_stress")[:, 1] / volume.sum()


def rows():
    scene = read_scene("mandel")
    plate = Plate(scene)
    source = "Mandel 1953, compressible water"
    with Clock() as clock:
        engine = engine_of("mandel")
        x, y = engine.read("node_position").T
        start, weight = engine.read("pressure"), plate_stress(engine)
        centre = (x < 1e-9) & (y < 1e-9)
        profiles, force = {}, {}
        for time in numpy.union1d(TIMES, HISTORY):
            engine.advance_to(time * plate.duration)
            profiles[time] = (engine.read("pressure") - start) / plate.initial
            force[time] = plate_stress(engine) - weight
    for time in TIMES:
        error = numpy.max(numpy.abs(profiles[time] - plate.excess(x, time)))
        yield row("mandel", f"excess pressure at T = {time:g}", "max", error, 0.01, "1", source, clock)
    history = numpy.array([profiles[time][centre][0] for time in HISTORY])
    exact = numpy.array([plate.excess(numpy.zeros(1), time)[0] for time in HISTORY])
    yield row("mandel", "pressure history at the centre", "max", numpy.max(numpy.abs(history - exact)), 0.01, "1", source, clock)
    yield row("mandel", "largest pressure at the centre", "abs", abs(history.max() - exact.max()), 0.01, "1", source, clock)
    error = max(abs(force[time] / LOAD + 1) for time in HISTORY)
    yield row("mandel", "force on the plate", "max", error, 0.01, "1", source, clock)
    for time in FIRST_STEPS:
        yield from first_step(plate, engine_of("mandel"), f"T = {time:g}", time)
    yield from first_step(plate, triangle_engine(scene, engine), "triangles", FIRST_STEPS[0])


def triangle_engine(scene, quads):
    """The same on triangles: the quads of an engine cut along alternating diagonals."""
    node = quads.read("cell_nodes").reshape(-1, 4)
    place = quads.read("node_position") - quads.read("displacement")
    column, level = (numpy.unique(centre.round(6), return_inverse=True)[1] for centre in place[node].mean(axis=1).T)
    is_even = (column + level) % 2 == 0
    cut = numpy.where(is_even[:, None], node[:, [0, 1, 2, 0, 2, 3]], node[:, [0, 1, 3, 1, 2, 3]]).reshape(-1, 3)
    count = len(cut)
    mesh = {"position": place, "cellStart": 3 * numpy.arange(count + 1), "cellNodes": cut, "cellSoil": numpy.zeros(count, int)}
    arrays = {f"ground.mesh.{name}": array for name, array in mesh.items()}
    return talus.Engine(talus.Scene.from_json({**scene, "ground": {"mesh": {}}}, arrays))


def first_step(plate, engine, when, time):
    """The plate is put on at once and held for a step of this length."""
    x, y = engine.read("node_position").T
    start = engine.read("pressure")
    with Clock() as clock:
        engine.push_motion_value("plate", 1, [0], [-plate.settlement([0.0])[0]])
        engine.step(time * plate.duration)
    excess = (engine.read("pressure") - start) / plate.initial
    inwards = numpy.argsort(-x)
    profiles = [excess[inwards][y[inwards] < 1e-9], excess[inwards][y[inwards] > plate.height - 1e-9]]
    yield from first_step_rows("mandel", when, profiles, clock)


if __name__ == "__main__":
    plate = Plate(read_scene("mandel"))
    after = numpy.geomspace(1e-7, 1.5, 80)
    series = {"time": [0.0, *after * plate.duration], "value": [0.0, *-plate.settlement(after)]}
    print(json.dumps({name: [float(f"{number:.6g}") for number in numbers] for name, numbers in series.items()}))
