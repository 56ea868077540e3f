"""Ground that comes to an end of its background goes on, is taken out, or is stopped; it is an event, and nothing is lost on the way."""

import pathlib
import sys
import unittest

import numpy

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "bindings" / "python"))

import talus  # noqa: E402  (needs the path above)

STEP, STEPS = 0.1, 30  # s


def bank(policy, is_wet=False, regime="dynamic", **ends):
    """A bank of sand that runs out over a floor to the right."""
    sand = {"name": "sand", "dryDensity": 1600, "porosity": 0.4,
            "solid": {"model": "mohrCoulomb", "youngModulus": 5e6, "poissonRatio": 0.3, "strength": {"cohesion": 50, "frictionAngle": 25}}}
    scene = {"name": "bank", "physics": {"water": is_wet, "regime": regime}, "soils": [sand],
             "ground": {"section": {"terrain": [[0, 2], [2, 2], [4, 0.5], [6, 0.5]], "base": [[0, 0], [6, 0]], "layers": [{"soil": "sand"}],
                                    "columnWidth": 0.5, "surfaceCellHeight": 0.25, "largestCellHeight": 0.5}},
             "boundaries": [{"name": "base", "side": "base", "motion": "friction", "frictionAngle": 15},
                            {"name": "left", "side": "left", "motion": "roller"}],
             "initial": {"stress": "elastic"}, "dynamics": {"cellSize": 0.25, **ends}}
    if policy:
        scene["dynamics"]["atEnds"] = policy
    if is_wet:
        sand["hydraulics"] = {"retention": {"model": "vanGenuchten", "alpha": 1e-4, "n": 2}, "conductivity": {"along": 1e-4}}
        scene["water"] = {"bulkModulus": 1e7}
        scene["initial"].update(flow="hydrostatic", waterTable=0.5)
        scene["surface"] = {"zones": [{"name": "rain", "time": [0], "rate": [1e-5]}]}
    return scene


def failing(policy, x_to):
    """A bank that stands by its suction until it is wet, and then runs out to the right."""
    loam = {"name": "loam", "dryDensity": 1600, "porosity": 0.4,
            "hydraulics": {"retention": {"model": "vanGenuchten", "alpha": 4e-4, "n": 2}, "conductivity": {"along": 1e-4}},
            "solid": {"model": "mohrCoulomb", "youngModulus": 1e7, "poissonRatio": 0.3, "strength": {"cohesion": 500, "frictionAngle": 30},
                      "softening": {"residualCohesion": 0, "residualFrictionAngle": 15, "slip": 0.05}}}
    return {"name": "failing", "physics": {"regime": "auto"}, "soils": [loam], "water": {"bulkModulus": 1e7},
            "ground": {"section": {"terrain": [[0, 4], [3, 4], [7.5, 0.5]], "base": [[0, 0], [7.5, 0]], "layers": [{"soil": "loam"}],
                                   "columnWidth": 0.5, "surfaceCellHeight": 0.4, "largestCellHeight": 0.5}},
            "boundaries": [{"name": "base", "side": "base", "motion": "fixed"}, {"name": "left", "side": "left", "motion": "roller"}],
            "surface": {"zones": [{"name": "rain", "time": [0], "rate": [3e-5]}]},
            "initial": {"flow": "suction", "suction": 2e4}, "numerics": {"tolerance": 0.1},
            "dynamics": {"cellSize": 0.5, "xTo": x_to, "atEnds": policy}}


def run(scene, threads=1):
    engine = talus.Engine(talus.Scene.from_json(scene), threads=threads)
    reports = [engine.step(STEP) for _ in range(STEPS)]
    return engine, reports


def ends(engine):
    return [event for event in engine.events() if event["kind"] == "left_background"]


def grains(engine):
    """Their volume."""
    left = engine.read("point_volume") > 0
    return numpy.sum((engine.read("point_volume") * (1 - engine.read("porosity")))[left])


