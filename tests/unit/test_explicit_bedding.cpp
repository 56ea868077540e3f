// Ground in motion that conducts water and gas along its bedding otherwise than across it.
#include "background/locate.hpp"
#include "background/shape.hpp"
#include "doctest/doctest.h"
#include "motion/explicit/explicit_mixture.hpp"
#include "verification/explicit_cases.hpp"
#include "verification/flow_cases.hpp"

#include <cmath>

using namespace talus;
using namespace talus::test;

namespace {

constexpr double gravity = 9.81, porosity = 0.4, grain_density = block_density / (1 - porosity);
constexpr double viscosity_ratio = 55;  // water's over the gas's
const ExplicitGas air{};

ExplicitHydraulics soil_of(const Conductivity& conductivity) {
    ExplicitHydraulics soil{grain_density, mean_conductivity(conductivity) / unit_weight};
    soil.gas_mobility = viscosity_ratio * soil.mobility;
    soil.anisotropy = anisotropy_of(conductivity);
    return soil;
}

constexpr size_t fields_of(Filling filling) {
    if (filling == Filling::exchange) return point_fields;
    return filling == Filling::three_phase ? gas_fields : wet_fields;
}

/// Water in a share of the pores, and air of the atmosphere's pressure in the rest.
void fill(FreePoints& points, size_t p, double filled) {
    const double pores = porosity * points[point_volume][p];
    points[water_mass][p] = 1000 * filled * pores;
    if (!points.field[gas_mass].empty()) points[gas_mass][p] = air.density * std::max(1 - filled, 0.0) * pores;
}

template <Filling filling>
ExplicitMixture<filling> make_ground(double cell_size, const Walls& walls, double weight, const ExplicitSoil& solid,
                                     const std::vector<ExplicitHydraulics>& hydraulics, const Hydraulics& curves,
                                     double bulk_modulus, FreePoints points, int32_t threads = 1) {
    std::vector<SaturationTable> tables(filling == Filling::saturated ? 0 : hydraulics.size(),
                                        SaturationTable(curves, bulk_modulus));
    return {cell_size,
            walls,
            weight,
            std::vector<ExplicitSoil>(hydraulics.size(), solid),
            hydraulics,
            std::move(tables),
            {1000, bulk_modulus},
            std::move(points),
            threads,
            air,
            {fluid_exchange(air.density, air.atmosphere, 293.15, 7.8e-6)}};
}

double sum_of(const FreePoints& points, PointField mass, PointField due) {
    if (points.field[mass].empty()) return 0;
    double sum = 0;
    for (size_t p = 0; p < points.count; ++p) sum += points[mass][p] + points[due][p];
    return sum;
}

/// What has changed its fluid: it counts as water and as air.
double passed_of(const FreePoints& points) {
    return sum_of(points, vapour_mass, vapour_due) - sum_of(points, dissolved_mass, dissolved_due);
}

template <template <Filling> class Test>
void in_each_composition() {
    Test<Filling::saturated>()();
    Test<Filling::unsaturated>()();
    Test<Filling::three_phase>()();
    Test<Filling::exchange>()();
}

}  // namespace

TEST_CASE("a bedding's mean conductivity and anisotropy are those of its tensor of resistance") {
    for (const Conductivity& k :
         {Conductivity{1e-4, 1e-5, 30}, Conductivity{1e-6, 1e-5, -70}, Conductivity{2, 1, 90}}) {
        const NodeVector anisotropy = anisotropy_of(k);
        const double mean = mean_conductivity(k), angle = k.dip * std::numbers::pi / 180;
        const double xx = std::pow(std::cos(angle), 2) / k.along + std::pow(std::sin(angle), 2) / k.across;
        const double xy = std::cos(angle) * std::sin(angle) * (1 / k.along - 1 / k.across);
        CHECK((1 - anisotropy.x) / mean == doctest::Approx(xx).epsilon(1e-12));
        CHECK(-anisotropy.y / mean == doctest::Approx(xy).epsilon(1e-12));
    }
    const NodeVector none = anisotropy_of({0.3, 0.3, 25});
    CHECK(mean_conductivity({0.3, 0.3, 25}) == 0.3);
    CHECK((none.x == 0 && none.y == 0));
    for (const Conductivity& k : {Conductivity{0.3, 1e-20, 45}, Conductivity{1e-20, 0.3, 45}}) {
        CHECK(mean_conductivity(k) / 2e-20 == doctest::Approx(1));
        CHECK(size_of(anisotropy_of(k)) < 1);
    }
}

