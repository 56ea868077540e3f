"""Finds libtalus, declares its functions, turns its status codes into exceptions."""
import ctypes
import json
import os
import pathlib

from . import _api
from .errors import BY_STATUS, Error

NAME = f"libtalus.so.{_api.ABI}"


def _candidates():
    if "TALUS_LIBRARY" in os.environ:
        yield os.environ["TALUS_LIBRARY"]
        return
    root = pathlib.Path(__file__).resolve().parents[3]  # of the checkout, or the lib folder of an installation
    places = (root / "build/release/lib" / NAME, root / "build/debug/lib" / NAME, root / NAME)
    yield from (str(place) for place in places if place.exists())
    yield NAME


def _load():
    name = next(_candidates())
    try:
        loaded = ctypes.CDLL(name)
    except OSError as error:
        raise ImportError(f"cannot load libtalus ({error}); build it, or set TALUS_LIBRARY to its file") from error
    for function, (result, arguments) in _api.FUNCTIONS.items():
        getattr(loaded, function).restype = result
        getattr(loaded, function).argtypes = arguments
    if loaded.talus_abi() != _api.ABI:
        raise ImportError(f"{name} has ABI {loaded.talus_abi()}, this package needs {_api.ABI}")
    return loaded


library = _load()


def version():
    """Version of the library, "0.1.0"."""
    return library.talus_version().decode()


def build_info():
    """What the library was built from: a dict."""
    return json.loads(library.talus_build_info())


def last_error():
    return library.talus_last_error().decode(errors="replace")


def check(status):
    """Raises the exception of a status below 0, and returns the others."""
    if status < 0:
        raise BY_STATUS.get(status, Error)(last_error())
    return status


def begun(structure):
    """An instance of a struct of talus.h, begun as its INIT macro does."""
    return structure(struct_size=ctypes.sizeof(structure))


def as_dict(structure):
    """The members of a struct by name; texts decoded."""
    pairs = ((name, getattr(structure, name)) for name, *_ in structure._fields_ if name != "struct_size")
    return {name: value.decode() if isinstance(value, bytes) else value for name, value in pairs}


def constant_name(prefixes, value):
    """The name in lower case of the constant of talus.h among `prefixes` that has this value."""
    return next((name.lower() for name in prefixes if getattr(_api, name) == value), str(value))
