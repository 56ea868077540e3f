"""One run in time."""
import functools
import json
import weakref
from ctypes import POINTER, byref, c_char_p, c_double, c_int32, c_int64, c_void_p

import numpy

from . import _api
from ._library import as_dict, begun, check, constant_name, last_error, library
from .errors import Cancelled, InvalidHandle, ViewHeld
from .view import View

_RAIN_POLICIES = {"reject": _api.RAIN_REJECT, "hold": _api.RAIN_HOLD, "zero": _api.RAIN_ZERO}
_EVENTS = ("SATURATED", "PONDING_STARTED", "PONDING_ENDED", "SEEPAGE_STARTED", "LOSS_OF_EQUILIBRIUM", "RAIN_ENDED",
           "MOTION_STARTED", "CAME_TO_REST", "SETTLED", "LEFT_BACKGROUND")
_REGIMES = ("QUASI_STATIC", "EQUILIBRIUM_LOST", "DYNAMIC", "AT_REST")
_STEPS = ("OK", "CANCELLED", "OUT_OF_RAIN", "ENDED_EARLY")


class _Handle:
    """Owns the engine; whoever holds its memory holds this."""

    def __init__(self, pointer, callbacks):
        self.pointer = pointer
        self.callbacks = callbacks

    def __del__(self):
        library.talus_engine_destroy(self.pointer)


class _Callbacks:
    """The host's callbacks as C functions. An exception of theirs cancels the step and is raised by the call around it.

    A progress function is always there: it lets Ctrl-C reach the interpreter during a long step.
    """

    def __init__(self, log, progress):
        self.exception = None
        self.log = _api.talus_log_callback(self._guard(log, None)) if log else _api.talus_log_callback()
        self.progress = _api.talus_progress_callback(self._guard(progress or (lambda fraction: False), 1))

    def _guard(self, function, when_raised):
        def call(_user, *arguments):
            try:
                arguments = [value.decode() if isinstance(value, bytes) else value for value in arguments]
                result = function(*arguments)
                return None if when_raised is None else int(bool(result))
            except BaseException as exception:  # KeyboardInterrupt too: nothing may leave a callback
                self.exception = self.exception or exception
                return when_raised
        return call

    def reraise(self):
        exception, self.exception = self.exception, None
        if exception is not None:
            raise exception


def _numbers(values):
    """A contiguous array of float64, and its first number's address."""
    array = numpy.ascontiguousarray(values, numpy.float64)
    return array, array.ctypes.data_as(POINTER(c_double))


def _series(time, values):
    time, values = numpy.atleast_1d(time), numpy.atleast_1d(values)
    if time.ndim != 1 or time.shape != values.shape:
        raise ValueError(f"times and values must have the same length, not {time.shape} and {values.shape}")
    (time, first_time), (values, first_value) = _numbers(time), _numbers(values)
    return len(time), first_time, first_value, (time, values)