TEST_CASE("the axes of a tensor are along its bedding, at any dip") {
    for (const double dip : {-90.0, -60.0, -45.0, -1e-9, 0.0, 20.0, 45.0, 46.0, 90.0}) {
        for (const Conductivity& k : {Conductivity{3, 1, dip}, Conductivity{1, 3, dip}}) {
            const BeddingAxes axes(anisotropy_of(k));
            const auto values = axes.each([&](double anisotropy) { return mean_conductivity(k) / (1 - anisotropy); });
            CHECK(values[0] == doctest::Approx(3));
            CHECK(values[1] == doctest::Approx(1));
            const Tensor tensor = conductivity_tensor(k);
            const NodeVector v{0.6, -1.7}, product = axes.product(values, v);
            CHECK(product.x == doctest::Approx(tensor.xx * v.x + tensor.xy * v.y));
            CHECK(product.y == doctest::Approx(tensor.xy * v.x + tensor.yy * v.y));
            const NodeVector back = axes.turned_back(axes.turned(v));
            CHECK(back.x == doctest::Approx(v.x));
            CHECK(back.y == doctest::Approx(v.y));
        }
    }
}

namespace {

/// Flux per pore space of water and of gas through the solid in the middle of a block whose pressures fall by `slope`, Pa/m, and whose stress bears that.
struct Fluxes {
    NodeVector water, gas;
};

template <Filling filling>
Fluxes fluxes(const Conductivity& conductivity, double filled, const NodeVector& slope) {
    constexpr double cell_size = 0.05, bulk_modulus = 1e7;
    constexpr bool has_gas = fields_of(filling) > wet_fields;
    FreePoints points = block_of_points(cell_size, 0, 0, 8, 8, fields_of(filling));
    size_t middle = 0;
    for (size_t p = 0; p < points.count; ++p) {
        const double x = points[position_x][p] - 0.2, y = points[position_y][p] - 0.2;
        const double pressure = 2000 - slope.x * x - slope.y * y;
        fill(points, p, filled);
        if (filled < 1 && has_gas) points[gas_mass][p] *= 1 + pressure / air.atmosphere;
        if (filled >= 1) points[water_mass][p] *= 1 + pressure / bulk_modulus;
        points[stress_xx][p] = points[stress_yy][p] = pressure;
        if (std::hypot(x, y) < std::hypot(points[position_x][middle] - 0.2, points[position_y][middle] - 0.2))
            middle = p;
    }
    auto ground = make_ground<filling>(cell_size, {}, 0, {elasticity(1e9, 0)}, {soil_of(conductivity)},
                                       van_genuchten(4e-5, 1.2), bulk_modulus, std::move(points));
    REQUIRE(ground.step(1e-4, true));
    const auto through = [&](PointField fluid) {
        const FreePoints& now = ground.points();
        return NodeVector{now[fluid][middle] - now[velocity_x][middle],
                          now.field[fluid + 1][middle] - now[velocity_y][middle]};
    };
    if constexpr (has_gas) return {through(liquid_velocity_x), through(gas_velocity_x)};
    return {through(liquid_velocity_x), {}};
}

template <Filling filling>
struct DrivesByTensor {
    void operator()() const {
        constexpr double along = 1e-7;
        const NodeVector slope{3000, -5000};
        for (const Conductivity& k : {Conductivity{along, 0.1 * along, 35}, Conductivity{0.01 * along, along, -20}}) {
            const Tensor tensor = conductivity_tensor(k);
            const auto compare = [&](const NodeVector& flux, const NodeVector& even) {
                CHECK(std::abs(even.x) > 0);
                // As fast in each direction as alike ground would be of the conductivity in the tensor.
                const double x = (tensor.xx * even.x + tensor.xy * even.y) / along;
                const double y = (tensor.xy * even.x + tensor.yy * even.y) / along;
                CHECK(std::hypot(flux.x - x, flux.y - y) < 1e-3 * std::hypot(x, y));
            };
            for (const double filled : {1.0, 0.5}) {
                if (filled < 1 && fields_of(filling) == wet_fields) continue;
                const Fluxes bedded = fluxes<filling>(k, filled, slope);
                const Fluxes even = fluxes<filling>({along, along, 0}, filled, slope);
                compare(bedded.water, even.water);
                if (filled < 1) compare(bedded.gas, even.gas);
                if (filled == 1)
                    CHECK(porosity * even.water.x == doctest::Approx(along / unit_weight * slope.x).epsilon(0.01));
            }
        }
    }
};

}  // namespace

