"""Water that stands on the ground loads it as much as it presses in the pores: a full column neither heaves nor settles."""

import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "bindings" / "python"))

import talus  # noqa: E402  (needs the path above)

HEIGHT, DEPTH = 2.0, 0.5  # m, of the ground and of the pond that its surface may hold
MODULUS = 1e6  # Pa, of a skeleton with Poisson's ratio 0
WATER_WEIGHT = 9810.0  # Pa/m


def scene(ground, stress, boundaries):
    clay = {"name": "clay", "porosity": 0.4, "dryDensity": 1600,
            "hydraulics": {"retention": {"model": "vanGenuchten", "alpha": 1e-4, "n": 2}, "conductivity": {"along": 1e-6}},
            "solid": {"model": "elastic", "youngModulus": MODULUS, "poissonRatio": 0}}
    return {"name": "pond", "physics": {"stress": stress}, "soils": [clay], "ground": ground,
            "boundaries": [{"name": "base", "side": "base", "motion": "fixed"}, *boundaries],
            "surface": {"pondingDepth": DEPTH, "zones": [{"name": "rain", "time": [0], "rate": [1e-4]}]},
            "initial": {"flow": "hydrostatic", "waterTable": HEIGHT, "stress": "gravity"}}


class Pond(unittest.TestCase):
    def check(self, ground, stress, boundaries=()):
        with talus.Engine(talus.Scene.from_json(scene(ground, stress, boundaries))) as engine:
            for _ in range(10):
                report = engine.step(86400)
            self.assertGreater(report["water_run_off"], 0)  # the pond is full
            surface = engine.read("pressure").min() + engine.read("pressure").max()
            self.assertAlmostEqual(surface / WATER_WEIGHT, HEIGHT + 2 * DEPTH, delta=1e-3)
            heave_without_load = WATER_WEIGHT * DEPTH * HEIGHT / MODULUS  # 9.8 mm
            self.assertLess(report["largest_displacement"], 1e-4 * heave_without_load)

    def test_column(self):
        for stress in ("net", "bishop"):
            self.check({"column": {"height": HEIGHT, "cells": 20, "layers": [{"soil": "clay"}]}}, stress)

    def test_section(self):
        ground = {"terrain": [[0, HEIGHT], [4, HEIGHT]], "base": [[0, 0], [4, 0]], "layers": [{"soil": "clay"}],
                  "columnWidth": 1, "surfaceCellHeight": 0.2, "largestCellHeight": 0.5}
        sides = [{"name": side, "side": side, "motion": "roller"} for side in ("left", "right")]
        self.check({"section": ground}, "net", sides)


if __name__ == "__main__":
    unittest.main()
