// The boundary of a mesh and the names of its sides.
#pragma once

#include "ground/mesh.hpp"

namespace talus {

enum SideNumber : int32_t { side_base = 0, side_left = 1, side_right = 2, side_surface = 3 };

/// Sets `sides` to base, left, right, surface, and `facets` to all boundary facets of a checked mesh, by geometry:
///   - column: the lowest node is the base, the highest one the surface;
///   - plane: the outer boundary, walked counter-clockwise, is cut at four corners: the lowest node of the smallest x,
///     the lowest and the highest node of the largest x, and the highest node of the smallest x. The pieces between
///     them are base, right, surface and left. So steps in the bedrock belong to the base, cliffs and overhangs to the
///     surface, and where the ground ends in a point it has no left or right side;
///   - boundaries of holes get a side of their own, `hole`, which only then exists.
/// Plane facets follow each other along the boundary: the base from the left, then right, surface (from the right),
/// left, holes.
void set_sides(Mesh& mesh);

}  // namespace talus
