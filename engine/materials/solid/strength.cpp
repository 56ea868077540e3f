#include "materials/solid/strength.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace talus {

namespace {

constexpr double atmospheric_pressure = 101325;  // Pa
constexpr double largest_friction_angle = 60;    // degrees

double tan_degrees(double angle) { return std::tan(angle * std::numbers::pi / 180); }

}  // namespace

ShearStrength shear_strength(const Strength& strength, double suction, double effective_saturation) {
    const ShearStrength saturated{strength.cohesion, strength.friction_angle};
    if (suction <= 0) return saturated;

    switch (strength.model) {
        case StrengthModel::constant: return saturated;
        case StrengthModel::fredlund:
            return {saturated.cohesion + suction * tan_degrees(strength.suction_friction_angle),
                    saturated.friction_angle};
        case StrengthModel::vanapalli:
            return {saturated.cohesion + suction * effective_saturation * tan_degrees(saturated.friction_angle),
                    saturated.friction_angle};
        case StrengthModel::exponential: {
            const double ratio = suction / atmospheric_pressure;
            const double friction_angle = saturated.friction_angle + strength.friction_gain * ratio;
            return {saturated.cohesion - strength.cohesion_gain * std::expm1(-strength.cohesion_rate * ratio),
                    std::min(friction_angle, largest_friction_angle)};
        }
    }
    return saturated;
}

}  // namespace talus
