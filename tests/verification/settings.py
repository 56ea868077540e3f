"""The settings that error depends on, in a scene that is a dict: the lengths and the growth of its cells, and its tolerance."""

DEFAULT_TOLERANCE = 1e-3  # of a scene that says none, docs/scenes.md
SECTION_LENGTHS = ("columnWidth", "bendColumnWidth", "surfaceCellHeight", "largestCellHeight")

# Of a section whose cells grow evenly (no `growth`), m: chosen among 15 such sets by the errors of slope and slope_gentle.
EVEN_LENGTHS = (1.8, 0.4, 0.08, 1.6)


def set_even_growth(scene):
    """Cells that grow evenly with the depth in place of the scene's own, so that one factor changes all of them alike."""
    ground = scene["ground"]["section"]
    for name in ("growth", "gradedDepth"):
        ground.pop(name, None)
    ground.update(zip(SECTION_LENGTHS, EVEN_LENGTHS))


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
