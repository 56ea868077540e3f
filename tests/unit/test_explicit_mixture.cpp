// Material points that hold water, on the Cartesian background.
#include "doctest/doctest.h"
#include "materials/hydraulic/curves.hpp"
#include "materials/hydraulic/saturation_table.hpp"
#include "materials/solid/strength.hpp"
#include "motion/explicit/explicit_mixture.hpp"
#include "motion/explicit/ground_edge.hpp"
#include "verification/explicit_cases.hpp"

#include <array>
#include <cmath>

using namespace talus;
using namespace talus::test;

namespace {

constexpr double gravity = 9.81, porosity = 0.4, grain_density = block_density / (1 - porosity);

Hydraulics loam() { return van_genuchten(4e-5, 1.2); }

const ExplicitGas air{};
const ExplicitHydraulics moist{grain_density, 1e-4 / (1000 * gravity), 0, false, 1e-4 / (18 * gravity)};

/// A column of one cell's width between rollers, filled to a share of its pores.
FreePoints wet_column(double cell_size, size_t cells, double filled, size_t fields = wet_fields) {
    FreePoints points = block_of_points(cell_size, 0, 0, 1, cells, fields);
    for (size_t p = 0; p < points.count; ++p)
        points[water_mass][p] = 1000 * porosity * filled * points[point_volume][p];
    return points;
}

Walls column_walls(double cell_size) {
    return {{WallKind::roller, 0, 0}, {WallKind::roller, cell_size, 0}, {WallKind::roller, 0, 0}};
}

double water_of(const FreePoints& points) {
    double sum = 0;
    for (size_t p = 0; p < points.count; ++p) sum += points[water_mass][p] + points[water_due][p];
    return sum;
}

double air_of(const FreePoints& points) {
    double sum = 0;
    for (size_t p = 0; p < points.count; ++p) sum += points[gas_mass][p] + points[gas_due][p];
    return sum;
}

/// Air of the atmosphere's pressure in what water leaves of the pores, or next to none.
void fill_with_air(FreePoints& points) {
    for (size_t p = 0; p < points.count; ++p) {
        const double room = porosity * points[point_volume][p] - points[water_mass][p] / 1000;
        points[gas_mass][p] = air.density * std::max(room, 0.0);
    }
}

}  // namespace

TEST_CASE("the saturation table is the inverse of the hydraulic table") {
    Hydraulics soil = loam();
    soil.retention.residual_saturation = 0.1;
    soil.retention.maximum_saturation = 0.97;
    const HydraulicTable curves(soil);
    const SaturationTable inverse(soil, 2e9);
    for (const double pressure : {-1.0, -9.0, -11.0, -300.0, -2e4, -1e5, -1e7}) {
        const HydraulicState state = curves.at(pressure);
        const SaturationTable::State found = inverse.at(state.saturation);
        CHECK(found.pressure == doctest::Approx(pressure).epsilon(1e-5));
        CHECK(found.permeability == doctest::Approx(state.permeability).epsilon(1e-5));
    }
    CHECK(inverse.at(0.99).pressure == 0.0);
    CHECK(inverse.at(0.05).pressure < -1e8);
}

TEST_CASE("where a soil would hold its water more stiffly than water is, the saturation table is as soft as water") {
    for (const double bulk_modulus : {1e7, 2e9}) {
        for (const SaturationTable& table : {SaturationTable(van_genuchten(1e-6, 6), bulk_modulus),
                                             SaturationTable(van_genuchten(1e-6, 12), bulk_modulus)}) {
            for (const double saturation : {0.999, 0.99999, 1 - 1e-9}) {
                CHECK(table.stiffness(saturation) <= bulk_modulus);
                const double step = 1e-3 * (1 - saturation);
                const double slope = (table.at(saturation).pressure - table.at(saturation - step).pressure) / step;
                CHECK(table.stiffness(saturation) == doctest::Approx(slope).epsilon(1e-2));
            }
        }
    }
    CHECK(SaturationTable(van_genuchten(1e-7, 1.03), 1e6).stiffness(0.9999) >
          1e8);  // where none of the curve is as soft
}

TEST_CASE("a soil that does not yield bears what its weak neighbour does not") {
    FreePoints points = block_of_points(0.1, 0, 0, 4, 4);
    points.soil.assign(points.count, 0);
    for (size_t p = 0; p < points.count; ++p) {
        points.soil[p] = points[position_x][p] > 0.2 ? 1 : 0;
        points[stress_xy][p] = 1000;
    }
    const Elasticity elastic = elasticity(1e7, 0.3);
    ExplicitMotion block(0.1, {}, 0, {{elastic}, {elastic, true, mohr_coulomb({100, 30}, 0, 1e300)}}, std::move(points),
                         1);
    block.step(1e-9, true);
    for (size_t p = 0; p < block.points().count; ++p) {
        const double stress = block.points()[stress_xy][p];
        if (block.points().soil[p] == 0) CHECK(stress == doctest::Approx(1000).epsilon(1e-6));
        if (block.points().soil[p] == 1) CHECK(stress < 100);
    }
}

