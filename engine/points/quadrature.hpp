// Points as the quadrature of the fitted mesh: where they start, and what they take from the nodes.
#pragma once

#include "background/shape.hpp"
#include "ground/mesh.hpp"
#include "points/points.hpp"

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

}  // namespace talus
