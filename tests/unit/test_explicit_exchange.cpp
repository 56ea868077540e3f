// Material points whose water and gas exchange vapour and dissolved air, on the Cartesian background.
#include "doctest/doctest.h"
#include "motion/explicit/explicit_mixture.hpp"
#include "verification/explicit_cases.hpp"

#include <cmath>

using namespace talus;
using namespace talus::test;

namespace {

using Exchange = ExplicitMixture<Filling::exchange>;

constexpr double gravity = 9.81, porosity = 0.4, grain_density = block_density / (1 - porosity);
const ExplicitGas air{};
const ExplicitHydraulics moist{grain_density, 1e-4 / (1000 * gravity), 0, false, 1e-4 / (18 * gravity)};

Hydraulics loam() { return van_genuchten(4e-5, 1.2); }

ExplicitExchange exchange_at_20_degrees(double humidity) {
    ExplicitExchange exchange{fluid_exchange(air.density, air.atmosphere, 293.15, 7.8e-6)};
    exchange.humidity = humidity;
    return exchange;
}

double sum_of(const FreePoints& points, PointField mass, PointField due) {
    double sum = 0;
    for (size_t p = 0; p < points.count; ++p) sum += points[mass][p] + points[due][p];
    return sum;
}

double passed_of(const FreePoints& points) {
    return sum_of(points, vapour_mass, vapour_due) - sum_of(points, dissolved_mass, dissolved_due);
}
double water_of(const FreePoints& points) { return sum_of(points, water_mass, water_due) + passed_of(points); }
double air_of(const FreePoints& points) { return sum_of(points, gas_mass, gas_due) - passed_of(points); }

/// Dry gas at the atmosphere's pressure over water without air.
void fill(FreePoints& points, size_t p, double filled) {
    const double pores = porosity * points[point_volume][p];
    points[water_mass][p] = 1000 * filled * pores;
    points[gas_mass][p] = air.density * (1 - filled) * pores;
}

}  // namespace

TEST_CASE(
    "moist ground that slumps loses no water and no air but through its edge, with the same bits for one and two threads") {
    constexpr double cell_size = 0.05;
    const auto run = [](const Walls& walls, int32_t threads) {
        FreePoints points = block_of_points(cell_size, 0.5, 0.02, 20, 20, point_fields);
        for (size_t p = 0; p < points.count; ++p) {
            fill(points, p, points[position_y][p] < 0.3 ? 1 : 0.7);
            points[velocity_x][p] = points[liquid_velocity_x][p] = points[gas_velocity_x][p] = 1;
        }
        const double water = water_of(points), gas = air_of(points);
        const ExplicitSoil soil{elasticity(1e6, 0.3), true, mohr_coulomb({100, 30}, 0, 1e300)};
        Exchange block(cell_size, walls, gravity, {soil}, {moist}, {{loam(), 1e6}}, {1000, 1e6}, std::move(points),
                       threads, air, exchange_at_20_degrees(0.5));
        block.set_rain([](double) { return 1e-4; });
        double rained = 0, lost = 0, escaped = 0;
        for (int i = 1; i <= 2000; ++i) {
            CHECK(block.step(block.critical_step(), i % 500 == 0));
            if (i % 500 != 0) continue;
            rained += block.rained() - block.run_off();
            lost += block.seepage() + block.evaporated();
            escaped += block.gas_escaped();
            block.restart();
        }
        CHECK(std::abs(water_of(block.points()) + lost - rained - water) < 1e-12 * water);
        CHECK(std::abs(air_of(block.points()) + escaped - gas) < 1e-12 * gas);
        CHECK(std::abs(escaped) < gas);
        return block.points();
    };
    const Wall end{WallKind::roller, 3, 0};
    for (const Walls& walls : {Walls{{}, end, {WallKind::fixed, 0, 0}},
                               Walls{{WallKind::friction, 0.45, 0.3}, end, {WallKind::friction, 0, 0.3}}}) {
        const FreePoints one = run(walls, 1), two = run(walls, 2);
        for (size_t f = 0; f < point_fields; ++f) CHECK(one.field[f] == two.field[f]);
        CHECK(one.least(gas_mass) >= 0);
    }
}

