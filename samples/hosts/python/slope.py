#!/usr/bin/python3
"""The slope from Python: 36 h of rain on a 45 degree face, watched at three points, nothing copied that need not be.

Usage: samples/hosts/python/slope.py [SCENE] [HOURS]. Prints a row each hour, and at the end the hash of the state: the same scene
stepped in the same way from C ends with the same one.
"""
import pathlib
import sys

import numpy

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "bindings/python"))
import talus

HOUR = 3600
WATCHED = ("A", "B", "C")


def wet_depth(engine, x, surface):
    """Depth in m below (x, surface) down to which the saturation is above 0.9."""
    depth = numpy.linspace(0.05, 10, 200)
    places = numpy.column_stack([numpy.full_like(depth, x), surface - depth])
    wet = engine.sample("saturation", places) > 0.9
    return depth[wet][-1] if wet.any() else 0.0


def main():
    path = sys.argv[1] if len(sys.argv) > 1 else ROOT / "samples/scenes/slope.json"
    hours = float(sys.argv[2]) if len(sys.argv) > 2 else 36

    # 1. A scene is what is simulated; what is wrong with it is said at once. 2. An engine is one run of it.
    with talus.Engine(talus.Scene.from_file(path)) as engine:
        # 3. Push: 12 mm/h from now on, in m/s.
        engine.set_rain("rain", 12e-3 / HOUR)
        print("   h " + "".join(f"   p({name}), kPa" for name in WATCHED) + "  largest |u|, mm  wet depth at B, m")
        for hour in range(1, int(hours) + 1):
            # 4. Step: the engine takes as many steps of its own as its tolerance asks for.
            report = engine.advance_to(hour * HOUR)
            # 5. Look. A history is a copy; a view is the engine's own memory, and good until the next step.
            pressure = [engine.history(name, "pressure")[1][-1] / 1e3 for name in WATCHED]
            displacement = engine.view("displacement")
            largest = 1e3 * numpy.linalg.norm(displacement, axis=1).max()
            print(f"{report['time'] / HOUR:4.0f} " + "".join(f"{p:13.2f}" for p in pressure) +
                  f"{largest:17.3f}{wet_depth(engine, 30, 20):19.2f}")
        for event in engine.events():
            print(event["message"])
        print(f"state {engine.hash() % 2**64:016x}")


if __name__ == "__main__":
    main()
