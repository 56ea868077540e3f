// Shear strength as a function of suction: the forms of StrengthModel.
#pragma once

#include "materials/solid/parameters.hpp"

#include <cmath>
#include <numbers>

namespace talus {

inline double sin_degrees(double angle) { return std::sin(angle * std::numbers::pi / 180); }
inline double tan_degrees(double angle) { return std::tan(angle * std::numbers::pi / 180); }

/// What Mohr-Coulomb takes at one place and time.
struct ShearStrength {
    double cohesion;        ///< Pa
    double friction_angle;  ///< degrees
};

/// Strength at a suction (Pa; at or below zero it adds nothing) and an effective saturation (-, 0 to 1).
/// The exponential form's friction angle, linear in suction, stays below 60 degrees, beyond any soil it was measured on.
ShearStrength shear_strength(const Strength& strength, double suction, double effective_saturation);

/// On a shear band as wide as a cell of this size (m), m: what softening goes by, so that a band dissipates the same in cells of any size.
inline double band_slip(double plastic_shear_strain, double size) {
    return std::sqrt(3.0) * size * plastic_shear_strain;
}

/// The strength of ground that has lost this share (0 to 1) of what the solid's softening takes.
ShearStrength softened(const ShearStrength& strength, const Solid& solid, double lost);

}  // namespace talus
