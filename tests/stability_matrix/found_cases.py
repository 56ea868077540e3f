"""What the random search found, reduced where the failure let itself be."""

from dataclasses import replace

from case import Case
from random_cases import moving_case, random_case, rigid_column
from scenes import column, earth, elastic_soil, rain_zone, section, sloping, soil


def coarse_over_fine(upper, lower, **others):
    """The reduced form of a random scene: two layers of a cell each."""
    return column([soil("upper", **upper), soil("lower", **lower)],
                  [{"soil": "upper"}, {"soil": "lower", "top": others["height"] / 2}], cells=2, **others)


def flow_cases():
    scene = coarse_over_fine({"alpha": 5e-3, "n": 10.0, "conductivity": 1e-2, "residual": 0.04},
                             {"alpha": 4e-7, "conductivity": 3e-4}, height=8.638, suction=1.402, rain=1.298e-4, base=-1120.0)
    yield Case("found/rigid_698_reduced", scene, [["step", 909e3, 1]])
    scene = coarse_over_fine({"alpha": 6e-3, "n": 10.0, "residual": 0.04448},
                             {"alpha": 4.5e-7, "n": 1.239, "conductivity": 1.295e-9, "porosity": 0.7234, "residual": 0.027},
                             height=3.022, suction=147e3, rain=1.2675e-5)
    yield Case("found/rigid_916_reduced", scene, [["step", 2144, 1]], tightened=True)
    scene = coarse_over_fine(
        {"alpha": 2.922e-3, "n": 1.0784, "conductivity": 2.528e-4, "porosity": 0.09884, "residual": 0.006611},
        {"alpha": 6.503e-3, "n": 7.88, "conductivity": 1.628e-9, "porosity": 0.46, "residual": 0.2741},
        height=0.5136, suction=218.1e3, rain=6.631e-5, ponding=0.2945)
    yield Case("found/rigid_1863_reduced", scene, [["step", 101.2e3, 1]], tightened=True)
    yield Case("found/77_reduced", wetted_from_below(), [["step", 0.02, 1], ["step", 589e3, 1]])
    for seed in (5, 228, 655, 698, 916, 1863):
        scene, steps = rigid_column(seed)
        yield Case(f"found/rigid_{seed}", scene, steps, tightened=True)


def wetted_from_below():
    """A coarse and very dry wedge whose base is suddenly wet, below clay; rigid."""
    soils = [soil("upper", alpha=1e-5, conductivity=1e-13, porosity=0.1), soil("lower", alpha=1e-3, n=10.0, porosity=0.1)]
    ground = section([[0, 10], [1, 10], [165, 30]], [[0, 0], [165, 0]], 33, 4, 15,
                     [{"soil": "upper"}, {"soil": "lower", "top": [[0, 0], [165, 10]]}])
    return {"name": "stability", "physics": {"deforming": False}, "soils": soils, "ground": ground,
            "boundaries": [{"name": "base", "side": "base", "flow": "hydrostatic", "flowValue": {"value": [0]}}],
            "surface": rain_zone(4.65e-8), "initial": {"flow": "hydrostatic", "waterTable": -24.5}}


def few_cells(ground, cells, initial, **others):
    """A metre of ground that deforms, in a few cells."""
    return {"name": "stability", "soils": [ground],
            "ground": {"column": {"height": 1, "cells": cells, "layers": [{"soil": "earth"}]}},
            "boundaries": [{"name": "base", "side": "base", "motion": "fixed"}], "initial": initial, **others}


def stiff_over_soft():
    """Level ground, of which a wedge below is a thousand times softer."""
    soils = [earth("upper", cohesion=0, friction=10, young=1e10), earth("lower", cohesion=0, friction=10, young=1e7)]
    ground = section([[0, 5], [16, 5]], [[0, 0], [16, 0]], 1, 1, 1,
                     [{"soil": "upper"}, {"soil": "lower", "top": [[0, 1], [16, 0]]}])
    return sloping(ground, soils, table=0)


def dry_sand():
    """Two cells of dry, evenly grained ground under rain, in Bishop's stress."""
    ground = section([[0, 1], [2, 1]], [[0, 0], [2, 0]], 1, 1, 1, [{"soil": "earth"}])
    hydraulics = {"alpha": 1e-3, "n": 9.0, "conductivity": 1e-10, "porosity": 0.1}
    scene = sloping(ground, [elastic_soil("earth", 1e11, 0, **hydraulics)], rain=1e-5, stress="bishop")
    return {**scene, "initial": {"flow": "suction", "suction": 4.6e5}}


def coupled_cases():
    yield Case("found/287_reduced", dry_sand(), [["step", 1, 1]])
    clay = earth(cohesion=0, friction=1, poisson=0, young=1e8, alpha=1e-7, conductivity=1e-11)
    scene = few_cells(clay, 1, {"flow": "suction", "suction": 0, "stress": "k0", "k0": 0.0})
    scene["boundaries"][0].update(flow="pressure", flowValue={"value": [0]})
    scene["boundaries"].append({"name": "load", "side": "surface", "motion": "traction",
                                "motionY": {"time": [0, 1], "value": [0, -1e3]}})
    yield Case("found/187_reduced", scene, [["step", 1, 1]])
    yield Case("found/254_reduced", stiff_over_soft(), [["step", 1, 1]])
    fredlund = {"model": "fredlund", "suctionFrictionAngle": 1}
    clay = earth(cohesion=100, friction=0, young=1e6, poisson=0, alpha=1e-6, conductivity=1e-7, strength=fredlund)
    scene = few_cells(clay, 2, {"flow": "suction", "suction": 2e3})
    scene["boundaries"][0].update(flow="pressure", flowValue={"value": [0]})
    yield Case("found/31_reduced", scene, [["step", 1, 1]])
    sand = earth(cohesion=0, friction=20, dilation=10, poisson=0.49, n=4, alpha=1e-5, conductivity=1e-8, strength=fredlund)
    scene = few_cells(sand, 1, {"flow": "hydrostatic", "waterTable": 0, "stress": "k0", "k0": 0.4}, surface=rain_zone(1e-6))
    yield Case("found/91_reduced", scene, [["step", 1, 5]])
    for number in (31, 77, 83, 89, 91, 107, 146, 187, 191, 203, 254, 257, 272, 287, 371, 382, 403, 440, 467, 673, 754,
                   773, 779, 787, 865, 914, 980, 1022, 1028, 1191, 1505, 1574, 1850, 1966, 2218, 2645, 3302, 3455, 3622,
                   3922, 3926, 4193, 5626, 6434, 7319, 9409, 9818, 9983, 10307, 12215, 12455, 13202, 14286, 14342,
                   15641, 17563):
        yield replace(random_case(number), name=f"found/{number}")
    # When it loses its equilibrium hangs on round-off, and with it what water it has at the end.
    yield replace(random_case(9692), name="found/9692", tightened=False)


def moving_cases():
    for number in (238, 2335, 2341, 2558, 2656, 2980):
        yield replace(moving_case(number, is_varied=False), name=f"found/moving_{number}")


def cases():
    yield from flow_cases()
    yield from coupled_cases()
    yield from moving_cases()
