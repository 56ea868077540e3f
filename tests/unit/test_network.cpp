// The flow's network and the equations on it, rigid ground.
#include "verification/flow_cases.hpp"

#include <doctest/doctest.h>

#include <numeric>
#include <random>

using namespace talus;
using namespace talus::test;

namespace {

Scene rigid_scene(const Conductivity& conductivity) {
    Scene scene = gardner_scene(2e-4, conductivity);
    scene.soils[0].hydraulics.retention = {};
    scene.soils[0].hydraulics.retention.alpha = 4e-5;
    scene.soils[0].hydraulics.retention.n = 1.2;
    scene.soils[0].hydraulics.relative_permeability = {};
    return scene;
}

Mesh mesh_of(CellKind kind, bool distorted) {
    return distorted ? distorted_mesh(4, 3, kind, 2, 1.5) : grid_mesh(4, 3, kind, [](double x, double y) {
        return std::array{2 * x, 1.5 * y};
    });
}

std::vector<double> random_pressures(const Mesh& mesh, std::mt19937& random, double driest) {
    std::uniform_real_distribution<double> exponent(2, std::log10(driest));
    std::vector<double> pressure;
    for (int32_t i = 0; i < mesh.node_count(); ++i) pressure.push_back(-std::pow(10, exponent(random)));
    return pressure;
}

/// Largest difference of the matrix from differences of stored - step inflow, each relative to the largest entry of its column.
double jacobian_error(FlowSystem& system, const std::vector<double>& pressure, double storage, double step) {
    SparseMatrix matrix = system.make_matrix();
    system.evaluate(0, pressure);
    storage > 0 ? system.assemble(step, matrix) : system.assemble_steady(matrix);
    const auto residual = [&](const std::vector<double>& at) {
        system.evaluate(0, at);
        std::vector<double> r(at.size());
        for (size_t i = 0; i < r.size(); ++i) r[i] = storage * system.stored()[i] - step * system.inflow()[i];
        return r;
    };
    double worst = 0;
    for (size_t j = 0; j < pressure.size(); ++j) {
        std::vector<double> before = pressure, after = pressure;
        const double change = 1e-5 * std::abs(pressure[j]);
        before[j] -= change;
        after[j] += change;
        std::vector<double> slope = residual(after);
        const std::vector<double> low = residual(before);
        for (size_t i = 0; i < slope.size(); ++i) slope[i] = (slope[i] - low[i]) / (2 * change);
        double largest = 0, error = 0;
        for (const double s : slope) largest = std::max(largest, std::abs(s));
        for (auto k = static_cast<size_t>(matrix.column_start[j]); k < static_cast<size_t>(matrix.column_start[j + 1]);
             ++k) {
            const auto i = static_cast<size_t>(matrix.row[k]);
            error = std::max(error, std::abs(matrix.value[k] - slope[i]));
            slope[i] = 0;
        }
        for (const double outside : slope) error = std::max(error, std::abs(outside));  // what the pattern leaves out
        worst = std::max(worst, error / largest);
    }
    return worst;
}

}  // namespace

TEST_CASE("links of rectangles do not cross, those of distorted or obliquely bedded cells do") {
    const Conductivity isotropic{1e-5, 1e-5, 0}, oblique{1e-5, 1e-6, 30};
    CHECK(make_network(mesh_of(CellKind::quads, false), rigid_scene(isotropic)).crossings.empty());
    CHECK_FALSE(make_network(mesh_of(CellKind::quads, true), rigid_scene(isotropic)).crossings.empty());
    CHECK(make_network(mesh_of(CellKind::quads, false), rigid_scene(oblique)).crossings.size() == 48);
}

TEST_CASE("the power lost in the flow is never negative, whatever the cells, K and k_r") {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(-1, 1), exponent(-6, 0);
    for (const CellKind kind : {CellKind::quads, CellKind::triangles}) {
        for (const double dip : {0., 25., 70.}) {
            const Network network = make_network(mesh_of(kind, true), rigid_scene({1e-5, 1e-8, dip}));
            for (int trial = 0; trial < 100; ++trial) {
                std::vector<double> permeability, lost;
                double power = 0, own = 0;
                for (size_t l = 0; l < network.links.size(); ++l) {
                    CHECK(network.transmissibility[l] > 0);
                    permeability.push_back(std::pow(10, exponent(random)));
                    lost.push_back(any(random) / std::sqrt(permeability.back() * network.transmissibility[l]));
                    own += network.transmissibility[l] * permeability[l] * lost[l] * lost[l];
                }
                power = own;
                for (size_t c = 0; c < network.crossings.size(); ++c) {
                    const auto a = static_cast<size_t>(network.crossings[c].link_a),
                               b = static_cast<size_t>(network.crossings[c].link_b);
                    power += 2 * network.cross_transmissibility[c] * std::sqrt(permeability[a] * permeability[b]) *
                             lost[a] * lost[b];
                }
                CHECK(power >= -1e-12 * own);
            }
        }
    }
}

