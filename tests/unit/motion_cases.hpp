// Meshes, points and loads for the tests of the equilibrium.
#pragma once

#include "background/shape.hpp"
#include "motion/equilibrium.hpp"
#include "points/quadrature.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace talus::test {

enum class CellKind { quads, triangles };
using Map = std::function<std::array<double, 2>(double, double)>;

/// Grid of (columns + 1) x (rows + 1) nodes, numbered row by row; `place` maps (0..1, 0..1) to the ground. Triangles are the
/// quads cut along alternating diagonals.
inline Mesh grid_mesh(int32_t columns, int32_t rows, CellKind kind, const Map& place) {
    Mesh mesh;
    for (int32_t j = 0; j <= rows; ++j) {
        for (int32_t i = 0; i <= columns; ++i) {
            const auto [x, y] = place(static_cast<double>(i) / columns, static_cast<double>(j) / rows);
            mesh.position.insert(mesh.position.end(), {x, y});
        }
    }
    mesh.cell_start.push_back(0);
    const auto add = [&](std::initializer_list<int32_t> nodes) {
        mesh.cell_nodes.insert(mesh.cell_nodes.end(), nodes);
        mesh.cell_start.push_back(static_cast<int32_t>(mesh.cell_nodes.size()));
        mesh.cell_soil.push_back(0);
    };
    for (int32_t j = 0; j < rows; ++j) {
        for (int32_t i = 0; i < columns; ++i) {
            const int32_t a = j * (columns + 1) + i, b = a + 1, c = b + columns + 1, d = a + columns + 1;
            if (kind == CellKind::quads) {
                add({a, b, c, d});
            } else if ((i + j) % 2 == 0) {
                add({a, b, c});
                add({a, c, d});
            } else {
                add({a, b, d});
                add({b, c, d});
            }
        }
    }
    return mesh;
}

inline Mesh column_mesh(int32_t cells, double height) {
    Mesh mesh;
    mesh.dimension = 1;
    mesh.cell_start.push_back(0);
    for (int32_t i = 0; i <= cells; ++i) mesh.position.push_back(height * i / cells);
    for (int32_t i = 0; i < cells; ++i) {
        mesh.cell_nodes.insert(mesh.cell_nodes.end(), {i, i + 1});
        mesh.cell_start.push_back(2 * (i + 1));
        mesh.cell_soil.push_back(0);
    }
    return mesh;
}

/// The cells' quadrature points, without stress.
inline Points unstressed_points(const Mesh& mesh) {
    Points points = make_points(mesh);
    const auto count = static_cast<size_t>(points.count);
    points.displacement.assign(points.position.size(), 0.0);
    points.skeleton_stress.assign(4 * count, 0.0);
    points.strain.assign(4 * count, 0.0);
    points.plastic_strain.assign(count, 0.0);
    points.mobilised_strength.assign(count, 0.0);
    return points;
}

/// What prescribes the displacement of a node: (x, y) -> {x prescribed, y prescribed}.
inline std::vector<uint8_t> constrain(const Mesh& mesh,
                                      const std::function<std::array<bool, 2>(double, double)>& where) {
    std::vector<uint8_t> prescribed(mesh.position.size(), 0);
    for (size_t i = 0; 2 * i < prescribed.size(); ++i) {
        const auto [x, y] = where(mesh.position[2 * i], mesh.position[2 * i + 1]);
        prescribed[2 * i] = x;
        prescribed[2 * i + 1] = y;
    }
    return prescribed;
}

/// Loads that own their arrays: none, until they are filled.
struct LoadArrays {
    std::vector<double> density, pore_stress, force, prescribed;
    std::vector<ShearStrength> strength;

    LoadArrays(const Mesh& mesh, const Points& points)
        : density(points.volume.size(), 0.0),
          pore_stress(points.volume.size(), 0.0),
          force(mesh.position.size(), 0.0),
          prescribed(mesh.position.size(), 0.0),
          strength(points.volume.size(), ShearStrength{0, 0}) {}

    [[nodiscard]] Loads view() const { return {density, pore_stress, strength, force, prescribed}; }
};

inline Solid elastic_solid(double young_modulus, double poisson_ratio) {
    Solid solid;
    solid.model = SolidModel::elastic;
    solid.young_modulus = young_modulus;
    solid.poisson_ratio = poisson_ratio;
    return solid;
}

inline Solid mohr_coulomb_solid(double young_modulus, double poisson_ratio) {
    Solid solid = elastic_solid(young_modulus, poisson_ratio);
    solid.model = SolidModel::mohr_coulomb;
    return solid;
}

}  // namespace talus::test
