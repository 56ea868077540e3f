"""What is simulated."""
import ctypes
import json
import os

import numpy

from . import _api
from ._library import begun, check, library

_TYPES = {"f": (numpy.float64, _api.FLOAT64), "i": (numpy.int32, _api.INT32), "u": (numpy.int32, _api.INT32)}


def _host_array(entry, values):
    """A talus_array, and the NumPy array that must outlive it."""
    values = numpy.asarray(values)
    if values.dtype.kind not in _TYPES:
        raise TypeError(f"array {entry}: numbers are needed, not {values.dtype}")
    dtype, kind = _TYPES[values.dtype.kind]
    kept = numpy.ascontiguousarray(values, dtype)
    if kept.dtype.kind == "i" and not numpy.array_equal(kept, values):
        raise OverflowError(f"array {entry}: a value does not fit into int32")
    array = begun(_api.talus_array)
    array.type, array.entry, array.data, array.count = kind, entry.encode(), kept.ctypes.data, kept.size
    return array, kept


class Scene:
    """Terrain, soils, discretisation, physics: immutable, may be shared by engines in several threads.

    Raises InvalidScene with a line for each problem: the entry's path, the value, what is allowed.
    """

    def __init__(self, handle):
        self._handle = handle

    @classmethod
    def from_file(cls, path):
        """JSON text or Cap'n Proto bytes, told by the file's content."""
        handle = ctypes.c_void_p()
        check(library.talus_scene_from_file(os.fsencode(path), ctypes.byref(handle)))
        return cls(handle)

    @classmethod
    def from_json(cls, scene, arrays=None):
        """JSON text, or a dict of the same. `arrays` gives entries by their path as arrays of numbers, which are copied:
        {"ground.mesh.position": nodes x 2 float64, "ground.mesh.cellNodes": int32, ...}; see docs/api.md.
        Integers go to entries of int32, floating-point numbers to entries of float64.
        """
        text = (scene if isinstance(scene, str) else json.dumps(scene)).encode()
        made = [_host_array(entry, values) for entry, values in (arrays or {}).items()]
        structs = (_api.talus_array * len(made))(*(array for array, _ in made))
        handle = ctypes.c_void_p()
        check(library.talus_scene_from_json_with_arrays(text, len(text), len(made), structs, ctypes.byref(handle)))
        return cls(handle)

    @classmethod
    def from_bytes(cls, message):
        """A flat Cap'n Proto message."""
        message = bytes(message)
        handle = ctypes.c_void_p()
        check(library.talus_scene_from_bytes(message, len(message), ctypes.byref(handle)))
        return cls(handle)

    def __del__(self):
        if getattr(self, "_handle", None):
            library.talus_scene_release(self._handle)
            self._handle = None
