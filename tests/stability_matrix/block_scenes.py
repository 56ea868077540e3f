"""Blocks and columns whose limit load is known in closed form, and meshes from lines."""

import math

from scenes import WATER_WEIGHT, dry, earth, held_ground, rain_zone, section

GRAVITY = 9.81
SATURATED_DENSITY = 2000.0  # of earth(): 1600 and 40 % of water


def compressive_strength(cohesion, friction):
    """Of a block that is free at its side, Pa."""
    angle = math.radians(friction)
    return 2 * cohesion * math.cos(angle) / (1 - math.sin(angle))


def smooth_block(soil, traction, width=0.5, height=1.0):
    """Half of a block between smooth plates, free at its right side, under a traction (Pa, up) that grows over a second."""
    ground = section([[0, height], [width, height]], [[0, 0], [width, 0]], width / 4, height / 8, height / 8,
                     [{"soil": soil["name"]}])
    return {"name": "stability", "soils": [soil], "ground": ground,
            "boundaries": [{"name": "base", "side": "base", "motion": "roller"},
                           {"name": "middle", "side": "left", "motion": "roller"},
                           {"name": "load", "side": "surface", "motion": "traction",
                            "motionY": {"time": [0, 1], "value": [0, traction]}}]}


def dry_block(soil, traction):
    """Without weight."""
    return {**smooth_block(dry(soil), traction), "physics": {"water": False}, "gravity": 0, "initial": {"stress": "zero"}}


def wetted_block(factor, seconds, cohesion=2e4, friction=30):
    """Under `factor` of the load that it bears without suction, and 50 kPa of suction, lost within `seconds` after 2 s."""
    height = 0.1
    load = factor * compressive_strength(cohesion, friction) - SATURATED_DENSITY * GRAVITY * height
    ground = earth(cohesion=cohesion, friction=friction, young=1e9, alpha=1e-5, conductivity=1e-4)
    scene = smooth_block(ground, -load, 0.05, height)
    lost = {"time": [2, 2 + seconds], "value": [-5e4, 0]}
    for side in ("base", "surface"):  # both at once: no pressure above 0 below, which net stress would carry
        scene["boundaries"].append({"name": f"{side} water", "side": side, "flow": "pressure", "flowValue": lost})
    return {**scene, "initial": {"flow": "suction", "suction": 5e4}}


def heaving_column(factor, stress="net"):
    """10 m of full earth without tensile strength under an upward flow: it floats where the base's pressure is its weight."""
    height = 10
    weight = SATURATED_DENSITY * GRAVITY * height
    ground = earth(tensile=0.0, young=1e8, conductivity=1e-3)
    return {"name": "stability", "physics": {"stress": stress}, "soils": [ground],
            "ground": {"column": {"height": height, "cells": 40, "layers": [{"soil": "earth"}]}},
            "boundaries": [{"name": "base", "side": "base", "motion": "fixed", "flow": "pressure",
                            "flowValue": {"time": [0, 86400], "value": [WATER_WEIGHT * height, factor * weight]}},
                           {"name": "drain", "side": "surface", "flow": "pressure", "flowValue": {"value": [0]}}],
            "initial": {"flow": "hydrostatic", "waterTable": height}}


def grid(x, y, triangles=False):
    """The arrays of a mesh of quads between lines at x and y, or of two triangles in each."""
    across = len(x)
    cells = []
    for row in range(len(y) - 1):
        for column in range(across - 1):
            a, b = row * across + column, (row + 1) * across + column
            cells += [[a, a + 1, b + 1], [a, b + 1, b]] if triangles else [[a, a + 1, b + 1, b]]
    return mesh([place for level in y for place in ((at, level) for at in x)], cells)


def mesh(places, cells):
    starts = [sum(map(len, cells[:count])) for count in range(len(cells) + 1)]
    return {"mesh": {"position": [float(number) for place in places for number in place], "cellStart": starts,
                     "cellNodes": [node for cell in cells for node in cell], "cellSoil": [0] * len(cells)}}


def raining(ground):
    """Ground of a mesh under rain, fixed below and on rollers."""
    return {"name": "stability", "soils": [earth()], "ground": ground, "boundaries": held_ground(), "surface": rain_zone(1e-6),
            "initial": {"flow": "hydrostatic", "waterTable": 1.0}}
