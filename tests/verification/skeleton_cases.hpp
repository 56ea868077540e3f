// Patch test and manufactured solution of the elastic skeleton on distorted meshes.
#pragma once

#include "verification/distorted.hpp"

#include <limits>
#include <numbers>

namespace talus::test {

struct PatchError {
    double displacement, stress;  ///< largest error over the largest value; infinite where no equilibrium was found
};

/// A rectangle whose edge is displaced linearly in x and y.
inline PatchError skeleton_patch_error(CellKind kind) {
    constexpr double young = 1e7, poisson = 0.3, width = 2, height = 1.5;
    Mesh mesh = distorted_mesh(5, 4, kind, width, height);
    Points points = unstressed_points(mesh);
    const auto prescribed = constrain(mesh, [](double x, double y) {
        const bool edge = is_on_edge(x, y, width, height);
        return std::array<bool, 2>{edge, edge};
    });
    Equilibrium equilibrium(mesh, points, {elastic_solid(young, poisson)}, prescribed, 0);
    LoadArrays loads(mesh, points);
    double largest = 0;
    for (size_t i = 0; i < mesh.position.size(); i += 2) {
        const double x = mesh.position[i], y = mesh.position[i + 1];
        loads.prescribed[i] = 1e-3 * (1 + 2 * x - 3 * y);
        loads.prescribed[i + 1] = 1e-3 * (-2 + 0.7 * x + 1.3 * y);
        largest = std::max({largest, std::abs(loads.prescribed[i]), std::abs(loads.prescribed[i + 1])});
    }
    constexpr double infinite = std::numeric_limits<double>::infinity();
    if (equilibrium.solve(loads.view()).status != EquilibriumStatus::converged) return {infinite, infinite};

    const Eigen::Vector4d strain(2e-3, 1.3e-3, 0, 0.7e-3 - 3e-3);
    const Eigen::Vector4d stress = elastic_stiffness(elasticity(young, poisson)) * strain;
    PatchError error{0, 0};
    for (size_t i = 0; i < loads.prescribed.size(); ++i) {
        error.displacement =
            std::max(error.displacement, std::abs(equilibrium.increment()[i] - loads.prescribed[i]) / largest);
    }
    for (size_t i = 0; i < points.skeleton_stress.size(); ++i) {
        const double difference = points.skeleton_stress[i] - stress[static_cast<Eigen::Index>(i % 4)];
        error.stress = std::max(error.stress, std::abs(difference) / stress.cwiseAbs().maxCoeff());
    }
    return error;
}

/// The curl of psi = sin^2(pi x) sin^2(pi y): it keeps the volume and rests on the unit square's edge, whatever the Poisson ratio.
struct Isochoric {
    static constexpr double shear_modulus = 4e6, scale = 1e-4;
    std::array<double, 2> displacement, body_force;  // m, N/m3

    Isochoric(double x, double y) {
        constexpr double pi = std::numbers::pi;
        const double c2x = std::cos(2 * pi * x), s2x = std::sin(2 * pi * x), c2y = std::cos(2 * pi * y),
                     s2y = std::sin(2 * pi * y);
        const double sx = (1 - c2x) / 2, sy = (1 - c2y) / 2;
        const double laplacian_u = pi * s2y * (2 * pi * pi * c2x) + sx * pi * (-4 * pi * pi * s2y);
        const double laplacian_v = -pi * s2x * (2 * pi * pi * c2y) - sy * pi * (-4 * pi * pi * s2x);
        displacement = {scale * sx * pi * s2y, -scale * sy * pi * s2x};
        body_force = {-shear_modulus * scale * laplacian_u, -shear_modulus * scale * laplacian_v};
    }
};

/// L2 error of the displacement over its norm, on cells x cells of the unit square; infinite where no equilibrium was found.
inline double displacement_error(CellKind kind, int32_t cells, double poisson_ratio) {
    Mesh mesh = distorted_mesh(cells, cells, kind);
    Points points = unstressed_points(mesh);
    const auto prescribed = constrain(mesh, [](double x, double y) {
        const bool edge = is_on_edge(x, y);
        return std::array<bool, 2>{edge, edge};
    });
    const Solid solid = elastic_solid(2 * Isochoric::shear_modulus * (1 + poisson_ratio), poisson_ratio);
    Equilibrium equilibrium(mesh, points, {solid}, prescribed, 0);
    LoadArrays loads(mesh, points);
    at_points(mesh, points, [&](double value, size_t node, size_t p) {
        const Isochoric field(points.position[2 * p], points.position[2 * p + 1]);
        for (size_t k = 0; k < 2; ++k) loads.force[2 * node + k] += value * points.volume[p] * field.body_force[k];
    });
    if (equilibrium.solve(loads.view()).status != EquilibriumStatus::converged)
        return std::numeric_limits<double>::infinity();
    return relative_error(mesh, points, equilibrium.increment(), 2,
                          [](double x, double y, size_t k) { return Isochoric(x, y).displacement[k]; });
}

}  // namespace talus::test
