#!/usr/bin/python3
"""The Python binding. Usage: test_python.py [-v] [TEST ...]; the library is the one that TALUS_LIBRARY names."""
import ctypes
import gc
import json
import os
import pathlib
import signal
import subprocess
import sys
import threading
import unittest

import numpy

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "bindings/python"), str(ROOT / "tests/precision")]
import talus
from variants import VARIANTS
from talus._library import library

SCENES = ROOT / "samples/scenes"
COLUMN = json.loads((SCENES / "column.json").read_text())


def column(**options):
    return talus.Engine(talus.Scene.from_json(COLUMN), **options)


class Basics(unittest.TestCase):
    def test_version_and_build(self):
        self.assertEqual(talus.version(), "0.1.0")
        self.assertEqual(talus.build_info()["version"], "0.1.0")

    def test_scene_from_dict_text_and_file(self):
        sources = (talus.Scene.from_json(COLUMN), talus.Scene.from_json(json.dumps(COLUMN)),
                   talus.Scene.from_file(SCENES / "column.json"))
        hashes = set()
        for scene in sources:
            with talus.Engine(scene) as engine:
                engine.step(10)
                hashes.add(engine.hash())
        self.assertEqual(len(hashes), 1)

    def test_wrong_scene_says_what_is_wrong(self):
        wrong = json.loads(json.dumps(COLUMN))
        wrong["soils"][0]["porosity"] = 40
        with self.assertRaisesRegex(talus.InvalidScene, r"soils\[0\]\.porosity.*40"):
            talus.Scene.from_json(wrong)
        with self.assertRaisesRegex(talus.InputOutputError, "nowhere.json"):
            talus.Scene.from_file("nowhere.json")
        with self.assertRaises(talus.InvalidScene):
            talus.Scene.from_bytes(b"12345678")

    def test_report_is_a_dict(self):
        with column() as engine:
            report = engine.step(10)
            self.assertEqual(report["status"], "ok")
            self.assertEqual(report["regime"], "quasi_static")
            self.assertEqual(report["time"], 10)
            self.assertAlmostEqual(report["water_rain"], 1e-3)
            self.assertEqual(engine.report(), {key: value for key, value in report.items() if key != "status"})
            self.assertEqual(engine.time, 10)

    def test_names_and_arguments(self):
        with column() as engine:
            for call in (lambda: engine.view("temperature"), lambda: engine.set_rain("snow", 0),
                         lambda: engine.history("nowhere", "pressure"), lambda: engine.history("top", "temperature")):
                with self.assertRaises(talus.UnknownName):
                    call()
            with self.assertRaisesRegex(talus.InvalidArgument, "mm/h"):
                engine.set_rain("rain", 12)
            with self.assertRaises(talus.InvalidArgument):
                engine.step(-1)
            with self.assertRaises(ValueError):
                engine.push_rain("rain", [0, 1], [0])

    def test_closed_engine(self):
        engine = column()
        engine.close()
        with self.assertRaises(talus.InvalidHandle):
            engine.step(1)

    def test_rain_policy(self):
        with column(rain_policy="hold") as engine:
            engine.push_rain("rain", [0, 5], [5e-5, numpy.nan])
            report = engine.step(10)
            self.assertAlmostEqual(report["water_rain"], 5e-4)
            self.assertEqual(report["rain_substitutions"], 1)


class LeftOut(unittest.TestCase):
    """What the physics of a scene leaves out is not there: no unknowns, no fields, no bytes."""

    OF_MOTION = {"displacement", "velocity", "total_stress", "net_stress", "strain", "plastic_strain", "mobilised_strength"}
    OF_WATER = {"pressure", "point_pressure", "suction", "saturation", "water_content", "darcy_flux"}

    def described(self, variant):
        scene = json.loads((SCENES / "slope_gentle.json").read_text())
        scene["ground"]["section"].update(columnWidth=4, surfaceCellHeight=0.5, gradedDepth=1, growth=1.6, largestCellHeight=4)
        scene["initial"] = {"flow": "hydrostatic", "waterTable": 8, "stress": "gravity"}
        scene["schedule"] = {"duration": 3600, "step": 3600}
        with talus.Engine(talus.Scene.from_json(VARIANTS[variant](scene))) as engine:
            engine.step(60)
            return engine.describe(), set(engine.fields)

    def test_full_scene_has_all(self):
        described, fields = self.described("full")
        self.assertEqual(described["unknowns"]["flow"], described["nodes"])
        self.assertGreater(described["unknowns"]["motion"], described["nodes"])
        self.assertLessEqual(self.OF_MOTION | self.OF_WATER, fields)

    def test_rigid_skeleton_has_no_motion(self):
        described, fields = self.described("rigid skeleton")
        self.assertEqual(described["unknowns"], {"flow": described["nodes"], "motion": 0})
        self.assertFalse(self.OF_MOTION & fields)
        self.assertLessEqual(self.OF_WATER, fields)
        self.assertIn("deformation", " ".join(described["left_out"]))
        self.assertLess(described["bytes"], self.described("full")[0]["bytes"])

    def test_dry_ground_has_no_water(self):
        described, fields = self.described("dry")
        self.assertEqual(described["unknowns"]["flow"], 0)
        self.assertFalse(self.OF_WATER & fields)
        self.assertIn("water", " ".join(described["left_out"]))
        self.assertLess(described["bytes"], self.described("full")[0]["bytes"])


