// Mohr-Coulomb with apex and Rankine tension cut-off, perfectly plastic for the given parameters, on isotropic elasticity.
//
// With principal stresses s1 >= s2 >= s3, tension positive, a stress is admissible when
//     (1 + sin phi) s1 - (1 - sin phi) s3 <= 2 c cos phi     and     s1 <= tensile strength.
// Shear flows with the dilation angle in place of phi, tension flows with its own plane (associated).
#pragma once

#include "materials/solid/elastic.hpp"
#include "materials/solid/strength.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace talus {

struct MohrCoulomb {
    double cohesion;          ///< Pa
    double sin_friction;      ///< -
    double cos_friction;      ///< -
    double sin_dilation;      ///< -, 0 to sin_friction
    double tensile_strength;  ///< Pa, infinite when only the apex limits tension
};

/// Dilation angle in degrees; flow never dilates more than the associated one, which holds dilation back as friction softens.
MohrCoulomb mohr_coulomb(const ShearStrength& strength, double dilation_angle, double tensile_strength);

/// Where on the yield surface a stress came to lie.
enum class YieldRegion : uint8_t {
    elastic,        ///< inside: the trial stress stands
    shear,          ///< main plane, s1 > s2 > s3
    shear_edge,     ///< edge of the cone, s2 = s3 or s1 = s2
    tension,        ///< one or two principal stresses at the tensile strength
    shear_tension,  ///< the main plane and the tensile strength at once
    apex,           ///< the tip: all principal stresses at the tensile strength, or at the cone's apex
};

struct PlasticReturn {
    Eigen::Vector4d stress;          ///< Pa
    Eigen::Vector4d plastic_strain;  ///< increment
    double plastic_shear_strain;     ///< increment of sqrt(2/3 e:e), e the deviator of the plastic strain
    YieldRegion region;
};

/// Largest and smallest principal stress, from the Mohr circle in the plane and the stress out of it.
struct ExtremeStress {
    double largest;
    double smallest;
};

inline ExtremeStress extreme_stress(const Eigen::Vector4d& stress) {
    const double centre = (stress[0] + stress[1]) / 2;
    const double half_difference = (stress[0] - stress[1]) / 2;
    const double radius = std::sqrt(half_difference * half_difference + stress[3] * stress[3]);
    return {std::max(centre + radius, stress[2]), std::min(centre - radius, stress[2])};
}

inline bool is_admissible(const MohrCoulomb& material, const Eigen::Vector4d& stress) {
    const auto [largest, smallest] = extreme_stress(stress);
    const double shear = (1 + material.sin_friction) * largest - (1 - material.sin_friction) * smallest;
    return shear <= 2 * material.cohesion * material.cos_friction && largest <= material.tensile_strength;
}

/// Returns an inadmissible stress to the yield surface; what return_stress does when is_admissible says no.
/// The tangent is d stress / d strain of the increment, row by row as (xx, yy, zz, xy); null where it is not wanted.
PlasticReturn return_to_yield_surface(const Elasticity& elastic, const MohrCoulomb& material,
                                      const Eigen::Vector4d& trial, Eigen::Matrix4d* tangent);

/// The stress of a step whose elastic trial stress is given, and its consistent tangent, null where it is not wanted. Defined for any trial stress
/// (below 1e150 Pa, whose square is a number).
inline PlasticReturn return_stress(const Elasticity& elastic, const MohrCoulomb& material, const Eigen::Vector4d& trial,
                                   Eigen::Matrix4d* tangent) {
    if (!is_admissible(material, trial)) return return_to_yield_surface(elastic, material, trial, tangent);
    if (tangent != nullptr) *tangent = elastic_stiffness(elastic);
    return {trial, Eigen::Vector4d::Zero(), 0, YieldRegion::elastic};
}

/// Local factor of safety: (c cos phi + p sin phi) / q, the radius that Mohr's circle of s1 and s3 may have over the one it has,
/// q, at the same centre -p = (s1 + s3) / 2. One on the shear planes and at the apex, zero beyond the apex. A thousandth of a
/// pascal added to both keeps the ratio defined where there is no shear.
inline double factor_of_safety(const MohrCoulomb& material, const Eigen::Vector4d& stress) {
    constexpr double negligible = 1e-3;
    const auto [largest, smallest] = extreme_stress(stress);
    const double available =
        material.cohesion * material.cos_friction - (largest + smallest) / 2 * material.sin_friction;
    const double mobilised = (largest - smallest) / 2;
    return std::max(available + negligible, 0.0) / (mobilised + negligible);
}

/// Share of the shear strength in use, 0 to 1: the inverse of the factor of safety, 1 where that is below 1.
inline double mobilised_strength(const MohrCoulomb& material, const Eigen::Vector4d& stress) {
    return 1 / std::max(factor_of_safety(material, stress), 1.0);
}

}  // namespace talus