TEST_CASE("a head linear in place flows evenly through distorted saturated ground") {
    for (const CellKind kind : {CellKind::quads, CellKind::triangles}) CHECK(flow_patch_error(kind) < 1e-10);
}

TEST_CASE("the flow does not jump where a full node comes to hydrostatic balance with a dry one above it") {
    Scene scene = rigid_scene({1e-4, 1e-4, 0});
    scene.soils[0].hydraulics.retention.alpha = 7e-3;
    scene.soils[0].hydraulics.retention.n = 5.6;
    const double unit_weight = scene.water.density * scene.gravity;
    const Mesh mesh = mesh_of(CellKind::quads, true);
    FlowSystem system = make_flow(scene, mesh, {});
    std::vector<double> pressure;
    for (int32_t i = 0; i < mesh.node_count(); ++i)
        pressure.push_back(unit_weight * (0.75 - mesh.position[2 * static_cast<size_t>(i) + 1]) +
                           50 * mesh.position[2 * static_cast<size_t>(i)]);
    const auto inflow_at = [&](size_t node, double p) {
        std::vector<double> moved = pressure;
        moved[node] = p;
        system.evaluate(0, moved);
        return std::vector<double>(system.inflow().begin(), system.inflow().end());
    };
    int looked_at = 0;
    for (size_t l = 0; l < system.network.links.size(); ++l) {
        const auto a =
            static_cast<size_t>(system.network.portions[static_cast<size_t>(system.network.links[l].portion_a)].node);
        const auto b =
            static_cast<size_t>(system.network.portions[static_cast<size_t>(system.network.links[l].portion_b)].node);
        if (!(pressure[a] > 500 && pressure[b] < -1000)) continue;
        const double balance = pressure[b] - system.network.fall[l];
        const std::vector<double> falling = inflow_at(a, balance - 1e-6), rising = inflow_at(a, balance + 1e-6);
        double jump = 0, largest = 0;
        for (size_t i = 0; i < falling.size(); ++i) {
            jump = std::max(jump, std::abs(rising[i] - falling[i]));
            largest = std::max(largest, std::abs(rising[i]));
        }
        CHECK(jump < 1e-5 * largest);
        ++looked_at;
    }
    CHECK(looked_at > 3);
}

TEST_CASE("what leaves one node enters others") {
    std::mt19937 random(2);
    for (const CellKind kind : {CellKind::quads, CellKind::triangles}) {
        const Scene scene = rigid_scene({1e-5, 2e-6, 25});
        const Mesh mesh = mesh_of(kind, true);
        FlowSystem system = make_flow(scene, mesh, {});
        system.evaluate(0, random_pressures(mesh, random, 1e5));
        double sum = 0, largest = 0;
        for (const double q : system.inflow()) {
            sum += q;
            largest = std::max(largest, std::abs(q));
        }
        CHECK(largest > 0);
        CHECK(std::abs(sum) <= 1e-14 * largest);
    }
}

TEST_CASE("nothing flows through distorted unsaturated ground at hydrostatic pressure") {
    for (const CellKind kind : {CellKind::quads, CellKind::triangles}) {
        const Scene scene = rigid_scene({1e-5, 2e-6, 25});
        const Mesh mesh = mesh_of(kind, true);
        FlowSystem system = make_flow(scene, mesh, {});
        std::vector<double> pressure;
        for (int32_t i = 0; i < mesh.node_count(); ++i)
            pressure.push_back(scene.water.density * scene.gravity *
                               (0.7 - mesh.position[2 * static_cast<size_t>(i) + 1]));
        system.evaluate(0, pressure);
        for (const double q : system.inflow()) CHECK(std::abs(q) < 1e-18);
    }
}

TEST_CASE("the flow's matrix is the derivative of its equations") {
    std::mt19937 random(3);
    for (const CellKind kind : {CellKind::quads, CellKind::triangles}) {
        const Scene scene = rigid_scene({1e-5, 2e-6, 25});
        const Mesh mesh = mesh_of(kind, true);
        FlowSystem system = make_flow(scene, mesh, {});
        for (int trial = 0; trial < 3; ++trial) {
            const std::vector<double> pressure = random_pressures(mesh, random, 1e5);
            CHECK(jacobian_error(system, pressure, 0, 1) < 2e-3);
            CHECK(jacobian_error(system, pressure, 1, 3600) < 2e-3);
            CHECK(jacobian_error(system, pressure, 1, 1) < 2e-3);
        }
    }
}
