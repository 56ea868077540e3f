// Initial stress: gravity and K0.
#include "motion/geostatic.hpp"
#include "unit/motion_cases.hpp"

#include <doctest/doctest.h>

using namespace talus;
using namespace talus::test;

namespace {

constexpr double gravity = 9.81, density = 1900, height = 10;

/// Level ground between rollers.
struct Level {
    Mesh mesh;
    Points points;
    Equilibrium equilibrium;
    LoadArrays loads;

    explicit Level(CellKind kind, double poisson_ratio)
        : mesh(grid_mesh(4, 10, kind,
                         [](double x, double y) {
                             return std::array<double, 2>{5 * x, height * y};
                         })),
          points(unstressed_points(mesh)),
          equilibrium(mesh, points, {mohr_coulomb_solid(2e7, poisson_ratio)},
                      constrain(mesh,
                                [](double x, double y) {
                                    return std::array<bool, 2>{x < 1e-9 || x > 5 - 1e-9, y < 1e-9};
                                }),
                      gravity),
          loads(mesh, points) {
        std::fill(loads.density.begin(), loads.density.end(), density);
        std::fill(loads.strength.begin(), loads.strength.end(), ShearStrength{5e3, 30});
        for (size_t p = 0; p < loads.pore_stress.size(); ++p) {  // water table 4 m below the surface
            loads.pore_stress[p] = std::max(0.0, 9810 * (height - 4 - points.position[2 * p + 1]));
        }
    }

    /// Largest error of the cells' mean stress against `horizontal` = ratio * vertical, vertical = -weight above + pore stress, Pa.
    [[nodiscard]] double stress_error(double ratio) const {
        double largest = 0;
        for (size_t c = 0; c < mesh.cell_soil.size(); ++c) {
            double vertical = 0, mean = 0, horizontal = 0, volume = 0;
            for (auto p = static_cast<size_t>(points.cell_start[c]); p < static_cast<size_t>(points.cell_start[c + 1]);
                 ++p) {
                vertical += points.volume[p] *
                            (loads.pore_stress[p] - density * gravity * (height - points.position[2 * p + 1]));
                mean += points.volume[p] * points.skeleton_stress[4 * p + 1];
                horizontal += points.volume[p] * points.skeleton_stress[4 * p];
                volume += points.volume[p];
            }
            largest =
                std::max({largest, std::abs(mean - vertical) / volume, std::abs(horizontal - ratio * mean) / volume});
        }
        return largest;
    }
};

}  // namespace

TEST_CASE("geostatic: gravity turned on elastically gives nu / (1 - nu), and no displacement remains") {
    Level level(CellKind::quads, 0.3);
    CHECK(turn_on_gravity(level.equilibrium, level.loads.view()).status == EquilibriumStatus::converged);
    CHECK(level.stress_error(0.3 / 0.7) < 1e-3);
    for (const double u : level.equilibrium.displacement()) CHECK(u == 0);
    for (const double e : level.points.strain) CHECK(e == 0);
    CHECK(level.equilibrium.least_factor_of_safety() > 1);
}

TEST_CASE("geostatic: gravity on triangles carries the weight") {
    Level level(CellKind::triangles, 0.3);
    CHECK(turn_on_gravity(level.equilibrium, level.loads.view()).status == EquilibriumStatus::converged);
    double total = 0;
    const auto reaction = level.equilibrium.reaction();
    for (size_t i = 1; i < reaction.size(); i += 2) total += reaction[i];
    level.equilibrium.solve(level.loads.view());
    total = 0;
    for (size_t i = 1; i < reaction.size(); i += 2) total += reaction[i];
    CHECK(total == doctest::Approx(density * gravity * 5 * height).epsilon(1e-6));
}

TEST_CASE("geostatic: K0") {
    for (const double k0 : {0.5, 1.0, 1.4}) {
        Level level(CellKind::quads, 0.3);
        const EquilibriumOutcome outcome =
            set_k0_stress(level.equilibrium, level.mesh, level.points, level.loads.view(), gravity, k0);
        CHECK(outcome.status == EquilibriumStatus::converged);
        CHECK(level.stress_error(k0) < 1.0);
        for (const double u : level.equilibrium.displacement()) CHECK(u == 0);
    }
}

TEST_CASE("geostatic: K0 in a column") {
    Mesh mesh = column_mesh(10, height);
    Points points = unstressed_points(mesh);
    std::vector<uint8_t> prescribed(mesh.position.size(), 0);
    prescribed[0] = 1;
    Equilibrium equilibrium(mesh, points, {mohr_coulomb_solid(2e7, 0.3)}, prescribed, gravity);
    LoadArrays loads(mesh, points);
    std::fill(loads.density.begin(), loads.density.end(), density);
    std::fill(loads.strength.begin(), loads.strength.end(), ShearStrength{5e3, 30});
    CHECK(set_k0_stress(equilibrium, mesh, points, loads.view(), gravity, 0.6).status == EquilibriumStatus::converged);
    for (size_t p = 0; p < points.volume.size(); ++p) {
        const double vertical = -density * gravity * (height - points.position[p]);
        CHECK(points.skeleton_stress[4 * p + 1] == doctest::Approx(vertical).epsilon(1e-9));
        CHECK(points.skeleton_stress[4 * p] == doctest::Approx(0.6 * vertical).epsilon(1e-9));
    }
}
