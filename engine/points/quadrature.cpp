#include "points/quadrature.hpp"

namespace talus {
namespace {

/// Calls visit(shape, the cell's first corner in Mesh::cell_nodes, its first point) for every cell.
template <class Visit>
void each_cell(const Mesh& mesh, const Points& points, Visit visit) {
    for (size_t c = 0; c < mesh.cell_soil.size(); ++c) {
        const int32_t first = mesh.cell_start[c];
        with_shape(mesh.cell_start[c + 1] - first, [&](auto shape) {
            visit(shape, static_cast<size_t>(first), static_cast<size_t>(points.cell_start[c]));
        });
    }
}

}  // namespace

Points make_points(const Mesh& mesh) {
    Points points;
    points.dimension = mesh.dimension;
    points.cell_start.assign(1, 0);
    for (size_t c = 0; c < mesh.cell_soil.size(); ++c) {
        const int32_t first = mesh.cell_start[c];
        with_shape(mesh.cell_start[c + 1] - first, [&](auto shape) {
            using Shape = decltype(shape);
            const auto places = gather_places<Shape>(mesh.position.data(), mesh.cell_nodes.data() + first);
            for (size_t i = 0; i < Shape::points; ++i) {
                const auto place = place_in_cell<Shape>(places, Shape::point[i]);
                points.position.insert(points.position.end(), place.begin(), place.end());
                points.volume.push_back(map_shape<Shape>(places, Shape::point[i]).determinant * Shape::weight[i]);
                points.soil.push_back(mesh.cell_soil[c]);
            }
        });
        points.cell_start.push_back(static_cast<int32_t>(points.soil.size()));
    }
    points.count = points.cell_start.back();
    return points;
}

void interpolate(const Mesh& mesh, const Points& points, std::span<const int32_t> corner_index,
                 std::span<const double> value, std::span<double> point_value) {
    each_cell(mesh, points, [&](auto shape, size_t corner, size_t first) {
        using Shape = decltype(shape);
        for (size_t i = 0; i < Shape::points; ++i) {
            const auto share = Shape::values(Shape::point[i]);
            double sum = 0;
            for (size_t a = 0; a < Shape::nodes; ++a)
                sum += share[a] * value[static_cast<size_t>(corner_index[corner + a])];
            point_value[first + i] = sum;
        }
    });
}

void interpolate_gradient(const Mesh& mesh, const Points& points, std::span<const double> node_value,
                          std::span<double> gradient) {
    each_cell(mesh, points, [&](auto shape, size_t corner, size_t first) {
        using Shape = decltype(shape);
        const int32_t* nodes = mesh.cell_nodes.data() + corner;
        const auto places = gather_places<Shape>(mesh.position.data(), nodes);
        for (size_t i = 0; i < Shape::points; ++i) {
            const auto mapped = map_shape<Shape>(places, Shape::point[i]);
            for (size_t k = 0; k < Shape::dimension; ++k) {
                double value = 0;
                for (size_t a = 0; a < Shape::nodes; ++a)
                    value += mapped.gradient[a][k] * node_value[static_cast<size_t>(nodes[a])];
                gradient[(first + i) * Shape::dimension + k] = value;
            }
        }
    });
}

}  // namespace talus