TEST_CASE("a uniform slope of the pressure drives what Darcy's law with the tensor says, in water and in gas") {
    in_each_composition<DrivesByTensor>();
}

namespace {

/// Two soils of different bedding, wet below, that fall against walls in the rain.
template <Filling filling>
struct LosesNothing {
    void operator()() const {
        const Wall end{WallKind::roller, 2, 0}, behind{WallKind::friction, 0.45, 0.3},
            rough{WallKind::friction, 0, 0.3};
        for (const Walls& walls :
             {Walls{{WallKind::roller, 0.45, 0}, end, {WallKind::fixed, 0, 0}}, Walls{behind, end, rough}}) {
            const FreePoints one = slump(walls, 1), two = slump(walls, 2);
            for (size_t f = 0; f < fields_of(filling); ++f) CHECK(one.field[f] == two.field[f]);
        }
    }
    static FreePoints slump(const Walls& walls, int32_t threads) {
        constexpr double cell_size = 0.05;
        FreePoints points = block_of_points(cell_size, 0.5, 0.02, 12, 14, fields_of(filling));
        for (size_t p = 0; p < points.count; ++p) {
            fill(points, p, filling == Filling::saturated || points[position_y][p] < 0.3 ? 1 : 0.7);
            points.soil[p] = points[position_y][p] + points[position_x][p] > 1.1 ? 1 : 0;
            points[velocity_x][p] = points[liquid_velocity_x][p] = 1;
            if (fields_of(filling) > wet_fields) points[gas_velocity_x][p] = 1;
        }
        const ExplicitSoil solid{elasticity(1e6, 0.3), true, mohr_coulomb({100, 30}, 0, 1e300)};
        auto ground = make_ground<filling>(cell_size, walls, gravity, solid,
                                           {soil_of({1e-2, 1e-5, 40}), soil_of({1e-6, 1e-4, -65})},
                                           van_genuchten(4e-5, 1.2), 1e6, std::move(points), threads);
        ground.set_rain([](double) { return 1e-4; });
        const auto water = [&] { return sum_of(ground.points(), water_mass, water_due) + passed_of(ground.points()); };
        const auto gas = [&] { return sum_of(ground.points(), gas_mass, gas_due) - passed_of(ground.points()); };
        const double water_before = water(), gas_before = gas();
        for (int i = 1; i <= 300; ++i) REQUIRE(ground.step(ground.critical_step(), i % 100 == 0));
        const double gained = ground.rained() - ground.run_off() - ground.seepage() - ground.evaporated();
        CHECK(std::abs(water() - water_before - gained) < 1e-12 * water_before);
        CHECK(std::abs(gas() + ground.gas_escaped() - gas_before) <= 1e-12 * gas_before);
        return ground.points();
    }
};

}  // namespace

TEST_CASE("ground with beddings that slumps loses no water and no air, with the same bits for one and two threads") {
    in_each_composition<LosesNothing>();
}

