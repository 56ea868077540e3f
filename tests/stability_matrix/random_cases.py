"""The random search: all ranges at once. The number of a scene is its seed, and its rest by three says which kind it is; scenes in motion
have numbers of their own."""

import math
import random

from case import Case
from claims import COLLAPSE
from scenes import MM_PER_HOUR, column, held_ground, rain_zone, section, soil

WEIGHT = 2e4  # Pa/m, of ground: what strengths and stiffnesses are drawn against


class Draw:
    """Numbers from a seed, to four digits."""

    def __init__(self, seed):
        self._random = random.Random(seed)
        self.choice, self.whole = self._random.choice, self._random.randint

    def log_uniform(self, low, high):
        return float(f"{low * (high / low) ** self._random.random():.4g}")

    def uniform(self, low, high):
        return float(f"{self._random.uniform(low, high):.4g}")


def random_soil(draw, name):
    return soil(name, alpha=draw.log_uniform(1e-7, 1e-2), n=round(1 + draw.log_uniform(0.03, 11), 4),
                conductivity=draw.log_uniform(1e-13, 1e-1), porosity=draw.log_uniform(0.05, 0.9),
                residual=draw.choice((0.0, draw.log_uniform(1e-3, 0.9))))


def random_steps(draw, most_times=4):
    steps = []
    for _ in range(draw.whole(2, 6)):
        steps += [["rain", draw.choice((0.0, draw.log_uniform(0.1, 1000) * MM_PER_HOUR))],
                  ["step", draw.log_uniform(1e-3, 1e6), draw.whole(1, most_times)]]
    return steps


def rigid_column(seed):
    draw = Draw(seed)
    height = draw.log_uniform(0.05, 20)
    layers = [{"soil": "upper"}, {"soil": "lower", "top": height / 2}]
    scene = column([random_soil(draw, "upper"), random_soil(draw, "lower")], layers, height=height, cells=2 * draw.whole(2, 20),
                   suction=draw.choice((0.0, draw.log_uniform(1, 1e6))), rain=draw.log_uniform(0.1, 1000) * MM_PER_HOUR,
                   base=draw.choice((None, 0.0, -draw.log_uniform(1, 1e5))),
                   ponding=draw.choice((0.0, draw.log_uniform(1e-3, 1))))
    return scene, random_steps(draw)


# --- ground that deforms ---

def random_strength(draw, cohesion, friction):
    gain = {"cohesionGain": draw.log_uniform(50, 1e5), "cohesionRate": draw.log_uniform(0.1, 1000),
            "frictionGain": draw.uniform(0, 60)}
    model = draw.choice(({"model": "vanapalli"}, {"model": "constant"}, {"model": "exponential", **gain},
                         {"model": "fredlund", "suctionFrictionAngle": draw.uniform(1, 40)}))
    return {"cohesion": cohesion, "frictionAngle": friction, **model}


def random_solid(draw, height, cohesion, friction):
    """From as soft as its own weight lets it be to rock."""
    solid = {"youngModulus": max(2e4, draw.log_uniform(100, 1e8) * WEIGHT * height),
             "poissonRatio": float(f"{0.5 - draw.log_uniform(1e-4, 0.5):.4f}")}
    tensile = draw.choice((None, 0.0, draw.log_uniform(1, 1e5)))
    plastic = {"strength": random_strength(draw, cohesion, friction),
               "dilationAngle": draw.choice((0, draw.uniform(0, friction)))}
    if tensile is not None:
        plastic["tensileStrength"] = tensile
    return {**solid, **draw.choice((plastic, plastic, {"model": "elastic"}))}


def random_ground(draw, name, height, cohesion, friction):
    ground = {**random_soil(draw, name), "dryDensity": draw.log_uniform(800, 2800),
              "solid": random_solid(draw, height, cohesion, friction)}
    ground["hydraulics"]["conductivity"]["porosityDependence"] = draw.choice(("none", "kozenyCarman"))
    return ground


def random_initial(draw, height):
    flow = draw.choice(({"flow": "suction", "suction": draw.choice((0.0, draw.log_uniform(1, 1e6)))},
                        {"flow": "hydrostatic", "waterTable": draw.uniform(-1, 1) * height}))
    return {**flow, **draw.choice(({"stress": "gravity"}, {"stress": "k0", "k0": draw.uniform(0.3, 1.5)}))}


def deforming(draw, ground, soils, boundaries, height):
    return {"name": "stability", "physics": {"stress": draw.choice(("net", "bishop"))},
            "water": {"bulkModulus": draw.choice((2e9, draw.log_uniform(1e7, 1e12)))}, "soils": soils, "ground": ground,
            "boundaries": boundaries, "surface": rain_zone(draw.log_uniform(0.1, 1000) * MM_PER_HOUR,
                                                           draw.choice((0.0, draw.log_uniform(1e-3, 1)))),
            "initial": random_initial(draw, height)}


