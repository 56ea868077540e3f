// Isotropic linear elasticity.
// Stress and strain here and in every solid material are (xx, yy, zz, xy) of plane strain, tension positive, shear strain as the
// angle gamma_xy; a column is the case in which only the yy strain changes.
#pragma once

#include <Eigen/Core>

namespace talus {

struct Elasticity {
    double lame;   ///< first Lame parameter, Pa
    double shear;  ///< shear modulus, Pa
};

/// Young modulus in Pa (> 0), Poisson ratio in (-1, 1/2).
inline Elasticity elasticity(double young_modulus, double poisson_ratio) {
    const double shear = young_modulus / (2 * (1 + poisson_ratio));
    return {2 * shear * poisson_ratio / (1 - 2 * poisson_ratio), shear};
}

/// The stiffness D of stress = D strain, Pa.
inline Eigen::Matrix4d elastic_stiffness(const Elasticity& elastic) {
    const double side = elastic.lame;
    const double axial = elastic.lame + 2 * elastic.shear;
    Eigen::Matrix4d stiffness;
    stiffness << axial, side, side, 0,  //
        side, axial, side, 0,           //
        side, side, axial, 0,           //
        0, 0, 0, elastic.shear;
    return stiffness;
}

}  // namespace talus
