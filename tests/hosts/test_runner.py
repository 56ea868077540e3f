#!/usr/bin/python3
"""The `talus` program, the C host and their files. Usage: test_runner.py BIN_FOLDER [-v] [TEST ...]."""
import json
import math
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import numpy

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ROOT / "samples/scenes"
BIN = pathlib.Path(sys.argv.pop(1)).resolve()
os.environ.setdefault("TALUS_LIBRARY", str(BIN.parent / "lib/libtalus.so.0"))
sys.path.insert(0, str(ROOT / "bindings/python"))
import talus

# A slope that takes a second: the gentle one, coarse, for six hours.
SMALL = json.loads((SCENES / "slope_gentle.json").read_text())
SMALL["ground"]["section"].update(columnWidth=4, surfaceCellHeight=0.5, gradedDepth=1, growth=1.6, largestCellHeight=4)
SMALL["schedule"] = {"duration": 6 * 3600, "step": 3600, "outputs": [0, 10000, 21600]}


def run(*arguments, **options):
    return subprocess.run([BIN / "talus", *map(str, arguments)], capture_output=True, text=True, **options)


class Folder(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def scene(self, scene=SMALL):
        path = self.folder / "scene.json"
        path.write_text(json.dumps(scene))
        return path


class Command(Folder):
    def test_version(self):
        self.assertEqual(run("--version").stdout, "talus 0.1.0\n")

    def test_wrong_use(self):
        for arguments in ((), ("dance",), ("run",), ("run", "x.json"), ("run", "x.json", "--out", "y", "--step", "-1")):
            self.assertEqual(run(*arguments).returncode, 2, arguments)

    def test_check(self):
        done = run("check", SCENES / "column.json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("rigid skeleton", done.stdout)
        self.assertIn("100 cells", done.stdout)

    def test_wrong_scene(self):
        wrong = json.loads((SCENES / "column.json").read_text())
        wrong["soils"][0]["porosity"] = 40
        for command in (("check", self.scene(wrong)), ("run", self.scene(wrong), "--out", self.folder / "out")):
            done = run(*command)
            self.assertEqual(done.returncode, 2)
            self.assertIn("soils[0].porosity", done.stderr)
        self.assertFalse((self.folder / "out").exists())
        self.assertEqual(run("check", self.folder / "none.json").returncode, 2)

    def test_scene_without_schedule(self):
        scene = json.loads((SCENES / "column.json").read_text())
        del scene["schedule"]
        done = run("run", self.scene(scene), "--out", self.folder / "out")
        self.assertEqual(done.returncode, 1)
        self.assertIn("schedule.duration", done.stderr)

    def test_folder_that_cannot_be_written(self):
        (self.folder / "file").write_text("")
        done = run("run", SCENES / "column.json", "--out", self.folder / "file" / "out")
        self.assertEqual(done.returncode, 1)
        self.assertIn("file", done.stderr)


# Sand that falls for a fifth of a second.
HEAP = json.loads((SCENES / "column_collapse.json").read_text())
HEAP["dynamics"]["cellSize"] = 0.01

# A bank that stands by its suction until rain takes it, after 111 minutes.
SOIL = {"name": "soil", "dryDensity": 1800, "porosity": 0.4,
        "hydraulics": {"retention": {"model": "vanGenuchten", "alpha": 4e-4, "n": 2}, "conductivity": {"along": 1e-4}},
        "solid": {"youngModulus": 10e6, "poissonRatio": 0.3, "strength": {"cohesion": 500, "frictionAngle": 30},
                  "softening": {"residualCohesion": 0, "residualFrictionAngle": 15, "slip": 0.05}}}
BANK = {"name": "bank", "physics": {"regime": "auto"}, "water": {"bulkModulus": 1e7}, "soils": [SOIL],
        "ground": {"section": {"terrain": [[0, 4], [3, 4], [6, 1], [12, 1]], "base": [[0, 0], [12, 0]], "layers": [{"soil": "soil"}],
                               "columnWidth": 0.5, "surfaceCellHeight": 0.4, "growth": 1, "largestCellHeight": 0.5}},
        "boundaries": [{"side": "base", "motion": "fixed"}, {"side": "left", "motion": "roller"}, {"side": "right", "motion": "roller"}],
        "surface": {"zones": [{"name": "rain", "time": [0], "rate": [3e-5]}]}, "initial": {"flow": "suction", "suction": 2e4},
        "dynamics": {"cellSize": 0.5}, "numerics": {"tolerance": 0.1}, "probes": [{"name": "A", "place": [3.5, 3]}],
        "schedule": {"duration": 7800, "step": 600, "motionStep": 0.5, "outputs": [0, 6000, 7200]}}
HEAP["schedule"] = {"duration": 0.2, "step": 0.05, "outputs": [0, 0.1, 0.2]}


class Samples(Folder):
    def test_every_scene_is_sound(self):
        for path in sorted(SCENES.glob("*.json")):
            with self.subTest(path.stem):
                done = run("check", path)
                self.assertEqual(done.returncode, 0, done.stderr)

    def test_columns_by_explicit_motion_take_in_the_rain(self):
        for name in ("column_explicit", "column_three_phase"):
            with self.subTest(name):
                scene = json.loads((SCENES / f"{name}.json").read_text())
                scene["schedule"] = {"duration": 1, "step": 0.5}
                out = self.folder / name
                done = run("run", self.scene(scene), "--out", out)
                self.assertEqual(done.returncode, 0, done.stderr)
                report = json.loads((out / "report.json").read_text())["last"]
                self.assertAlmostEqual(report["water_infiltrated"], 0.05 * 1e-4, delta=1e-12)
                self.assertAlmostEqual(talus.Results(out).probes["base.pressure"][-1], -37975, delta=50)


class Run(Folder):
    def test_what_a_run_leaves(self):
        out = self.folder / "out"
        done = run("run", self.scene(), "--out", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("infiltrated", done.stdout)
        self.assertFalse(list(out.rglob("*.part")))

        results = talus.Results(out)
        report = results.report
        self.assertEqual(report["status"], "finished")
        self.assertEqual([step["time"] for step in report["steps"]],
                         [3600, 7200, 10000, 10800, 14400, 18000, 21600])
        self.assertAlmostEqual(report["last"]["water_rain"], 70 * 0.012 * 6, places=6)  # 70 m of surface, 12 mm/h, 6 h
        self.assertLess(abs(report["last"]["water_residual"]), 1e-8 * report["last"]["water_rain"])
        self.assertEqual(results.times, [0, 10000, 21600])
        self.assertEqual(list(results.probes["time"]), [0] + [step["time"] for step in report["steps"]])
        self.assertIn("A.pressure", results.probes)

    def test_the_same_bits_as_python(self):
        out = self.folder / "out"
        run("run", self.scene(), "--out", out, "--tolerance", 2e-3)
        results = talus.Results(out)
        with talus.Engine(talus.Scene.from_json(SMALL), tolerance=2e-3) as engine:
            for time_ in [step["time"] for step in results.report["steps"]]:
                engine.advance_to(time_)
            self.assertEqual(f"{engine.hash() % 2**64:016x}", results.report["hash"])
            fields = results.fields(21600)
            self.assertTrue(numpy.array_equal(fields.nodes["pressure"], engine.read("pressure")))
            self.assertTrue(numpy.array_equal(fields.nodes["displacement"][:, :2], engine.read("displacement")))
            self.assertTrue(numpy.array_equal(fields.points["position"][:, :2], engine.read("point_position")))
            self.assertTrue(numpy.array_equal(fields.points["net_stress"], engine.read("net_stress")))
            self.assertTrue(numpy.array_equal(fields.cells["cell_soil"], engine.read("cell_soil")))
            self.assertTrue(numpy.array_equal(results.probes["A.pressure"], engine.history("A", "pressure")[1]))

    def test_dynamic_ground(self):
        out = self.folder / "out"
        done = run("run", self.scene(HEAP), "--out", out, "--threads", 2)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("run-out", done.stdout)
        self.assertNotIn("infiltrated", done.stdout)
        self.assertFalse((out / "ground.pvd").exists())
        results = talus.Results(out)
        self.assertEqual(results.times, [0, 0.1, 0.2])
        self.assertEqual(results.report["last"]["regime"], "dynamic")
        with talus.Engine(talus.Scene.from_json(HEAP)) as engine:
            for time_ in results.steps("time"):
                engine.advance_to(time_)
            self.assertEqual(f"{engine.hash() % 2**64:016x}", results.report["hash"])
            points = results.fields(0.2).points
            self.assertTrue(numpy.array_equal(points["position"][:, :2], engine.read("point_position")))
            self.assertTrue(numpy.array_equal(points["point_soil"], engine.read("point_soil")))

    def test_from_storm_to_rest(self):
        out = self.folder / "out"
        done = run("run", self.scene(BANK), "--out", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        results = talus.Results(out)
        self.assertEqual(results.mesh_times, [0, 6000, 7200])
        begun, rested, settled = (event["time"] for event in results.report["events"][:3])
        self.assertEqual(settled, rested)
        moving = [time for time in results.moving_times if time <= rested]  # the start of the motion, each of its steps, its end
        self.assertEqual((moving[0], moving[-1]), (begun, rested))
        self.assertEqual(moving[:-1], [begun + 0.5 * k for k in range(len(moving) - 1)])
        with talus.Engine(talus.Scene.from_json(BANK), stop_at_motion=True) as engine:
            status = "ok"
            while status == "ok":
                status = engine.step(600)["status"]
            self.assertEqual((status, engine.time), ("ended_early", begun))
        self.assertEqual(results.report["last"]["regime"], "quasi_static")
        kinds = [event["kind"] for event in results.report["events"]]
        self.assertEqual(kinds[:3], ["motion_started", "came_to_rest", "settled"])
        points = results.fields(rested).points
        self.assertGreater(numpy.linalg.norm(points["displacement"], axis=1).max(), 1)
        self.assertTrue(numpy.isfinite(results.probes["A.pressure"]).all())
        self.assertTrue(numpy.isnan(results.probes["A.strain.xx"][results.probes["time"] == rested]).all())
        drawn = subprocess.run([sys.executable, ROOT / "samples/plots.py", out], capture_output=True, text=True)
        self.assertEqual(drawn.returncode, 0, drawn.stderr)
        self.assertTrue((out / "frames.png").exists() and (out / "contours.png").exists())
        self.assertEqual((out / "motion.gif").read_bytes()[:6], b"GIF89a")

    def test_interrupt_cancels_and_leaves_what_was_done(self):
        scene = json.loads((SCENES / "column.json").read_text())
        scene["schedule"] = {"duration": 1e7, "step": 1, "outputs": []}
        scene["ground"]["column"]["cells"] = 400
        out = self.folder / "out"
        process = subprocess.Popen([BIN / "talus", "run", self.scene(scene), "--out", out], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True)
        while not (out / "ground.pvd").exists():
            time.sleep(0.01)
        time.sleep(0.2)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(60), 130)
        self.assertIn("cancelled", process.stderr.read())
        process.stderr.close()
        report = json.loads((out / "report.json").read_text())
        self.assertEqual(report["status"], "cancelled")
        self.assertEqual(report["last"]["time"], len(report["steps"]))
        self.assertFalse(list(out.rglob("*.part")))

    def test_paraview_reads_the_files(self):
        try:
            import vtk
        except ImportError:
            self.skipTest("python3-vtk9 is not installed")
        from vtk.util.numpy_support import vtk_to_numpy
        out = self.folder / "out"
        run("run", self.scene(), "--out", out)
        fields = talus.Results(out).fields(21600)
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(out / "fields/ground_0002.vtu"))
        reader.Update()
        grid = reader.GetOutput()
        self.assertEqual(grid.GetNumberOfCells(), len(fields.ends))
        self.assertTrue(numpy.array_equal(vtk_to_numpy(grid.GetPoints().GetData()), fields.nodes["position"]))
        self.assertTrue(numpy.array_equal(vtk_to_numpy(grid.GetPointData().GetArray("pressure")), fields.nodes["pressure"]))
        self.assertEqual(vtk_to_numpy(grid.GetFieldData().GetArray("TimeValue"))[0], 21600)
        sizes = vtk.vtkCellSizeFilter()
        sizes.SetInputData(grid)
        sizes.Update()
        area = vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Area")).sum()
        self.assertAlmostEqual(area, 20 * 30 + 30 * 20 + 20 * 10, delta=1)  # a section of 70 m with a face of 1 : 1.5


class Plots(Folder):
    def test_plots(self):
        for scene, plots in ((HEAP, {"frames", "energy", "histories"}), (SMALL, {"contours", "histories", "water"}),
                             (json.loads((SCENES / "column.json").read_text()), {"profiles", "histories", "water"})):
            out = self.folder / scene["name"]
            run("run", self.scene(scene), "--out", out)
            done = subprocess.run([sys.executable, ROOT / "samples/plots.py", out], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual({path.stem for path in out.glob("*.png")}, plots)


class RainAlarm(Folder):
    def test_storm(self):
        storm = ROOT / "samples/hosts/storm.csv"
        done = subprocess.run([BIN / "rain_alarm", self.scene(), storm, "A", "B", "C"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("2 bad gauge values were replaced", done.stdout)
        self.assertRegex(done.stdout, r"ALARM  probe [ABC]: pore pressure is")

        # The same hours and rates from Python: the same bits.
        lines = [line.split(",") for line in storm.read_text().splitlines() if not line.startswith("#")]
        with talus.Engine(talus.Scene.from_json(SMALL), rain_policy="hold") as engine:
            for hour, rate in ((float(hour), float(rate)) for hour, rate in lines):
                if hour * 3600 > engine.time:
                    engine.advance_to(hour * 3600.0)
                engine.push_rain(0, [hour * 3600.0], [rate * (1e-3 / 3600)])
            self.assertIn(f"state {engine.hash() % 2**64:016x}", done.stdout)
            self.assertTrue(math.isclose(engine.time, 36 * 3600))


if __name__ == "__main__":
    unittest.main()
