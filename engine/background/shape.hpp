// Linear shape functions on the fitted mesh's cells and their quadrature, one struct a shape, so that a loop over cells
// of one shape is compiled for it. Node order is that of Mesh::cell_nodes: a line upwards, plane cells
// counter-clockwise.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace talus {

/// Line on -1 <= xi <= 1; two Gauss points, exact for cubics.
struct Line2 {
    static constexpr size_t nodes = 2;
    static constexpr size_t dimension = 1;
    static constexpr size_t points = 2;
    using Natural = std::array<double, dimension>;
    using Values = std::array<double, nodes>;
    using Gradients = std::array<std::array<double, dimension>, nodes>;

    static constexpr double gauss = 0.57735026918962576451;  // 1 / sqrt(3)
    static constexpr std::array<Natural, points> point = {{{-gauss}, {gauss}}};
    static constexpr std::array<double, points> weight = {1, 1};
    static constexpr Natural centre = {0};

    static constexpr Values values(const Natural& at) { return {(1 - at[0]) / 2, (1 + at[0]) / 2}; }
    static constexpr Gradients gradients(const Natural&) { return {{{-0.5}, {0.5}}}; }
};

/// Triangle (0,0) (1,0) (0,1); three interior points, exact for quadratics.
struct Tri3 {
    static constexpr size_t nodes = 3;
    static constexpr size_t dimension = 2;
    static constexpr size_t points = 3;
    using Natural = std::array<double, dimension>;
    using Values = std::array<double, nodes>;
    using Gradients = std::array<std::array<double, dimension>, nodes>;

    static constexpr std::array<Natural, points> point = {{{1. / 6, 1. / 6}, {2. / 3, 1. / 6}, {1. / 6, 2. / 3}}};
    static constexpr std::array<double, points> weight = {1. / 6, 1. / 6, 1. / 6};
    static constexpr Natural centre = {1. / 3, 1. / 3};

    static constexpr Values values(const Natural& at) { return {1 - at[0] - at[1], at[0], at[1]}; }
    static constexpr Gradients gradients(const Natural&) { return {{{-1, -1}, {1, 0}, {0, 1}}}; }
};

/// Square on -1 <= xi, eta <= 1, from (-1,-1) counter-clockwise; 2 x 2 Gauss points in the same order, exact for
/// bicubics.
struct Quad4 {
    static constexpr size_t nodes = 4;
    static constexpr size_t dimension = 2;
    static constexpr size_t points = 4;
    using Natural = std::array<double, dimension>;
    using Values = std::array<double, nodes>;
    using Gradients = std::array<std::array<double, dimension>, nodes>;

    static constexpr double gauss = Line2::gauss;
    static constexpr std::array<Natural, points> point = {
        {{-gauss, -gauss}, {gauss, -gauss}, {gauss, gauss}, {-gauss, gauss}}};
    static constexpr std::array<double, points> weight = {1, 1, 1, 1};
    static constexpr Natural centre = {0, 0};

    static constexpr Values values(const Natural& at) {
        const auto [xi, eta] = at;
        return {(1 - xi) * (1 - eta) / 4, (1 + xi) * (1 - eta) / 4, (1 + xi) * (1 + eta) / 4, (1 - xi) * (1 + eta) / 4};
    }
    static constexpr Gradients gradients(const Natural& at) {
        const auto [xi, eta] = at;
        return {{{-(1 - eta) / 4, -(1 - xi) / 4},
                 {(1 - eta) / 4, -(1 + xi) / 4},
                 {(1 + eta) / 4, (1 + xi) / 4},
                 {-(1 + eta) / 4, (1 - xi) / 4}}};
    }
};

/// Places of a cell's nodes, m.
template <class Shape>
using NodePlaces = std::array<std::array<double, Shape::dimension>, Shape::nodes>;

/// A shape mapped to the ground at one place of a cell.
template <class Shape>
struct Mapped {
    typename Shape::Values value;        ///< N, -
    typename Shape::Gradients gradient;  ///< dN/dx, 1/m
    double determinant;  ///< of dx/dxi: times the quadrature weight it is the point's length (m) or area (m2)
};

/// N, dN/dx and det(dx/dxi) at a natural place of the cell whose nodes are at `places`.
template <class Shape>
constexpr Mapped<Shape> map_shape(const NodePlaces<Shape>& places, const typename Shape::Natural& at) {
    const auto natural = Shape::gradients(at);
    Mapped<Shape> mapped{Shape::values(at), {}, 0};
    if constexpr (Shape::dimension == 1) {
        double dx = 0;
        for (size_t i = 0; i < Shape::nodes; ++i) dx += natural[i][0] * places[i][0];
        mapped.determinant = dx;
        for (size_t i = 0; i < Shape::nodes; ++i) mapped.gradient[i][0] = natural[i][0] / dx;
    } else {
        double x_xi = 0, x_eta = 0, y_xi = 0, y_eta = 0;
        for (size_t i = 0; i < Shape::nodes; ++i) {
            x_xi += natural[i][0] * places[i][0];
            x_eta += natural[i][1] * places[i][0];
            y_xi += natural[i][0] * places[i][1];
            y_eta += natural[i][1] * places[i][1];
        }
        mapped.determinant = x_xi * y_eta - x_eta * y_xi;
        for (size_t i = 0; i < Shape::nodes; ++i) {
            mapped.gradient[i][0] = (natural[i][0] * y_eta - natural[i][1] * y_xi) / mapped.determinant;
            mapped.gradient[i][1] = (natural[i][1] * x_xi - natural[i][0] * x_eta) / mapped.determinant;
        }
    }
    return mapped;
}

/// Place in the ground (m) of a natural place of a cell.
template <class Shape>
constexpr std::array<double, Shape::dimension> place_in_cell(const NodePlaces<Shape>& places,
                                                             const typename Shape::Natural& at) {
    const auto value = Shape::values(at);
    std::array<double, Shape::dimension> place{};
    for (size_t i = 0; i < Shape::nodes; ++i) {
        for (size_t k = 0; k < Shape::dimension; ++k) place[k] += value[i] * places[i][k];
    }
    return place;
}

/// Places of a cell's nodes, gathered from `position` (nodes x dimension, m) by its node numbers.
template <class Shape>
constexpr NodePlaces<Shape> gather_places(const double* position, const int32_t* cell_nodes) {
    NodePlaces<Shape> places{};
    for (size_t i = 0; i < Shape::nodes; ++i) {
        for (size_t k = 0; k < Shape::dimension; ++k) {
            places[i][k] = position[static_cast<size_t>(cell_nodes[i]) * Shape::dimension + k];
        }
    }
    return places;
}

/// Calls `use` with the shape that has this many nodes (2, 3 or 4).
template <class Use>
constexpr decltype(auto) with_shape(int32_t nodes, Use&& use) {
    if (nodes == 2) return use(Line2{});
    if (nodes == 3) return use(Tri3{});
    return use(Quad4{});
}

}  // namespace talus
