// Points as the quadrature of the fitted mesh: where they start, and what they take from the nodes.
#pragma once

#include "background/shape.hpp"
#include "ground/mesh.hpp"
#include "points/points.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

namespace talus {

/// The quadrature points of every cell, with their soil, position and volume. No other field is sized.
Points make_points(const Mesh& mesh);

/// Value at every point of a field known at the cells' corners: corner k of Mesh::cell_nodes has value[corner_index[k]]. For a node
/// field, corner_index is Mesh::cell_nodes itself.
void interpolate(const Mesh& mesh, const Points& points, std::span<const int32_t> corner_index,
                 std::span<const double> value, std::span<double> point_value);

/// Gradient of a node field at every point: points x dimension, per m.
void interpolate_gradient(const Mesh& mesh, const Points& points, std::span<const double> node_value,
                          std::span<double> gradient);

/// Values at a place in a cell, from its points: linear over them, kept within their range. `rows`: the values of the cell's points.
template <class Shape>
void sample_points(const double* rows, int64_t components, const typename Shape::Natural& at,
                   std::span<double> values) {
    // The points are the corners of a smaller copy of the cell about its centre, in the same order.
    typename Shape::Natural place = at;
    if constexpr (Shape::nodes == 3) {
        place = {2.0 * at[0] - 1.0 / 3.0, 2.0 * at[1] - 1.0 / 3.0};
    } else {
        for (double& coordinate : place) coordinate /= Shape::gauss;
    }
    const auto share = Shape::values(place);
    for (size_t k = 0; k < static_cast<size_t>(components); ++k) {
        double low = rows[k];
        double high = rows[k];
        double value = 0;
        for (size_t i = 0; i < Shape::points; ++i) {
            const double here = rows[i * static_cast<size_t>(components) + k];
            value += share[i] * here;
            low = std::min(low, here);
            high = std::max(high, here);
        }
        values[k] = std::clamp(value, low, high);
    }
}

}  // namespace talus
