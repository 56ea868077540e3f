// Water and gas in the same pores: their pressure from their masses and the pores' volume.
//
//     gas    P = atmosphere + p_g = gas / (1 - S)     ideal and isothermal; `gas` is P were the pores full of it
//     water  filled = S (1 + p_g / K)
// P is the root above zero of P^2 / K - (filled + gas / K - c) P - c gas = 0, c = 1 - atmosphere / K. It grows with either mass, for water stiffer
// than the atmosphere's pressure by K per `filled` at most: however little gas there is, pores are as stiff as water and no stiffer, whether
// pressed or stretched. Suction stretches no water: it is the retention's at `filled`, and p_l = p_g - s.
#pragma once

#include <cmath>

namespace talus {

/// The stiff fluids of a scene.
struct PoreFluids {
    double bulk_modulus;  ///< K of the water, Pa
    double atmosphere;    ///< Pa, absolute
};

/// P, absolute, Pa. `filled`: volume of the water without pressure, over the pores'; `gas`: Pa, absolute, were the pores full of it.
inline double shared_pressure(const PoreFluids& fluids, double filled, double gas) {
    const double softness = 1 / fluids.bulk_modulus, rest = 1 - fluids.atmosphere * softness;
    const double excess = filled + gas * softness - rest;
    const double root = std::sqrt(excess * excess + 4 * rest * gas * softness);
    // Written so that nothing cancels.
    return excess < 0 ? 2 * rest * gas / (root - excess) : 0.5 * fluids.bulk_modulus * (root + excess);
}

}  // namespace talus
