"""Error against wall and CPU seconds, log-log: a row of axes a headline quantity, a line a tolerance and kind of cells."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
from quantities import done_rows, front, headlines_of

COSTS = (("wall_s", "wall seconds"), ("cpu_s", "CPU seconds"))


def file_of(case):
    return f"error_against_time_{case}.png"


def draw_tolerances(axes, rows, cost, quantity):
    for even, tolerance in sorted({(row["setting"]["even"], row["setting"]["tolerance"]) for row in rows}, reverse=True):
        line = sorted((row for row in rows if (row["setting"]["even"], row["setting"]["tolerance"]) == (even, tolerance)),
                      key=lambda row: row["nodes"])
        axes.loglog([row[cost] for row in line], [quantity.of(row) for row in line], "^--" if even else "o-", markersize=4,
                    linewidth=0.8, label=f"tolerance {tolerance:g}" + (", even cells" if even else ""))


def draw_marks(axes, rows, result, cost, quantity):
    best = front(rows, quantity)
    axes.loglog([row[cost] for row in best], [quantity.of(row) for row in best], "k-", linewidth=3, alpha=0.15, label="front")
    for row in (row for row in rows if row["default"]):
        axes.plot(row[cost], quantity.of(row), "ks", markersize=10, fillstyle="none", label="the scene's setting")
    explicit, baseline = result["explicit"], result["baseline"]
    if explicit:
        axes.plot([run[cost] for run in explicit], [quantity.of(run) for run in explicit], "rv-", markersize=5, linewidth=0.8,
                  label="explicit motion")
    if baseline and not (baseline["recorded"] and cost == "wall_s"):  # the recorded wall seconds are those of a busy machine
        axes.plot(baseline[cost], quantity.of(baseline), "rx", markersize=9, markeredgewidth=2, label=baseline["name"])


def label_ticks(axis):
    """Decades, or 1, 2 and 5 of each where there are few of them."""
    low, high = axis.get_view_interval()
    axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high < 300 * low else (1,)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def draw(case, result, folder):
    rows, headlines = done_rows(result), headlines_of(case)
    if not rows:
        return
    figure, grid = plt.subplots(len(headlines), 2, figsize=(9, 2.8 * len(headlines)), sharex="col", layout="constrained")
    for quantity, line in zip(headlines, grid):
        for (cost, _), axes in zip(COSTS, line):
            draw_tolerances(axes, rows, cost, quantity)
            draw_marks(axes, rows, result, cost, quantity)
            axes.grid(True, alpha=0.25)
            label_ticks(axes.xaxis)
            label_ticks(axes.yaxis)
        line[0].set_ylabel(f"error, {quantity.heading}")
    for (_, label), axes in zip(COSTS, grid[-1]):
        axes.set_xlabel(label)
    grid[0, 1].legend(fontsize=7)
    figure.suptitle(case)
    figure.savefig(folder / file_of(case), dpi=100, metadata={"Software": None})
    plt.close(figure)
