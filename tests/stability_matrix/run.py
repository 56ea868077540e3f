"""Runs a case in a process of its own and says how it ended: finished, refused, crashed or hung; and whether that is right."""

import time

import numpy
import talus
from check import Watch, balances, has_lost_equilibrium
from isolated import in_a_process
from settings import DEFAULT_TOLERANCE
from settling import Settling

BALANCE = 1e-8
MONOTONE = 1e-6
RANGE = 1e-12  # of saturation: rounding
GROWTH = 1.0  # of an increment from step to step
YIELD = 1e-6  # of the strength
MOVED_SHARE = 0.99  # of the random search that may move by no more than the tolerance
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
    return {"substeps": sum(report["flow_substeps"] for report in reports),
            "failures": sum(report["flow_failures"] for report in reports),
            **balances(reports), "wall_s": wall,
            "equilibrium_lost": has_lost_equilibrium(engine), "growth": settling and settling.growth()}


def simulate(case, tolerance=None):
    """The row's figures and the saturation at the end (nothing where refused)."""
    try:
        engine = talus.Engine(talus.Scene.from_json(case.scene), tolerance=tolerance)
        watch = Watch(engine, case.scene)
        watch.look()
        figures = march(case, engine, watch)
    except talus.Error as error:
        return {"outcome": "refused", "reason": f"{type(error).__name__}: {error}"}, None
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


def faults(case, row):
    """What is wrong with the row, one text a fault."""
    if case.refusal:
        right = row["outcome"] == "refused" and case.refusal in row["reason"]
        return [] if right else [f"not refused for '{case.refusal}'"]
    if row["outcome"] != "finished" or row["reason"]:
        return [row["reason"].splitlines()[0]]  # refused, crashed, hung; or refused with a tenth of the tolerance
    found = [f"not finite: {name}" for name in row["not_finite"]]
    if not row["balance"] <= BALANCE:
        found.append(f"water balance {row['balance']:.2g} of the water moved, {row['balance_stored']:.2g} of that stored")
    if not row["out_of_range"] <= RANGE:
        found.append(f"saturation out of its range by {row['out_of_range']:.2g}")
    if not row["yield_exceeded"] <= YIELD:
        found.append(f"yield exceeded by {row['yield_exceeded']:.2g} of the strength")
    if case.settles and not row["growth"] <= GROWTH:
        found.append(f"increments grow by {row['growth']:.3g} from step to step")
    if case.loses not in (None, row["equilibrium_lost"]):
        found.append("equilibrium is " + ("lost" if row["equilibrium_lost"] else "not lost, beyond the limit load"))
    if case.sweep != "random" and (row.get("moved") or 0.0) > DEFAULT_TOLERANCE:  # of the random search a share may
        found.append(f"moves by {row['moved']:.2g} of the range of saturation with a tenth of the tolerance")
    if case.monotone:
        found += [f"{name} {row[name]:.2g}" for name in ("overshoot_saturation", "overshoot_pressure")
                  if not row[name] <= MONOTONE]
    return found


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


def moved_row(rows):
    """The random search's share that a tenth of the tolerance moves by no more than the tolerance; None without a search."""
    moved = [row["moved"] for row in rows if row["sweep"] == "random" and row.get("moved") is not None]
    if not moved:
        return None
    share = sum(value <= DEFAULT_TOLERANCE for value in moved) / len(moved)
    text = f"{100 * share:.1f} % of {len(moved)} move by no more than the tolerance; the most {max(moved):.2g}"
    return {"case": "tolerance/tightened", "sweep": "tolerance", "place": (), "monotone": False, "why": "", **EMPTY,
            "outcome": "finished", "price": None, "faults": [] if share >= MOVED_SHARE else [text], "reason": text,
            "passed": share >= MOVED_SHARE}
