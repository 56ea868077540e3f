"""The verification cases by name. Each is a function that yields rows (see tests/verify)."""

import column
import mandel
import slopes
import srivastava_yeh
import terzaghi

CASES = {
    "column": lambda: column.rows("column"),
    "column_constant_k": lambda: column.rows("column_constant_k"),
    "terzaghi": terzaghi.rows,
    "mandel": mandel.rows,
    "srivastava_yeh": srivastava_yeh.rows,
    "slope_gentle": lambda: slopes.rows("slope_gentle"),
    "slope": lambda: slopes.rows("slope"),
}