def coupled_column(seed):
    """A load on two layers, which its sides hold."""
    draw = Draw(seed)
    height = draw.log_uniform(0.1, 50)
    soils = [random_ground(draw, name, height, draw.choice((0, draw.log_uniform(50, 1e5))), draw.uniform(1, 60))
             for name in ("upper", "lower")]
    ground = {"column": {"height": height, "cells": 2 * draw.whole(2, 15),
                         "layers": [{"soil": "upper"}, {"soil": "lower", "top": height / 2}]}}
    load = draw.choice((0.0, -draw.log_uniform(1e-3, 3) * WEIGHT * height))
    base = draw.choice(({}, {"flow": "pressure", "flowValue": {"value": [draw.uniform(-1, 1) * 1e4 * height]}}))
    boundaries = [{"name": "base", "side": "base", "motion": "fixed", **base},
                  {"name": "load", "side": "surface", "motion": "traction",
                   "motionY": {"time": [0, draw.log_uniform(1e-3, 1e5)], "value": [0, load]}}]
    return deforming(draw, ground, soils, boundaries, height), random_steps(draw)


def slope_strength(draw, height, steepness):
    """Cohesion and friction of ground of which either alone bears a dry face: by Taylor's number, or by the angle of rest."""
    margin = draw.log_uniform(1.2, 20)
    cohesive = (max(50.0, 0.25 * margin * WEIGHT * height), draw.uniform(1, 50))
    resting = min(60.0, max(1.0, math.degrees(math.atan(margin * steepness))))
    return draw.choice((cohesive, (draw.choice((0, draw.log_uniform(50, 1e4))), round(resting, 3))))


def small_section(seed):
    """A face between two levels, on two layers of which the lower one's top may tilt; a few cells."""
    draw = Draw(seed)
    width = draw.log_uniform(2, 500)
    steepness = draw.log_uniform(0.02, 1.2)
    low = draw.log_uniform(0.1, 0.6) * width
    fall = steepness * width / 3
    height = low + fall
    soils = [random_ground(draw, name, height, *slope_strength(draw, fall, steepness)) for name in ("upper", "lower")]
    top = [[0.0, draw.uniform(0.2, 0.8) * low], [width, draw.uniform(0.2, 0.8) * low]]
    ground = section([[0.0, height], [width / 3, height], [2 * width / 3, low], [width, low]], [[0.0, 0.0], [width, 0.0]],
                     width / draw.whole(4, 8), height / draw.whole(5, 10), height / draw.whole(2, 4),
                     [{"soil": "upper"}, {"soil": "lower", "top": top}])
    boundaries = held_ground()
    watered = boundaries[draw.whole(0, 2)]
    level = {"time": [0, draw.log_uniform(1, 1e6)], "value": [0.0, draw.uniform(-1, 1) * height]}
    watered.update(draw.choice(({}, {"flow": "hydrostatic", "flowValue": level})))
    return deforming(draw, ground, soils, boundaries, low), random_steps(draw, most_times=2)


# --- ground in motion ---

TOO_SOFT = "too soft for what it bears"
SUBSTEPS = (10, 3000)  # about


def random_walls(draw):
    """Of the base, the left and the right; the ground may leave a side without one."""
    for side, motions in (("base", ("fixed", "roller", "friction")), ("left", ("roller", None, "friction")),
                          ("right", ("roller", None, "friction"))):
        motion = draw.choice(motions)
        if motion:
            yield {"name": side, "side": side, "motion": motion,
                   **({"frictionAngle": draw.uniform(1, 45)} if motion == "friction" else {})}


def moving_soil(draw, name, height, is_wet):
    soil = {**random_soil(draw, name), "dryDensity": draw.log_uniform(800, 2800),
            "solid": {"youngModulus": max(2e4, draw.log_uniform(30, 1e6) * WEIGHT * height),
                      "poissonRatio": float(f"{0.5 - draw.log_uniform(1e-3, 0.5):.4f}")}}
    if is_wet:
        soil["hydraulics"]["conductivity"]["porosityDependence"] = draw.choice(("none", "kozenyCarman"))
    else:
        del soil["hydraulics"]
    if draw.whole(0, 4) == 0:
        soil["solid"]["model"] = "elastic"
        return soil
    cohesion, friction = draw.choice((0, draw.log_uniform(50, 1e5))), draw.uniform(1, 60)
    if is_wet:
        strength = random_strength(draw, cohesion, friction)
    else:
        strength = {"model": "constant", "cohesion": cohesion, "frictionAngle": friction}
    soil["solid"].update(strength=strength, dilationAngle=draw.choice((0, draw.uniform(0, friction))))
    if draw.choice((True, False)):
        soil["solid"]["softening"] = {"residualCohesion": draw.choice((0, cohesion)), "slip": draw.log_uniform(1e-4, 1),
                                      "residualFrictionAngle": draw.uniform(1, friction)}
    return soil


