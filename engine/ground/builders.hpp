// One builder a kind of ground. Column and section give sound meshes by construction, but are checked all the same.
#pragma once

#include "ground/mesh.hpp"
#include "scene/scene.hpp"

#include <string>

namespace talus {

/// Cells from the base (y = 0) up. The boundaries between layers fall on cell boundaries: each layer gets the whole
/// number of equal cells that puts its top nearest to the column's even spacing. A layer thinner than height / cells is
/// refused.
[[nodiscard]] Mesh build_column(const Scene& scene);

/// Vertical grid lines at every vertex of terrain, base and layer tops, and at most column_width apart between them.
/// Every grid line has the same number of rows in each layer, as many as the deepest place of that layer needs. On each
/// line, from the surface down, cells have surface_cell_height to graded_depth and then grow; where the line has more
/// rows than its depth needs they grow more slowly, and where even equal cells would be too many they shrink in
/// proportion. No cell is higher than the grading says for its depth. A layer that pinches out ends in triangles. Nodes
/// and cells are numbered line by line from the left, from the base up.
[[nodiscard]] Mesh build_section(const Scene& scene);

/// The scene's own arrays, as they are; sides by geometry.
[[nodiscard]] Mesh build_imported(const Scene& scene);

/// A Gmsh file, 2.2 or 4.1, ASCII, with 3-node triangles and 4-node quads in the plane z = 0, turned counter-clockwise
/// where they are not. Every cell belongs to one physical surface, whose name is a soil's. Facets on a named physical
/// line get the side of that name, which is added to the mesh's where it is not base, left, right or surface; all
/// others have their sides by geometry. Physical lines without a name, or inside the ground, say nothing. Nodes are in
/// the order in which cells use them.
[[nodiscard]] Mesh build_gmsh(const Scene& scene);

/// Number of the soil called `name`; `path` is the scene's entry, for the message.
[[nodiscard]] int32_t find_soil(const Scene& scene, const std::string& name, const std::string& path);

}  // namespace talus
