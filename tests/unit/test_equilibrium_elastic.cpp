// The elastic skeleton: patch tests, gravity.
#include "verification/skeleton_cases.hpp"

#include <doctest/doctest.h>

using namespace talus;
using namespace talus::test;

TEST_CASE("equilibrium: a linear field is exact on distorted quads and triangles") {
    for (const CellKind kind : {CellKind::quads, CellKind::triangles}) {
        const PatchError error = skeleton_patch_error(kind);
        CHECK(error.displacement < 1e-10);
        CHECK(error.stress < 1e-10);
    }
}

TEST_CASE("equilibrium: a column under gravity and pore pressure carries its exact stress") {
    constexpr double young = 1e7, poisson = 0.3;
    Mesh mesh = column_mesh(20, 10);
    Points points = unstressed_points(mesh);
    std::vector<uint8_t> prescribed(mesh.position.size(), 0);
    prescribed[0] = 1;
    Equilibrium equilibrium(mesh, points, {elastic_solid(young, poisson)}, prescribed, 9.81);
    LoadArrays loads(mesh, points);
    std::fill(loads.density.begin(), loads.density.end(), 2000.0);
    for (size_t p = 0; p < loads.pore_stress.size(); ++p)
        loads.pore_stress[p] = 1000 * 9.81 * (10 - points.position[p]);
    const EquilibriumOutcome outcome = equilibrium.solve(loads.view());
    CHECK(outcome.status == EquilibriumStatus::converged);
    CHECK(outcome.iterations == 1);
    for (size_t c = 0; c < 20; ++c) {  // linear cells carry the mean over a cell
        const double y = (static_cast<double>(c) + 0.5) * 0.5;
        const double vertical = -1000 * 9.81 * (10 - y);
        CHECK(points.skeleton_stress[8 * c + 1] == doctest::Approx(vertical).epsilon(1e-10));
        CHECK(points.skeleton_stress[8 * c] == doctest::Approx(vertical * poisson / (1 - poisson)).epsilon(1e-10));
    }
    CHECK(equilibrium.reaction()[0] == doctest::Approx(2000 * 9.81 * 10).epsilon(1e-10));
}

TEST_CASE("equilibrium: rock that rides on soft ground is balanced as far as displacements can tell") {
    // The last digit of 0.03 m over a cell of 2 m is some 0.1 Pa in a modulus of 4e16 Pa, as much as the tolerance is of these loads.
    Mesh mesh = column_mesh(20, 40);
    std::fill(mesh.cell_soil.begin() + 10, mesh.cell_soil.end(), 1);
    Points points = unstressed_points(mesh);
    for (size_t p = points.soil.size() / 2; p < points.soil.size(); ++p) points.soil[p] = 1;
    std::vector<uint8_t> prescribed(mesh.position.size(), 0);
    prescribed[0] = 1;
    Equilibrium equilibrium(mesh, points, {elastic_solid(7e7, 0.47), elastic_solid(2.6e13, 0.4999)}, prescribed, 9.81);
    LoadArrays loads(mesh, points);
    std::fill(loads.density.begin(), loads.density.end(), 2000.0);
    CHECK(equilibrium.solve(loads.view()).status == EquilibriumStatus::converged);
    CHECK(points.skeleton_stress[8 * 15 + 1] == doctest::Approx(-2000 * 9.81 * 9).epsilon(1e-5));
}
