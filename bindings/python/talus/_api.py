"""Constants, structs and functions of talus.h. Derived by capi/derive.py; do not edit."""
from ctypes import (CFUNCTYPE, POINTER, Structure, c_char_p, c_double, c_int32, c_int64, c_void_p)

VERSION_MAJOR = 0
VERSION_MINOR = 1
VERSION_PATCH = 0
ABI = 0
OK = 0
CANCELLED = 1
OUT_OF_RAIN = 2
OUTSIDE = 3
ENDED_EARLY = 4
INVALID_HANDLE = -1
INVALID_ARGUMENT = -2
INVALID_SCENE = -3
UNKNOWN_NAME = -4
NOT_CONVERGED = -5
OUT_OF_MEMORY = -6
INPUT_OUTPUT = -7
INTERNAL = -8
BUSY = -9
FLOAT64 = 0
INT32 = 1
NODE = 0
POINT = 1
CELL = 2
MESH = 3
QUASI_STATIC = 0
EQUILIBRIUM_LOST = 1
DYNAMIC = 2
AT_REST = 3
SATURATED = 1
PONDING_STARTED = 2
PONDING_ENDED = 3
SEEPAGE_STARTED = 4
LOSS_OF_EQUILIBRIUM = 5
RAIN_ENDED = 6
MOTION_STARTED = 7
CAME_TO_REST = 8
SETTLED = 9
LEFT_BACKGROUND = 10
RAIN_REJECT = 0
RAIN_HOLD = 1
RAIN_ZERO = 2
LOG_INFORMATION = 1
LOG_WARNING = 2

talus_log_callback = CFUNCTYPE(None, c_void_p, c_int32, c_char_p)
talus_progress_callback = CFUNCTYPE(c_int32, c_void_p, c_double)


class talus_options(Structure):
    _fields_ = [
        ("struct_size", c_int32),
        ("rain_policy", c_int32),
        ("tolerance", c_double),
        ("log", talus_log_callback),
        ("log_user", c_void_p),
        ("progress", talus_progress_callback),
        ("progress_user", c_void_p),
        ("threads", c_int32),
        ("stop_at_motion", c_int32),
    ]


class talus_array(Structure):
    _fields_ = [
        ("struct_size", c_int32),
        ("type", c_int32),
        ("entry", c_char_p),
        ("data", c_void_p),
        ("count", c_int64),
    ]


class talus_field(Structure):
    _fields_ = [
        ("struct_size", c_int32),
        ("type", c_int32),
        ("location", c_int32),
        ("rank", c_int32),
        ("shape", c_int64 * 4),
        ("strides", c_int64 * 4),
        ("data", c_void_p),
        ("name", c_char_p),
        ("units", c_char_p),
        ("standard_name", c_char_p),
        ("epoch", c_int64),
    ]


class talus_step_report(Structure):
    _fields_ = [
        ("struct_size", c_int32),
        ("regime", c_int32),
        ("time", c_double),
        ("flow_substeps", c_int64),
        ("flow_failures", c_int64),
        ("flow_iterations", c_int64),
        ("coupling_steps", c_int64),
        ("coupling_iterations", c_int64),
        ("motion_iterations", c_int64),
        ("rain_substitutions", c_int64),
        ("water_rain", c_double),
        ("water_infiltrated", c_double),
        ("water_run_off", c_double),
        ("water_seepage", c_double),
        ("water_inflow", c_double),
        ("water_drained", c_double),
        ("water_stored", c_double),
        ("water_initial", c_double),
        ("water_residual", c_double),
        ("largest_displacement", c_double),
        ("largest_velocity", c_double),
        ("least_factor_of_safety", c_double),
        ("seconds_flow", c_double),
        ("seconds_motion", c_double),
        ("seconds_total", c_double),
        ("motion_substeps", c_int64),
        ("kinetic_energy", c_double),
        ("elastic_energy", c_double),
        ("potential_energy", c_double),
        ("dissipated_energy", c_double),
        ("peak_velocity", c_double),
        ("sliding_volume", c_double),
        ("front_x", c_double),
        ("run_out", c_double),
    ]


class talus_event(Structure):
    _fields_ = [
        ("struct_size", c_int32),
        ("kind", c_int32),
        ("time", c_double),
        ("x", c_double),
        ("y", c_double),
        ("value", c_double),
        ("message", c_char_p),
    ]