class Dynamic(unittest.TestCase):
    """Ground that moves by its momentum."""

    def heap(self, **options):
        scene = json.loads((SCENES / "column_collapse.json").read_text())
        scene["dynamics"]["cellSize"] = 0.01
        return talus.Engine(talus.Scene.from_json(scene), **options)

    def test_report_fields_and_probes(self):
        with self.heap() as engine:
            start = engine.read("point_position")
            report = engine.step(0.2)
            self.assertEqual(report["regime"], "dynamic")
            self.assertGreater(report["run_out"], 0.02)
            self.assertGreater(report["motion_substeps"], 100)
            self.assertTrue(numpy.allclose(engine.read("point_position"), start + engine.read("displacement"), atol=1e-15))
            speed = numpy.linalg.norm(engine.read("velocity"), axis=1)
            self.assertEqual(report["largest_velocity"], speed.max())
            self.assertLess(engine.history("corner", "displacement.y")[1][-1], -0.02)
            with self.assertRaisesRegex(talus.UnknownName, "dynamic ground has no field 'pressure'"):
                engine.view("pressure")
            described = engine.describe()
            self.assertEqual((described["physics"]["regime"], described["points"]), ("dynamic", len(start)))
            self.assertLessEqual(described["bytes_a_point"], 160)

    def test_raster_has_values_where_the_ground_is(self):
        with self.heap() as engine:
            engine.step(0.3)
            drawn = engine.sample_raster("mobilised_strength", 0.005, 0.195, 0.01, -0.01, 50, 20)
            self.assertTrue(numpy.isnan(drawn[0]).all())
            self.assertFalse(numpy.isnan(drawn[-1, :15]).any())

    def test_threads_change_no_bit(self):
        hashes = set()
        for threads in (1, 2):
            with self.heap(threads=threads) as engine:
                engine.step(0.1)
                engine.step(0.1)
                hashes.add(engine.hash())
        self.assertEqual(len(hashes), 1)


class Arrays(unittest.TestCase):
    def test_mesh_from_memory(self):
        scene = json.loads(json.dumps(COLUMN))
        scene["ground"] = {"mesh": {}}
        scene["surface"]["zones"] = [{"name": "rain"}]
        del scene["probes"], scene["schedule"]
        arrays = {"ground.mesh.position": numpy.array([[0, 0], [1, 0], [1, 1], [0, 1.0]]),
                  "ground.mesh.cellStart": numpy.array([0, 4]),
                  "ground.mesh.cellNodes": [0, 1, 2, 3],
                  "ground.mesh.cellSoil": numpy.zeros(1, numpy.int64)}
        with talus.Engine(talus.Scene.from_json(scene, arrays)) as engine:
            self.assertTrue(numpy.array_equal(engine.read("node_position"), arrays["ground.mesh.position"]))
        arrays["ground.mesh.cellSoil"] = numpy.array([2**40])
        with self.assertRaises(OverflowError):
            talus.Scene.from_json(scene, arrays)

    def test_read_sample_raster_and_history(self):
        with talus.Engine(talus.Scene.from_file(SCENES / "slope_gentle.json")) as engine:
            position = engine.read("node_position")
            pressure = engine.read("pressure")
            inside = len(position) // 2
            self.assertTrue(numpy.allclose(engine.sample("pressure", position[[inside]]), pressure[inside], rtol=1e-6))
            self.assertTrue(numpy.isnan(engine.sample("pressure", [[0, 99]])[0]))
            raster = engine.sample_raster("darcy_flux", 1, 20, 2, -2, columns=4, rows=3)
            self.assertEqual(raster.shape, (3, 4, 2))
            self.assertTrue(numpy.array_equal(raster[1, 2], engine.sample("darcy_flux", [[5, 18]])[0]))
            engine.add_probe("mine", 10, 20)
            engine.step(600)
            time, value = engine.history("mine", "pressure")
            self.assertEqual(list(time), [0, 600])
            self.assertEqual(len(value), 2)


