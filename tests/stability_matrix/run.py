"""Runs a case in a process of its own and says how it ended: finished, refused, crashed or hung; and whether that is right."""

import time

import numpy
import talus
from check import Watch, balances, energy_gained, has_lost_equilibrium
from claims import tested
from faults import faults
from isolated import in_a_process
from settings import DEFAULT_TOLERANCE
from settling import Settling

EMPTY = {"reason": None, "balance": None, "balance_stored": None, "substeps": None, "failures": None, "wall_s": None}


def is_refused(engine, seconds):
    """Whether the step is refused and the state stands, bit for bit."""
    before = engine.hash()
    try:
        engine.step(seconds)
    except talus.Error:
        return engine.hash() == before
    return False


def act(engine, action, *arguments):
    """One entry of a case's steps; returns the reports of it."""
    if action == "step":
        return [engine.step(arguments[0]) for _ in range(arguments[1])]
    if action == "refused_step":
        if not all(is_refused(engine, arguments[0]) for _ in range(arguments[1])):
            raise AssertionError(f"a step of {arguments[0]:g} s was done, or changed the state")
    elif action == "rain":
        engine.set_rain("rain", *arguments)
    else:
        engine.push_flow_value(arguments[0], engine.time, arguments[1])
    return []


def march(case, engine, watch):
    """Substeps, failures and water balances, with the wall seconds of the engine alone."""
    reports, wall, settling = [], 0.0, Settling(engine) if case.settles else None
    for action in case.steps:
        begun = time.perf_counter()
        reports += act(engine, *action)
        wall += time.perf_counter() - begun
        watch.look()
        if settling:
            settling.look()
    return {"substeps": sum(report["flow_substeps"] + report["motion_substeps"] for report in reports),
            "failures": sum(report["flow_failures"] for report in reports),
            **balances(reports or [engine.report()]), "energy_gained": energy_gained(reports or [engine.report()]), "wall_s": wall,
            "equilibrium_lost": has_lost_equilibrium(engine), "growth": settling and settling.growth()}


def simulate(case, tolerance=None):
    """The row's figures and the saturation at the end (nothing where refused)."""
    try:
        engine = talus.Engine(talus.Scene.from_json(case.scene), tolerance=tolerance)
        watch = Watch(engine, case.scene)
        watch.look()
        figures = march(case, engine, watch)
    except talus.Error as error:
        return {"outcome": "refused", "reason": tested(case.scene, f"{type(error).__name__}: {error}")}, None
    return {"outcome": "finished", **figures, **watch.seen}, watch.effective_saturation()


def figures_of(case):
    figures, saturation = simulate(case)
    if case.tightened and saturation is not None:
        tight, other = simulate(case, DEFAULT_TOLERANCE / 10)
        figures["moved"] = None if other is None else float(numpy.max(numpy.abs(saturation - other)))
        figures["reason"] = tight.get("reason") and f"with a tenth of the tolerance: {tight['reason']}"
    return figures


def isolated(case):
    """The figures from a process that may crash or hang."""
    outcome, result = in_a_process(case.bound, figures_of, case)
    return result if outcome == "finished" else {"outcome": outcome, "reason": result}


def run(case):
    row = {"case": case.name, "sweep": case.sweep, "place": case.place, "monotone": case.monotone, "why": case.why,
           **EMPTY, **isolated(case)}
    row["faults"] = faults(case, row)
    row["passed"] = not row["faults"]
    return row


def price(rows):
    """Wall seconds over those of the sweep's first case, the benign one."""
    benign = {}
    for row in rows:
        base = benign.setdefault(row["sweep"], row["wall_s"])
        row["price"] = row["wall_s"] / base if row["wall_s"] and base and row["sweep"] not in ("random", "found") else None
