#include "materials/solid/strength.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace talus {

namespace {

constexpr double atmospheric_pressure = 101325;  // Pa
constexpr double largest_friction_angle = 60;    // degrees

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

ShearStrength softened(const ShearStrength& strength, const Solid& solid, double lost) {
    if (!(solid.softening.slip > 0)) return strength;
    constexpr double degree = std::numbers::pi / 180;
    const double peak = sin_degrees(solid.strength.friction_angle);
    const double residual = sin_degrees(solid.softening.residual_friction_angle);
    const double sine = sin_degrees(strength.friction_angle) + lost * (residual - peak);
    return {strength.cohesion + lost * (solid.softening.residual_cohesion - solid.strength.cohesion),
            std::asin(sine) / degree};
}

}  // namespace talus
