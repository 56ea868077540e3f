"""The two settings that error depends on, in a scene that is a dict: the lengths of its cells and its tolerance."""

DEFAULT_TOLERANCE = 1e-3  # of a scene that says none, docs/scenes.md
SECTION_LENGTHS = ("columnWidth", "bendColumnWidth", "surfaceCellHeight", "largestCellHeight")


def set_resolution(scene, coarsening):
    """Changes the lengths of the scene's cells by a factor; returns the height of the uppermost cell."""
    if "column" in scene["ground"]:
        ground = scene["ground"]["column"]
        ground["cells"] = round(ground["cells"] / coarsening)
        return ground["height"] / ground["cells"]
    ground = scene["ground"]["section"]
    for name in SECTION_LENGTHS:
        ground[name] *= coarsening
    return ground["surfaceCellHeight"]


def set_tolerance(scene, loosening):
    """Changes the scene's tolerance by a factor; returns it."""
    numerics = scene.setdefault("numerics", {})
    numerics["tolerance"] = float(f"{numerics.get('tolerance', DEFAULT_TOLERANCE) * loosening:.3g}")
    return numerics["tolerance"]
