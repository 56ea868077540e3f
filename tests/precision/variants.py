"""A scene, as a dict, with physics left out."""


def without(entry, *names):
    return {name: value for name, value in entry.items() if name not in names}


def boundaries_without(scene, *names):
    """Those that still say something."""
    changed = [without(boundary, *names) for boundary in scene["boundaries"]]
    return [boundary for boundary in changed if "flow" in boundary or "motion" in boundary]


def rigid(scene):
    return {**scene, "physics": {"deforming": False}, "soils": [without(soil, "dryDensity", "solid") for soil in scene["soils"]],
            "boundaries": boundaries_without(scene, "motion"), "initial": without(scene["initial"], "stress")}


def dry_soil(soil):
    """Its strength is that without suction."""
    strength = {**soil["solid"]["strength"], "model": "constant"}
    return {**without(soil, "hydraulics"), "solid": {**soil["solid"], "strength": strength}}


def dry(scene):
    return {**without(scene, "surface"), "physics": {"water": False}, "soils": [dry_soil(soil) for soil in scene["soils"]],
            "boundaries": boundaries_without(scene, "flow", "flowValue"), "initial": {"stress": scene["initial"]["stress"]}}


VARIANTS = {"full": lambda scene: scene, "rigid skeleton": rigid, "dry": dry}