namespace {

/// A column one cell wide in the rain, whose walls let nothing flow aside.
template <Filling filling>
FreePoints wet_column(const ExplicitHydraulics& soil) {
    constexpr double cell_size = 0.05;
    constexpr size_t cells = 10;
    FreePoints points = block_of_points(cell_size, 0, 0, 1, cells, fields_of(filling));
    for (size_t p = 0; p < points.count; ++p) fill(points, p, filling == Filling::saturated ? 1 : 0.8);
    const Walls walls{{WallKind::roller, 0, 0}, {WallKind::roller, cell_size, 0}, {WallKind::roller, 0, 0}};
    auto column = make_ground<filling>(cell_size, walls, gravity, {elasticity(1e7, 0)}, {soil},
                                       van_genuchten(4e-5, 1.2), 1e6, std::move(points));
    column.set_rain([](double) { return 1e-3; });
    for (int i = 1; i <= 500; ++i) REQUIRE(column.step(1e-4, i == 500));
    return column.points();
}

template <Filling filling>
double largest_difference(const FreePoints& a, const FreePoints& b) {
    double largest = 0;
    for (size_t p = 0; p < a.count; ++p) {
        largest = std::max(largest, std::abs(a[water_mass][p] / b[water_mass][p] - 1));
        if constexpr (fields_of(filling) > wet_fields)
            largest = std::max(largest, std::abs(a[gas_mass][p] / b[gas_mass][p] - 1));
    }
    return largest;
}

template <Filling filling>
struct ConductsBetweenWalls {
    void operator()() const {
        constexpr double along = 1e-3, across = 1e-5, dip = 40, angle = dip * std::numbers::pi / 180;
        // What cannot flow aside is driven back: the resistance along the walls counts.
        const double upwards = 1 / (std::pow(std::sin(angle), 2) / along + std::pow(std::cos(angle), 2) / across);
        const FreePoints bedded = wet_column<filling>(soil_of({along, across, dip}));
        const FreePoints even = wet_column<filling>(soil_of({upwards, upwards, 0}));
        const FreePoints better = wet_column<filling>(soil_of({along, along, 0}));
        CHECK(largest_difference<filling>(bedded, even) < 0.05 * largest_difference<filling>(better, even));
    }
};

/// The way of ground with a bedding, all but alike in all directions.
template <Filling filling>
struct ComesToAlike {
    void operator()() const {
        const FreePoints bedded = wet_column<filling>(soil_of({1e-4 * (1 + 1e-12), 1e-4, 30}));
        CHECK(largest_difference<filling>(bedded, wet_column<filling>(soil_of({1e-4, 1e-4, 30}))) < 1e-9);
    }
};

}  // namespace

TEST_CASE("between two walls ground conducts by its resistance along them") {
    in_each_composition<ConductsBetweenWalls>();
}

TEST_CASE("ground whose bedding makes hardly any difference is as ground that conducts alike in all directions") {
    in_each_composition<ComesToAlike>();
}

namespace {

constexpr double duration = 10;  // s
const Conductivity sandy{1e-2, 1e-3, 30};

Hydraulics sand() { return van_genuchten(2e-4, 2); }

/// What water spreads from, Pa: wetter at the left.
double pressure_at_start(double x, double y) {
    return -unit_weight * (0.8 - 0.4 * std::cos(std::numbers::pi * x) + 0.3 * std::cos(std::numbers::pi * y));
}

/// Nodal pressures of a closed metre of rigid ground after that time, by the quasi-static flow.
std::vector<double> spread_by_flow(const Mesh& mesh) {
    Scene scene;
    scene.physics.deforming = false;
    Soil soil;
    soil.porosity = porosity;
    soil.hydraulics = sand();
    soil.hydraulics.conductivity = sandy;
    scene.soils.push_back(soil);
    FlowSystem system = make_flow(scene, mesh, {});
    FlowIntegrator integrator(system, 1e-4);
    FlowState state;
    for (size_t i = 0; i < mesh.position.size(); i += 2)
        state.pressure.push_back(pressure_at_start(mesh.position[i], mesh.position[i + 1]));
    system.evaluate(0, state.pressure);
    state.stored.assign(system.stored().begin(), system.stored().end());
    REQUIRE(integrator.advance(state, duration, [](double, std::span<const double>) { return false; }) ==
            AdvanceResult::done);
    return state.pressure;
}

/// The same by explicit motion of stiff ground between four walls.
ExplicitMixture<Filling::unsaturated> spread_by_motion(size_t cells, const Conductivity& conductivity) {
    const double cell_size = 1 / static_cast<double>(cells);
    const HydraulicTable curves(sand());
    FreePoints points = block_of_points(cell_size, 0, 0, cells, cells, wet_fields);
    for (size_t p = 0; p < points.count; ++p) {
        const double x = points[position_x][p], y = points[position_y][p];
        fill(points, p, curves.at(pressure_at_start(x, y)).saturation);
        points[stress_yy][p] = -(block_density + 1000 * porosity * 0.7) * gravity * (1 - y);
        points[stress_xx][p] = points[stress_zz][p] = points[stress_yy][p] * 3 / 7;
    }
    const Walls walls{
        {WallKind::roller, 0, 0}, {WallKind::roller, 1, 0}, {WallKind::roller, 0, 0}, {WallKind::roller, 1, 0}};
    auto ground = make_ground<Filling::unsaturated>(cell_size, walls, gravity, {elasticity(1e7, 0.3)},
                                                    {soil_of(conductivity)}, sand(), 1e6, std::move(points));
    const double water = sum_of(ground.points(), water_mass, water_due);
    const auto steps = static_cast<int>(std::ceil(duration / ground.critical_step()));
    for (int i = 1; i <= steps; ++i) REQUIRE(ground.step(duration / steps, i == steps));
    CHECK(std::abs(sum_of(ground.points(), water_mass, water_due) - water) < 1e-12 * water);
    return ground;
}

}  // namespace

