// From the scene's description of the ground to its fitted mesh.
#pragma once

#include "ground/mesh.hpp"
#include "scene/scene.hpp"

namespace talus {

/// The mesh of a validated scene's ground, checked by check_mesh() and with its sides set (ground/sides.hpp).
/// Throws Error(invalid_scene) where the description makes no sound mesh, Error(io) where the mesh file cannot be read.
[[nodiscard]] Mesh build_mesh(const Scene& scene);

}  // namespace talus
