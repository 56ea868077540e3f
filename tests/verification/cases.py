"""The verification cases by name. Each is a function that yields rows (see tests/verify)."""

import functools

import column
import dynamic_slides
import engine_cases
import explicit_exchange
import explicit_motion
import mandel
import run_out
import slopes
import srivastava_yeh
import terzaghi

CASES = {
    "column": lambda: column.rows("column"),
    "column_constant_k": lambda: column.rows("column_constant_k"),
    "terzaghi": terzaghi.rows,
    "mandel": mandel.rows,
    "srivastava_yeh": srivastava_yeh.rows,
    **{name: functools.partial(engine_cases.rows, name)
       for name in ("footing_q4", "footing_t3", "patch", "order", "elastic_bar", "rotation")},
    "saturated_wave": explicit_motion.saturated_wave_rows,
    "wave_speeds": explicit_motion.wave_rows,
    "gas_diffusion": explicit_motion.diffusion_rows,
    "exchange_box": explicit_exchange.box_rows,
    "vapour_diffusion": explicit_exchange.vapour_rows,
    "column_explicit": explicit_motion.column_rows,
    "column_three_phase": explicit_motion.three_phase_column_rows,
    "column_collapse": dynamic_slides.collapse_rows,
    "cohesive_slope": dynamic_slides.slope_rows,
    "slope_gentle": lambda: slopes.rows("slope_gentle"),
    "slope": lambda: slopes.rows("slope"),
    "slope_triangles": slopes.triangles_rows,
    "slope_failure": slopes.failure_rows,
    "slope_run_out": run_out.rows,
}