TEST_CASE("moist ground in motion bears what its strength at its suction says") {
    Strength exponential{StrengthModel::exponential, 1e3, 20};
    exponential.cohesion_gain = 2e4;
    exponential.cohesion_rate = 5;
    exponential.friction_gain = 10;
    FreePoints points = block_of_points(0.1, 0, 0, 4, 4, gas_fields);
    for (size_t p = 0; p < points.count; ++p) {
        points[water_mass][p] = 1000 * porosity * 0.8 * points[point_volume][p];
        points[stress_xy][p] = 1e5;
    }
    ExplicitHydraulics hydraulics{grain_density, 1e-10};
    hydraulics.strength = exponential;
    const ExplicitSoil soil{elasticity(1e7, 0.3), true, mohr_coulomb(shear_strength(exponential, 0, 1), 0, 1e300)};
    ExplicitMixture<Filling::unsaturated> block(0.1, {}, 0, {soil}, {hydraulics}, {{loam(), 1e6}}, {1000, 1e6},
                                                std::move(points), 1);
    block.step(1e-9, true);
    for (size_t p = 0; p < block.points().count; ++p) {
        const ShearStrength at_suction = shear_strength(exponential, -block.pressure(p), 1);
        const MohrCoulomb material = block.strength(p);
        CHECK(at_suction.cohesion > 1.5e4);
        CHECK(material.cohesion == doctest::Approx(at_suction.cohesion).epsilon(1e-9));
        CHECK(material.sin_friction == doctest::Approx(sin_degrees(at_suction.friction_angle)).epsilon(1e-9));
        // Shear alone: half the difference of the principal stresses is c cos(phi), the apex being far.
        CHECK(block.points()[stress_xy][p] == doctest::Approx(material.cohesion * material.cos_friction).epsilon(0.05));
    }
}

TEST_CASE("ground in motion conducts by its porosity as Kozeny and Carman have it") {
    constexpr double cell_size = 0.05, assumed = 0.5;
    const auto drain = [&]<Filling filling>(double mobility_factor, double conductance) {
        FreePoints points = wet_column(cell_size, 10, 0.8, gas_fields);
        for (size_t p = 0; p < points.count; ++p)
            if (points[position_y][p] > 0.25) points[water_mass][p] *= 1.1;
        fill_with_air(points);
        ExplicitHydraulics soil = moist;
        soil.mobility *= mobility_factor;
        soil.gas_mobility *= mobility_factor;
        soil.initial_conductance = conductance;
        ExplicitMixture<filling> column(cell_size, column_walls(cell_size), gravity, {{elasticity(1e11, 0)}}, {soil},
                                        {{loam(), 1e6}}, {1000, 1e6}, std::move(points), 1);
        for (int i = 1; i <= 200; ++i) REQUIRE(column.step(1e-5, i == 200));
        return column.points();
    };
    const double factor = kozeny_carman(porosity) / kozeny_carman(assumed);
    const auto compare = [&]<Filling filling>() {
        const FreePoints by_law = drain.template operator()<filling>(1, kozeny_carman(assumed));
        const FreePoints by_hand = drain.template operator()<filling>(factor, 0),
                         otherwise = drain.template operator()<filling>(1, 0);
        double off = 0, other = 0;
        for (size_t p = 0; p < by_law.count; ++p) {
            off = std::max(off, std::abs(by_law[water_mass][p] - by_hand[water_mass][p]));
            other = std::max(other, std::abs(by_law[water_mass][p] - otherwise[water_mass][p]));
        }
        CHECK(off < 1e-4 * other);
        CHECK(other > 0);
    };
    compare.template operator()<Filling::unsaturated>();
    compare.template operator()<Filling::three_phase>();
}

TEST_CASE("wet ground that falls apart loses no water") {
    constexpr double cell_size = 0.1;
    const Wall fixed{WallKind::fixed, 0, 0}, rough{WallKind::friction, 0, 0.3}, behind{WallKind::friction, 0.95, 0.5};
    for (const Walls& walls : {Walls{{}, {}, fixed}, Walls{behind, {}, fixed}, Walls{behind, {}, rough}}) {
        FreePoints points = block_of_points(cell_size, 1, 0, 5, 10, gas_fields);
        for (size_t p = 0; p < points.count; ++p)
            points[water_mass][p] = 1000 * porosity * 0.9 * points[point_volume][p];
        ExplicitMixture<Filling::unsaturated> column(
            cell_size, walls, gravity, {{elasticity(1e6, 0.3), true, mohr_coulomb({1, 10}, 0, 1e300)}},
            {{grain_density, 1e-2 / (1000 * gravity)}}, {{loam(), 1e6}}, {1000, 1e6}, std::move(points), 1);
        column.set_rain([](double) { return 1e-4; });
        const double before = water_of(column.points());
        for (int i = 1; i <= 3000; ++i) REQUIRE(column.step(column.critical_step(), i % 100 == 0));
        const double gained = column.rained() - column.run_off() - column.seepage();
        CHECK(water_of(column.points()) == doctest::Approx(before + gained).epsilon(1e-12));
        CHECK(column.rained() > 0);
    }
}

