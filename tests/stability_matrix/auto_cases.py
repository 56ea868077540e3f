"""Ground that stands in the rain until it fails, moves by its momentum, rests and settles, once or again and again."""

from block_scenes import mesh
from case import Case, Sweep
from dynamic_cases import HELD, bedded, dynamic
from scenes import earth, section

STORM = [["step", 600.0, 16]]
OPEN = HELD[:2]  # without a wall at its right
SOFTENING = {"residualCohesion": 0.0, "residualFrictionAngle": 15.0, "slip": 0.05}


def bank(scale=1.0, face=((6, 1), (12, 1)), layers=None):
    """4 m high, 3 m wide at its top, times `scale`; and its face."""
    terrain = [[scale * x, scale * y] for x, y in ((0, 4), (3, 4), *face)]
    return section(terrain, [[0, 0], [terrain[-1][0], 0]], 0.5 * scale, 0.4 * scale, 0.5 * scale, layers or [{"soil": "earth"}])


def failing(ground=None, soils=None, walls=HELD, cell_size=0.5, water=1e7, rain=3e-5, suction=2e4, softening=SOFTENING, **numbers):
    """A bank that stands by its suction."""
    soil = earth(**{"cohesion": 500, "friction": 30, "alpha": 4e-4, "n": 2.0, "conductivity": 1e-4, **numbers})
    if softening:
        soil["solid"]["softening"] = softening
    scene = dynamic(ground or bank(), [soil, *(soils or [])], walls, cell_size, water, rain)
    return {**scene, "physics": {"regime": "auto"}, "initial": {"flow": "suction", "suction": suction}, "numerics": {"tolerance": 0.1}}


def bishop():
    scene = failing()
    scene["physics"]["stress"] = "bishop"
    return scene


def of_triangles():
    """The bank as a mesh that the host gives."""
    x, rows = [0.5 * k for k in range(25)], 9
    places = [[at, row / (rows - 1) * (4 if at <= 3 else max(7 - at, 1))] for row in range(rows) for at in x]
    corners = [row * len(x) + column for row in range(rows - 1) for column in range(len(x) - 1)]
    return mesh(places, [cell for a in corners for cell in ([a, a + 1, a + 1 + len(x)], [a, a + 1 + len(x), a + len(x)])])


SWEEPS = (
    Sweep("auto", ("rain, m/s", "slip of softening, m"), ((3e-5, 3e-6, 1e-5, 3e-4), (0.05, 1e-4, 1.0)),
          lambda rain, slip: failing(rain=rain, softening={**SOFTENING, "slip": slip}),
          lambda rain, slip: [["step", 0.018 / rain, 16]], monotone=False),
)


def cases():
    for sweep in SWEEPS:
        yield from sweep.cases()
    yield Case("auto_bank/benign", failing(), STORM)
    yield Case("auto_bank/no_softening", failing(softening=None, cohesion=50), STORM)
    yield Case("auto_bank/one_step", failing(), [["step", 9600.0, 1]])
    yield Case("auto_bank/short_steps", failing(), [["step", 600.0, 10], ["step", 5.0, 200]])
    yield Case("auto_bank/rain_on_and_off", failing(), [["step", 600.0, 12], ["rain", 0.0], ["step", 3600.0, 3], ["rain", 3e-5], ["step", 600.0, 6]])
    yield Case("auto_bank/for_a_day", failing(), [["step", 3600.0, 24]], bound=60)
    yield Case("auto_bank/thin", failing(bank(face=((7.5, 0.5),)), walls=OPEN), STORM)
    yield Case("auto_bank/coarse", failing(cell_size=1.0), STORM)
    yield Case("auto_bank/fine", failing(cell_size=0.125), STORM, bound=60)
    yield Case("auto_bank/small", failing(bank(0.1), cell_size=0.05, rain=3e-6, cohesion=50, alpha=4e-3, suction=2e3), STORM)
    yield Case("auto_bank/stiff_water", failing(water=2e9), STORM, bound=60)
    yield Case("auto_bank/soft_ground", failing(young=5e5), STORM)
    yield Case("auto_bank/stiff_ground", failing(young=1e9), STORM)
    yield Case("auto_bank/steep_retention", failing(alpha=2e-5, n=6.0, conductivity=1e-5), STORM)
    yield Case("auto_bank/bishop", bishop(), STORM)
    yield Case("auto_bank/bedded", bedded(failing(), 1e-5, -30.0), STORM)
    yield Case("auto_bank/no_friction", failing(friction=1.0, cohesion=1.5e4, rain=1e-4, softening={"residualCohesion": 500, "residualFrictionAngle": 1.0, "slip": 0.01},
                                                 strength={"model": "fredlund", "suctionFrictionAngle": 20.0}), STORM)
    yield Case("auto_bank/layers", failing(bank(layers=[{"soil": "earth"}, {"soil": "rock", "top": [[0, 0.75], [12, 0.75]]}]),
                                           [earth("rock", young=1e9, cohesion=1e6, conductivity=1e-9)]), STORM)
    yield Case("auto_bank/imported", failing(of_triangles()), STORM)
