"""Time and memory of a scene and of the same scene with physics left out; the page docs/left_out.md."""

import os
import pathlib

import composition_cost
import talus
from machine import circumstances, text
from page import number, table
from rows import Clock, read_scene
from sweep import in_bounds
from variants import VARIANTS

SCENE = "slope_gentle"
HOURS = 6

INTRODUCTION = f"""\
<!-- Written by tests/bench left_out. Do not edit. -->
# What a scene saves by what it leaves out

`tests/bench left_out` writes this page and `build/reports/bench.json`. The scene is `{SCENE}` as it is in `samples/scenes`, {HOURS} hours
of it by steps of an hour, one thread, a process a variant. *State* is `bytes` of `talus_engine_describe`: the fields at nodes
and points. *Process* is what the process grew by, matrices and their factors included. In brackets: the ratio to the full scene.
"""


# --- one variant ---

def resident_bytes():
    return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def measure(scene):
    made, before = talus.Scene.from_json(scene), resident_bytes()
    with Clock() as creation:
        engine = talus.Engine(made)
    with Clock() as storm:
        for hour in range(1, HOURS + 1):
            engine.advance_to(3600.0 * hour)
    grown, described = resident_bytes() - before, engine.describe()
    return {"creation_cpu_s": creation.cpu, "creation_wall_s": creation.wall, "hour_cpu_s": storm.cpu / HOURS,
            "hour_wall_s": storm.wall / HOURS, "points": described["points"], "state_bytes": described["bytes"],
            "process_bytes": grown, "unknowns": described["unknowns"], "left_out": described["left_out"],
            "fields": [field["name"] for field in described["fields"]], "reason": None}


def measure_or_say(scene):
    try:
        return measure(scene)
    except talus.Error as error:
        return {"reason": str(error)}


def run():
    scene = read_scene(SCENE)
    rows = [{"variant": name, **in_bounds(measure_or_say, change(scene))} for name, change in VARIANTS.items()]
    return {"scene": SCENE, "hours": HOURS, "rows": rows, "motion": composition_cost.run(), **circumstances()}


# --- the page ---

FIGURES = {
    "creation, CPU s": lambda row: row["creation_cpu_s"],
    "a simulated hour, CPU s": lambda row: row["hour_cpu_s"],
    "unknowns of flow": lambda row: row["unknowns"]["flow"],
    "unknowns of motion": lambda row: row["unknowns"]["motion"],
    "state, bytes a point": lambda row: row["state_bytes"] / row["points"],
    "process, MB": lambda row: row["process_bytes"] / 1e6,
    "fields": lambda row: len(row["fields"]),
}


def figure_line(row, full):
    for value_of in FIGURES.values():
        value, whole = value_of(row), value_of(full)
        yield number(value) + (f" ({number(value / whole)})" if row is not full and whole else "")


def page(result):
    done = [row for row in result["rows"] if not row["reason"]]
    lines = [INTRODUCTION, f"{text(result)}\n"]
    if done:
        lines += table(["variant", *FIGURES], [[row["variant"], *figure_line(row, result["rows"][0])] for row in done])
    lines += [f"- {row['variant']} leaves out: {'; '.join(row['left_out'])}." for row in done]
    lines += [f"- {row['variant']} was not run to the end: {row['reason']}" for row in result["rows"] if row["reason"]]
    return "\n".join([*lines, *motion_lines(result["motion"])]) + "\n"


# --- ground in motion ---

COMPOSITIONS = {"dry_elastic": "dry, elastic", "dry_mohr_coulomb": "dry, Mohr-Coulomb", "two_phase": "solid and water",
                "three_phase": "solid, water and air", "exchange": "the same, with exchange"}


def motion_lines(cost):
    """Nanoseconds of a point and substep by composition, and of a dry scene beside the loop that it needs."""
    yield "\n## In motion\n"
    yield ("Explicit motion, 16,384 points that collapse (`tests/bench throughput`), one thread: each composition is a loop of its own. The last row is"
           " the same dry column as a scene of the whole engine, beside the loop of dry ground alone in the same substeps.\n")
    known = {name: cost[key] for key, name in COMPOSITIONS.items()}
    full = list(known)[-1]
    lines = [[name, f"{value:.1f}", f"{value / known[full]:.2f}"] for name, value in known.items()]
    yield from table(["composition", "ns a point and substep", "of the last"], lines)
    ratio = cost["dry_scene"] / cost["dry_scene_alone"]
    yield from table(["", "ns a point and substep", "of the loop alone"],
                     [["loop of dry ground alone", f"{cost['dry_scene_alone']:.1f}", "1"],
                      ["dry scene of the whole engine", f"{cost['dry_scene']:.1f}", f"{ratio:.3f}"]])