class talus_history(Structure):
    _fields_ = [
        ("struct_size", c_int32),
        ("reserved", c_int32),
        ("count", c_int64),
        ("time", POINTER(c_double)),
        ("value", POINTER(c_double)),
        ("epoch", c_int64),
    ]


class talus_raster(Structure):
    _fields_ = [
        ("struct_size", c_int32),
        ("columns", c_int32),
        ("rows", c_int32),
        ("reserved", c_int32),
        ("x", c_double),
        ("y", c_double),
        ("dx", c_double),
        ("dy", c_double),
    ]


# name: (result, [arguments])
FUNCTIONS = {
    "talus_version": (c_char_p, []),
    "talus_abi": (c_int32, []),
    "talus_build_info": (c_char_p, []),
    "talus_status_name": (c_char_p, [c_int32]),
    "talus_last_error": (c_char_p, []),
    "talus_scene_from_json": (c_int32, [c_char_p, c_int64, POINTER(c_void_p)]),
    "talus_scene_from_bytes": (c_int32, [c_void_p, c_int64, POINTER(c_void_p)]),
    "talus_scene_from_file": (c_int32, [c_char_p, POINTER(c_void_p)]),
    "talus_scene_from_json_with_arrays": (c_int32, [c_char_p, c_int64, c_int32, POINTER(talus_array), POINTER(c_void_p)]),
    "talus_scene_retain": (c_int32, [c_void_p]),
    "talus_scene_release": (c_int32, [c_void_p]),
    "talus_engine_create": (c_int32, [c_void_p, POINTER(talus_options), POINTER(c_void_p)]),
    "talus_engine_destroy": (None, [c_void_p]),
    "talus_engine_error": (c_char_p, [c_void_p]),
    "talus_engine_describe": (c_int32, [c_void_p, POINTER(c_char_p)]),
    "talus_engine_zone": (c_int32, [c_void_p, c_char_p, POINTER(c_int32)]),
    "talus_engine_push_rain": (c_int32, [c_void_p, c_int32, c_int64, POINTER(c_double), POINTER(c_double)]),
    "talus_engine_set_rain": (c_int32, [c_void_p, c_int32, c_double]),
    "talus_engine_boundary": (c_int32, [c_void_p, c_char_p, POINTER(c_int32)]),
    "talus_engine_push_flow_value": (c_int32, [c_void_p, c_int32, c_int64, POINTER(c_double), POINTER(c_double)]),
    "talus_engine_push_motion_value": (c_int32, [c_void_p, c_int32, c_int32, c_int64, POINTER(c_double), POINTER(c_double)]),
    "talus_engine_step": (c_int32, [c_void_p, c_double, POINTER(talus_step_report)]),
    "talus_engine_advance_to": (c_int32, [c_void_p, c_double, POINTER(talus_step_report)]),
    "talus_engine_cancel": (None, [c_void_p]),
    "talus_engine_time": (c_double, [c_void_p]),
    "talus_engine_epoch": (c_int64, [c_void_p]),
    "talus_engine_report": (c_int32, [c_void_p, POINTER(talus_step_report)]),
    "talus_engine_field_count": (c_int32, [c_void_p, POINTER(c_int32)]),
    "talus_engine_field_name": (c_int32, [c_void_p, c_int32, POINTER(c_char_p)]),
    "talus_engine_view": (c_int32, [c_void_p, c_char_p, POINTER(talus_field)]),
    "talus_engine_read": (c_int32, [c_void_p, c_char_p, c_int64, POINTER(c_double)]),
    "talus_engine_sample": (c_int32, [c_void_p, c_char_p, c_int64, POINTER(c_double), POINTER(c_double)]),
    "talus_engine_sample_raster": (c_int32, [c_void_p, c_char_p, POINTER(talus_raster), c_int64, POINTER(c_double)]),
    "talus_engine_probe": (c_int32, [c_void_p, c_char_p, POINTER(c_int32)]),
    "talus_engine_add_probe": (c_int32, [c_void_p, c_char_p, c_double, c_double, POINTER(c_int32)]),
    "talus_engine_probe_history": (c_int32, [c_void_p, c_int32, c_char_p, POINTER(talus_history)]),
    "talus_engine_event_count": (c_int32, [c_void_p, POINTER(c_int64)]),
    "talus_engine_event": (c_int32, [c_void_p, c_int64, POINTER(talus_event)]),
    "talus_engine_hash": (c_int32, [c_void_p, POINTER(c_int64)]),
}
