"""Small columns from a few numbers: the scenes that the cases vary."""

WATER_WEIGHT = 9810.0  # Pa/m
MM_PER_HOUR = 1e-3 / 3600  # m/s


def soil(name="soil", alpha=1e-4, n=2.0, conductivity=1e-5, porosity=0.4, residual=0.0):
    """A soil without a skeleton; alpha in 1/Pa, conductivity in m/s."""
    return {"name": name, "porosity": porosity,
            "hydraulics": {"retention": {"model": "vanGenuchten", "alpha": alpha, "n": n, "residualSaturation": residual},
                           "conductivity": {"along": conductivity}}}


def column(soils=None, layers=None, height=1.0, cells=40, suction=3e4, rain=1e-6, base=None, ponding=0.0, initial=None):
    """A rigid column under rain (m/s, None: no zone of it), closed at its base or with the pressure `base` (Pa) held there."""
    soils = soils or [soil()]
    scene = {"name": "stability", "physics": {"deforming": False}, "soils": soils,
             "ground": {"column": {"height": height, "cells": cells, "layers": layers or [{"soil": soils[0]["name"]}]}},
             "initial": initial or {"flow": "suction", "suction": suction}}
    if rain is not None:
        scene["surface"] = {"pondingDepth": ponding, "zones": [{"name": "rain", "time": [0], "rate": [rain]}]}
    if base is not None:
        scene["boundaries"] = [{"name": "base", "side": "base", "flow": "pressure", "flowValue": {"value": [base]}}]
    return scene


def loaded_column(conductivity=1e-9, bulk_modulus=2e9, poisson=0.3):
    """10 m of full elastic clay under 100 kPa, drained at its top: the load is put within a second."""
    clay = {**soil("clay", 1e-5, 2.0, conductivity), "dryDensity": 1600,
            "solid": {"model": "elastic", "youngModulus": 1e8, "poissonRatio": poisson}}
    clay["hydraulics"]["relativePermeability"] = {"model": "constant"}
    return {"name": "stability", "water": {"bulkModulus": bulk_modulus}, "soils": [clay],
            "ground": {"column": {"height": 10, "cells": 50, "layers": [{"soil": "clay"}]}},
            "boundaries": [
                {"name": "base", "side": "base", "flow": "impermeable", "motion": "fixed"},
                {"name": "drain", "side": "surface", "flow": "pressure", "flowValue": {"value": [0]}},
                {"name": "load", "side": "surface", "motion": "traction",
                 "motionY": {"time": [0, 1], "value": [0, -100e3]}}],
            "initial": {"flow": "hydrostatic", "waterTable": 10, "stress": "gravity"}}


def small_slope(cohesion=1e4, friction=30, dilation=0, tensile=None, poisson=0.3, young=1e7):
    """A section of 14 m by 4 m with a face of 1 : 2 under rain, without tensile strength where `tensile` is 0 (Pa)."""
    solid = {"model": "mohrCoulomb", "youngModulus": young, "poissonRatio": poisson, "dilationAngle": dilation,
             "strength": {"cohesion": cohesion, "frictionAngle": friction}}
    if tensile is not None:
        solid["tensileStrength"] = tensile
    ground = {"terrain": [[0, 4], [6, 4], [10, 2], [14, 2]], "base": [[0, 0], [14, 0]], "layers": [{"soil": "earth"}],
              "columnWidth": 1.0, "surfaceCellHeight": 0.5, "largestCellHeight": 1.0}
    return {"name": "stability", "soils": [{**soil("earth", 4e-5), "dryDensity": 1600, "solid": solid}],
            "ground": {"section": ground},
            "boundaries": [{"name": "base", "side": "base", "motion": "fixed"},
                           *({"name": side, "side": side, "motion": "roller"} for side in ("left", "right"))],
            "surface": {"zones": [{"name": "rain", "time": [0], "rate": [1e-6]}]},
            "initial": {"flow": "hydrostatic", "waterTable": 1.0}}