namespace {

constexpr double coefficient = 0.3;  // of friction

/// A block of two cells' height that slides over a base with friction at 2 m/s for 0.4 s, in balance with its weight and its pores' pressure; its speed in the end.
template <Filling filling>
double slide(double filled, int32_t threads) {
    constexpr double cell_size = 0.1, height = 2 * cell_size, bulk_modulus = 1e6;
    constexpr ExplicitHydraulics tight{grain_density, 1e-10 / (1000 * gravity), 0, false, 1e-12};
    FreePoints points = block_of_points(cell_size, 0, 0, 10, 2, gas_fields);
    const double density = block_density + 1000 * porosity * filled;
    for (size_t p = 0; p < points.count; ++p) {
        const double depth = height - points[position_y][p];
        const double pressure = filled < 1 ? 0 : 1000 * gravity * depth;
        points[water_mass][p] = 1000 * porosity * filled * points[point_volume][p] * (1 + pressure / bulk_modulus);
        points[stress_yy][p] = pressure - density * gravity * depth;
        points[stress_xx][p] = pressure;
        points[velocity_x][p] = points[liquid_velocity_x][p] = points[gas_velocity_x][p] = 2;
    }
    fill_with_air(points);
    ExplicitMixture<filling> block(cell_size, {{}, {}, {WallKind::friction, 0, coefficient}}, gravity,
                                   {{elasticity(1e8, 0)}}, {tight}, {{loam(), bulk_modulus}}, {1000, bulk_modulus},
                                   std::move(points), threads);
    const double water = water_of(block.points());
    const auto steps = static_cast<int64_t>(std::ceil(0.4 / block.critical_step()));
    for (int64_t step = 1; step <= steps; ++step) REQUIRE(block.step(0.4 / static_cast<double>(steps), step == steps));
    CHECK(water_of(block.points()) == doctest::Approx(water - block.seepage()).epsilon(1e-12));
    double momentum = 0, mass = 0;
    for (size_t p = 0; p < block.points().count; ++p) {
        momentum += block.points()[solid_mass][p] * block.points()[velocity_x][p];
        mass += block.points()[solid_mass][p];
    }
    return momentum / mass;
}

double slowed_by(double share_of_weight) { return 2 - coefficient * share_of_weight * gravity * 0.4; }

}  // namespace

TEST_CASE("friction slows wet ground by what presses its skeleton on the wall") {
    CHECK(slide<Filling::unsaturated>(0.5, 1) == doctest::Approx(slowed_by(1)).epsilon(0.01));
    CHECK(slide<Filling::three_phase>(0.5, 1) == doctest::Approx(slowed_by(1)).epsilon(0.01));
    const double density = block_density + 1000 * porosity;
    CHECK(slide<Filling::unsaturated>(1, 1) == doctest::Approx(slowed_by((density - 1000) / density)).epsilon(0.01));
    CHECK(slide<Filling::unsaturated>(1, 1) == slide<Filling::unsaturated>(1, 2));
}

TEST_CASE("wet ground that rubs on both walls of a corner gains no energy there") {
    constexpr double cell_size = 0.25, poisson = 0.45, filled = 0.5;
    constexpr ExplicitHydraulics tight{grain_density, 1e-10 / (1000 * gravity)};
    const Walls walls{{WallKind::friction, 0, 0.7}, {WallKind::friction, 2, 0.55}, {WallKind::friction, 0, 0.035}};
    FreePoints points = block_of_points(cell_size, 0, 0, 8, 4, gas_fields);
    for (size_t p = 0; p < points.count; ++p) {
        const double vertical = -(block_density + 1000 * porosity * filled) * gravity * (1 - points[position_y][p]);
        points[water_mass][p] = 1000 * porosity * filled * points[point_volume][p];
        points[stress_yy][p] = vertical;
        points[stress_xx][p] = points[stress_zz][p] = poisson / (1 - poisson) * vertical;
    }
    ExplicitMixture<Filling::unsaturated> ground(cell_size, walls, gravity, {{elasticity(1e7, poisson)}}, {tight},
                                                 {{loam(), 1e6}}, {1000, 1e6}, std::move(points), 1);
    const auto energy = [&] {
        const Energies parts = ground.energies();
        return parts.kinetic + parts.elastic + parts.potential;
    };
    const double start = energy(), dt = ground.critical_step();
    for (int step = 1; step <= 500; ++step) REQUIRE(ground.step(dt, step == 500));
    CHECK(energy() - start < 0.02 * ground.energies().elastic);
}

