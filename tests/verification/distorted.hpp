// Distorted meshes, and what is integrated over them.
#pragma once

#include "unit/motion_cases.hpp"

#include <algorithm>
#include <cmath>

namespace talus::test {

/// A rectangle of cells whose inner nodes are moved by up to a fifth of a cell each way, without a pattern: however fine the
/// mesh, its cells do not become parallelograms.
inline Mesh distorted_mesh(int32_t columns, int32_t rows, CellKind kind, double width = 1, double height = 1) {
    const auto scattered = [](double i, double j) {  // -0.2 to 0.2
        const double large = std::sin(12.9898 * i + 78.233 * j) * 43758.5453;
        return 0.4 * (large - std::floor(large) - 0.5);
    };
    return grid_mesh(columns, rows, kind, [&](double x, double y) {
        const double i = std::round(x * columns), j = std::round(y * rows);
        const bool inside = i > 0 && i < columns && j > 0 && j < rows;
        const double di = inside ? scattered(i, j) : 0, dj = inside ? scattered(i + 0.5, j) : 0;
        return std::array<double, 2>{width * (i + di) / columns, height * (j + dj) / rows};
    });
}

/// Whether a place lies on the edge of a rectangle.
inline bool is_on_edge(double x, double y, double width = 1, double height = 1) {
    return std::min({x, y, width - x, height - y}) < 1e-9;
}

/// Calls use(N, node, point) for each point of each cell and each of the cell's nodes.
template <class Use>
void at_points(const Mesh& mesh, const Points& points, const Use& use) {
    for (size_t c = 0; c < mesh.cell_soil.size(); ++c) {
        const auto start = static_cast<size_t>(mesh.cell_start[c]);
        with_shape(mesh.cell_start[c + 1] - mesh.cell_start[c], [&](auto shape) {
            using Shape = decltype(shape);
            for (size_t i = 0; i < Shape::points; ++i) {
                const auto value = Shape::values(Shape::point[i]);
                for (size_t a = 0; a < Shape::nodes; ++a) {
                    use(value[a], static_cast<size_t>(mesh.cell_nodes[start + a]),
                        static_cast<size_t>(points.cell_start[c]) + i);
                }
            }
        });
    }
}

/// L2 norm of the error of what is linear in the cells between the values at nodes (nodes x components), over that of
/// exact(x, y, component).
template <class Exact>
double relative_error(const Mesh& mesh, const Points& points, std::span<const double> nodal, size_t components,
                      const Exact& exact) {
    std::vector<double> found(points.volume.size() * components, 0.0);
    at_points(mesh, points, [&](double value, size_t node, size_t p) {
        for (size_t k = 0; k < components; ++k) found[components * p + k] += value * nodal[components * node + k];
    });
    double squared = 0, reference = 0;
    for (size_t p = 0; p < points.volume.size(); ++p) {
        for (size_t k = 0; k < components; ++k) {
            const double right = exact(points.position[2 * p], points.position[2 * p + 1], k);
            squared += points.volume[p] * std::pow(found[components * p + k] - right, 2);
            reference += points.volume[p] * std::pow(right, 2);
        }
    }
    return std::sqrt(squared / reference);
}

}  // namespace talus::test