TEST_CASE("water spreads along a tilted bedding in motion as in the quasi-static flow") {
    const Mesh mesh = distorted_mesh(30, 30, CellKind::quads);
    const std::vector<double> pressure = spread_by_flow(mesh);
    const Locator locator(mesh);
    const auto difference = [&](const ExplicitMixture<Filling::unsaturated>& ground) {
        double squares = 0;
        for (size_t p = 0; p < ground.points().count; ++p) {
            const CellPlace place = locator.locate(ground.points()[position_x][p], ground.points()[position_y][p]);
            REQUIRE(place.cell >= 0);
            const auto share = Quad4::values({place.natural[0], place.natural[1]});
            double expected = 0;
            const int32_t* nodes =
                &mesh.cell_nodes[static_cast<size_t>(mesh.cell_start[static_cast<size_t>(place.cell)])];
            for (size_t a = 0; a < Quad4::nodes; ++a) expected += share[a] * pressure[static_cast<size_t>(nodes[a])];
            const double off = ground.pressure(p) - expected;
            squares += off * off;
        }
        return std::sqrt(squares / static_cast<double>(ground.points().count));
    };
    // First order: 163, 83 and 42 Pa with 5, 10 and 20 cells; of 7000 Pa between the wettest and the driest at the start.
    CHECK(difference(spread_by_motion(5, sandy)) < 200);
    CHECK(difference(spread_by_motion(10, sandy)) < 100);
    CHECK(difference(spread_by_motion(5, {sandy.along, sandy.across, -sandy.dip})) > 500);
}

namespace {

/// What seeps out of the upright face of full ground past which its water falls, over what the pressure's slope alone would drive.
template <Filling filling>
double share_that_seeps(const Conductivity& conductivity) {
    constexpr double cell_size = 0.05, width = 0.4, height = 0.8, bulk_modulus = 1e6, dt = 5e-5;
    constexpr int steps = 20;
    const Tensor tensor = conductivity_tensor(conductivity);
    const double slope = -tensor.xy / tensor.xx * unit_weight;  // of the pressure along x, by which nothing flows aside
    FreePoints points = block_of_points(cell_size, 0, 0, 8, 16, fields_of(filling));
    for (size_t p = 0; p < points.count; ++p) {
        const double pressure = slope * (points[position_x][p] - width);
        fill(points, p, 1);
        points[water_mass][p] *= 1 + pressure / bulk_modulus;
        points[stress_xx][p] = pressure;
        points[stress_yy][p] =
            pressure - (block_density + 1000 * porosity) * gravity * (height - points[position_y][p]);
    }
    const Walls walls{{WallKind::roller, 0, 0}, {}, {WallKind::roller, 0, 0}, {WallKind::roller, height, 0}};
    auto ground = make_ground<filling>(cell_size, walls, gravity, {elasticity(1e9, 0)}, {soil_of(conductivity)},
                                       van_genuchten(4e-5, 1.2), bulk_modulus, std::move(points));
    for (int i = 1; i <= steps; ++i) REQUIRE(ground.step(dt, i == steps));
    const double by_slope = 1000 * tensor.xx * -slope / unit_weight * height;
    return ground.seepage() / (steps * dt) / by_slope;
}

}  // namespace

TEST_CASE("nothing seeps out of a face along which the bedding holds the water") {
    for (const double dip : {30.0, 60.0}) {
        CHECK(std::abs(share_that_seeps<Filling::unsaturated>({1e-4, 1e-5, dip})) < 0.02);
        CHECK(std::abs(share_that_seeps<Filling::three_phase>({1e-4, 1e-5, dip})) < 0.02);
    }
}