TEST_CASE("wet ground leaves a wall with friction as if there were none") {
    constexpr double cell_size = 0.1;
    FreePoints points = block_of_points(cell_size, 0, 0, 5, 4, gas_fields);
    for (size_t p = 0; p < points.count; ++p) {
        points[water_mass][p] = 1000 * porosity * 0.5 * points[point_volume][p];
        points[velocity_x][p] = points[liquid_velocity_x][p] = 1;
        points[velocity_y][p] = points[liquid_velocity_y][p] = 1;
    }
    const Walls walls{{WallKind::friction, 0, 0.5}, {}, {WallKind::friction, 0, 0.5}};
    ExplicitMixture<Filling::unsaturated> block(cell_size, walls, gravity, {{elasticity(1e6, 0)}}, {moist},
                                                {{loam(), 1e6}}, {1000, 1e6}, std::move(points), 1);
    const double dt = block.critical_step();
    for (int i = 1; i <= 40; ++i) REQUIRE(block.step(dt, i == 40));
    const FreePoints& thrown = block.points();
    double x = 0, y = 0, mass = 0;
    for (size_t p = 0; p < thrown.count; ++p) {
        x += thrown[solid_mass][p] * thrown[velocity_x][p] + thrown[water_mass][p] * thrown[liquid_velocity_x][p];
        y += thrown[solid_mass][p] * thrown[velocity_y][p] + thrown[water_mass][p] * thrown[liquid_velocity_y][p];
        mass += thrown[solid_mass][p] + thrown[water_mass][p];
    }
    CHECK(x / mass == doctest::Approx(1).epsilon(1e-9));
    CHECK(y / mass == doctest::Approx(1 - 40 * dt * gravity).epsilon(1e-9));
}

TEST_CASE("dry ground below wet ground gives none of the water that does not flow") {
    constexpr double cell_size = 0.1, residual = 0.2;
    Hydraulics sand = van_genuchten(6e-3, 7);
    sand.retention.residual_saturation = residual;
    FreePoints points = block_of_points(cell_size, 0, 0, 1, 20, gas_fields);
    for (size_t p = 0; p < points.count; ++p) {
        points.soil[p] = points[position_y][p] < 1 ? 1 : 0;
        const double filled = points.soil[p] == 1 ? residual : 0.9;
        points[water_mass][p] = 1000 * porosity * filled * points[point_volume][p];
    }
    const double kept = residual * porosity * 1000 / block_density;
    const std::vector<ExplicitHydraulics> hydraulics{{grain_density, 1e-2 / (1000 * gravity)},
                                                     {grain_density, 1e-9 / (1000 * gravity), 0, false, 0, kept}};
    ExplicitMixture<Filling::unsaturated> column(cell_size, column_walls(cell_size), gravity,
                                                 {{elasticity(1e7, 0.3)}, {elasticity(1e7, 0.3)}}, hydraulics,
                                                 {{loam(), 1e6}, {sand, 1e6}}, {1000, 1e6}, std::move(points), 1);
    const double before = water_of(column.points());
    for (int i = 1; i <= 500; ++i) {
        REQUIRE(column.step(column.critical_step(), i % 10 == 0));
        if (i % 10 != 0) continue;
        for (size_t p = 0; p < column.points().count; ++p) {
            if (column.points().soil[p] == 1)
                CHECK(column.points()[water_mass][p] >= kept * column.points()[solid_mass][p] * (1 - 1e-14));
        }
    }
    CHECK(water_of(column.points()) + column.seepage() == doctest::Approx(before).epsilon(1e-13));
}

TEST_CASE("what shared pores read of a soil is that of its curves") {
    const Hydraulics soil = loam();
    const HydraulicTable curves(soil);
    const SaturationTable table(soil, 2e9);
    constexpr double m = 1 - 1 / 1.2;
    for (const double suction : {5.0, 300.0, 2e4, 1e6}) {
        const HydraulicState state = curves.at(-suction);
        const double wet = table.effective(state.saturation);
        const SaturationTable::MixedState found = table.mixed_at(wet, std::log(SaturationTable::odds(wet)));
        CHECK(found.suction == doctest::Approx(suction).epsilon(1e-4));
        CHECK(found.permeability == doctest::Approx(state.permeability).epsilon(1e-4));
        CHECK(found.mean_permeability == doctest::Approx(-state.potential / suction).epsilon(1e-4));
        if (suction < curves.chord()) continue;  // there k_rg is a chord too
        const double parker = std::sqrt(1 - wet) * std::pow(1 - std::pow(wet, 1 / m), 2 * m);
        CHECK(found.gas_permeability == doctest::Approx(parker).epsilon(1e-4));
    }
}

