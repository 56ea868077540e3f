"""The quantities whose errors are tabled, and the fronts: runs that no cheaper run is as good as."""

import dataclasses

WATCHED = ("crest", "face", "beside_toe")  # of the displacement


SAME = 0.01  # errors that differ by this part of them are the same error
MILLIMETRES = ("mm", 1e3)


@dataclasses.dataclass(frozen=True)
class Quantity:
    """The largest of some errors of a row, in a unit for people."""

    name: str
    keys: tuple
    unit: str = "Pa"
    factor: float = 1.0
    targets: tuple = ()  # errors for which the cheapest setting is said; headlines have them

    def of(self, row):
        return self.factor * max(row["errors"][key] for key in self.keys)

    @property
    def heading(self):
        return f"{self.name}, {self.unit}" if self.unit else self.name


COLUMN = (
    Quantity("mean error of S", ("saturation",), "", targets=(3e-3, 1e-3, 3e-4, 1e-4, 3e-5)),
    Quantity("p off the front", ("pressure_off_front_Pa",), targets=(500, 200, 100, 50, 20)),
    Quantity("place of the front", ("front_m",), *MILLIMETRES),
)
SLOPE = (
    Quantity("p at 36 h, rms", ("rms_pressure_Pa",), targets=(1000, 500, 200, 100, 50)),
    Quantity("p at A, B, C", tuple(f"pressure_{place}_Pa" for place in "ABC"), targets=(4000, 2000, 1000, 350, 100)),
    Quantity("displacement", tuple(f"displacement_{place}_m" for place in WATCHED), *MILLIMETRES, targets=(2, 1, 0.5, 0.2, 0.1)),
    *(Quantity(f"p at {place}", (f"pressure_{place}_Pa",)) for place in "ABC"),
    *(Quantity(f"S at {place}", (f"saturation_{place}",), "") for place in "ABC"),
    *(Quantity(place.replace("_", " "), (f"displacement_{place}_m",), *MILLIMETRES) for place in (*WATCHED, "toe")),
)
# What must be no larger than the baseline's where run times are compared.
COMPARED = ("rms_pressure_Pa", *(f"pressure_{place}_Pa" for place in "ABC"), *(f"saturation_{place}" for place in "ABC"))


def quantities_of(case):
    return COLUMN if case.startswith("column") else SLOPE


def headlines_of(case):
    return [quantity for quantity in quantities_of(case) if quantity.targets]


def done_rows(result):
    """The rows that have errors, cheapest first."""
    return sorted((row for row in result["rows"] if not row["reason"]), key=lambda row: row["cpu_s"])


def front(rows, quantity):
    """Of rows by cost: those with a smaller error than every cheaper one, by more than SAME."""
    best, found = float("inf"), []
    for row in rows:
        if (1 + SAME) * quantity.of(row) < best:
            best = quantity.of(row)
            found.append(row)
    return found


def cheapest(rows, quantity, error):
    """The cheapest row with at most this error, or None."""
    return next((row for row in rows if quantity.of(row) <= error), None)


def coarsest_as_good(rows, baseline):
    """The row of the fewest nodes (then: the cheapest) whose errors are none of them larger than the baseline's, or None."""
    good = [row for row in rows if all(row["errors"][key] <= baseline["errors"][key] for key in COMPARED)]
    return min(good, key=lambda row: (row["nodes"], row["cpu_s"]), default=None)
