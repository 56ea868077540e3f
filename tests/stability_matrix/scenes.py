"""Small scenes from a few numbers: what the cases vary. SI units, angles in degrees."""

WATER_WEIGHT = 9810.0  # Pa/m
MM_PER_HOUR = 1e-3 / 3600  # m/s


def soil(name="soil", alpha=1e-4, n=2.0, conductivity=1e-5, porosity=0.4, residual=0.0):
    """A soil without a skeleton; alpha in 1/Pa, conductivity in m/s."""
    return {"name": name, "porosity": porosity,
            "hydraulics": {"retention": {"model": "vanGenuchten", "alpha": alpha, "n": n, "residualSaturation": residual},
                           "conductivity": {"along": conductivity}}}


def elastic_soil(name="clay", young=1e8, poisson=0.3, alpha=1e-5, **hydraulics):
    return {**soil(name, alpha, **hydraulics), "dryDensity": 1600,
            "solid": {"model": "elastic", "youngModulus": young, "poissonRatio": poisson}}


def earth(name="earth", cohesion=1e4, friction=30, dilation=0, tensile=None, poisson=0.3, young=1e7, strength=None, alpha=4e-5,
          **hydraulics):
    """A soil of Mohr-Coulomb; its tensile strength in Pa (None: the cone's), `strength`: entries of a model of its own."""
    solid = {"model": "mohrCoulomb", "youngModulus": young, "poissonRatio": poisson, "dilationAngle": dilation,
             "strength": {"cohesion": cohesion, "frictionAngle": friction, **(strength or {})}}
    if tensile is not None:
        solid["tensileStrength"] = tensile
    return {**soil(name, alpha, **hydraulics), "dryDensity": 1600, "solid": solid}


def dry(soil):
    return {name: value for name, value in soil.items() if name != "hydraulics"}


def rain_zone(rate, ponding=0.0):
    return {"pondingDepth": ponding, "zones": [{"name": "rain", "time": [0], "rate": [rate]}]}


def column(soils=None, layers=None, height=1.0, cells=40, suction=3e4, rain=1e-6, base=None, ponding=0.0, initial=None):
    """A rigid column under rain (m/s, None: no zone of it), closed at its base or with the pressure `base` (Pa) held there."""
    soils = soils or [soil()]
    scene = {"name": "stability", "physics": {"deforming": False}, "soils": soils,
             "ground": {"column": {"height": height, "cells": cells, "layers": layers or [{"soil": soils[0]["name"]}]}},
             "initial": initial or {"flow": "suction", "suction": suction}}
    if rain is not None:
        scene["surface"] = rain_zone(rain, ponding)
    if base is not None:
        scene["boundaries"] = [{"name": "base", "side": "base", "flow": "pressure", "flowValue": {"value": [base]}}]
    return scene


def loaded_column(conductivity=1e-9, bulk_modulus=2e9, poisson=0.3, ramp=1.0, soils=None, layers=None):
    """10 m of full elastic clay under 100 kPa, drained at its top: the load is put within `ramp` seconds."""
    soils = soils or [elastic_soil(poisson=poisson, conductivity=conductivity)]
    for clay in soils:
        clay["hydraulics"]["relativePermeability"] = {"model": "constant"}
    return {"name": "stability", "water": {"bulkModulus": bulk_modulus}, "soils": soils,
            "ground": {"column": {"height": 10, "cells": 50, "layers": layers or [{"soil": soils[0]["name"]}]}},
            "boundaries": [
                {"name": "base", "side": "base", "flow": "impermeable", "motion": "fixed"},
                {"name": "drain", "side": "surface", "flow": "pressure", "flowValue": {"value": [0]}},
                {"name": "load", "side": "surface", "motion": "traction",
                 "motionY": {"time": [0, ramp], "value": [0, -100e3]}}],
            "initial": {"flow": "hydrostatic", "waterTable": 10, "stress": "gravity"}}


def held_ground():
    """Fixed below, on rollers at its sides."""
    return [{"name": "base", "side": "base", "motion": "fixed"},
            *({"name": side, "side": side, "motion": "roller"} for side in ("left", "right"))]


def sloping(ground, soils, rain=1e-6, table=1.0, stress="net"):
    """Ground in plane strain under rain, with a water table at rest."""
    return {"name": "stability", "physics": {"stress": stress}, "soils": soils, "ground": ground, "boundaries": held_ground(),
            "surface": rain_zone(rain), "initial": {"flow": "hydrostatic", "waterTable": table}}


def section(terrain, base, width, height, largest, layers):
    """Columns of cells as wide as `width`, `height` at the surface and growing to `largest` below."""
    return {"section": {"terrain": terrain, "base": base, "layers": layers, "columnWidth": width, "surfaceCellHeight": height,
                        "growth": 1.2, "largestCellHeight": largest}}


def small_slope(scale=1.0, rain=1e-6, stress="net", soils=None, layers=None, **numbers):
    """14 m by 4 m with a face of 1 : 2, times `scale`; `numbers` are those of its earth."""
    def scaled(*places):
        return [[scale * x, scale * y] for x, y in places]
    ground = section(scaled((0, 4), (6, 4), (10, 2), (14, 2)), scaled((0, 0), (14, 0)), scale, 0.5 * scale, scale,
                     layers or [{"soil": "earth"}])
    return sloping(ground, soils or [earth(**numbers)], rain, scale, stress)
