#!/usr/bin/python3
"""Arrows point down only: every quoted include of the tree goes to a folder that the including folder may know.

Usage: check_layers.py [SOURCE_DIR]. Exit status 1 and one line a wrong include otherwise.
"""
import pathlib
import re
import sys

# Each part of the engine and the parts it may know, from the bottom up. A path names one header instead of a whole folder.
SOLID = "materials/solid/parameters.hpp"
HYDRAULIC = "materials/hydraulic/parameters.hpp"
GROUND_UP_TO_POINTS = {"materials", "scene", "ground", "background", "points"}
PHYSICS = GROUND_UP_TO_POINTS | {"linear"}
ENGINE = {
    "materials": set(),
    "linear": set(),
    "scene": {SOLID, HYDRAULIC},
    "ground": {"scene"},
    "background": {"scene", "ground/mesh.hpp"},
    "points": GROUND_UP_TO_POINTS,
    "flow": PHYSICS,
    "motion": PHYSICS,
    "coupling": PHYSICS | {"flow", "motion"},
    "snapshot": PHYSICS | {"flow", "motion", "coupling"},
    "engine": PHYSICS | {"flow", "motion", "coupling", "snapshot"},
}
FOR_ALL = "error.hpp"
CAPI = {"engine.hpp", FOR_ALL, "talus/talus.h"}
HOST = {"talus/talus.h"}

INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]', re.MULTILINE)
SOURCES = {".cpp", ".hpp", ".c", ".h"}


def part_of(engine, header):
    """The engine's part that a header belongs to (engine.* is the part `engine`), or None for a header of others."""
    if not (engine / header).is_file() and header.split("/")[0] not in ENGINE:
        return None
    return header.split("/")[0] if "/" in header else "engine"


def engine_problem(engine, file, header):
    own = part_of(engine, str(file.relative_to(engine)))
    other = part_of(engine, header)
    if own not in ENGINE:
        return f"{own} has no place among the layers yet"
    if header == FOR_ALL or other == own or other in ENGINE[own] or header in ENGINE[own]:
        return None
    if other is None:
        beside = (file.parent / header).is_file() or header.startswith(".")
        return "is not written from the engine's root" if beside else None
    return f"{own} may not know {other}"


def outside_problem(root, header, allowed):
    talus_header = part_of(root / "engine", header) or (root / "capi/include" / header).is_file()
    if not talus_header or header in allowed:
        return None
    return f"may know {', '.join(sorted(allowed))} alone"


def problems(root):
    engine = root / "engine"
    for folder, allowed in {"engine": None, "capi": CAPI, "samples": HOST, "bindings": HOST}.items():
        for file in sorted(path for path in (root / folder).rglob("*") if path.suffix in SOURCES):
            for header in INCLUDE.findall(file.read_text()):
                outside = allowed is not None
                problem = outside_problem(root, header, allowed) if outside else engine_problem(engine, file, header)
                if problem:
                    yield f"{file.relative_to(root)}: {header}: {problem}"


def main():
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[1]
    found = list(problems(root))
    print("\n".join(found) or "layers: every arrow points down")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
