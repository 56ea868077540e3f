"""Talus from Python: rainfall-induced landslides, stepped from a script. SI units; see docs/api.md.

    import talus

    scene = talus.Scene.from_file("samples/scenes/slope.json")
    with talus.Engine(scene) as engine:
        engine.set_rain("storm", 0.012 / 3600)
        while engine.time < 36 * 3600:
            report = engine.step(3600)
        pressure = engine.read("pressure")

It is a thin layer over libtalus: ctypes and NumPy, nothing to compile. The library is looked for in TALUS_LIBRARY (a file),
then in the build folder of the checkout that this package lies in, then where the system looks for libraries.
"""
from ._library import build_info, version
from .engine import Engine
from .errors import (Busy, Cancelled, Error, InputOutputError, InternalError, InvalidArgument, InvalidHandle, InvalidScene,
                     NotConverged, OutOfMemory, StaleView, UnknownName, ViewHeld)
from .results import Results
from .scene import Scene
from .view import View

__all__ = ["Busy", "Cancelled", "Engine", "Error", "InputOutputError", "InternalError", "InvalidArgument", "InvalidHandle",
           "InvalidScene", "NotConverged", "OutOfMemory", "Results", "Scene", "StaleView", "UnknownName", "View", "ViewHeld",
           "build_info", "version"]
