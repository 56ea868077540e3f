"""Exceptions: one class a status of the C API, with the engine's own message."""
from . import _api


class Error(Exception):
    """A call of Talus failed; the engine is as it was before it. `status` is the value of talus.h."""

    status = None


class InvalidHandle(Error):
    """The engine or the scene is closed."""

    status = _api.INVALID_HANDLE


class InvalidArgument(Error, ValueError):
    status = _api.INVALID_ARGUMENT


class InvalidScene(Error, ValueError):
    """The message has a line for each problem of the scene."""

    status = _api.INVALID_SCENE


class UnknownName(Error, KeyError):
    """No such field, zone, boundary, probe or quantity."""

    status = _api.UNKNOWN_NAME
    __str__ = Exception.__str__  # KeyError's shows quotes


class NotConverged(Error, ArithmeticError):
    """The solver stopped. This says nothing about the slope."""

    status = _api.NOT_CONVERGED


class OutOfMemory(Error, MemoryError):
    status = _api.OUT_OF_MEMORY


class InputOutputError(Error, OSError):
    status = _api.INPUT_OUTPUT


class InternalError(Error, RuntimeError):
    status = _api.INTERNAL


class Busy(Error, RuntimeError):
    """Another call on the engine is running: in another thread, or around this callback."""

    status = _api.BUSY


class Cancelled(Error):
    """The step was cancelled and undone."""

    status = _api.CANCELLED


class StaleView(Error, ReferenceError):
    """A view was used after its engine stepped or closed: take a new one."""


class ViewHeld(Error, BufferError):
    """The engine cannot step while arrays of its memory are held: delete them, or copy by Engine.read."""


BY_STATUS = {kind.status: kind for kind in
             (InvalidHandle, InvalidArgument, InvalidScene, UnknownName, NotConverged, OutOfMemory, InputOutputError,
              InternalError, Busy, Cancelled)}
