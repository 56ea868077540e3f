// Ground whose material points have not moved at all comes back as it was.
#include "coupling/deposit.hpp"
#include "doctest/doctest.h"
#include "ground/build.hpp"
#include "points/quadrature.hpp"
#include "scene/read.hpp"
#include "scene/validate.hpp"

#include <cmath>

using namespace talus;

namespace {

constexpr double water_table = 2, water_weight = 9810, soil_weight = 18e3;  // m, N/m3

const char* const bank_text = R"({
    "name": "bank",
    "physics": {"regime": "auto"},
    "water": {"bulkModulus": 1e8},
    "soils": [{"name": "upper", "dryDensity": 1800, "porosity": 0.4,
               "hydraulics": {"retention": {"model": "vanGenuchten", "alpha": 4e-05, "n": 1.2},
                              "conductivity": {"along": 1e-04}},
               "solid": {"youngModulus": 10e6, "poissonRatio": 0.3,
                         "strength": {"model": "vanapalli", "cohesion": 12e3, "frictionAngle": 30},
                         "softening": {"residualCohesion": 1e3, "residualFrictionAngle": 20, "slip": 0.1}}},
              {"name": "lower", "dryDensity": 1800, "porosity": 0.4,
               "hydraulics": {"retention": {"model": "vanGenuchten", "alpha": 4e-05, "n": 1.2},
                              "conductivity": {"along": 1e-04}},
               "solid": {"model": "elastic", "youngModulus": 10e6, "poissonRatio": 0.3}}],
    "ground": {"section": {"terrain": [[0, 6], [4, 6], [10, 3], [14, 3]], "base": [[0, 0], [14, 0]],
                           "layers": [{"soil": "upper"}, {"soil": "lower", "top": [[0, 1], [14, 1]]}],
                           "columnWidth": 0.5, "surfaceCellHeight": 0.25, "growth": 1.3, "largestCellHeight": 1}},
    "boundaries": [{"side": "base", "motion": "fixed"}, {"side": "left", "motion": "roller"},
                   {"side": "right", "motion": "roller"}],
    "initial": {"flow": "hydrostatic", "waterTable": 2},
    "dynamics": {"cellSize": 0.5}
})";

double height_of(double x) { return x < 4 ? 6 : x < 10 ? 6 - (x - 4) / 2 : 3; }

/// The bank with a stress that grows with the depth, handed over to points.
struct Bank {
    Scene scene = read_json(bank_text);
    Mesh mesh;
    std::vector<double> pressure;

    Bank() {
        validate(scene);
        mesh = build_mesh(scene);
        for (size_t i = 0; i < mesh.position.size(); i += 2) {
            pressure.push_back(water_weight * (water_table - mesh.position[i + 1]));
        }
    }

    [[nodiscard]] DynamicGround ground() const {
        Points points = make_points(mesh);
        for (size_t p = 0; p < static_cast<size_t>(points.count); ++p) {
            const double vertical = soil_weight * (points.position[2 * p + 1] - 6);
            points.skeleton_stress.insert(points.skeleton_stress.end(),
                                          {vertical / 2, vertical, vertical / 2, vertical / 10});
        }
        Handover handover;
        std::vector<double> lost;
        for (size_t p = 0; p < static_cast<size_t>(points.count); ++p) lost.push_back(points.position[2 * p + 1] / 6);
        handover.pressure = pressure;
        handover.lost_strength = lost;
        return {scene, mesh, points, handover, 1};
    }
};

double area_of(const Mesh& mesh) {
    double area = 0;
    for (const double volume : make_points(mesh).volume) area += volume;
    return area;
}

}  // namespace

TEST_CASE("ground that lies where it was has its volume, its surface and its state on the mesh under its points") {
    const Bank bank;
    const std::optional<Deposit> deposit = find_deposit(bank.scene, bank.ground());
    REQUIRE(deposit);
    const Mesh& mesh = deposit->mesh;
    CHECK(area_of(mesh) == doctest::Approx(area_of(bank.mesh)).epsilon(1e-12));

    double highest = 0, off_surface = 0, off_pressure = 0, off_suction = 0, off_stress = 0, off_lost = 0;
    for (size_t i = 0; i < static_cast<size_t>(mesh.node_count()); ++i) {
        const double x = mesh.position[2 * i], y = mesh.position[2 * i + 1];
        const double pressure = water_weight * (water_table - y);
        (pressure > 0 ? off_pressure : off_suction) =
            std::max(pressure > 0 ? off_pressure : off_suction, std::abs(deposit->pressure[i] - pressure));
        off_stress = std::max(off_stress, std::abs(deposit->stress[4 * i + 1] - soil_weight * (y - 6)));
        if (y > 1.5) off_lost = std::max(off_lost, std::abs(deposit->lost_strength[i] - y / 6));
        CHECK(deposit->displacement[2 * i + 1] == 0);
        CHECK(deposit->porosity[i] == doctest::Approx(0.4).epsilon(1e-12));
        highest = std::max(highest, y);
        if (y > height_of(x) - 0.05) off_surface = std::max(off_surface, std::abs(y - height_of(x)));
    }
    // As much as lies or stands in a quarter of a cell of the grid, half the distance of two points. What has bounds stays within the points' range; the surface
    // is evened out over a cell beside its bends.
    constexpr double quarter = 0.125, half = 0.25;
    CHECK(off_surface < quarter);
    CHECK(off_pressure < quarter * water_weight);
    CHECK(off_suction < half * water_weight);
    CHECK(off_stress < quarter * soil_weight);
    CHECK(off_lost < half / 6);
    CHECK(highest == doctest::Approx(6).epsilon(1e-12));
    for (size_t c = 0; c < mesh.cell_soil.size(); ++c) {
        double middle = 0;
        for (size_t k = 0; k < 4; ++k)
            middle += mesh.position[2 * static_cast<size_t>(mesh.cell_nodes[4 * c + k]) + 1] / 4;
        if (std::abs(middle - 1) > 0.3) CHECK(mesh.cell_soil[c] == (middle > 1 ? 0 : 1));
    }
}

TEST_CASE("ground that is anywhere thinner than a cell has no mesh under it") {
    Bank bank;
    bank.scene.dynamics.cell_size = 3.5;
    CHECK(!find_deposit(bank.scene, bank.ground()));
}
