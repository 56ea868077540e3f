// Water and air in equilibrium between liquid and gas.
#include "doctest/doctest.h"
#include "materials/hydraulic/fluid_exchange.hpp"
#include "verification/explicit_cases.hpp"

#include <algorithm>
#include <cmath>

using namespace talus;
using namespace talus::test;

namespace {

FluidExchange at_20_degrees() { return fluid_exchange(1.2041, 101325, 293.15, 7.8e-6); }

/// doctest's Approx is an absolute bound for values below 1.
bool same(double a, double b, double share) {
    constexpr double nothing = 1e-12;
    return std::abs(a - b) <= share * std::max({std::abs(a), std::abs(b), nothing / share});
}

double suction_at(const SaturationTable& table, double saturation) { return -table.at(saturation).pressure; }

}  // namespace

TEST_CASE("vapour over water and moist soil is that of the tables") {
    CHECK(saturated_vapour_pressure(273.16) == doctest::Approx(611.66).epsilon(1e-4));
    CHECK(saturated_vapour_pressure(293.15) == doctest::Approx(2339).epsilon(2e-4));
    CHECK(saturated_vapour_pressure(313.15) == doctest::Approx(7385).epsilon(2e-4));
    CHECK(saturated_vapour_pressure(373.15) == doctest::Approx(101418).epsilon(2e-4));
    const FluidExchange fluids = at_20_degrees();
    CHECK(fluids.saturated_vapour / 0.01729 == doctest::Approx(1).epsilon(1e-3));
    // At the wilting point, 1.5 MPa, 98.9 % of humidity; half of it at 94 MPa.
    CHECK(fluids.vapour_density(1.5e6) / fluids.saturated_vapour == doctest::Approx(0.989).epsilon(1e-3));
    CHECK(fluids.vapour_density(93.8e6) / fluids.saturated_vapour == doctest::Approx(0.5).epsilon(2e-3));
}

TEST_CASE("Kelvin, Henry, Dalton and retention hold at any masses of water and air") {
    FluidExchange fluids = at_20_degrees();
    const auto holds = [&fluids](const SaturationTable& table) {
        for (const double water : {1e-3, 0.01, 0.1, 5.0, 300.0, 850.0, 990.0, 999.99, 1000.5}) {
            for (const double air : {0.0, 1e-3, 0.05, 0.2, 1.2, 10.0}) {
                CAPTURE(water);
                CAPTURE(air);
                const Partition found = find_partition(table, fluids, water, air, water / 1000);
                const double wet = found.saturation, room = 1 - wet;
                REQUIRE(wet >= 0);
                REQUIRE(room >= 0);
                const double suction = found.gas_pressure - found.water_pressure;
                const double liquid = 1000 * (1 + found.gas_pressure / fluids.bulk_modulus);
                CHECK(same(wet * (liquid - found.dissolved) + room * found.vapour, water, 1e-11));
                if (room == 0) {
                    CHECK(same(found.dissolved, air, 1e-12));
                    CHECK(same(found.water_pressure, fluids.bulk_modulus * ((water + air) / 1000 - 1), 1e-6));
                    continue;
                }
                const double air_pressure = 101325 + found.gas_pressure - fluids.vapour * found.vapour;
                CHECK(same(found.dissolved, fluids.solubility * air_pressure / fluids.air, 1e-6));
                CHECK(same(wet * found.dissolved + room * air_pressure / fluids.air, air, 1e-6));
                if (wet == 0) {
                    CHECK(same(found.vapour, water, 1e-12));
                    continue;
                }
                CHECK(same(found.vapour, fluids.vapour_density(suction), 1e-9));
                CHECK(same(suction, suction_at(table, wet), 1e-5));
            }
        }
    };
    for (const double bulk_modulus : {2e9, 1e7, 2e5}) {
        CAPTURE(bulk_modulus);
        fluids.bulk_modulus = bulk_modulus;
        for (const Hydraulics& soil : {van_genuchten(4e-5, 1.2), van_genuchten(1e-3, 4)}) holds({soil, bulk_modulus});
    }
}

TEST_CASE("a partition does not depend on where its search starts, and changes little where gas or liquid vanishes") {
    const FluidExchange fluids = at_20_degrees();
    const SaturationTable table(van_genuchten(1e-4, 2), 2e9);
    for (const double water : {0.02, 400.0, 999.0}) {
        const double wet = find_partition(table, fluids, water, 0.3, 0.5).saturation;
        for (const double start : {1e-9, 0.9, 1.0, 1.01})
            CHECK(same(find_partition(table, fluids, water, 0.3, start).saturation, wet, 1e-9));
    }
    // Air that just dissolves: at the atmosphere's pressure, water takes so much of it.
    const double air = fluids.solubility * (101325 - fluids.vapour * fluids.saturated_vapour) / fluids.air;
    for (const double missing : {1e-7, -1e-7}) {
        const Partition found = find_partition(table, fluids, 1000 - air, air * (1 + missing), 1);
        CHECK(std::abs(found.water_pressure) < 1);
        CHECK(found.saturation == doctest::Approx(1).epsilon(1e-6));
    }
}