class Engine:
    """A run of a scene, at time 0 when created: pore pressure and stress are in equilibrium.

    tolerance    error allowed in time; None: the scene's
    rain_policy  what to do with a NaN or negative rate: "reject" (InvalidArgument), "hold" the last good one, "zero"
    log          called with (level, text)
    progress     called within steps with the fraction done; a true result cancels
    threads      of a dynamic ground; results do not depend on it
    stop_at_motion  whether a step ends where ground of the regime auto starts to move or comes to rest

    Used by one thread at a time; cancel() and time by any. Calls release the GIL.
    """

    def __init__(self, scene, tolerance=None, rain_policy="reject", log=None, progress=None, threads=1,
                 stop_at_motion=False):
        callbacks = _Callbacks(log, progress)
        options = begun(_api.talus_options)
        options.tolerance = tolerance or 0.0
        options.threads = threads
        options.stop_at_motion = stop_at_motion
        options.rain_policy = _RAIN_POLICIES[rain_policy]
        options.log, options.progress = callbacks.log, callbacks.progress
        pointer = c_void_p()
        self._handle = None
        self._lent = []  # (name, weak reference to the bytes) of arrays of the engine's memory
        status = library.talus_engine_create(scene._handle, byref(options), byref(pointer))
        if status >= 0:
            self._handle = _Handle(pointer, callbacks)
        callbacks.reraise()
        check(status)

    # --- lifetime ---

    def close(self):
        """Ends the run. Its memory goes when the last array of it does."""
        self._handle = None

    @property
    def closed(self):
        return self._handle is None

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.close()

    @property
    def _pointer(self):
        if self._handle is None:
            raise InvalidHandle("the engine is closed")
        return self._handle.pointer

    # --- push ---

    def _index(self, find, name):
        if not isinstance(name, str):
            return int(name)
        index = c_int32()
        check(find(self._pointer, name.encode(), byref(index)))
        return index.value

    def push_rain(self, zone, time, rate):
        """Rain on a zone (name or number): rate[k] m/s over [time[k], time[k+1]). Replaces what was known from time[0] on."""
        zone = self._index(library.talus_engine_zone, zone)
        count, time, rate, _kept = _series(time, rate)
        check(library.talus_engine_push_rain(self._pointer, zone, count, time, rate))

    def set_rain(self, zone, rate):
        """Rain on a zone in m/s, from now until changed."""
        check(library.talus_engine_set_rain(self._pointer, self._index(library.talus_engine_zone, zone), rate))

    def push_flow_value(self, boundary, time, value):
        """The pressure (Pa), water table (m) or inflow (m/s) of a boundary: linear between the times."""
        boundary = self._index(library.talus_engine_boundary, boundary)
        count, time, value, _kept = _series(time, value)
        check(library.talus_engine_push_flow_value(self._pointer, boundary, count, time, value))

    def push_motion_value(self, boundary, component, time, value):
        """The displacement (m) or traction (Pa) of a boundary along x (0) or y (1): linear between the times."""
        boundary = self._index(library.talus_engine_boundary, boundary)
        count, time, value, _kept = _series(time, value)
        check(library.talus_engine_push_motion_value(self._pointer, boundary, component, count, time, value))

    # --- step ---

    def step(self, dt):
        """Carries the run dt seconds on and returns the step's report, a dict with the members of talus_step_report.

        report["status"] is "ok", "out_of_rain" or "ended_early" (see stop_at_motion). Raises Cancelled when cancelled, NotConverged when the solver stopped:
        the engine is then as it was before the step. Raises ViewHeld while arrays of the engine's memory are held.
        """
        return self._advance(library.talus_engine_step, dt)

    def advance_to(self, time):
        """The same, to exactly this time in s."""
        return self._advance(library.talus_engine_advance_to, time)

    def _advance(self, function, value):
        self._require_no_lent()
        report = begun(_api.talus_step_report)
        status = function(self._pointer, value, byref(report))
        self._handle.callbacks.reraise()
        if check(status) == _api.CANCELLED:
            raise Cancelled(last_error())
        return {"status": constant_name(_STEPS, status), **_report(report)}

    def cancel(self):
        """Ends the step that runs, or else the next one. From any thread."""
        library.talus_engine_cancel(self._pointer)

    @property
    def time(self):
        """s since the start."""
        return library.talus_engine_time(self._pointer)

    @property
    def epoch(self):
        """Changes when the engine's memory does."""
        return library.talus_engine_epoch(self._pointer)

    def report(self):
        """The last step's report."""
        report = begun(_api.talus_step_report)
        check(library.talus_engine_report(self._pointer, byref(report)))
        return _report(report)

    # --- query ---

    def describe(self):
        """What the engine is composed of and what it left out: a dict; see docs/api.md."""
        text = c_char_p()
        check(library.talus_engine_describe(self._pointer, byref(text)))
        return json.loads(text.value)

    @property
    def fields(self):
        """Names of the fields."""
        return [field["name"] for field in self.describe()["fields"]]

    def view(self, field):
        """A field without a copy: a View."""
        out = begun(_api.talus_field)
        check(library.talus_engine_view(self._pointer, field.encode(), byref(out)))
        return View(self, out)

    def read(self, field):
        """A copy of a field: an array of rows, or rows x components."""
        return numpy.array(self.view(field).array)

    def sample(self, field, places):
        """A field at places (n x 2: x, y; in a column n: y): n, or n x components. NaN outside the ground."""
        places, first_place = _numbers(numpy.asarray(places, float).reshape(-1, self._dimension))
        values, first_value = _numbers(numpy.empty(self._with_components(field, (len(places),))))
        check(library.talus_engine_sample(self._pointer, field.encode(), len(places), first_place, first_value))
        return values

    def sample_raster(self, field, x, y, dx, dy, columns, rows):
        """A field on a raster: rows x columns, or rows x columns x components; [row, column] is at (x + column dx,
        y + row dy). NaN outside the ground."""
        raster = begun(_api.talus_raster)
        raster.x, raster.y, raster.dx, raster.dy, raster.columns, raster.rows = x, y, dx, dy, columns, rows
        values, first_value = _numbers(numpy.empty(self._with_components(field, (max(rows, 0), max(columns, 0)))))
        check(library.talus_engine_sample_raster(self._pointer, field.encode(), byref(raster), values.size, first_value))
        return values

    @functools.cached_property
    def _dimension(self):
        return self.describe()["dimension"]

    def _with_components(self, field, shape):
        return shape + self.view(field).shape[1:]

    # --- probes, events ---

    def add_probe(self, name, x, y):
        """A new probe at (x, y), its history beginning now; returns its number."""
        index = c_int32()
        check(library.talus_engine_add_probe(self._pointer, name.encode(), x, y, byref(index)))
        return index.value

    def history(self, probe, quantity):
        """Times and values of a quantity ("pressure", "displacement.x") at a probe (name or number): two arrays, copies."""
        probe = self._index(library.talus_engine_probe, probe)
        out = begun(_api.talus_history)
        check(library.talus_engine_probe_history(self._pointer, probe, quantity.encode(), byref(out)))
        if out.count == 0:
            return numpy.empty(0), numpy.empty(0)
        return tuple(numpy.ctypeslib.as_array(first, (out.count,)).copy() for first in (out.time, out.value))

    def events(self):
        """What happened so far: a list of dicts with kind, time, x, y, value, message."""
        count = c_int64()
        check(library.talus_engine_event_count(self._pointer, byref(count)))
        return [self._event(index) for index in range(count.value)]

    def _event(self, index):
        event = begun(_api.talus_event)
        check(library.talus_engine_event(self._pointer, index, byref(event)))
        return {**as_dict(event), "kind": constant_name(_EVENTS, event.kind)}

    def hash(self):
        """Of the state, bit for bit."""
        value = c_int64()
        check(library.talus_engine_hash(self._pointer, byref(value)))
        return value.value

    # --- arrays of the engine's memory ---

    def _lend(self, name, memory):
        self._forget_returned()
        self._lent.append((name, weakref.ref(memory)))

    def _forget_returned(self):
        self._lent = [(name, reference) for name, reference in self._lent if reference() is not None]

    def _require_no_lent(self):
        self._forget_returned()
        if self._lent:
            names = sorted({name for name, _ in self._lent})
            raise ViewHeld(f"arrays of the engine's memory are held ({', '.join(names)}): delete them before the step, "
                           f"or copy them by Engine.read")


def _report(structure):
    return {**as_dict(structure), "regime": constant_name(_REGIMES, structure.regime)}
