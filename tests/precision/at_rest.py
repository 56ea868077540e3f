"""What a point that is held at rest costs beside one that moves: the cohesive slope, dry and moist, with a long floor in front of it."""

import time

import numpy
import talus
from rows import read_scene

REST_SPEED = 1e-3  # m/s
STEP, SETTLED, STEPS = 0.1, 60, 100  # s; steps of the host, of which those from SETTLED on are timed
MOISTURE = {"retention": {"model": "vanGenuchten", "alpha": 4e-05, "n": 1.2}, "relativePermeability": {"model": "mualem"},
            "conductivity": {"along": 1e-05}}


def scene_of(rest_speed, is_moist):
    scene = read_scene("cohesive_slope")
    if is_moist:
        scene["physics"]["water"] = True
        scene["water"] = {"bulkModulus": 1e7}
        scene["soils"][0]["hydraulics"] = MOISTURE
        scene["initial"].update(flow="saturation", saturation=0.6)
    scene["ground"]["section"].update(terrain=[[0, 5], [6, 5], [11, 1], [100, 1]], base=[[0, 0], [100, 0]])
    if rest_speed:
        scene["dynamics"]["restSpeed"] = rest_speed
    scene["boundaries"].append({"name": "right", "side": "right", "motion": "roller"})
    del scene["probes"]
    return scene


class Slide:
    """The slide with a rest speed, m/s, or none; what its steps took from SETTLED on, once the floor is quiet."""

    def __init__(self, rest_speed, is_moist):
        self.engine = talus.Engine(talus.Scene.from_json(scene_of(rest_speed, is_moist)))
        self.points = self.engine.describe()["points"]
        self.seconds, self.substeps, self.held_points = 0.0, 0, 0.0

    def step(self, is_timed):
        begun = time.process_time()
        self.report = self.engine.step(STEP)
        if not is_timed:
            return
        self.seconds += time.process_time() - begun
        self.substeps += self.report["motion_substeps"]
        self.held_points += (numpy.abs(self.engine.read("velocity")).max(axis=1) == 0).sum() * self.report["motion_substeps"]

    @property
    def held(self):
        return self.held_points / self.substeps

    @property
    def seconds_a_substep(self):
        return self.seconds / self.substeps


def run(is_moist):
    """Nanoseconds of a substep of points that move and that are held; what holding changes. The two slides take turns: a machine's speed changes with time."""
    free, held = Slide(0.0, is_moist), Slide(REST_SPEED, is_moist)
    for step in range(STEPS):
        free.step(step >= SETTLED)
        held.step(step >= SETTLED)
    moving = free.seconds_a_substep / free.points
    resting = (held.seconds_a_substep - moving * (held.points - held.held)) / held.held
    changes = {name: abs(held.report[name] / free.report[name] - 1) for name in ("run_out", "dissipated_energy")}
    return {"ground": "moist" if is_moist else "dry", "rest_speed": REST_SPEED, "points": held.points, "held": held.held,
            "moving_ns": 1e9 * moving, "resting_ns": 1e9 * resting, "ratio": resting / moving, "changes": changes}
