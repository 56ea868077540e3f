"""Runs a case in a setting of its own, in a process of its own; and the finite-element baseline beside it."""

import importlib.util
import json
import subprocess
import sys

import column
import explicit_motion
import numpy
import slopes
import talus
from isolated import in_a_process
from rows import REFERENCES, read_scene
from settings import set_even_growth, set_resolution, set_tolerance

WALL_BOUND = 120.0  # s: a run that takes longer is stopped
EXPLICIT_CELLS = (8, 12, 25)  # of the column by explicit motion
LEAST_MEASURED = 1.0  # s: shorter runs are repeated until they add up to this,
MOST_REPEATS = 5  # but no more than this, and the quickest counts


# --- one run ---

def run(case, coarsening, loosening, even=False):
    """A row: setting, size, errors and seconds, or the reason why there are none."""
    scene = read_scene(case)
    if even:
        set_even_growth(scene)
    setting = {"resolution_m": set_resolution(scene, coarsening), "tolerance": set_tolerance(scene, loosening), "even": even}
    default = coarsening == 1 and loosening == 1 and not even
    row = {"case": case, "setting": setting, "default": default, "nodes": None, "errors": None, "wall_s": None, "cpu_s": None,
           "reason": None}
    return {**row, **in_bounds(measure_or_say, case, scene)}


def in_bounds(function, *arguments):
    """The dict that function returns from a process of its own, or the reason why there is none."""
    outcome, result = in_a_process(WALL_BOUND, function, *arguments)
    return result if outcome == "finished" else {"reason": result}


def measure_or_say(case, scene):
    try:
        return measure(case, scene)
    except talus.Error as error:
        return {"reason": str(error)}


def measure(case, scene):
    made = talus.Scene.from_json(scene)
    simulate = column.simulate if case.startswith("column") else slopes.simulate
    clocks = []
    while len(clocks) < MOST_REPEATS and sum(clock.wall for clock in clocks) < LEAST_MEASURED:
        *result, clock = simulate(lambda: talus.Engine(made))
        clocks.append(clock)
    engine = result[0]
    lost = [event["time"] for event in engine.events() if event["kind"] == "loss_of_equilibrium"]
    if lost:
        return {"reason": f"no equilibrium from {lost[0] / 3600:.2f} h on, where the reference has one"}
    errors = column_errors(case, *result) if case.startswith("column") else slope_errors(case, *result)
    return {"nodes": engine.describe()["nodes"], "errors": {name: float(error) for name, error in errors.items()},
            "wall_s": min(clock.wall for clock in clocks), "cpu_s": min(clock.cpu for clock in clocks)}


def column_errors(case, _engine, profiles):
    """The largest over the times of the profiles."""
    errors = list(column.profile_errors(case, profiles))
    return {name: float(max(error[name] for error in errors)) for name in errors[0]}


def slope_errors(case, engine):
    return {"rms_pressure_Pa": slopes.field_error(case, engine), **slopes.history_errors(case, engine)}


# --- other methods ---

def run_explicit(case, quick=False):
    """The column by explicit motion of material points: rows beside the sweep's, as the baseline's."""
    settings = EXPLICIT_CELLS if case == "column" else ()
    for cells in settings[:1] if quick else settings:
        profiles, clock = explicit_motion.column_run(cells)
        heights = numpy.full(cells, 1 / cells)
        at_times = [(numpy.array(profile["height"]), heights, numpy.array(profile["pressure"]), numpy.array(profile["saturation"]))
                    for profile in profiles[:len(column.TIMES)]]
        yield {"name": f"explicit motion, {1 / cells:.3g} m", "recorded": False, "nodes": cells,
               "errors": column_errors(case, None, at_times), "wall_s": clock.wall, "cpu_s": clock.cpu}


def run_baseline(case, folder):
    """The finite elements of reference/baseline.py, run now if possible, else as recorded; None where there are none."""
    recorded = REFERENCES / f"baseline_{case}.json"
    if not recorded.exists():
        return None
    command = [sys.executable, str(REFERENCES / "baseline.py"), case]
    ran = importlib.util.find_spec("dolfinx") and subprocess.run(command, cwd=folder, capture_output=True).returncode == 0
    result = json.loads(((folder if ran else REFERENCES) / recorded.name).read_text())
    name = f"FEM, {result['cells']} linear quads, " + ("run beside" if ran else "recorded on another occasion")
    return {"name": name, "recorded": not ran, **{key: result[key] for key in ("nodes", "errors", "wall_s", "cpu_s")}}
