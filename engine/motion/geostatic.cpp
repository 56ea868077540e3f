#include "motion/geostatic.hpp"

#include <algorithm>
#include <limits>

namespace talus {

namespace {

struct Interval {
    double low, high;
};

/// The part of the vertical line at x that lies in a convex cell; empty (low > high) where it passes by.
Interval vertical_cut(const Mesh& mesh, size_t cell, double x) {
    Interval cut{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    const auto first = static_cast<size_t>(mesh.cell_start[cell]),
               last = static_cast<size_t>(mesh.cell_start[cell + 1]);
    for (size_t k = first; k < last; ++k) {
        const double* const a = mesh.position.data() + 2 * static_cast<size_t>(mesh.cell_nodes[k]);
        const double* const b =
            mesh.position.data() + 2 * static_cast<size_t>(mesh.cell_nodes[k + 1 < last ? k + 1 : first]);
        if (std::min(a[0], b[0]) > x || std::max(a[0], b[0]) < x || a[0] == b[0]) continue;
        const double y = a[1] + (x - a[0]) / (b[0] - a[0]) * (b[1] - a[1]);
        cut = {std::min(cut.low, y), std::max(cut.high, y)};
    }
    return cut;
}

Interval column_cut(const Mesh& mesh, size_t cell) {
    const double a = mesh.position[static_cast<size_t>(mesh.cell_nodes[static_cast<size_t>(mesh.cell_start[cell])])];
    const double b =
        mesh.position[static_cast<size_t>(mesh.cell_nodes[static_cast<size_t>(mesh.cell_start[cell]) + 1])];
    return {std::min(a, b), std::max(a, b)};
}

std::vector<double> cell_means(const Points& points, std::span<const double> value, size_t cells) {
    std::vector<double> means(cells, 0.0);
    for (size_t c = 0; c < cells; ++c) {
        double volume = 0;
        for (auto p = static_cast<size_t>(points.cell_start[c]); p < static_cast<size_t>(points.cell_start[c + 1]);
             ++p) {
            means[c] += points.volume[p] * value[p];
            volume += points.volume[p];
        }
        means[c] /= volume;
    }
    return means;
}

// The whole weight is one load that cannot be put on in parts: stress that the elastic solution gave stiff ground moves far.
constexpr int32_t most_steps_at_start = 2000;

}  // namespace

EquilibriumOutcome settle_in_place(Equilibrium& equilibrium, const Loads& loads, int32_t most_creep_steps) {
    const EquilibriumOutcome outcome = equilibrium.solve(loads, Equilibrium::tolerance, most_creep_steps);
    if (outcome.status == EquilibriumStatus::converged) equilibrium.accept_stress();
    return outcome;
}

EquilibriumOutcome turn_on_gravity_elastically(Equilibrium& equilibrium, const Loads& loads) {
    const EquilibriumOutcome elastic = equilibrium.solve_elastically(loads);
    if (elastic.status == EquilibriumStatus::converged) equilibrium.accept_stress();
    return elastic;
}

EquilibriumOutcome turn_on_gravity(Equilibrium& equilibrium, const Loads& loads) {
    const EquilibriumOutcome elastic = turn_on_gravity_elastically(equilibrium, loads);
    if (elastic.status != EquilibriumStatus::converged) return elastic;
    return settle_in_place(equilibrium, loads, most_steps_at_start);
}

void put_k0_stress(const Mesh& mesh, Points& points, const Loads& loads, double gravity, double k0) {
    const auto cells = static_cast<size_t>(mesh.cell_count());
    const auto dimension = static_cast<size_t>(mesh.dimension);
    const std::vector<double> density = cell_means(points, loads.density, cells);
    for (size_t p = 0; p < static_cast<size_t>(points.count); ++p) {
        const double x = points.position[p * dimension];
        const double y = points.position[p * dimension + dimension - 1];
        double weight = 0;
        for (size_t c = 0; c < cells; ++c) {
            const Interval cut = dimension == 1 ? column_cut(mesh, c) : vertical_cut(mesh, c, x);
            weight += density[c] * gravity * std::max(cut.high - std::max(cut.low, y), 0.0);
        }
        const double vertical = loads.pore_stress[p] - weight;
        const std::array<double, 4> stress = {k0 * vertical, vertical, k0 * vertical, 0};
        std::copy(stress.begin(), stress.end(), points.skeleton_stress.begin() + static_cast<std::ptrdiff_t>(4 * p));
    }
}

EquilibriumOutcome set_k0_stress(Equilibrium& equilibrium, const Mesh& mesh, Points& points, const Loads& loads,
                                 double gravity, double k0) {
    put_k0_stress(mesh, points, loads, gravity, k0);
    equilibrium.accept_stress();
    return settle_in_place(equilibrium, loads, most_steps_at_start);
}

}  // namespace talus