class Ends(unittest.TestCase):
    def test_extend_goes_on_as_if_there_were_none(self):
        free, _ = run(bank(None))
        with_end, _ = run(bank("extend", xTo=6.1))
        self.assertEqual(free.hash(), with_end.hash())
        self.assertEqual(len(ends(with_end)), 1)
        self.assertGreaterEqual(ends(with_end)[0]["x"], 6.1)
        self.assertEqual(ends(free), [])

    def test_absorb_takes_points_out_with_what_they_hold(self):
        engine, reports = run(bank("absorb", is_wet=True, xTo=6.1))
        gone = engine.read("point_volume") == 0
        self.assertGreater(gone.sum(), 10)
        self.assertAlmostEqual(reports[-1]["front_x"], engine.read("point_position")[:, 0].max())
        self.assertTrue(numpy.isnan(engine.read("saturation")[gone]).all())
        self.assertTrue(numpy.isfinite(engine.read("saturation")[~gone]).all())
        self.assertGreater(reports[-1]["water_drained"], 0.01)
        for report in reports:
            self.assertLess(abs(report["water_residual"]), 1e-12 * report["water_stored"])
        start = talus.Engine(talus.Scene.from_json(bank("absorb", is_wet=True, xTo=6.1)))
        taken = sum(event["value"] for event in ends(engine))
        self.assertAlmostEqual(grains(engine) + 0.6 * taken, grains(start), delta=0.05 * taken)  # it dilates on its way
        self.assertTrue(all(event["value"] > 0 for event in ends(engine)))
        energies = [report["dissipated_energy"] for report in reports]
        self.assertGreater(min(numpy.diff(energies)), -1e-6 * energies[-1])

    def test_absorb_is_undone_and_done_again_to_the_last_bit(self):
        scene = bank("absorb", is_wet=True, xTo=6.1)
        straight, _ = run(scene)
        two, _ = run(scene, threads=2)
        self.assertEqual(straight.hash(), two.hash())
        cancelling = talus.Engine(talus.Scene.from_json(scene), progress=lambda fraction: self.cancels and fraction > 0.9)
        for step in range(STEPS):
            self.cancels = step % 3 == 0
            if self.cancels:
                with self.assertRaises(talus.Error):
                    cancelling.step(STEP)
                self.cancels = False
            cancelling.step(STEP)
        self.assertEqual(straight.hash(), cancelling.hash())
        self.assertEqual([event["value"] for event in ends(straight)], [event["value"] for event in ends(cancelling)])

    def test_ground_of_which_all_was_taken_out_can_be_stepped(self):
        scene = bank("absorb", yFrom=-3.0)
        del scene["boundaries"][:]
        scene["initial"]["stress"] = "zero"
        scene["dynamics"]["restSpeed"] = 1e-3
        engine, reports = run(scene)
        self.assertEqual(engine.read("point_volume").max(), 0)
        self.assertEqual(reports[-1]["kinetic_energy"], 0)
        self.assertLessEqual(reports[-1]["largest_displacement"], 5.5)
        self.assertTrue(numpy.isnan(engine.sample("velocity", [[3.0, -4.0]])).all())

    def test_stop_holds_the_ground_by_a_smooth_wall(self):
        for is_wet in (False, True):
            engine, reports = run(bank("stop", is_wet, xTo=6.3, yTo=2.1))
            position = engine.read("point_position")
            self.assertLess(position[:, 0].max(), 6.3)
            self.assertGreater(position[:, 0].max(), 6.1)
            self.assertEqual(len(ends(engine)), 1)
            self.assertEqual(ends(engine)[0]["value"], 0)
            if is_wet:
                self.assertLess(abs(reports[-1]["water_residual"]), 1e-12 * reports[-1]["water_stored"])

    def test_ground_that_failed_settles_without_what_was_taken_out(self):
        for policy, is_taken in (("absorb", True), ("stop", False)):
            engine = talus.Engine(talus.Scene.from_json(failing(policy, 7.6)))
            start = grains(engine)
            reports = [engine.step(600) for _ in range(16)]
            kinds = [event["kind"] for event in engine.events()]
            self.assertIn("settled", kinds)
            taken = sum(event["value"] for event in ends(engine))
            self.assertEqual(taken > 0, is_taken)
            self.assertAlmostEqual(grains(engine) + 0.6 * taken, start, delta=0.05 * taken + 1e-9 * start)
            for report in reports:
                self.assertLess(abs(report["water_residual"]), 1e-9 * report["water_stored"])

    def test_ground_beyond_an_end_is_refused(self):
        for name, place in (("xTo", 5.0), ("xFrom", 1.0), ("yTo", 1.5), ("yFrom", 0.25)):
            scene = bank("absorb", **{name: place})
            del scene["boundaries"][:]
            scene["initial"]["stress"] = "zero"
            with self.assertRaisesRegex(talus.Error, f"dynamics.{name} = {place:g} m: the ground reaches to"):
                talus.Engine(talus.Scene.from_json(scene))


if __name__ == "__main__":
    unittest.main()
