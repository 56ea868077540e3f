"""Delta debugging: the least scene and steps that still fail in the same way.

The scene and its steps are one tree of lists, dicts, numbers and texts. A change is kept where the same kind of fault stays: one
that makes the scene invalid is another kind, so that the changes need to know little of what a scene may say.
"""

import copy
import json
import math
import re
import time
from dataclasses import replace

from faults import kind
from settings import SECTION_LENGTHS, set_resolution

MOST_SECONDS = 600
HUNG_AFTER = 5.0  # s: what takes longer counts as hung while it is shrunk


def kinds(row):
    return {kind(text) for text in row["faults"] or [row["reason"] or ""]} - {""}


def paths(tree, path=()):
    """Of everything in it, the outer before what they hold."""
    entries = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    for name, entry in entries:
        yield (*path, name)
        yield from paths(entry, (*path, name))


def holder(tree, path):
    """The list or dict that holds the last name of the path; None where a change before has taken it away."""
    try:
        for name in path[:-1]:
            tree = tree[name]
        tree[path[-1]]
    except (KeyError, IndexError, TypeError):
        return None
    return tree


# --- the changes: each takes the tree and yields smaller ones of its kind at a path ---

def without(tree, path):
    if len(path) > 1 and (path[0] == "scene" or len(path) == 2):  # of the steps whole ones only
        changed = copy.deepcopy(tree)
        del holder(changed, path)[path[-1]]
        yield changed


def only_layer(tree, path):
    """One of the layers, from the surface to the base."""
    if path[-2:-1] == ("layers",):
        changed = copy.deepcopy(tree)
        layers = holder(changed, path[:-1])
        layer = holder(changed, path)[path[-1]]
        layers["layers"] = [{name: value for name, value in layer.items() if name != "top"}]
        yield changed


def coarser(tree, path):
    if path == ("scene", "ground"):
        changed = copy.deepcopy(tree)
        try:
            set_resolution(changed["scene"], 2)
        except (KeyError, ZeroDivisionError):  # a mesh, or a single cell
            return
        yield changed


def simpler_numbers(value):
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return
    if isinstance(value, int):
        yield from (number for number in (1, 2, value // 2) if 0 < number < value)
        return
    power = 10.0 ** math.floor(math.log10(abs(value))) if value and math.isfinite(value) else 1.0
    for number in (0.0, 1.0, math.copysign(power, value), float(f"{value:.1g}"), float(f"{value:.2g}")):
        if len(f"{number:g}") < len(f"{value:.15g}"):
            yield number


def simpler(tree, path):
    value = holder(tree, path)[path[-1]]
    for number in simpler_numbers(value):
        if path[-1] in SECTION_LENGTHS and number < value:
            continue  # more cells are not simpler
        changed = copy.deepcopy(tree)
        holder(changed, path)[path[-1]] = number
        yield changed


CHANGES = (only_layer, without, coarser, simpler)


def passes(tree, fails):
    """One round of all changes at all places: the tree with those that keep the failure."""
    for change in CHANGES:
        for path in list(paths(tree)):
            candidates = change(tree, path) if holder(tree, path) is not None else ()
            tree = next((candidate for candidate in candidates if fails(candidate)), tree)
    return tree


def shrink(tree, fails, seconds=MOST_SECONDS):
    """The least tree that still `fails`, or what is reached by then."""
    end = time.monotonic() + seconds
    def fails_in_time(candidate):
        return time.monotonic() < end and fails(candidate)
    smaller = passes(tree, fails_in_time)
    while smaller != tree:
        tree, smaller = smaller, passes(smaller, fails_in_time)
    return tree


def shrunk(case, run_case):
    """(its kinds of fault, its case of the least scene); `run_case` gives a case's row."""
    case = replace(case, bound=min(case.bound, HUNG_AFTER))
    wanted = kinds(run_case(case))
    def fails(tree):
        return bool(wanted & kinds(run_case(replace(case, **tree))))
    tree = {"scene": case.scene, "steps": case.steps}
    return wanted, replace(case, **(shrink(tree, fails) if wanted else tree))


def text(case):
    """As JSON; lists of numbers in a line."""
    spread = json.dumps({"scene": case.scene, "steps": case.steps}, indent=1)
    return re.sub(r"\[[^][{}]*\]", lambda found: re.sub(r"\s+", " ", found[0]), spread)
