// Water and air that share pores as liquid and gas in equilibrium, at one temperature.
//
//     vapour in the gas        rho_v = rho_sat exp(-s M_w / (rho_l R T))                        Kelvin
//     air in the liquid        rho_d = M_a H p_a, p_a the partial pressure of the gas's air     Henry
//     gas                      P = atmosphere + p_g = R T (rho_v / M_w + rho_a / M_a)           Dalton, ideal gases
//     liquid                   rho = rho_l (1 + p_g / K), with all that is dissolved in it
//     p_g - p_l = s(S)                                                                          the soil's retention
// As in shared_pores.hpp the gas's pressure presses and stretches the liquid, suction does not. Where all of the air is dissolved no gas is
// left, and where all of the water is vapour no liquid is.
#pragma once

#include "materials/hydraulic/saturation_table.hpp"

namespace talus {

inline constexpr double gas_constant = 8.314462618;      // J/(mol K)
inline constexpr double water_molar_mass = 0.018015268;  // kg/mol

/// Pa, over a level surface of pure water at a temperature in K (Wagner & Pruss, J. Phys. Chem. Ref. Data 31, 2002).
double saturated_vapour_pressure(double temperature);

/// What the two fluids and the two that pass between them are like.
struct FluidExchange {
    double atmosphere = 101325;    ///< Pa, absolute
    double bulk_modulus = 2e9;     ///< K, Pa
    double liquid_density = 1000;  ///< rho_l, kg/m3 at no gauge pressure
    double air = 0;                ///< R T / M_a, J/kg
    double vapour = 0;             ///< R T / M_w, J/kg
    double saturated_vapour = 0;   ///< rho_sat, kg/m3
    double solubility = 0;         ///< H R T: air in a volume of liquid over that in a volume of gas, -

    /// Kelvin's, kg per m3 of gas; suction in Pa.
    [[nodiscard]] double vapour_density(double suction) const;
};

/// Of air of a density (kg/m3) at the atmosphere's pressure (Pa), a temperature (K) and Henry's constant (mol/(m3 Pa)).
FluidExchange fluid_exchange(double air_density, double atmosphere, double temperature, double henry_constant);

struct Partition {
    double saturation;      ///< S of the liquid
    double water_pressure;  ///< p_l, Pa
    double gas_pressure;    ///< p_g, Pa; p_l where there is no gas
    double vapour;          ///< rho_v, kg per m3 of gas
    double dissolved;       ///< rho_d, kg per m3 of liquid
    SaturationTable::MixedState state;
};

/// Where `water` and `air` (kg per m3 of pores, in both fluids together) come to rest; `start`: about the saturation.
Partition find_partition(const SaturationTable& table, const FluidExchange& fluids, double water, double air,
                         double start);

}  // namespace talus
