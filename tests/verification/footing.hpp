// Bearing capacity of a rigid strip on weightless soil that yields at constant shear strength (Tresca, undrained): Prandtl's
// N_c = q / c = 2 + pi, whether the strip is rough or smooth.
#pragma once

#include "unit/motion_cases.hpp"

#include <algorithm>
#include <cmath>

namespace talus::test {

struct Footing {
    double bearing_factor = 0;  ///< N_c: mean pressure under the strip over the cohesion, at the last step
    double last_growth = 0;     ///< by how much it still grew over the last step, relative
    int32_t steps = 0;
    int32_t iterations = 0;
    int32_t factorisations = 0;
    bool converged = true;
    int32_t nodes = 0;
};

/// Half of a strip of half width 1 m pressed into a half space (6 m wide, 3 m deep). `cells_under_strip` cells lie under the half
/// strip, finest at its edge, where the stress is singular.
inline Footing press_footing(CellKind kind, int32_t cells_under_strip, bool rough) {
    constexpr double cohesion = 1e5, young = 1e10, poisson = 0.49;  // so stiff that the ground keeps its shape
    constexpr double width = 6, depth = 3;
    const int32_t n = cells_under_strip;
    const int32_t columns = 3 * n, rows = 2 * n;
    // Cells shrink towards the strip's edge from both sides, and towards the surface.
    const auto towards = [](double t, double strength) { return std::expm1(strength * t) / std::expm1(strength); };
    const auto place = [&](double s, double t) -> std::array<double, 2> {
        const double i = s * columns;
        const double x = i <= n ? 1 - towards(1 - i / n, 2.0) : 1 + (width - 1) * towards((i - n) / (2 * n), 3.7);
        return {x, depth * (1 - towards(1 - t, 2.5))};
    };
    Mesh mesh = grid_mesh(columns, rows, kind, place);
    Points points = unstressed_points(mesh);
    const auto is_under = [&](double x, double y) { return y > depth - 1e-9 && x < 1 + 1e-9; };
    const auto prescribed = constrain(mesh, [&](double x, double y) {
        const bool side = x < 1e-9 || x > width - 1e-9, base = y < 1e-9;
        return std::array<bool, 2>{side || base || (rough && is_under(x, y)), base || is_under(x, y)};
    });
    Equilibrium equilibrium(mesh, points, {mohr_coulomb_solid(young, poisson)}, prescribed, 0);
    LoadArrays loads(mesh, points);
    std::fill(loads.strength.begin(), loads.strength.end(), ShearStrength{cohesion, 0});

    Footing result;
    result.nodes = mesh.node_count();
    constexpr int32_t most_steps = 40;
    constexpr double largest_push = 5e-5;
    double push = 1e-5;
    for (; result.steps < most_steps; ++result.steps) {
        for (size_t i = 0; i < mesh.position.size(); i += 2) {
            loads.prescribed[i + 1] = prescribed[i + 1] != 0 && mesh.position[i + 1] > depth / 2 ? -push : 0;
        }
        const EquilibriumOutcome outcome = equilibrium.solve(loads.view());
        result.iterations += outcome.iterations;
        result.factorisations += outcome.factorisations;
        if (outcome.status != EquilibriumStatus::converged) {
            result.converged = false;
            break;
        }
        double force = 0;
        for (size_t i = 0; i < mesh.position.size(); i += 2) {
            if (mesh.position[i + 1] > depth / 2) force -= equilibrium.reaction()[i + 1];
        }
        equilibrium.accept();
        result.last_growth = force / cohesion / std::max(result.bearing_factor, 1e-9) - 1;
        result.bearing_factor = force / cohesion;
        if (result.steps > 5 && std::abs(result.last_growth) < 1e-4) break;
        push = std::min(1.2 * push, largest_push);
    }
    return result;
}

}  // namespace talus::test
