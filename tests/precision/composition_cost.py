"""What each composition of a ground in motion costs, and what the engine adds to the loop of the dry one."""

import json
import os
import pathlib
import subprocess

import talus
from rows import Clock

CELLS = 64  # a metre
SECONDS = 300 * 0.018 / CELLS  # simulated: 300 substeps, as the loop alone
RUNS = 5  # of which the quickest counts

SCENE = {
    "name": "collapse", "physics": {"water": False, "regime": "dynamic"},
    "soils": [{"name": "sand", "dryDensity": 1800, "porosity": 0.4,
               "solid": {"youngModulus": 1e6, "poissonRatio": 0.3,
                         "strength": {"model": "constant", "cohesion": 50, "frictionAngle": 30}}}],
    "ground": {"section": {"terrain": [[0, 1], [1, 1]], "base": [[0, 0], [1, 0]], "layers": [{"soil": "sand"}], "columnWidth": 1 / CELLS,
                           "surfaceCellHeight": 1 / CELLS, "growth": 1, "largestCellHeight": 1 / CELLS}},
    "boundaries": [{"name": "base", "side": "base", "motion": "fixed"}, {"name": "left", "side": "left", "motion": "roller"}],
    "initial": {"stress": "zero"}, "dynamics": {"cellSize": 1 / CELLS},
}


def throughput(threads):
    """Rows of the program throughput."""
    program = pathlib.Path(os.environ["TALUS_LIBRARY"]).resolve().parent.parent / "bin" / "throughput"
    return json.loads(subprocess.run([program, str(threads)], check=True, capture_output=True, text=True).stdout)


def loops():
    """Nanoseconds of a point and substep by composition, of the loops alone."""
    return {row["composition"]: 1e3 / row["million_point_updates_a_second"] for row in throughput(1) if row["cells_a_metre"] == CELLS}


def dry_engine():
    """The same of the dry collapse as a scene of the whole engine."""
    engine = talus.Engine(talus.Scene.from_json(SCENE))
    with Clock() as clock:
        report = engine.step(SECONDS)
    return 1e9 * clock.cpu / report["motion_substeps"] / engine.describe()["points"]


def run():
    """Best of several runs, one kind after the other: what disturbs one disturbs all."""
    best = {}
    for _ in range(RUNS):
        for name, cost in {**loops(), "dry_scene": dry_engine()}.items():
            best[name] = min(best.get(name, cost), cost)
    return best
