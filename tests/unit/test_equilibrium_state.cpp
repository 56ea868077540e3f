// Accept, reject, restore: the state of the equilibrium, and how stress turns with the ground.
#include "unit/motion_cases.hpp"

#include <doctest/doctest.h>

#include <numbers>

using namespace talus;
using namespace talus::test;

namespace {

struct State {
    Mesh mesh;
    Points points;
    bool operator==(const State& other) const {
        const auto fields = [](const State& s) {
            return std::tie(s.mesh.position, s.points.position, s.points.volume, s.points.displacement,
                            s.points.skeleton_stress, s.points.strain, s.points.plastic_strain,
                            s.points.mobilised_strength);
        };
        return fields(*this) == fields(other);
    }
};

/// A block of soil pressed from above until part of it yields.
struct Block {
    Mesh mesh;
    Points points;
    std::vector<uint8_t> prescribed;
    Equilibrium equilibrium;
    LoadArrays loads;

    explicit Block(CellKind kind)
        : mesh(grid_mesh(6, 6, kind,
                         [](double x, double y) {
                             return std::array<double, 2>{x, y};
                         })),
          points(unstressed_points(mesh)),
          prescribed(
              constrain(mesh,
                        [](double x, double y) {
                            return std::array<bool, 2>{x < 1e-9 || y < 1e-9, y < 1e-9 || (y > 1 - 1e-9 && x < 0.5)};
                        })),
          equilibrium(mesh, points, {mohr_coulomb_solid(1e7, 0.3)}, prescribed, 9.81),
          loads(mesh, points) {
        std::fill(loads.strength.begin(), loads.strength.end(), ShearStrength{4e3, 25});
        std::fill(loads.density.begin(), loads.density.end(), 1800.0);
    }

    EquilibriumOutcome press(double depth) {
        for (size_t i = 0; 2 * i < mesh.position.size(); ++i) {
            const bool is_pressed = mesh.position[2 * i] < 0.5 && prescribed[2 * i + 1] != 0 && i > 6;
            loads.prescribed[2 * i + 1] = is_pressed ? -depth : 0;
        }
        return equilibrium.solve(loads.view());
    }
    [[nodiscard]] State state() const { return {mesh, points}; }
};

}  // namespace

TEST_CASE("equilibrium: reject leaves no trace, and the next step has the same bits as without the rejected one") {
    for (const CellKind kind : {CellKind::quads, CellKind::triangles}) {
        Block block(kind), other(kind);
        for (Block* b : {&block, &other}) {
            CHECK(b->press(1e-3).status == EquilibriumStatus::converged);
            b->equilibrium.accept();
        }
        const State before = block.state();
        CHECK(block.press(5e-3).yielding > 0);
        CHECK_FALSE(block.state() == before);
        block.equilibrium.reject();
        CHECK(block.state() == before);

        block.press(1e-3);
        other.press(1e-3);
        block.equilibrium.accept();
        other.equilibrium.accept();
        CHECK(block.state() == other.state());
    }
}

TEST_CASE("equilibrium: a restored run goes on with the same bits") {
    Block run(CellKind::quads);
    run.press(1e-3);
    run.equilibrium.accept();
    const State saved = run.state();
    const std::vector<double> displacement(run.equilibrium.displacement().begin(),
                                           run.equilibrium.displacement().end());
    run.press(2e-3);
    run.equilibrium.accept();

    Block restored(CellKind::quads);
    restored.mesh.position = saved.mesh.position;
    restored.points = saved.points;
    restored.equilibrium.restore(displacement);
    restored.press(2e-3);
    restored.equilibrium.accept();
    CHECK(restored.state() == run.state());
}

TEST_CASE("equilibrium: a second solve with the same loads starts from the first one's increment") {
    Block block(CellKind::quads);
    CHECK(block.press(1e-3).iterations > 1);
    CHECK(block.press(1e-3).iterations == 0);
}

