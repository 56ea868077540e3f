"""The random search over processes, and what holds of it as a whole."""

from concurrent.futures import ProcessPoolExecutor

import run
from random_cases import random_case
from settings import DEFAULT_TOLERANCE

MOVED_SHARE = 0.99  # that a tenth of the tolerance may move by no more than the tolerance
REFUSED_SHARE = 0.01


def run_number(number):
    return run.run(random_case(number))


def rows(numbers, jobs):
    """One after the other in the numbers' order, some at once: no price is taken of them."""
    with ProcessPoolExecutor(jobs) as pool:
        yield from pool.map(run_number, numbers)


def shares(found):
    """Rows of the search as a whole, none without a search."""
    search = [row for row in found if row["sweep"] == "random"]
    if len(search) > 1:
        yield moved_row([row["moved"] for row in search if row.get("moved") is not None])
        yield refused_row(search)


def moved_row(moved):
    share = sum(value <= DEFAULT_TOLERANCE for value in moved) / max(len(moved), 1)
    text = f"{100 * share:.1f} % of {len(moved)} move by no more than the tolerance; the most {max(moved, default=0):.2g}"
    return share_row("tightened", text, share >= MOVED_SHARE)


def refused_row(search):
    share = sum(row["outcome"] == "refused" for row in search) / len(search)
    return share_row("refused", f"{100 * share:.2f} % of {len(search)} are refused", share <= REFUSED_SHARE)


def share_row(name, text, is_met):
    return {"case": f"share/{name}", "sweep": "share", "place": (), "monotone": False, "why": text, **run.EMPTY,
            "outcome": "finished", "price": None, "faults": [] if is_met else [text], "reason": text, "passed": is_met}
