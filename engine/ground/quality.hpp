// What every mesh must be before anything is computed on it.
#pragma once

#include "ground/mesh.hpp"

#include <string>

namespace talus {

/// Throws Error(invalid_scene), naming the scene's entry `path` and the cell or node (from 0) and its place, unless
///   - the arrays fit together, every number is finite and in range, every cell has 2 (column), 3 or 4 (plane)
///     different nodes;
///   - every cell is counter-clockwise with a positive Jacobian at all its corners (a column's cells go upwards);
///   - every node belongs to a cell, and no two nodes are at one place;
///   - every edge belongs to one or two cells that lie on its two sides, the boundary passes every node at most once,
///     and the cells are one piece connected by edges.
/// Facets and sides are not looked at. Soils are only checked for being >= 0.
void check_mesh(const Mesh& mesh, const std::string& path);

}  // namespace talus
