"""Shapes of the ground: meshes with tiny and needle cells, thin and wide domains, slopes of 1 m and 1 km."""

from block_scenes import grid, mesh, raining
from case import HOUR, Case
from scenes import earth, section, sloping, small_slope

STORM = [["step", HOUR, 12]]
LINES = [0.0, 1.0, 2.0, 3.0, 4.0]


def with_a_narrow_gap(width):
    """The lines of a mesh with two of them `width` apart."""
    return sorted(LINES + [2.0 + width])


def flat_triangle():
    """Four triangles in a square, one of them as flat as rounding."""
    return mesh([(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 1e-11)], [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])


def mesh_cases():
    for kind, triangles in (("quads", False), ("triangles", True)):
        yield Case(f"mesh_{kind}/benign", raining(grid(LINES, LINES, triangles)), STORM)
        for width in (1e-2, 1e-4, 1e-6):  # needles along the gap, and where two gaps cross a cell of width squared
            lines = with_a_narrow_gap(width)
            yield Case(f"mesh_{kind}/needles_{width:g}", raining(grid(lines, LINES, triangles)), STORM)
            yield Case(f"mesh_{kind}/flat_{width:g}", raining(grid(LINES, lines, triangles)), STORM)
            yield Case(f"mesh_{kind}/tiny_{width**2:g}", raining(grid(lines, lines, triangles)), STORM)
        yield Case(f"mesh_{kind}/tiny_1e-09", raining(grid(*[with_a_narrow_gap(3.16e-5)] * 2, triangles)), STORM)
        yield Case(f"mesh_{kind}/coincident", raining(grid(with_a_narrow_gap(1e-9), LINES, triangles)), STORM,
                   refusal="at the same place", why="nodes within 1e-9 of the mesh's extent are one node twice")
    yield Case("mesh_triangles/no_area", raining(flat_triangle()), STORM, refusal="no area", why="a flat cell has no answer")


def level_ground(width, height, cell_width, cell_height, largest):
    """Level ground of one soil."""
    ground = section([[0, height], [width, height]], [[0, 0], [width, 0]], cell_width, cell_height, largest, [{"soil": "earth"}])
    return sloping(ground, [earth()], table=0.5 * height)


def domain_cases():
    yield Case("domain/benign", level_ground(10, 10, 2, 0.5, 1), STORM)
    yield Case("domain/tall_thin", level_ground(1, 1000, 0.5, 0.5, 20), STORM)
    yield Case("domain/flat_wide", level_ground(1000, 1, 20, 0.1, 0.2), STORM)
    yield Case("domain/flat_and_very_wide", level_ground(1e5, 1, 2000, 0.1, 0.2), STORM)
    yield Case("slope_size/benign", small_slope(), STORM)
    for name, scale in (("1_m", 1 / 14), ("1_km", 1000 / 14), ("100_km", 1e5 / 14)):
        yield Case(f"slope_size/{name}", small_slope(scale, young=1e7 * max(scale, 1)), STORM)
    yield Case("slope_size/30_km_soft", small_slope(3e4 / 14), STORM, refusal="too soft to stay in equilibrium",
               why="its weight outweighs its stiffness: any displacement grows sevenfold from step to step")


def cases():
    yield from mesh_cases()
    yield from domain_cases()