class Views(unittest.TestCase):
    def test_no_copy(self):
        with column() as engine:
            view = engine.view("pressure")
            out = talus._api.talus_field(struct_size=ctypes.sizeof(talus._api.talus_field))
            self.assertEqual(library.talus_engine_view(engine._pointer, b"pressure", ctypes.byref(out)), 0)
            self.assertEqual(view.array.ctypes.data, out.data)
            self.assertEqual(numpy.asarray(view).ctypes.data, out.data)
            self.assertEqual((view.units, view.location, view.shape), ("Pa", "node", (101,)))
            self.assertEqual(numpy.max(view), engine.read("pressure").max())

    def test_every_field(self):
        with talus.Engine(talus.Scene.from_file(SCENES / "slope_gentle.json")) as engine:
            for name in engine.fields:
                view = engine.view(name)
                self.assertTrue(numpy.array_equal(view.array, engine.read(name)), name)
                self.assertFalse(view.array.flags.owndata)

    def test_read_only(self):
        with column() as engine:
            array = engine.view("pressure").array
            for part in (array, array[3:5], array[::2], array.reshape(1, -1)):
                with self.assertRaises(ValueError):
                    part.flat[0] = 1
                with self.assertRaises(ValueError):
                    part.flags.writeable = True

    def test_stale_view_says_so(self):
        engine = column()
        view = engine.view("pressure")
        engine.step(1)
        self.assertTrue(view.stale)
        with self.assertRaisesRegex(talus.StaleView, "pressure.*epoch"):
            view[0]
        fresh = engine.view("pressure")
        engine.close()
        with self.assertRaisesRegex(talus.StaleView, "closed"):
            numpy.asarray(fresh)

    def test_engine_does_not_step_under_an_array(self):
        with column() as engine:
            for take in (lambda: engine.view("pressure").array, lambda: engine.view("pressure")[3:9:2],
                         lambda: memoryview(numpy.asarray(engine.view("pressure"))),
                         lambda: engine.view("pressure").array.reshape(-1, 1).T):
                held = take()
                with self.assertRaisesRegex(talus.ViewHeld, "pressure"):
                    engine.step(1)
                del held
                gc.collect()
                engine.step(1)

    def test_array_outlives_the_engine(self):
        engine = column()
        expected = engine.read("pressure")
        array = engine.view("pressure").array
        engine.close()
        del engine
        gc.collect()
        self.assertTrue(numpy.array_equal(array, expected))

    def test_read_is_a_copy(self):
        with column() as engine:
            before = engine.read("pressure")
            engine.step(60)
            self.assertFalse(numpy.array_equal(before, engine.read("pressure")))


class Callbacks(unittest.TestCase):
    def test_progress_cancels(self):
        with column(progress=lambda fraction: True) as engine:
            before = engine.hash()
            with self.assertRaises(talus.Cancelled):
                engine.step(60)
            self.assertEqual(engine.hash(), before)
            self.assertEqual(engine.time, 0)

    def test_exception_in_a_callback_comes_out_of_the_step(self):
        def fail(fraction):
            raise LookupError("mine")
        with column(progress=fail) as engine:
            before = engine.hash()
            with self.assertRaisesRegex(LookupError, "mine"):
                engine.step(60)
            self.assertEqual(engine.hash(), before)

    def test_interrupt_cancels_the_step(self):
        def interrupt(fraction):
            os.kill(os.getpid(), signal.SIGINT)
        with column(progress=interrupt) as engine:
            before = engine.hash()
            with self.assertRaises(KeyboardInterrupt):
                engine.step(60)
            self.assertEqual(engine.hash(), before)

    def test_log(self):
        scene = json.loads(json.dumps(COLUMN))
        scene["surface"]["zones"][0]["rainEnd"] = 5
        lines = []
        with talus.Engine(talus.Scene.from_json(scene), log=lambda level, text: lines.append(text)) as engine:
            self.assertEqual(engine.step(10)["status"], "out_of_rain")
            self.assertIn("rain_ended", [event["kind"] for event in engine.events()])
        self.assertTrue(lines)


class Threads(unittest.TestCase):
    def test_engines_in_threads_give_the_same_bits(self):
        def run(hashes):
            with column() as engine:
                for _ in range(5):
                    engine.step(20)
                hashes.append(engine.hash())
        hashes = []
        run(hashes)
        threads = [threading.Thread(target=run, args=(hashes,)) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(set(hashes)), 1)

    def test_hundred_engines_leave_nothing(self):
        for _ in range(100):
            with column() as engine:
                engine.step(1)


class Library(unittest.TestCase):
    def test_loading_and_unloading_leaves_nothing(self):
        script = """
import ctypes, _ctypes, sys
for i in range(200):
    library = ctypes.CDLL(sys.argv[1])
    library.talus_scene_from_json(b"{", 1, ctypes.byref(ctypes.c_void_p()))
    _ctypes.dlclose(library._handle)
maps = open("/proc/self/maps").read()
sys.exit("libtalus is still loaded" if "libtalus" in maps else 0)
"""
        subprocess.run([sys.executable, "-c", script, library._name], check=True)


if __name__ == "__main__":
    unittest.main()
