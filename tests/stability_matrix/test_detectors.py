#!/usr/bin/python3
"""That the detectors fire: each is shown values that are doctored, and sound ones. Usage: test_detectors.py [-v] [TEST ...]"""

import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "verification"), str(ROOT / "bindings" / "python")]

import dynamic_cases  # noqa: E402  (these need the paths above)
import numpy  # noqa: E402
import scenes  # noqa: E402
import settling  # noqa: E402
import shrink  # noqa: E402
import talus  # noqa: E402
from case import Case  # noqa: E402
from check import Watch, balances  # noqa: E402
from claims import DISPROVED, tested  # noqa: E402
from faults import faults  # noqa: E402
from settings import DEFAULT_TOLERANCE  # noqa: E402
from strength import excess, relative_excess  # noqa: E402

SOUND = {"outcome": "finished", "reason": None, "balance": 0.0, "balance_stored": 0.0, "not_finite": [], "out_of_range": 0.0,
         "overshoot_saturation": 0.0, "overshoot_pressure": 0.0, "yield_exceeded": 0.0, "energy_gained": None, "equilibrium_lost": False, "growth": 0.9}


class Doctored:
    """An engine of which some fields are replaced."""

    def __init__(self, engine):
        self._engine, self.replaced = engine, {}

    def __getattr__(self, name):
        return getattr(self._engine, name)

    def read(self, name):
        return self.replaced[name] if name in self.replaced else self._engine.read(name)

    def replace(self, name, change):
        self.replaced[name] = change(self._engine.read(name).copy())


def changed_at(index, value):
    def change(values):
        values[index] = value
        return values
    return change


def raised(stress):
    stress[5] += [0, 0, 0, 1e6]
    return stress


def watched(scene, name=None, change=None, steps=1, seconds=3600):
    """What is seen of a run in which a field is doctored."""
    engine = Doctored(talus.Engine(talus.Scene.from_json(scene)))
    for _ in range(steps):
        engine.step(seconds)
    if name:
        engine.replace(name, change)
    watch = Watch(engine, scene)
    watch.look()
    return watch.seen


class Values(unittest.TestCase):
    def found(self, case=None, **doctored):
        return faults(case or Case("test/1", {}, []), {**SOUND, **doctored})

    def test_sound_values_pass(self):
        for scene in (scenes.column(), scenes.small_slope()):
            self.assertEqual(self.found(**watched(scene)), [])

    def test_not_finite(self):
        for value in (numpy.nan, numpy.inf):
            for field in ("pressure", "darcy_flux"):
                found = self.found(**watched(scenes.column(), field, changed_at(0, value)))
                self.assertIn(f"not finite: {field}", found)

    def test_saturation_out_of_range(self):
        scene = scenes.column([scenes.soil(residual=0.1)])
        for value in (1 + 1e-11, 0.1 - 1e-11):
            self.assertRegex(self.found(**watched(scene, "saturation", changed_at(3, value)))[0], "saturation out of its range")

    def test_overshoot(self):
        case = Case("test/1", {}, [], monotone=True)
        for field, value in (("saturation", 0.9), ("pressure", 1e4)):
            found = self.found(case, **watched(scenes.column(), field, changed_at(20, value)))
            self.assertRegex(found[0], f"overshoot_{field}")

    def test_water_balance(self):
        report = {f"water_{name}": 0.0 for name in ("run_off", "seepage", "inflow", "drained", "residual")}
        report |= {"water_rain": 1.0, "water_infiltrated": 1.0, "water_initial": 2.0, "water_stored": 3.0,
                   "motion_substeps": 0}
        self.assertEqual(self.found(**balances([report])), [])
        for name in ("rain", "stored", "residual", "drained"):
            wrong = {**report, f"water_{name}": report[f"water_{name}"] + 2e-8}
            self.assertRegex(self.found(**balances([report, wrong, report]))[0], "water balance", name)
            unknown = {**report, f"water_{name}": numpy.nan}
            self.assertRegex(self.found(**balances([report, unknown, report]))[0], "water balance", name)

    def test_bounds(self):
        for case, bound, name, text in ((None, 1e-6, "yield_exceeded", "yield exceeded"),
                                        (None, DEFAULT_TOLERANCE, "moved", "moves by"), (None, 0.05, "energy_gained", "energy gained"),
                                        (Case("test/1", {}, [], settles=True), 1.0, "growth", "increments grow")):
            self.assertEqual(self.found(case, **{name: 0.99 * bound}), [])
            self.assertRegex(self.found(case, **{name: 1.01 * bound})[0], text)
            self.assertRegex(self.found(case, **{name: numpy.nan})[0], text)

    def test_loss_of_equilibrium(self):
        for expected in (True, False):
            case = Case("test/1", {}, [], loses=expected)
            self.assertEqual(self.found(case, equilibrium_lost=expected), [])
            self.assertRegex(self.found(case, equilibrium_lost=not expected)[0], "equilibrium is")

    def test_endings(self):
        for outcome in ("refused", "crashed", "hung"):
            self.assertEqual(self.found(outcome=outcome, reason="so\nit is"), ["so"])
        self.assertEqual(self.found(Case("test/1", {}, [], refusal="so"), outcome="refused", reason="so it is"), [])
        self.assertNotEqual(self.found(Case("test/1", {}, [], refusal="so")), [])
        permitted = Case("test/1", {}, [], may_be_refused="so")
        self.assertEqual(self.found(permitted, outcome="refused", reason="so it is"), [])
        self.assertNotEqual(self.found(permitted, outcome="crashed", reason="so it is"), [])
        self.assertNotEqual(self.found(permitted, outcome="refused", reason=f"so it is{DISPROVED}"), [])


