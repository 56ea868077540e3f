"""Steps of the host and its clock."""

from case import DAY, HOUR, YEAR, Case
from scenes import column, small_slope

UNEVEN = [["step", seconds, 1] for seconds in (1e-6, YEAR, 1e-3, DAY, 1e-5, HOUR, 1.0, YEAR)]


def column_cases():
    yield Case("time/benign", column(), [["step", 60, 100]], monotone=True)
    yield Case("time/tiny_steps", column(), [["step", 1e-3, 1000]] * 10, monotone=True)
    yield Case("time/million_steps", column(), [["step", 1e-3, 10_000]] * 100, monotone=True, bound=300)
    yield Case("time/tiniest_steps", column(), [["step", 1e-6, 1000]], monotone=True)
    yield Case("time/year_at_once", column(), [["step", YEAR, 1]], monotone=True)
    yield Case("time/uneven", column(base=-1e4), UNEVEN)
    yield Case("time/drizzle_100_years", column(rain=1e-9, base=-1e4), [["step", YEAR, 100]])
    yield Case("time/late_clock", column(rain=1e-9, base=-1e4), [["step", 1e9, 1], ["rain", 1e-6], ["step", 1e-3, 100],
                                                                ["step", 60, 60]])
    yield Case("time/zero_step", column(), [["step", 60, 1], ["step", 0, 1]], refusal="must be positive",
               why="a step carries the run on; the state does not change")
    yield Case("time/zero_steps", column(), [["step", 60, 1], ["refused_step", 0, 1000], ["step", 60, 99]], monotone=True)


def slope_cases():
    """The same on coupled ground."""
    yield Case("slope_time/benign", small_slope(), [["step", HOUR, 12]])
    for seconds in (1e-6, 1e-3, 1.0, DAY, YEAR):
        yield Case(f"slope_time/{seconds:g}", small_slope(), [["step", seconds, 10]])
    yield Case("slope_time/uneven", small_slope(), UNEVEN)
    yield Case("slope_time/uneven_dry", small_slope(rain=0.0), UNEVEN)
    yield Case("slope_time/late_clock", small_slope(rain=0.0), [["step", 1e9, 1], ["rain", 1e-6], ["step", 1e-3, 20],
                                                               ["step", HOUR, 12]])
    yield Case("slope_time/late_clock_tiny", small_slope(rain=0.0), [["step", 1e9, 1], ["rain", 1e-6], ["step", 1e-6, 20]])


def cases():
    yield from column_cases()
    yield from slope_cases()
