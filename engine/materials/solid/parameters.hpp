// What a scene says about a soil's skeleton.
#pragma once

#include <limits>

namespace talus {

enum class SolidModel { elastic, mohr_coulomb };

/// How cohesion c and friction angle phi grow with the suction s (see docs/theory.md).
///   constant:    c, phi
///   fredlund:    c + s tan(suction_friction_angle)           Fredlund, Morgenstern & Widger (1978)
///   vanapalli:   c + s S_e tan(phi)                          Vanapalli et al. (1996)
///   exponential: c + cohesion_gain [1 - exp(-cohesion_rate s / p_atm)], phi + friction_gain s / p_atm
enum class StrengthModel { constant, fredlund, vanapalli, exponential };

struct Strength {
    StrengthModel model = StrengthModel::vanapalli;
    double cohesion = 0;                ///< Pa
    double friction_angle = 0;          ///< degrees
    double suction_friction_angle = 0;  ///< degrees, fredlund only
    double cohesion_gain = 0;           ///< Pa, exponential only
    double cohesion_rate = 0;           ///< -, exponential only
    double friction_gain = 0;           ///< degrees, exponential only
};

/// How the strength falls with the slip on a shear band. Without a slip it does not.
struct Softening {
    double residual_cohesion = std::numeric_limits<double>::quiet_NaN();        ///< Pa
    double residual_friction_angle = std::numeric_limits<double>::quiet_NaN();  ///< degrees
    double slip = 0;                                                            ///< m, at which they are reached
};

/// How friction grows with the rate of shear. Without a grain diameter it does not.
struct InertialFriction {
    double limit_friction_angle = std::numeric_limits<double>::quiet_NaN();  ///< degrees, at a boundless rate
    double inertial_number = 0.279;                                          ///< -, at which half of the way is gone
    double grain_diameter = 0;                                               ///< m
};

struct Solid {
    SolidModel model = SolidModel::mohr_coulomb;
    double young_modulus = 0;                                           ///< Pa
    double poisson_ratio = 0;                                           ///< -
    Strength strength;                                                  ///< mohr_coulomb only
    double dilation_angle = 0;                                          ///< degrees, mohr_coulomb only
    double tensile_strength = std::numeric_limits<double>::infinity();  ///< Pa; infinite: the cone's apex alone
    Softening softening;                                                ///< mohr_coulomb only
    InertialFriction inertial_friction;                                 ///< mohr_coulomb only
};

}  // namespace talus
