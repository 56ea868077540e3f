// The elastic skeleton: patch tests, gravity, order, locking.
#include "unit/motion_cases.hpp"

#include <doctest/doctest.h>

using namespace talus;
using namespace talus::test;

namespace {

/// The unit square, its inner nodes moved by up to 0.3 of a cell.
std::array<double, 2> distorted(double x, double y) {
    const double inside = std::sin(3.14159265358979 * x) * std::sin(3.14159265358979 * y);
    return {2 * (x + 0.06 * inside * std::sin(13 * x + 7 * y)), 1.5 * (y + 0.06 * inside * std::cos(11 * x - 9 * y))};
}

constexpr double young = 1e7, poisson = 0.3;

/// Boundary displacement of a linear field; returns the largest error of displacement and of stress, relative to the largest ones.
std::array<double, 2> patch_error(CellKind kind) {
    Mesh mesh = grid_mesh(5, 4, kind, distorted);
    Points points = unstressed_points(mesh);
    const auto prescribed = constrain(mesh, [](double x, double y) {
        const bool edge = x < 1e-9 || x > 2 - 1e-9 || y < 1e-9 || y > 1.5 - 1e-9;
        return std::array<bool, 2>{edge, edge};
    });
    const auto field = [](double x, double y) {
        return std::array<double, 2>{1e-3 * (1 + 2 * x - 3 * y), 1e-3 * (-2 + 0.7 * x + 1.3 * y)};
    };
    Equilibrium equilibrium(mesh, points, {elastic_solid(young, poisson)}, prescribed, 9.81);
    LoadArrays loads(mesh, points);
    for (size_t i = 0; 2 * i < mesh.position.size(); ++i) {
        const auto [u, v] = field(mesh.position[2 * i], mesh.position[2 * i + 1]);
        loads.prescribed[2 * i] = u;
        loads.prescribed[2 * i + 1] = v;
    }
    const EquilibriumOutcome outcome = equilibrium.solve(loads.view());
    CHECK(outcome.status == EquilibriumStatus::converged);

    const Eigen::Vector4d strain(2e-3, 1.3e-3, 0, 0.7e-3 - 3e-3);
    const Eigen::Vector4d stress = elastic_stiffness(elasticity(young, poisson)) * strain;
    double displacement_error = 0, stress_error = 0;
    for (size_t i = 0; i < loads.prescribed.size(); ++i) {
        displacement_error = std::max(displacement_error, std::abs(equilibrium.increment()[i] - loads.prescribed[i]));
    }
    for (size_t p = 0; p < points.volume.size(); ++p) {
        for (size_t k = 0; k < 4; ++k) {
            stress_error = std::max(stress_error, std::abs(points.skeleton_stress[4 * p + k] - stress[static_cast<Eigen::Index>(k)]));
        }
    }
    return {displacement_error / 5e-3, stress_error / stress.cwiseAbs().maxCoeff()};
}

}  // namespace

TEST_CASE("equilibrium: a linear field is exact on distorted quads and triangles") {
    for (const CellKind kind : {CellKind::quads, CellKind::triangles}) {
        const auto [displacement, stress] = patch_error(kind);
        CHECK(displacement < 1e-10);
        CHECK(stress < 1e-10);
    }
}

TEST_CASE("equilibrium: a column under gravity and pore pressure carries its exact stress") {
    Mesh mesh = column_mesh(20, 10);
    Points points = unstressed_points(mesh);
    std::vector<uint8_t> prescribed(mesh.position.size(), 0);
    prescribed[0] = 1;
    Equilibrium equilibrium(mesh, points, {elastic_solid(young, poisson)}, prescribed, 9.81);
    LoadArrays loads(mesh, points);
    std::fill(loads.density.begin(), loads.density.end(), 2000.0);
    for (size_t p = 0; p < loads.pore_stress.size(); ++p) loads.pore_stress[p] = 1000 * 9.81 * (10 - points.position[p]);
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
