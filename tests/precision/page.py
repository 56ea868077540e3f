"""docs/error_against_time.md from the rows of the sweep."""

from machine import text_with_build
from plot import file_of
from quantities import SAME, cheapest, coarsest_as_good, done_rows, front, headlines_of, quantities_of
from settings import EVEN_LENGTHS

REQUIRED_RATIO = 10.0

INTRODUCTION = """\
<!-- Written by tests/work_precision. Do not edit. -->
# Error against run time

`tests/work_precision` writes this page, its plots, and every row as JSON (`build/reports/work_precision.json`); `--case NAME`
runs one case and keeps the others' rows, `--quick` runs three resolutions. One thread, a process a run; the seconds are those of
the whole run with the engine's creation, the least of up to five where a run takes less than a second. What takes 120 s is
stopped. The FEM's seconds are those of its solve alone, without mesh and compilation.

*Cells* is the height of the uppermost cells; a setting changes all lengths of the scene's cells by one factor. *Even* cells grow
evenly with the depth (no `growth`) in place of the scene's; their lengths, {even} m times the factor for `columnWidth`,
`bendColumnWidth`, `surfaceCellHeight` and `largestCellHeight`, were chosen among 15 such sets by these very errors, so that a
single even row may owe something to luck: see its neighbours. *Tolerance* is `numerics.tolerance`. Errors are against the independent references in `tests/verification/reference`: of a column the largest
over 20, 80, 160 and 320 s, of a slope the largest of the hourly samples over 36 h, and *rms* over the raster of half a metre at
36 h. *Displacement* is the largest of crest, face and beside the toe; the toe itself is a singular point where every mesh has
its own value. Rows are sorted by CPU seconds. **Bold**: no cheaper run has so small an error, give or take {same:.0f} %; these
rows are the front of the quantity. *Explicit motion* is the column on material points that move by their momentum, two a cell, as in
`tests/verify --case column_explicit`: its steps are those of a wave through a cell, in water 20 times softer than it is.
"""


def number(value):
    return f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"


def setting_text(row):
    even = " even" if row["setting"]["even"] else ""
    return f"{row['setting']['resolution_m']:.3g} m{even}, {row['setting']['tolerance']:g}"


def table(heads, lines):
    yield "| " + " | ".join(heads) + " |"
    yield "|" + " --- |" * len(heads)
    for line in lines:
        yield "| " + " | ".join(line) + " |"
    yield ""


# --- the table of a case ---

def row_line(row, quantities, fronts):
    cells = [number(quantity.of(row)) for quantity in quantities]
    cells = [f"**{cell}**" if any(row is other for other in best) else cell for cell, best in zip(cells, fronts)]
    name = setting_text(row) + (" (the scene's)" if row["default"] else "")
    return [name, str(row["nodes"]), f"{row['wall_s']:.3g}", f"{row['cpu_s']:.3g}", *cells]


def beside_line(other, quantities):
    wall = "-" if other["recorded"] else f"{other['wall_s']:.3g}"
    return [other["name"], str(other["nodes"]), wall, f"{other['cpu_s']:.3g}", *(number(quantity.of(other)) for quantity in quantities)]


def rows_table(case, result, rows):
    quantities = quantities_of(case)
    fronts = [front(rows, quantity) for quantity in quantities]
    lines = [(row["cpu_s"], row_line(row, quantities, fronts)) for row in rows]
    beside = result["explicit"] + ([result["baseline"]] if result["baseline"] else [])
    lines += [(other["cpu_s"], beside_line(other, quantities)) for other in beside]
    heads = ["cells, tolerance", "nodes", "wall, s", "CPU, s", *(quantity.heading for quantity in quantities)]
    yield from table(heads, [line for _, line in sorted(lines, key=lambda entry: entry[0])])


# --- what follows from it ---

def choice_lines(case, rows):
    """Which setting for which error, down to the first error that none is as small as."""
    for quantity in headlines_of(case):
        for target in quantity.targets:
            row = cheapest(rows, quantity, target)
            found = [setting_text(row), f"{row['cpu_s']:.3g}"] if row else ["none of these", "-"]
            yield [f"{quantity.name} at most {target:g} {quantity.unit}".rstrip(), *found]
            if row is None:
                break


def default_lines(case, rows):
    """Whether the scene's own setting is on the fronts."""
    default = next((row for row in rows if row["default"]), None)
    if default is None:
        yield "- The scene's own setting has no errors to compare (see below)."
        return
    for quantity in headlines_of(case):
        better = cheapest(rows, quantity, (1 + SAME) * quantity.of(default))
        own = f"- {quantity.name}: the scene's own setting ({setting_text(default)}) is"
        if better is default:
            yield f"{own} on the front."
        else:
            yield (f"{own} **not on the front**: {setting_text(better)} has {number(quantity.of(better))} against "
                   f"{number(quantity.of(default))} {quantity.unit}".rstrip()
                   + f" in {default['cpu_s'] / better['cpu_s']:.1f} times less CPU.")


def ratio_line(rows, baseline):
    """CPU against the baseline's at no larger error."""
    what = "no error larger than the baseline's (p rms, p and S at A, B, C)"
    kind = "recorded on another occasion, so the ratio is a rough one" if baseline["recorded"] else "run beside"
    row = coarsest_as_good(rows, baseline)
    if row is None:
        return f"**CPU ratio to the 1222-quad FEM: not met.** No setting has {what}; required: {REQUIRED_RATIO:g}."
    ratio = baseline["cpu_s"] / row["cpu_s"]
    verdict = "met" if ratio >= REQUIRED_RATIO else "**not met**"
    return (f"CPU ratio to the 1222-quad FEM ({kind}): **{ratio:.2g}**, required {REQUIRED_RATIO:g}: {verdict}. "
            f"{setting_text(row)} ({row['nodes']} nodes) is the coarsest with {what}: "
            f"{row['cpu_s']:.3g} against {baseline['cpu_s']:.3g} s.")


def failure_lines(result):
    for row in result["rows"]:
        if row["reason"]:
            first_line = row["reason"].splitlines()[0].replace("|", "\\|")
            yield [setting_text(row) + (" (the scene's)" if row["default"] else ""), first_line]


def case_lines(case, result):
    rows = done_rows(result)
    yield f"## {case}"
    yield f"{text_with_build(result)}\n"
    if rows:
        yield f"![error against run time]({file_of(case)})\n"
    if rows or result["baseline"]:
        yield from rows_table(case, result, rows)
    if result["baseline"]:
        yield ratio_line(rows, result["baseline"]) + "\n"
    if rows:
        yield from default_lines(case, rows)
        yield ""
        yield from table(["wanted", "cheapest setting", "CPU, s"], choice_lines(case, rows))
    failures = list(failure_lines(result))
    if failures:
        yield "Not run to the end:\n"
        yield from table(["cells, tolerance", "reason"], failures)


def write(cases, folder):
    lines = [INTRODUCTION.format(same=100 * SAME, even=", ".join(map(str, EVEN_LENGTHS)))]
    for case, result in cases.items():
        lines += case_lines(case, result)
    (folder / "error_against_time.md").write_text("\n".join(lines).rstrip() + "\n", encoding="utf-8")
