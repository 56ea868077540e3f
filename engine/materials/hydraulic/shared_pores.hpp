// Water and gas in the same pores: their pressures from their masses and the pores' volume.
//
//     gas    P = atmosphere + p_g = gas / (1 - S)              ideal and isothermal; `gas` is P were the pores full of it
//     water  p_l = K (filled / S - 1) where p_l > 0, S = filled else
//     p_g - p_l = s(S)                                         the soil's retention
// Tension does not stretch the water. The pressures grow without bound as pores close: there is one solution for any masses above zero.
#pragma once

#include "materials/hydraulic/saturation_table.hpp"

#include <cmath>

namespace talus {

struct SharedPores {
    double water_pressure;  ///< p_l, Pa
    double gas_pressure;    ///< p_g, Pa
    double gas_share;       ///< 1 - S
    SaturationTable::MixedState state;
};

/// The stiff fluids of a scene.
struct PoreFluids {
    double bulk_modulus;  ///< K of the water, Pa
    double atmosphere;    ///< Pa, absolute
};

/// Where the water is pressed together. `filled`: volume of the water without pressure, over the pores'; `gas`: Pa, absolute, were the pores full
/// of it.
SharedPores press_pores(const SaturationTable& table, const PoreFluids& fluids, double filled, double gas);

/// The same of any water; `state` is the retention's at `filled`.
inline SharedPores share_pores(const SaturationTable& table, const PoreFluids& fluids, double filled, double gas,
                               const SaturationTable::MixedState& state) {
    if (filled < 1) {
        const double gas_pressure = gas / (1 - filled) - fluids.atmosphere;
        if (gas_pressure <= state.suction) return {gas_pressure - state.suction, gas_pressure, 1 - filled, state};
    }
    return press_pores(table, fluids, filled, gas);
}

}  // namespace talus
