// What the skeleton carries: the input of one solve of the equilibrium.
#pragma once

#include "materials/solid/strength.hpp"

#include <span>

namespace talus {

/// Total stress = skeleton stress - pore_stress * identity. The spans must outlive the solve only.
struct Loads {
    std::span<const double> density;          ///< points, of solid and water together, kg/m3
    std::span<const double> pore_stress;      ///< points, Pa, compression positive, any sign
    std::span<const ShearStrength> strength;  ///< points; read where the soil is mohr_coulomb, may be empty otherwise
    std::span<const double> force;            ///< nodes x dimension, on the boundary, N per m of thickness
    std::span<const double> prescribed;       ///< nodes x dimension, displacement increment, m; read where prescribed
};

}  // namespace talus
