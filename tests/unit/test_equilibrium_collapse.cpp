// Collapse is proved, not guessed; and the bearing capacity of a footing as a fast check of the plastic limit.
#include "motion/geostatic.hpp"
#include "unit/motion_cases.hpp"
#include "verification/footing.hpp"

#include <doctest/doctest.h>

#include <numbers>

using namespace talus;
using namespace talus::test;

namespace {

/// A vertical cut 1 m high in level ground, under its own weight.
EquilibriumOutcome stand_vertical_cut(CellKind kind, double cohesion) {
    const auto place = [](double x, double y) { return std::array<double, 2>{3 * x, y}; };
    Mesh mesh = grid_mesh(24, 8, kind, place);
    Points points = unstressed_points(mesh);
    const auto prescribed = constrain(mesh, [](double x, double y) {
        return std::array<bool, 2>{x < 1e-9 || y < 1e-9, y < 1e-9};
    });
    Equilibrium equilibrium(mesh, points, {mohr_coulomb_solid(1e7, 0.3)}, prescribed, 9.81);
    LoadArrays loads(mesh, points);
    std::fill(loads.density.begin(), loads.density.end(), 2000.0);
    std::fill(loads.strength.begin(), loads.strength.end(), ShearStrength{cohesion, 25});
    return turn_on_gravity(equilibrium, loads.view());
}

}  // namespace

TEST_CASE("collapse: a vertical cut stands or falls by its critical height") {
    // H_c = 4 c / gamma tan(45 + phi / 2) for a plane wedge; 3.83 in place of 4 along a log spiral (Chen 1975).
    const double critical = 9.81 * 2000 / 3.83 / std::tan((45 + 12.5) * std::numbers::pi / 180);
    for (const CellKind kind : {CellKind::quads, CellKind::triangles}) {
        CHECK(stand_vertical_cut(kind, 1.15 * critical).status == EquilibriumStatus::converged);
        const EquilibriumOutcome fallen = stand_vertical_cut(kind, 0.8 * critical);
        CHECK(fallen.status == EquilibriumStatus::no_equilibrium);
        CHECK(fallen.collapse.displacement > fallen.collapse.elastic_displacement);
        CHECK(fallen.collapse.surplus > 0.01);
        CHECK(fallen.collapse.persistence > 0.95);
        CHECK(fallen.collapse.place[0] > 2);  // the wedge behind the cut's face at x = 3
        CHECK(fallen.collapse.place[1] > 0.3);
    }
}

TEST_CASE("collapse: a surplus that falls towards a balance within five times the elastic displacement is no proof") {
    CollapseWatch watch(0.1);
    for (double u = 0.001; u < 0.5; u *= 1.2) CHECK_FALSE(watch.add(u, 0.1 * (1 - u / 0.5), 1));
}

TEST_CASE(
    "collapse: a surplus that stays is proof, but only beyond the elastic displacement and in a steady direction") {
    CollapseWatch steady(0.1), turning(0.1);
    for (double u = 0.001; u < 0.5; u *= 1.2) {
        CHECK(steady.add(u, 0.02, 0.999) == (u > 0.1));
        CHECK_FALSE(turning.add(u, 0.02, 0.9));
    }
}

TEST_CASE("footing: the bearing factor is Prandtl's, from above, on a coarse mesh") {
    for (const CellKind kind : {CellKind::quads, CellKind::triangles}) {
        const Footing footing = press_footing(kind, 6, false);
        CHECK(footing.converged);
        CHECK(footing.bearing_factor / (2 + std::numbers::pi) > 1);
        CHECK(footing.bearing_factor / (2 + std::numbers::pi) < 1.06);
    }
}
