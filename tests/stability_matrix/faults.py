"""What is wrong with a row: a text a fault, and its kind."""

import re

from claims import DISPROVED
from settings import DEFAULT_TOLERANCE

BALANCE = 1e-8
MONOTONE = 1e-6
RANGE = 1e-12  # of saturation: rounding
GROWTH = 1.0  # of an increment from step to step
YIELD = 1e-6  # of the strength
ENERGY = 0.05  # of the largest kinetic and elastic energy: explicit waves in a few cells swing by as much


def kind(text):
    """A fault's or a refusal's text, numbers apart."""
    return re.sub(r"[-+]?\b\d[\d.]*(e[-+]?\d+)?", "#", text.splitlines()[0]) if text else ""


def of_refusal(case, row):
    """None where the row is not one of a run that ended short of its end."""
    reason = row["reason"] or ""
    if case.refusal:
        right = row["outcome"] == "refused" and case.refusal in reason
        return [] if right else [f"not refused for '{case.refusal}'"]
    if row["outcome"] == "refused" and DISPROVED not in reason and case.may_be_refused and case.may_be_refused in reason:
        return []
    if row["outcome"] != "finished" or reason:
        return [reason.splitlines()[0]]  # refused, crashed, hung; or refused with a tenth of the tolerance
    return None


def of_values(row):
    yield from (f"not finite: {name}" for name in row["not_finite"])
    if not row["balance"] <= BALANCE:
        yield f"water balance {row['balance']:.2g} of the water moved, {row['balance_stored']:.2g} of that stored"
    if not row["out_of_range"] <= RANGE:
        yield f"saturation out of its range by {row['out_of_range']:.2g}"
    if not row["yield_exceeded"] <= YIELD:
        yield f"yield exceeded by {row['yield_exceeded']:.2g} of the strength"


    if not (row["energy_gained"] or 0.0) <= ENERGY:
        yield f"energy gained, {row['energy_gained']:.2g} of the kinetic and elastic"


def of_the_case(case, row):
    """What the case itself expects."""
    if case.settles and not row["growth"] <= GROWTH:
        yield f"increments grow by {row['growth']:.3g} from step to step"
    if case.loses not in (None, row["equilibrium_lost"]):
        yield "equilibrium is " + ("lost" if row["equilibrium_lost"] else "not lost, beyond the limit load")
    if case.sweep != "random" and not (row.get("moved") or 0.0) <= DEFAULT_TOLERANCE:  # of the random search a share may
        yield f"moves by {row['moved']:.2g} of the range of saturation with a tenth of the tolerance"
    if case.monotone:
        yield from (f"{name} {row[name]:.2g}" for name in ("overshoot_saturation", "overshoot_pressure")
                    if not row[name] <= MONOTONE)


def faults(case, row):
    found = of_refusal(case, row)
    return [*of_values(row), *of_the_case(case, row)] if found is None else found
