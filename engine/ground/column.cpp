#include "error.hpp"
#include "ground/builders.hpp"
#include "ground/quality.hpp"
#include "ground/sides.hpp"
#include "ground/text.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

/// Cell boundary (counted from the base) at the top of each layer, from the uppermost layer down.
std::vector<int32_t> layer_boundaries(const ColumnGround& column) {
    const double spacing = column.height / column.cells;
    const size_t count = column.layers.size();
    std::vector<int32_t> boundary(count);
    int32_t below = 0;
    for (size_t k = count; k-- > 0;) {
        const double top = k == 0 ? column.height : column.layers[k].top;
        const double bottom = k + 1 < count ? column.layers[k + 1].top : 0;
        if (!(top - bottom >= spacing * (1 - 1e-9))) {
            throw Error(Status::invalid_scene, "ground.column.layers[" + std::to_string(k) + "]: is " +
                                                   number_text(top - bottom) + " m thick, thinner than a cell (" +
                                                   number_text(spacing) +
                                                   " m); give the column more cells or the layer more thickness");
        }
        boundary[k] = std::max(below + 1, static_cast<int32_t>(std::lround(top / spacing)));
        below = boundary[k];
    }
    return boundary;
}

}  // namespace

Mesh build_column(const Scene& scene) {
    const ColumnGround& column = scene.ground.column;
    const std::vector<int32_t> boundary = layer_boundaries(column);

    Mesh mesh;
    mesh.dimension = 1;
    mesh.position = {0};
    mesh.cell_start = {0};
    int32_t first = 0;
    double bottom = 0;
    for (size_t k = column.layers.size(); k-- > 0;) {
        const std::string path = "ground.column.layers[" + std::to_string(k) + "].soil";
        const int32_t soil = find_soil(scene, column.layers[k].soil, path);
        const double top = k == 0 ? column.height : column.layers[k].top;
        const int32_t cells = boundary[k] - first;
        for (int32_t i = 1; i <= cells; ++i) {
            const int32_t cell = first + i - 1;
            mesh.position.push_back(i == cells ? top : bottom + (top - bottom) * i / cells);
            mesh.cell_nodes.insert(mesh.cell_nodes.end(), {cell, cell + 1});
            mesh.cell_start.push_back(2 * (cell + 1));
            mesh.cell_soil.push_back(soil);
        }
        first = boundary[k];
        bottom = top;
    }
    check_mesh(mesh, "ground.column");
    set_sides(mesh);
    return mesh;
}

}  // namespace talus