TEST_CASE("equilibrium: a stress turns with the ground, in one step of 90 degrees or in nine") {
    for (const int32_t steps : {1, 9}) {
        Mesh mesh = grid_mesh(2, 2, CellKind::quads, [](double x, double y) { return std::array<double, 2>{x, y}; });
        Points points = unstressed_points(mesh);
        for (size_t p = 0; p < points.volume.size(); ++p) {
            const std::array<double, 4> stress = {3e4, -1e4, 2e4, 0.5e4};
            std::copy(stress.begin(), stress.end(),
                      points.skeleton_stress.begin() + static_cast<std::ptrdiff_t>(4 * p));
        }
        const std::vector<double> volume = points.volume;
        const std::vector<uint8_t> prescribed(mesh.position.size(), 1);
        Equilibrium equilibrium(mesh, points, {elastic_solid(1e7, 0.3)}, prescribed, 0);
        LoadArrays loads(mesh, points);
        for (int32_t k = 0; k < steps; ++k) {
            const double angle = std::numbers::pi / 2 / steps;
            for (size_t i = 0; i < mesh.position.size(); i += 2) {
                const double x = mesh.position[i], y = mesh.position[i + 1];
                loads.prescribed[i] = std::cos(angle) * x - std::sin(angle) * y - x;
                loads.prescribed[i + 1] = std::sin(angle) * x + std::cos(angle) * y - y;
            }
            CHECK(equilibrium.solve(loads.view()).status == EquilibriumStatus::converged);
            equilibrium.accept();
        }
        // Spin at the midpoint and Cayley's form are exact for a pure rotation, however large.
        for (size_t p = 0; p < points.volume.size(); ++p) {
            CHECK(points.skeleton_stress[4 * p] == doctest::Approx(-1e4).epsilon(1e-9));
            CHECK(points.skeleton_stress[4 * p + 1] == doctest::Approx(3e4).epsilon(1e-9));
            CHECK(points.skeleton_stress[4 * p + 2] == doctest::Approx(2e4).epsilon(1e-9));
            CHECK(points.skeleton_stress[4 * p + 3] == doctest::Approx(-0.5e4).epsilon(1e-9));
            CHECK(std::abs(points.strain[4 * p]) < 1e-12);
            CHECK(points.volume[p] == doctest::Approx(volume[p]).epsilon(1e-12));
        }
    }
}

// A turn by 1e-4 along the nodes' straight ways is 1e-8 of volume: 1e13 Pa / (3 (1 - 2 nu)) times that is 170 MPa of tension.
TEST_CASE("equilibrium: stiff ground that yields keeps its stress in a turn that strains it beyond its strength") {
    Mesh mesh = grid_mesh(1, 1, CellKind::quads, [](double x, double y) { return std::array<double, 2>{x, y}; });
    Points points = unstressed_points(mesh);
    const double turn = 1e-4;
    const std::array<double, 4> stress = {-4e4, -1e4, -2e4, 0};
    for (size_t p = 0; p < points.volume.size(); ++p)
        std::copy(stress.begin(), stress.end(), points.skeleton_stress.begin() + static_cast<std::ptrdiff_t>(4 * p));
    const std::vector<uint8_t> prescribed(mesh.position.size(), 1);
    Equilibrium equilibrium(mesh, points, {mohr_coulomb_solid(1e13, 0.4999)}, prescribed, 0);
    LoadArrays loads(mesh, points);
    std::fill(loads.strength.begin(), loads.strength.end(), ShearStrength{2e3, 30});
    for (size_t i = 0; i < mesh.position.size(); i += 2) {
        loads.prescribed[i] = -turn * mesh.position[i + 1];
        loads.prescribed[i + 1] = turn * mesh.position[i];
    }
    CHECK(equilibrium.solve(loads.view()).yielding > 0);
    const std::vector<double> balanced = points.skeleton_stress;
    equilibrium.accept();
    for (size_t p = 0; p < points.volume.size(); ++p) {
        for (size_t k = 0; k < 3; ++k) {
            CHECK(balanced[4 * p + k] < -5e3);
            CHECK(points.skeleton_stress[4 * p + k] == doctest::Approx(balanced[4 * p + k]).epsilon(1e-6));
        }
    }
}

TEST_CASE("equilibrium: nodes, points and volumes follow the increment") {
    Mesh mesh = grid_mesh(3, 2, CellKind::quads, [](double x, double y) {
        return std::array<double, 2>{x + 0.1 * y, y - 0.1 * x * y};
    });
    Points points = unstressed_points(mesh);
    const std::vector<uint8_t> prescribed(mesh.position.size(), 1);
    Equilibrium equilibrium(mesh, points, {elastic_solid(1e7, 0.3)}, prescribed, 0);
    LoadArrays loads(mesh, points);
    for (size_t i = 0; i < mesh.position.size(); ++i) loads.prescribed[i] = 0.05 * std::sin(static_cast<double>(7 * i));
    equilibrium.solve(loads.view());
    equilibrium.accept();
    const Points expected = make_points(mesh);
    for (size_t i = 0; i < expected.position.size(); ++i)
        CHECK(points.position[i] == doctest::Approx(expected.position[i]).epsilon(1e-12));
    for (size_t p = 0; p < expected.volume.size(); ++p)
        CHECK(points.volume[p] == doctest::Approx(expected.volume[p]).epsilon(1e-12));
    for (size_t i = 0; i < mesh.position.size(); ++i) CHECK(equilibrium.displacement()[i] == loads.prescribed[i]);
}
