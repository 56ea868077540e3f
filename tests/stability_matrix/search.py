"""The random search over processes, and what holds of it as a whole."""

from concurrent.futures import ProcessPoolExecutor

import run
from random_cases import moving_case, random_case
from settings import DEFAULT_TOLERANCE

MOVED_SHARE = 0.99  # that a tenth of the tolerance may move by no more than the tolerance
REFUSED_SHARE = 0.01


MOVING = 5  # of so many scenes one moves by its momentum


def case_of(index):
    return moving_case(index // MOVING) if index % MOVING == MOVING - 1 else random_case(index - index // MOVING)


def run_index(index):
    return run.run(case_of(index))


def rows(count, jobs):
    """One after the other, some at once: no price is taken of them."""
    with ProcessPoolExecutor(jobs) as pool:
        yield from pool.map(run_index, range(count))


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