TEST_CASE("a closed column settles in the first step, and then nothing passes in it") {
    constexpr double cell_size = 0.05;
    FreePoints points = block_of_points(cell_size, 0, 0, 1, 10, point_fields);
    for (size_t p = 0; p < points.count; ++p) fill(points, p, 0.8);
    const double water = water_of(points), gas = air_of(points);
    const Walls walls{{WallKind::roller, 0, 0},
                      {WallKind::roller, cell_size, 0},
                      {WallKind::roller, 0, 0},
                      {WallKind::roller, 0.5, 0}};
    Exchange column(cell_size, walls, 0, {{elasticity(1e9, 0.3)}}, {moist}, {{loam(), 1e8}}, {1000, 1e8},
                    std::move(points), 1, air, exchange_at_20_degrees(1));
    column.step(column.critical_step(), true);
    const FreePoints first = column.points();
    CHECK(column.relative_humidity(0) == doctest::Approx(1).epsilon(1e-3));
    // About a hundredth of the air per volume is in the water, of which there is four times as much.
    CHECK(column.dissolved_air(0) / 0.0213 == doctest::Approx(1).epsilon(1e-2));
    CHECK(column.gas_pressure(0) < -4e3);
    for (int i = 1; i <= 1000; ++i) column.step(column.critical_step(), i == 1000);
    CHECK(std::abs(water_of(column.points()) - water) < 1e-13 * water);
    CHECK(std::abs(air_of(column.points()) - gas) < 1e-13 * gas);
    for (size_t p = 0; p < first.count; ++p) {
        for (const PointField name : {water_mass, gas_mass, vapour_mass, dissolved_mass})
            CHECK(column.points()[name][p] / first[name][p] == doctest::Approx(1).epsilon(1e-6));
    }
}

TEST_CASE(
    "ground dries into a dry atmosphere through its surface as Fick's law says, and air comes in for what leaves") {
    // All of it vapour, in ground that a humidity of 0.8 is in equilibrium with: into a dry atmosphere the first of it leaves as from a half-space,
    // 2 density sqrt(D t / pi).
    constexpr double cell_size = 0.0025, humidity = 0.8, time = 0.05;
    ExplicitExchange exchange = exchange_at_20_degrees(0);
    exchange.vapour_diffusivity = 2.4e-3;
    const FluidExchange& fluids = exchange.fluids;
    FreePoints points = block_of_points(cell_size, 0, 0, 1, 40, point_fields);
    const double density = humidity * fluids.saturated_vapour;
    for (size_t p = 0; p < points.count; ++p) {
        const double pores = porosity * points[point_volume][p];
        points[vapour_mass][p] = density * pores;
        points[gas_mass][p] = points[vapour_mass][p] + (air.atmosphere - fluids.vapour * density) / fluids.air * pores;
    }
    const Walls walls{{WallKind::roller, 0, 0}, {WallKind::roller, cell_size, 0}, {WallKind::roller, 0, 0}};
    Exchange column(cell_size, walls, 0, {{elasticity(1e9, 0.3)}}, {{grain_density, 1e-30, 0, false, 1e-5}},
                    {{van_genuchten(1e-3, 4), 1e7}}, {1000, 1e7}, std::move(points), 1, air, exchange);
    const double water = water_of(column.points()), gas = air_of(column.points());
    const auto steps = static_cast<int64_t>(std::ceil(time / column.critical_step()));
    for (int64_t i = 1; i <= steps; ++i) column.step(time / static_cast<double>(steps), i == steps);
    CHECK(std::abs(water_of(column.points()) + column.evaporated() - water) < 1e-12 * water);
    CHECK(std::abs(air_of(column.points()) + column.gas_escaped() - gas) < 1e-12 * gas);
    const double diffusivity = exchange.vapour_diffusivity * std::cbrt(porosity);
    const double left = 2 * porosity * density * std::sqrt(diffusivity * time / std::numbers::pi) * cell_size;
    CHECK(column.evaporated() / left == doctest::Approx(1).epsilon(0.01));
    // As many moles of air as of vapour.
    CHECK(-column.gas_escaped() * fluids.air / (column.evaporated() * fluids.vapour) ==
          doctest::Approx(1).epsilon(0.01));
}