TEST_CASE("rain on an unsaturated column enters it, and no water is lost") {
    constexpr double cell_size = 0.05;
    const Hydraulics soil = loam();
    ExplicitMixture<Filling::unsaturated> column(cell_size, column_walls(cell_size), gravity, {{elasticity(1e7, 0.3)}},
                                                 {{grain_density, 1e-4 / (1000 * gravity)}}, {{soil, 1e6}}, {1000, 1e6},
                                                 wet_column(cell_size, 20, 0.85), 1);
    column.set_rain([](double) { return 1e-4; });
    const double before = water_of(column.points()), dt = column.critical_step();
    const auto steps = static_cast<int64_t>(std::ceil(2 / dt));
    for (int64_t i = 1; i <= steps; ++i) column.step(dt, i == steps);
    const double fallen = 1000 * 1e-4 * cell_size * dt * static_cast<double>(steps);
    CHECK(column.rained() == doctest::Approx(fallen).epsilon(1e-12));
    CHECK(column.run_off() == 0.0);
    CHECK(column.seepage() == 0.0);
    CHECK(water_of(column.points()) - before == doctest::Approx(column.rained()).epsilon(1e-9));
    for (size_t p = 0; p < column.points().count; ++p) CHECK(column.saturation(p) <= 1.0);
}

TEST_CASE("a full column sheds the rain that it cannot hold, and its water stays at rest") {
    constexpr double cell_size = 0.05;
    FreePoints points = wet_column(cell_size, 20, 1);
    const double bulk_modulus = 1e7;
    for (size_t p = 0; p < points.count; ++p)
        points[water_mass][p] *= 1 + 1000 * gravity * (1 - points[position_y][p]) / bulk_modulus;
    ExplicitMixture<Filling::unsaturated> column(cell_size, column_walls(cell_size), gravity, {{elasticity(1e9, 0.3)}},
                                                 {{grain_density, 1e-4 / (1000 * gravity)}}, {{loam(), bulk_modulus}},
                                                 {1000, bulk_modulus}, std::move(points), 1);
    column.set_rain([](double) { return 1e-4; });
    const double before = water_of(column.points()), dt = column.critical_step();
    const auto steps = static_cast<int64_t>(std::ceil(2 / dt));
    for (int64_t i = 1; i <= steps; ++i) column.step(dt, i == steps);
    CHECK(column.run_off() == doctest::Approx(column.rained()).epsilon(0.2));
    const double gained = column.rained() - column.run_off() - column.seepage();
    CHECK(water_of(column.points()) == doctest::Approx(before + gained).epsilon(1e-12));
    for (size_t p = 0; p < column.points().count; ++p) {
        const double depth = 1 - column.points()[position_y][p];
        CHECK(column.pressure(p) / (1000 * gravity) == doctest::Approx(depth).epsilon(cell_size));
    }
}

TEST_CASE("water and gas share pores at any masses, and these are no stiffer than water") {
    for (const PoreFluids fluids : {PoreFluids{2e9, 101325}, PoreFluids{1e7, 101325}, PoreFluids{2e5, 101325}}) {
        for (const double filled : {1e-3, 0.3, 0.85, 0.999, 1 - 1e-7, 1.0, 1.001, 1.05}) {
            for (const double gas : {0.0, 1e-3, 10.0, 1e5, 1e7, 1e9}) {
                const double pressure = shared_pressure(fluids, filled, gas);
                const double saturation = filled / (1 + (pressure - fluids.atmosphere) / fluids.bulk_modulus);
                const double rounding = 1e-14 * pressure;
                CHECK(pressure >= 0);
                CHECK(std::abs(pressure * (1 - saturation) - gas) <= 1e-6 * gas + rounding);
                const double more = 1e-6 * filled, rise = shared_pressure(fluids, filled + more, gas) - pressure;
                CHECK(rise >= 0);
                CHECK(rise <= fluids.bulk_modulus * more * (1 + 1e-6) + rounding);
            }
        }
    }
    const PoreFluids fluids{2e9, 101325};
    CHECK(shared_pressure({1e13, fluids.atmosphere}, 0.99, fluids.atmosphere) / fluids.atmosphere ==
          doctest::Approx(100).epsilon(1e-3));
    CHECK(shared_pressure(fluids, 1.0001, 0) - fluids.atmosphere == doctest::Approx(2e5));
    CHECK(shared_pressure(fluids, 1 - 1e-5, 0) - fluids.atmosphere == doctest::Approx(-2e4));
    CHECK(shared_pressure(fluids, 0.9, 0) == 0);  // water stretched by all of the atmosphere leaves a void
}