def crossing_time(soils, water, cell_size):
    """In which about the fastest wave crosses a cell, s."""
    squares = [soil["solid"]["youngModulus"] / (0.5 - soil["solid"]["poissonRatio"]) / soil["dryDensity"] + water / 1000 / soil["porosity"]
               for soil in soils]
    return cell_size / math.sqrt(max(squares))


def moving_section(seed):
    """A face on two layers that need not stand, dry or wet."""
    draw = Draw(seed)
    width, steepness = draw.log_uniform(0.5, 500), draw.log_uniform(0.05, 3)
    low, fall = draw.log_uniform(0.1, 0.6) * width, steepness * width / 3
    height, is_wet = low + fall, draw.choice((True, False))
    soils = [moving_soil(draw, name, height, is_wet) for name in ("upper", "lower")]
    cell_size = float(f"{height / draw.whole(3, 15):.4g}")
    ground = section([[0.0, height], [width / 3, height], [2 * width / 3, low], [width, low]], [[0.0, 0.0], [width, 0.0]],
                     width / draw.whole(4, 8), height / draw.whole(5, 10), height / draw.whole(2, 4),
                     [{"soil": "upper"}, {"soil": "lower", "top": [[0.0, low / 2], [width, low / 2]]}])
    walls = list(random_walls(draw))
    is_held = any(wall["side"] == "base" for wall in walls) and any(wall["motion"] != "roller" or wall["side"] != "base" for wall in walls)
    scene = {"name": "stability", "soils": soils, "ground": ground, "boundaries": walls,
             "physics": {"regime": "dynamic", "water": is_wet}, "dynamics": {"cellSize": cell_size},
             "initial": {"stress": draw.choice(("elastic", "zero")) if is_held else "zero"}}
    water = 0.0
    if is_wet:
        water = draw.log_uniform(1e5, 2e9)
        scene["physics"]["stress"] = draw.choice(("net", "bishop"))
        scene["water"] = {"bulkModulus": water}
        scene["surface"] = rain_zone(draw.log_uniform(0.1, 1000) * MM_PER_HOUR)
        scene["initial"].update(draw.choice(({"flow": "suction", "suction": draw.choice((0.0, draw.log_uniform(1, 1e6)))},
                                             {"flow": "hydrostatic", "waterTable": draw.uniform(-1, 1) * height})))
    elif draw.choice((True, False)):
        scene["dynamics"]["restSpeed"] = draw.log_uniform(1e-6, 1)
    duration = draw.log_uniform(*SUBSTEPS) * crossing_time(soils, water, cell_size)
    return scene, [["step", float(f"{duration * draw.uniform(0.01, 0.5):.4g}"), 1] for _ in range(draw.whole(1, 5))]


def vary(scene, seed):
    """What was not drawn at first; by numbers of its own, so that all else is as it was without."""
    draw = Draw(f"varied {seed}")
    wet = [soil["hydraulics"]["conductivity"] for soil in scene["soils"] if "hydraulics" in soil]
    if draw.whole(0, 2) == 0:
        for conductivity in wet:
            across = conductivity["along"] * draw.log_uniform(1e-6, 10)
            conductivity.update(across=float(f"{min(across, 0.3):.4g}"), dip=draw.uniform(-90, 90))
    if wet and draw.choice((True, False)):
        scene["dynamics"]["restSpeed"] = draw.log_uniform(1e-6, 1)
    terrain = scene["ground"]["section"]["terrain"]
    if draw.whole(0, 2) == 0 and not any(wall["side"] == "right" for wall in scene["boundaries"]):
        width = terrain[-1][0]
        scene["dynamics"].update(xTo=width * draw.uniform(1, 1.5), yTo=terrain[0][1] * draw.uniform(1, 2), atEnds="stop")


def moving_case(number, is_varied=True):
    scene, steps = moving_section(number)
    if is_varied:
        vary(scene, number)
    return Case(f"random/moving_{number}", scene, steps, may_be_refused=TOO_SOFT)


KINDS = (rigid_column, coupled_column, small_section)


def random_case(number):
    scene, steps = KINDS[number % len(KINDS)](number)
    return Case(f"random/{number}", scene, steps, may_be_refused=COLLAPSE, tightened=True)