class Yield(unittest.TestCase):
    def beyond(self, *stress, tensile=numpy.inf):
        """Of 10 kPa and 30 degrees."""
        return relative_excess(*excess(numpy.array([stress]), numpy.array([1e4]), numpy.array([30.0]), tensile))

    def test_compression(self):
        limit = 2e4 * numpy.cos(numpy.pi / 6) / (1 - 0.5)
        self.assertLess(self.beyond(0, -limit, -0.3 * limit, 0), 1e-15)
        self.assertGreater(self.beyond(0, -1.00001 * limit, -0.3 * limit, 0), 1e-6)

    def test_shear_turns_the_principal_stresses(self):
        radius = 1e4 * numpy.cos(numpy.pi / 6)
        self.assertLess(self.beyond(0, 0, 0, radius), 1e-15)
        self.assertGreater(self.beyond(0, 0, 0, 1.00001 * radius), 1e-6)

    def test_tension(self):
        self.assertEqual(self.beyond(1e3, 0, 0, 0, tensile=1e3), 0)
        self.assertGreater(self.beyond(1.001e3, 0, 0, 0, tensile=1e3), 1e-6)

    def test_in_motion(self):
        bishop = dynamic_cases.wet_bank()
        bishop["physics"]["stress"] = "bishop"
        for scene, field in ((dynamic_cases.dry_bank(), "net_stress"), (dynamic_cases.wet_bank(), "net_stress"), (bishop, "total_stress")):
            self.assertLess(watched(scene, seconds=0.1)["yield_exceeded"], 1e-9)
            self.assertGreater(watched(scene, field, raised, seconds=0.1)["yield_exceeded"], 1e-3)

    def test_of_a_run(self):
        for measure, field in (("net", "net_stress"), ("bishop", "total_stress")):
            scene = scenes.small_slope(stress=measure, cohesion=2500, friction=24)
            self.assertLess(watched(scene)["yield_exceeded"], 1e-9)
            self.assertGreater(watched(scene, field, raised)["yield_exceeded"], 1e-3)
        wetter = watched(scenes.small_slope(cohesion=0, friction=20, rain=1e-5), "suction", lambda values: 0 * values)
        self.assertGreater(wetter["yield_exceeded"], 1e-6)  # what suction held is beyond the strength without it


class Growth(unittest.TestCase):
    def test_increments(self):
        self.assertLess(settling.growth([8, 4, 2, 1], 1e-3), 1)
        self.assertGreater(settling.growth([1, 1.1, 1.21], 1e-3), 1)
        self.assertLess(settling.growth([1, 1e-9, 5e-4], 1e-3), 1)  # below what counts

    def test_alternating_pressures(self):
        scene = scenes.loaded_column(ramp=1)
        engine = Doctored(talus.Engine(talus.Scene.from_json(scene)))
        watch = settling.Settling(engine)
        for step in range(8):
            engine.step(1)
            engine.replace("pressure", lambda values: values + 100 * (-1.5) ** step)
            watch.look()
        self.assertGreater(watch.growth(), 1.4)


class Claims(unittest.TestCase):
    def test_collapse(self):
        reason = "InvalidScene: the ground does not stand under its own weight: it fails"
        sound = scenes.small_slope(soils=[scenes.earth(), scenes.earth("other")])
        weak = scenes.small_slope(soils=[scenes.earth(cohesion=50, friction=1), scenes.earth("other")])
        self.assertIn(DISPROVED, tested(sound, reason))
        self.assertEqual(tested(weak, reason), reason)
        self.assertEqual(tested(sound, "NotConverged: t = 1 s"), "NotConverged: t = 1 s")


class Shrinking(unittest.TestCase):
    TREE = {"scene": {"soils": [{"alpha": 0.00712, "n": 3}, {"alpha": 1.0}], "title": "x",
                      "ground": {"column": {"height": 5.0, "cells": 64}}},
            "steps": [["rain", 1e-5], ["step", 123.4, 7], ["step", 1.0, 3]]}

    @staticmethod
    def fails(tree):
        """A steep soil, eight cells and a step of more than 100 s."""
        soils = tree["scene"].get("soils", [])
        cells = tree["scene"].get("ground", {}).get("column", {}).get("cells", 0)
        return (any(1e-3 < soil.get("alpha", 0) < 1 for soil in soils) and cells >= 8 and
                any(step[0] == "step" and step[1] > 100 for step in tree["steps"]))

    def test_to_what_fails(self):
        least = shrink.shrink(self.TREE, self.fails)
        self.assertTrue(self.fails(least))
        self.assertEqual(least["scene"]["soils"], [{"alpha": 0.007}])
        self.assertEqual(least["scene"]["ground"]["column"]["cells"], 8)
        self.assertEqual(least["steps"], [["step", 120.0, 1]])

    def test_nothing_where_nothing_may_go(self):
        self.assertEqual(shrink.shrink(self.TREE, lambda tree: tree == self.TREE), self.TREE)

    def test_no_time(self):
        self.assertEqual(shrink.shrink(self.TREE, self.fails, seconds=0), self.TREE)

    def test_the_same_kind_stays(self):
        def row_of(case):
            long = any(step[0] == "step" and step[1] > 100 for step in case.steps)
            return {"faults": [f"t = {len(case.steps)} s: stopped" if long else "InvalidScene: no step"], "reason": None}
        kinds, least = shrink.shrunk(Case("test/1", **self.TREE), row_of)
        self.assertEqual(kinds, {"t = # s: stopped"})
        self.assertEqual(least.steps, [["step", 120.0, 1]])


if __name__ == "__main__":
    unittest.main()
