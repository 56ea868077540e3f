#include "materials/solid/strength.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>

using namespace talus;

namespace {

Strength soil(StrengthModel model) {
    Strength strength;
    strength.model = model;
    strength.cohesion = 12e3;
    strength.friction_angle = 30;
    return strength;
}

}  // namespace

TEST_CASE("strength: constant takes no notice of suction") {
    const ShearStrength result = shear_strength(soil(StrengthModel::constant), 50e3, 0.9);
    CHECK(result.cohesion == 12e3);
    CHECK(result.friction_angle == 30);
}

TEST_CASE("strength: Fredlund adds s tan(phi_b)") {
    Strength strength = soil(StrengthModel::fredlund);
    strength.suction_friction_angle = 15;
    const ShearStrength result = shear_strength(strength, 50e3, 0.9);
    CHECK(result.cohesion == doctest::Approx(25397.459621556).epsilon(1e-12));  // 12000 + 50000 (2 - sqrt 3)
    CHECK(result.friction_angle == 30);
}

TEST_CASE("strength: Vanapalli adds s S_e tan(phi)") {
    const ShearStrength result = shear_strength(soil(StrengthModel::vanapalli), 50e3, 0.9);
    CHECK(result.cohesion == doctest::Approx(37980.762113533).epsilon(1e-12));  // 12000 + 45000 / sqrt 3
    CHECK(result.friction_angle == 30);
}

TEST_CASE("strength: exponential gains cohesion up to a limit, and friction") {
    Strength strength = soil(StrengthModel::exponential);
    strength.cohesion_gain = 40e3;
    strength.cohesion_rate = 2;
    strength.friction_gain = 3;
    const ShearStrength one_atmosphere = shear_strength(strength, 101325, 0.9);
    CHECK(one_atmosphere.cohesion == doctest::Approx(46586.588670535).epsilon(1e-12));  // 12000 + 40000 (1 - exp -2)
    CHECK(one_atmosphere.friction_angle == doctest::Approx(33).epsilon(1e-15));
    const ShearStrength very_dry = shear_strength(strength, 1e9, 0.01);
    CHECK(very_dry.cohesion == doctest::Approx(52e3));
    CHECK(very_dry.friction_angle == 60);
}

TEST_CASE("strength: suction adds nothing at or below zero, and enters without a jump") {
    for (const StrengthModel model :
         {StrengthModel::constant, StrengthModel::fredlund, StrengthModel::vanapalli, StrengthModel::exponential}) {
        Strength strength = soil(model);
        strength.suction_friction_angle = 15;
        strength.cohesion_gain = 40e3;
        strength.cohesion_rate = 2;
        strength.friction_gain = 3;
        for (const double suction : {0.0, -1.0, -80e3}) {
            const ShearStrength result = shear_strength(strength, suction, 1);
            CHECK(result.cohesion == 12e3);
            CHECK(result.friction_angle == 30);
        }
        const ShearStrength barely_dry = shear_strength(strength, 1e-3, 1);
        CHECK(barely_dry.cohesion - 12e3 < 1e-2);
        CHECK(barely_dry.friction_angle - 30 < 1e-6);
    }
}
