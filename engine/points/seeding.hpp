// Material points of a Cartesian background, cut out of a fitted mesh: each has the exact volume of its part of the ground.
#pragma once

#include "ground/mesh.hpp"
#include "points/free_points.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace talus {

struct SeededPoints {
    FreePoints points;          ///< at rest, without stress
    std::vector<int32_t> cell;  ///< the cell of the mesh that the largest part of each point is of
};

/// Two points a cell of the grid and direction: one for the ground of each soil in a quarter of a grid cell, at its centroid. Less than a
/// tenth of a quarter joins the ground of the same soil beside it. The mesh is a plane one; `corner` (m) is any corner of the grid's cells;
/// `density`: one a soil, kg/m3. Throws Error(invalid_scene) where there would be too many points.
SeededPoints seed_points(const Mesh& mesh, double cell_size, std::array<double, 2> corner,
                         std::span<const double> density);

}  // namespace talus
