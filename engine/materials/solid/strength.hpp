// Shear strength as a function of suction: the forms of StrengthModel.
#pragma once

#include "materials/solid/parameters.hpp"

namespace talus {

/// What Mohr-Coulomb takes at one place and time.
struct ShearStrength {
    double cohesion;        ///< Pa
    double friction_angle;  ///< degrees
};

/// Strength at a suction (Pa; at or below zero it adds nothing) and an effective saturation (-, 0 to 1).
/// The exponential form's friction angle, linear in suction, stays below 60 degrees, beyond any soil it was measured on.
ShearStrength shear_strength(const Strength& strength, double suction, double effective_saturation);

/// The strength of ground that has lost this share (0 to 1) of what the solid's softening takes.
ShearStrength softened(const ShearStrength& strength, const Solid& solid, double lost);

}  // namespace talus