TEST_CASE("an edge is found from the share of the surroundings below it") {
    // Integrals of N, y N and (y - mean y) dN/dy up to the edge, by the midpoint rule; z is the depth below it.
    const auto spline = [](double y) {
        const double far = std::abs(y);
        return far < 0.5 ? 0.75 - y * y : 0.5 * std::pow(std::max(1.5 - far, 0.0), 2);
    };
    for (const double above : {-1.3, -0.8, -0.5, -0.2, 0.0, 0.4, 0.6, 1.1}) {
        constexpr int parts = 20000;
        const double step = (above + 1.5) / parts;
        double share = 0, moment = 0, gas = 0, gas_moment = 0;  // of gas in a share of 0.1 + z of the ground
        for (int i = 0; i < parts; ++i) {
            const double y = -1.5 + (i + 0.5) * step;
            share += step * spline(y);
            moment += step * y * spline(y);
            gas += step * (0.1 + above - y) * spline(y);
            gas_moment += step * (0.1 + above - y) * (above - y) * spline(y);
        }
        const LevelEdge edge(share);
        CHECK(edge.above == doctest::Approx(above).epsilon(1e-3));
        // By parts, integral of (y - mean y) dN/dy = (above - mean y) N(above) - share.
        CHECK(edge.sidedness ==
              doctest::Approx(share / (share - (above - moment / share) * spline(above))).epsilon(1e-3));
        const GroundEdge ground({0, spline(above) * 2}, share, 2);
        CHECK(ground.height == doctest::Approx(2 * above).epsilon(1e-3));
        CHECK(ground.distance == doctest::Approx(2 * (above - moment / share)).epsilon(1e-3));
        // By parts, integral of (0.1 + z) dN/dy = 0.1 N(above) + integral of N.
        const NodeVector sum{0, 2 * (0.1 * spline(above) + share)};
        CHECK(ground.distance_to(4 * gas, sum, 4 * share) == doctest::Approx(2 * gas_moment / gas).epsilon(1e-3));
    }
}

TEST_CASE("a linear field drives the very flow that it should through an edge, however few and uneven the points are") {
    struct Point {
        double x, y, volume, mass;  // place from the node, in cells
    };
    constexpr double size = 0.5;  // m
    constexpr std::array<Point, 5> points{{{-0.7, -0.9, 0.06, 80},
                                           {0.3, -0.8, 0.05, 120},
                                           {-0.2, -0.1, 0.07, 90},
                                           {0.9, -0.4, 0.04, 70},
                                           {0.6, 0.2, 0.05, 60}}};
    const auto spline = [](double x) {
        return std::abs(x) < 0.5 ? 0.75 - x * x : 0.5 * std::pow(1.5 - std::abs(x), 2);
    };
    const auto slope = [](double x) {  // by the node's distance to the point, per metre
        return (std::abs(x) < 0.5 ? -2 * x : -std::copysign(1.5 - std::abs(x), x)) / size;
    };
    double volume = 0, mass = 0;
    NodeVector sum, middle;
    NodeMoments moments;
    for (const Point& p : points) {
        const double x = p.x * size, y = p.y * size, along_x = p.volume * slope(p.x) * spline(p.y),
                     along_y = p.volume * spline(p.x) * slope(p.y), share = p.mass * spline(p.x) * spline(p.y);
        volume += p.volume * spline(p.x) * spline(p.y);
        mass += share;
        middle = {middle.x + share * x, middle.y + share * y};
        sum = {sum.x + along_x, sum.y + along_y};
        moments = {moments.xx + x * along_x, moments.yy + y * along_y, moments.yx + y * along_x,
                   moments.xy + x * along_y};
    }
    middle = {middle.x / mass, middle.y / mass};
    GroundEdge edge(sum, volume / (size * size), size);
    const double by_share = edge.more;
    edge.fit(volume, sum, middle, moments);
    CHECK(std::abs(edge.more - by_share) > 0.01);  // these points are no even filling
    NodeVector pushed;                             // by a head that rises by 1 a metre along the normal
    for (const Point& p : points) {
        const double x = p.x * size - middle.x, y = p.y * size - middle.y;
        const double head = p.volume * (edge.normal.x * x + edge.normal.y * y);
        pushed = {pushed.x + head * slope(p.x) * spline(p.y), pushed.y + head * spline(p.x) * slope(p.y)};
    }
    CHECK(dot(edge.normal, edge.stretched(edge.stretched(pushed))) == doctest::Approx(-volume).epsilon(1e-12));
}

