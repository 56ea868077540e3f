#include "materials/hydraulic/fluid_exchange.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

/// Where the pores hold a given saturation: the fluids' state and what water is in them, and the slopes by the saturation.
struct Filled {
    Partition partition;
    double water;  // kg per m3 of pores
    double water_slope, suction_slope, gas_slope, vapour_slope, dissolved_slope;
};

SaturationTable::MixedState state_at(const SaturationTable& table, double saturation, double& slope) {
    const double effective = table.effective(saturation);
    const double logit = std::log(SaturationTable::odds(std::max(effective, 0.0)));
    slope = table.suction_slope(effective, logit);
    return table.mixed_at(effective, logit);
}

Filled fill(const SaturationTable& table, const FluidExchange& fluids, double air, double saturation) {
    double suction_slope = 0;
    const SaturationTable::MixedState state = state_at(table, saturation, suction_slope);
    const double room = 1 - saturation, per_solubility = room + fluids.solubility * saturation;
    const double vapour = fluids.vapour_density(state.suction);
    const double vapour_slope = -vapour * suction_slope / (fluids.liquid_density * fluids.vapour);
    const double air_in_gas = air / per_solubility;
    const double gas = fluids.air * air_in_gas + fluids.vapour * vapour - fluids.atmosphere;
    const double gas_slope =
        fluids.air * air_in_gas * (1 - fluids.solubility) / per_solubility + fluids.vapour * vapour_slope;
    const double dissolved = fluids.solubility * air_in_gas;
    const double density = fluids.liquid_density * (1 + gas / fluids.bulk_modulus);
    const double water_slope = density + saturation * fluids.liquid_density * gas_slope / fluids.bulk_modulus -
                               dissolved / per_solubility - vapour + room * vapour_slope;
    return {{saturation, gas - state.suction, gas, vapour, dissolved, state},
            saturation * (density - dissolved) + room * vapour,
            water_slope,
            suction_slope,
            gas_slope,
            vapour_slope,
            dissolved * (1 - fluids.solubility) / per_solubility};
}

/// At a saturation so near that the slopes tell the rest.
Partition beside(const Filled& found, double step) {
    Partition partition = found.partition;
    partition.saturation += step;
    partition.gas_pressure += step * found.gas_slope;
    partition.water_pressure += step * (found.gas_slope - found.suction_slope);
    partition.vapour += step * found.vapour_slope;
    partition.dissolved += step * found.dissolved_slope;
    partition.state.suction += step * found.suction_slope;
    return partition;
}

/// Pores full of liquid, in which all of the air is dissolved.
Partition without_gas(const SaturationTable& table, const FluidExchange& fluids, double water, double air) {
    const double pressure = fluids.bulk_modulus * ((water + air) / fluids.liquid_density - 1);
    double slope = 0;
    return {1, pressure, pressure, fluids.saturated_vapour, air, state_at(table, 1, slope)};
}

}  // namespace

double saturated_vapour_pressure(double temperature) {
    constexpr double critical_temperature = 647.096, critical_pressure = 22.064e6;
    const double far = 1 - temperature / critical_temperature, root = std::sqrt(far);
    const double sum = -7.85951783 * far + 1.84408259 * far * root - 11.7866497 * std::pow(far, 3) +
                       22.6807411 * std::pow(far, 3) * root - 15.9618719 * std::pow(far, 4) +
                       1.80122502 * std::pow(far, 7) * root;
    return critical_pressure * std::exp(critical_temperature / temperature * sum);
}

double FluidExchange::vapour_density(double suction) const {
    return saturated_vapour * std::exp(-suction / (liquid_density * vapour));
}

FluidExchange fluid_exchange(double air_density, double atmosphere, double temperature, double henry_constant) {
    const double thermal = gas_constant * temperature;
    FluidExchange fluids;
    fluids.atmosphere = atmosphere;
    fluids.air = atmosphere / air_density;
    fluids.vapour = thermal / water_molar_mass;
    fluids.saturated_vapour = saturated_vapour_pressure(temperature) / fluids.vapour;
    fluids.solubility = henry_constant * thermal;
    return fluids;
}

// Newton's method on the water that pores of a saturation S hold, which grows with S: the liquid is denser than the vapour that makes way
// for it, and both are denser the lower the suction is.
Partition find_partition(const SaturationTable& table, const FluidExchange& fluids, double water, double air,
                         double start) {
    constexpr int most_iterations = 100;
    constexpr double near = 1e-6;  // of the saturation, or of what gas has: its square is what the last step leaves
    const double of_air = std::max(air, 0.0);
    const double bubbles_at =
        fluids.air * of_air / fluids.solubility + fluids.vapour * fluids.saturated_vapour - fluids.atmosphere;
    if (water + of_air >= fluids.liquid_density * (1 + bubbles_at / fluids.bulk_modulus))
        return without_gas(table, fluids, water, of_air);
    if (water < fluids.saturated_vapour) {
        Partition dry = fill(table, fluids, of_air, 0).partition;
        if (water <= dry.vapour) {
            const double missing = fluids.vapour * (dry.vapour - water);
            dry.gas_pressure -= missing;
            dry.water_pressure -= missing;
            dry.vapour = water;
            return dry;
        }
    }
    double low = 0, high = 1, saturation = std::clamp(start, 1e-12, 1 - 1e-9);
    Filled found{};
    double step = 0;
    for (int i = 0; i < most_iterations; ++i) {
        found = fill(table, fluids, of_air, saturation);
        step = (water - found.water) / found.water_slope;
        if (std::abs(step) <= near * std::min(saturation, 1 - saturation)) break;
        (found.water > water ? high : low) = saturation;
        saturation += step;
        if (!(saturation > low && saturation < high)) saturation = 0.5 * (low + high);
    }
    return beside(found, std::clamp(step, low - saturation, high - saturation));
}

}  // namespace talus
