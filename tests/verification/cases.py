"""The verification cases by name. Each is a function that yields rows (see tests/verify)."""

import column
import slopes

CASES = {
    "column": lambda: column.rows("column"),
    "column_constant_k": lambda: column.rows("column_constant_k"),
    "slope_gentle": lambda: slopes.rows("slope_gentle"),
    "slope": lambda: slopes.rows("slope"),
}
