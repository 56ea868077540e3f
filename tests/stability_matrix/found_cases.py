"""What the random search found, reduced where the failure let itself be."""

from case import Case
from random_cases import rigid_column
from scenes import column, soil


def coarse_over_fine(upper, lower, **others):
    """The reduced form of a random scene: two layers of a cell each."""
    return column([soil("upper", **upper), soil("lower", **lower)],
                  [{"soil": "upper"}, {"soil": "lower", "top": others["height"] / 2}], cells=2, **others)


def cases():
    scene = coarse_over_fine({"alpha": 5e-3, "n": 10.0, "conductivity": 1e-2, "residual": 0.04},
                             {"alpha": 4e-7, "conductivity": 3e-4}, height=8.638, suction=1.402, rain=1.298e-4, base=-1120.0)
    yield Case("found/698_reduced", scene, [["step", 909e3, 1]])
    scene = coarse_over_fine({"alpha": 6e-3, "n": 10.0, "residual": 0.04448},
                             {"alpha": 4.5e-7, "n": 1.239, "conductivity": 1.295e-9, "porosity": 0.7234, "residual": 0.027},
                             height=3.022, suction=147e3, rain=1.2675e-5)
    yield Case("found/916_reduced", scene, [["step", 2144, 1]], tightened=True)
    scene = coarse_over_fine(
        {"alpha": 2.922e-3, "n": 1.0784, "conductivity": 2.528e-4, "porosity": 0.09884, "residual": 0.006611},
        {"alpha": 6.503e-3, "n": 7.88, "conductivity": 1.628e-9, "porosity": 0.46, "residual": 0.2741},
        height=0.5136, suction=218.1e3, rain=6.631e-5, ponding=0.2945)
    yield Case("found/1863_reduced", scene, [["step", 101.2e3, 1]], tightened=True)
    for seed in (5, 228, 655, 698, 916, 1863):
        scene, steps = rigid_column(seed)
        yield Case(f"found/{seed}", scene, steps, tightened=True)