TEST_CASE("ground takes the rain that it conducts wherever in a cell its surface lies") {
    constexpr size_t cells = 6;
    constexpr double conductivity = 1e-3, height = 1, cell_size = height / cells, nearly_full = 54;  // m/s, m, m, s
    for (const double above : {0.0, 0.25, 0.5, 0.75}) {  // of the surface over an edge of cells, in cells
        const double taller = 1 + above / cells;
        FreePoints points = wet_column(cell_size, cells, 0.85);
        for (size_t p = 0; p < points.count; ++p) {
            for (const PointField field : {position_y, point_volume, solid_mass, water_mass})
                points[field][p] *= taller;
            const double depth = height * taller - points[position_y][p];
            points[stress_yy][p] = -block_density * gravity * depth;
            points[stress_xx][p] = points[stress_zz][p] = points[stress_yy][p] * 3 / 7;
        }
        ExplicitMixture<Filling::unsaturated> column(
            cell_size, column_walls(cell_size), gravity, {{elasticity(2e7, 0.3)}},
            {{grain_density, conductivity / (1000 * gravity)}}, {{loam(), 1e7}}, {1000, 1e7}, std::move(points), 1);
        column.set_rain([](double) { return conductivity; });
        const auto steps = static_cast<int>(std::ceil(nearly_full / column.critical_step()));
        for (int i = 1; i <= steps; ++i) column.step(nearly_full / steps, i == steps);
        CHECK(column.run_off() < 2e-3 * column.rained());
    }
}

TEST_CASE("water at rest under gravity stays at rest") {
    constexpr double cell_size = 0.05, height = 1;
    FreePoints points = wet_column(cell_size, 20, 1);
    const double bulk_modulus = 1e8;
    for (size_t p = 0; p < points.count; ++p) {
        const double depth = height - points[position_y][p];
        points[water_mass][p] *= 1 + 1000 * gravity * depth / bulk_modulus;
        points[stress_yy][p] = -(block_density + porosity * 1000 - 1000) * gravity * depth;
        points[stress_xx][p] = points[stress_zz][p] = points[stress_yy][p] * 3 / 7;
    }
    ExplicitMixture<Filling::saturated> column(cell_size, column_walls(cell_size), gravity, {{elasticity(1e7, 0.3)}},
                                               {{grain_density, 1e-4 / (1000 * gravity)}}, {}, {1000, bulk_modulus},
                                               std::move(points), 1);
    const double before = water_of(column.points()), dt = column.critical_step();
    for (int i = 1; i <= 2000; ++i) column.step(dt, i == 2000);
    for (size_t p = 0; p < column.points().count; ++p) {
        const double depth = height - column.points()[position_y][p];
        // To within the weight of half a cell of water.
        const double error = std::abs(column.pressure(p) / (1000 * gravity) - depth) / cell_size;
        CHECK(error < 0.5);
        CHECK(std::abs(column.points()[velocity_y][p]) < 1e-4);
    }
    CHECK(water_of(column.points()) + column.run_off() + column.seepage() == doctest::Approx(before).epsilon(1e-12));
}

TEST_CASE("gas at rest stays at rest in ground that it and its water do not leave") {
    constexpr double cell_size = 0.05, bulk_modulus = 1e8;
    const Hydraulics soil = loam();
    const SaturationTable table(soil, 2e9);
    // Suction and gas of a column in which neither fluid flows, the gas's pressure that of the atmosphere at the top.
    FreePoints points = wet_column(cell_size, 20, 1, gas_fields);
    const double specific = air.atmosphere / air.density;
    const HydraulicTable curves(soil);
    for (size_t p = 0; p < points.count; ++p) {
        const double depth = 1 - points[position_y][p];
        const double gas = air.atmosphere * std::exp(gravity * depth / specific);
        const double suction = gas - air.atmosphere + 3e4 - 1000 * gravity * depth;
        const double saturation = curves.at(-suction).saturation, pores = porosity * points[point_volume][p];
        points[water_mass][p] = 1000 * saturation * pores * (1 + (gas - air.atmosphere) / bulk_modulus);
        points[gas_mass][p] = air.density * gas / air.atmosphere * (1 - saturation) * pores;
        points[stress_yy][p] = -(block_density + 1000 * porosity * 0.9) * gravity * depth;
        points[stress_xx][p] = points[stress_zz][p] = points[stress_yy][p] * 3 / 7;
    }
    Walls walls = column_walls(cell_size);
    walls.top = {WallKind::roller, 1, 0};
    ExplicitMixture<Filling::three_phase> column(cell_size, walls, gravity, {{elasticity(1e9, 0.3)}}, {moist}, {table},
                                                 {1000, bulk_modulus}, std::move(points), 1, air);
    const double dt = column.critical_step();
    for (int i = 1; i <= 2000; ++i) column.step(dt, i == 2000);
    for (size_t p = 0; p < column.points().count; ++p) {
        const double depth = 1 - column.points()[position_y][p];
        const double gas = air.atmosphere * std::expm1(gravity * depth / specific);
        // To the weight of a millimetre of air; of water, ten.
        CHECK(std::abs(column.gas_pressure(p) - gas) < 10 * 1e-3 * air.density * gravity);
    }
}

