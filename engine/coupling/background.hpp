// The Cartesian background of a dynamic ground as the scene has it: its cells, the walls that hold the ground, and its ends.
#pragma once

#include "ground/mesh.hpp"
#include "motion/explicit/walled_grid.hpp"
#include "points/free_points.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <vector>

namespace talus {

struct Background {
    /// At most the scene's, and such that two upright walls lie a whole number of cells apart, m.
    double cell_size = 0;
    Walls walls;  ///< sides that hold the ground, and ends that stop it
};

/// About the ground of a mesh as it lies. Throws Error(invalid_scene) where a wall is not a straight side along an axis.
Background make_background(const Scene& scene, const Mesh& mesh);

/// Throws Error(invalid_scene) where the ground does not lie between the ends.
void check_between_ends(const Dynamics& dynamics, const Mesh& mesh);

/// The points that have come to an end: beyond it, or within a cell of one that stops them.
std::vector<int32_t> points_at_ends(const Dynamics& dynamics, const FreePoints& points, double cell_size);

}  // namespace talus
