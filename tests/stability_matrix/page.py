"""docs/stability.md and its maps from the rows."""

import statistics
from collections import Counter

import flow_cases
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from cases import SWEEPS
from faults import kind
from machine import circumstances, text_with_build
from matplotlib.colors import LogNorm

MOST_RANDOM = 20  # failures of the random search in the table

INTRODUCTION = """\
<!-- Written by tests/stability. Do not edit. -->
# Numerical stability on stiff and extreme cases

`tests/stability` writes this page, its maps, and every row as JSON. Each case is a scene with a host's steps, run in a process
of its own under a wall bound. It passes when it finishes with a water balance within 1e-8 of the water moved until then (which
counts at least a millionth of the water stored, in motion a ten-thousandth), no NaN or infinity in any view, saturation within its soil's range (in motion, to 1e-6), no peak
above 1e-6 inside the profile where physics has none, and no stress beyond the strength by more than 1e-6 of it (until equilibrium
is lost, after which the skeleton stands as it was), no energy gained by dry ground in motion beyond 5 % of the largest kinetic and elastic
energy; or when it is refused and a refusal is right. A refusal because the ground does
not stand is wrong where it stands with one Young's modulus. *Overshoot* is that of
saturation and of pressure, each per unit of its range; a dash where physics allows peaks. *Price* is the wall time over that of
the sweep's first case, the benign one; a run of a millisecond has it to some 2 times only. Cases `found` and `random` run again
with a tenth of the tolerance (but `found/9692`, which loses its equilibrium sooner or later by round-off). On the maps a cross is a case that failed.

Cases `split` load a column at once and then wait: increments of displacement and pressure from step to step, the largest over the
column, must not grow. An increment counts at least what the tolerance lets stand: 1e-3 of the largest displacement, and of the
weight of the column's height of water.

Cases `limit_*` and `suction_lost` are loaded to 0.98 and 1.02 of what they bear, in closed form but for `limit_slope`:
equilibrium must be lost beyond it and only there. Cases `dynamic*` move by their momentum; their substeps are the engine's own, so that none
is too long; those of `dynamic_gas` have gas that moves (that it may be squeezed to a hundredth is shown by a unit test), those of `dynamic_exchange`
the same that takes up vapour, under dry air, and air that dissolves. Cases `auto*` stand in the rain until they fail, move, rest and settle, once or again and again.
"""


def number(value):
    return "-" if value is None else f"{value:.2g}"


def line(row):
    over = [number(row.get(name) if row["monotone"] else None) for name in ("overshoot_saturation", "overshoot_pressure")]
    verdict = "passed" if row["passed"] else "**failed**: " + "; ".join(row["faults"])
    remark = f" ({row['why']})" if row["why"] else ""
    cells = [row["case"], row["outcome"], number(row["balance"]), *over, str(row["substeps"] or "-"), str(row["failures"]),
             number(row["wall_s"]), number(row["price"]), (verdict + remark).replace("|", "\\|")]
    return "| " + " | ".join(cells) + " |"


def summary(rows):
    outcomes = {name: sum(row["outcome"] == name for row in rows) for name in ("finished", "refused", "crashed", "hung")}
    yield ", ".join(f"{count} {name}" for name, count in outcomes.items()) + (
        f"; {sum(row['passed'] for row in rows)} passed, {sum(not row['passed'] for row in rows)} failed.\n")
    names = {sweep.name for sweep in flow_cases.SWEEPS}
    prices = [row["price"] for row in rows if row["price"] and row["sweep"] in names]
    if prices:
        median, worst = statistics.median(prices), max(prices)
        yield f"Price over the sweeps of flow: median {median:.2g} (bound 5), worst {worst:.2g} (bound 100).\n"


def by_kind(texts, scenes):
    found = Counter(map(kind, texts))
    yield from (f"- {count} times ({100 * count / scenes:.2g} %): {text}" for text, count in found.most_common())
    yield ""


def kinds(rows):
    """How many of the random search were refused and failed for which reason, numbers apart."""
    refused = [row["reason"] for row in rows if row["outcome"] == "refused"]
    yield f"{len(rows)} scenes. {len(refused)} were refused:\n"
    yield from by_kind(refused, len(rows))
    failed = sum(not row["passed"] for row in rows)
    yield f"{failed} failed; by kind, then the first {MOST_RANDOM} of them:\n" if failed else "None failed.\n"
    yield from by_kind([fault for row in rows for fault in row["faults"]], len(rows))


def file_of(sweep):
    return f"stability_{sweep.name}.png"


def draw(sweep, rows, folder):
    """The price at each pair of values, on even spacing."""
    axes_values = [sorted(values) for values in sweep.values]
    columns, lines = ([values.index(row["place"][axis]) for row in rows] for axis, values in enumerate(axes_values))
    figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
    marks = axes.scatter(columns, lines, c=[row["price"] or 1 for row in rows], s=500, marker="s",
                         norm=LogNorm(0.1, 100), cmap="viridis")
    bad = [index for index, row in enumerate(rows) if not row["passed"]]
    axes.plot([columns[index] for index in bad], [lines[index] for index in bad], "rx", markersize=14, markeredgewidth=3)
    axes.set_xticks(range(len(axes_values[0])), [f"{value:g}" for value in axes_values[0]])
    axes.set_yticks(range(len(axes_values[1])), [f"{value:g}" for value in axes_values[1]])
    axes.set(xlabel=sweep.labels[0], ylabel=sweep.labels[1], title=sweep.name)
    axes.margins(0.15)
    figure.colorbar(marks, label="price, times the benign case")
    figure.savefig(folder / file_of(sweep), dpi=100, metadata={"Software": None})
    plt.close(figure)


def sections(rows, folder):
    sweeps = {sweep.name: sweep for sweep in SWEEPS}
    for name in dict.fromkeys(row["sweep"] for row in rows):
        part = [row for row in rows if row["sweep"] == name]
        yield f"## {name}"
        if name in sweeps and len(part) > 1:
            draw(sweeps[name], part, folder)
            yield f"![price]({file_of(sweeps[name])})\n"
        if part[0].get("growth") is not None:
            yield f"From step to step increments grow by {max(row.get('growth') or 0 for row in part):.3g} at most (bound 1).\n"
        if name == "random":
            yield from kinds(part)
            part = [row for row in part if not row["passed"]][:MOST_RANDOM]
            if not part:
                continue
        yield "| case | outcome | balance | overshoot S | overshoot p | substeps | failures | wall, s | price | verdict |"
        yield "|" + " --- |" * 10
        yield from map(line, part)
        yield ""


def write(rows, folder):
    folder.mkdir(parents=True, exist_ok=True)
    lines = [INTRODUCTION, text_with_build(circumstances()) + "\n", *summary(rows), *sections(rows, folder)]
    (folder / "stability.md").write_text("\n".join(lines).rstrip() + "\n", encoding="utf-8")