TEST_CASE("gas that hardly anything holds back stays calm under an open surface") {
    constexpr double cell_size = 0.05;
    FreePoints points = wet_column(cell_size, 20, 0.5, gas_fields);
    fill_with_air(points);
    for (size_t p = 0; p < points.count; ++p) points[gas_mass][p] *= 1 + 1e-5;
    // Soft ground and water, so that the gas's wave is the fastest.
    ExplicitMixture<Filling::three_phase> column(
        cell_size, column_walls(cell_size), 0, {{elasticity(1e7, 0.3)}}, {{grain_density, 1e-9, 0, false, 1e-2}},
        {{van_genuchten(1e-3, 4), 1e7}}, {1000, 1e7}, std::move(points), 1, air);
    for (int i = 1; i <= 2000; ++i) REQUIRE(column.step(column.critical_step(), i == 2000));
    for (size_t p = 0; p < column.points().count; ++p) CHECK(std::abs(column.gas_pressure(p)) < 10);
}

TEST_CASE("a mixture gives the same bits with one and two threads") {
    constexpr double cell_size = 0.05;
    const auto run = [](int32_t threads) {
        FreePoints points = block_of_points(cell_size, 0.5, 0.02, 20, 20, wet_fields);
        for (size_t p = 0; p < points.count; ++p) {
            points[water_mass][p] = 1000 * porosity * points[point_volume][p];
            points[velocity_x][p] = points[liquid_velocity_x][p] = 1;
        }
        const ExplicitSoil soil{elasticity(1e6, 0.3), true, mohr_coulomb({100, 30}, 0, 1e300)};
        ExplicitMixture<Filling::saturated> block(cell_size, {{}, {WallKind::roller, 3, 0}, {WallKind::fixed, 0, 0}},
                                                  gravity, {soil}, {{grain_density, 1e-7}}, {}, {1000, 1e6},
                                                  std::move(points), threads);
        for (int i = 1; i <= 300; ++i) block.step(block.critical_step(), i == 300);
        return block.points();
    };
    const FreePoints one = run(1), two = run(2);
    for (size_t f = 0; f < wet_fields; ++f) CHECK(one.field[f] == two.field[f]);
}

TEST_CASE(
    "ground of three phases that slumps loses no water and no air but through its edge, with the same bits for one and two threads") {
    constexpr double cell_size = 0.05;
    const auto run = [](const Walls& walls, int32_t threads) {
        FreePoints points = block_of_points(cell_size, 0.5, 0.02, 20, 20, gas_fields);
        for (size_t p = 0; p < points.count; ++p) {
            const double filled = points[position_y][p] < 0.3 ? 1 : 0.7;
            points[water_mass][p] = 1000 * porosity * filled * points[point_volume][p];
            points[velocity_x][p] = points[liquid_velocity_x][p] = points[gas_velocity_x][p] = 1;
        }
        fill_with_air(points);
        const double water = water_of(points), gas = air_of(points);
        const ExplicitSoil soil{elasticity(1e6, 0.3), true, mohr_coulomb({100, 30}, 0, 1e300)};
        ExplicitMixture<Filling::three_phase> block(cell_size, walls, gravity, {soil}, {moist}, {{loam(), 1e6}},
                                                    {1000, 1e6}, std::move(points), threads, air);
        for (int i = 1; i <= 2000; ++i) CHECK(block.step(block.critical_step(), i == 2000));
        CHECK(water_of(block.points()) + block.seepage() == doctest::Approx(water).epsilon(1e-12));
        CHECK(air_of(block.points()) + block.gas_escaped() == doctest::Approx(gas).epsilon(1e-12));
        CHECK(std::abs(block.gas_escaped()) < gas);
        return block.points();
    };
    const Wall rough{WallKind::friction, 0, 0.3}, behind{WallKind::friction, 0.45, 0.3},
        ahead{WallKind::friction, 1.65, 0.3};
    for (const Walls& walls :
         {Walls{{}, {WallKind::roller, 3, 0}, {WallKind::fixed, 0, 0}, {}}, Walls{behind, ahead, rough, {}},
          Walls{{WallKind::roller, 0.45, 0}, ahead, {WallKind::fixed, 0, 0}, {}}}) {
        const FreePoints one = run(walls, 1), two = run(walls, 2);
        for (size_t f = 0; f < gas_fields; ++f) CHECK(one.field[f] == two.field[f]);
        CHECK(one.least(gas_mass) >= 0);
    }
}
