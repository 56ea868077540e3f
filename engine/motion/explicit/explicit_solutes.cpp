// What the points do with the solutes of their fluids: vapour, and air in the water.
//
// Points hold liquid and gas and what of them is solute. Flow and diffusion change the water and the air of a point; how they are shared by its
// two fluids is found anew each step, as they are always in equilibrium (materials/hydraulic/fluid_exchange.hpp).
#include "motion/explicit/explicit_mixture.hpp"
#include "motion/explicit/fluid_gifts.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

double fraction_of(double solute, double fluid) { return fluid > 0 ? solute / fluid : 0; }

/// n^(1/3) S^(7/3) of a fluid in so much of the ground (Millington & Quirk 1961).
double tortuosity(double content, double saturation) { return saturation * saturation * std::cbrt(content); }

}  // namespace

template <>
void ExplicitMixture<Filling::exchange>::set_exchange(const ExplicitExchange& exchange) {
    exchange_ = exchange.fluids;
    exchange_.liquid_density = water_.density;
    exchange_.bulk_modulus = water_.bulk_modulus;
    const double vapour = exchange.humidity * exchange_.saturated_vapour;
    const double air = (exchange_.atmosphere - exchange_.vapour * vapour) / exchange_.air;
    NodeSolutes& solutes = nodes_.solutes;
    solutes.vapour_diffusivity = exchange.vapour_diffusivity;
    solutes.air_diffusivity = exchange.air_diffusivity;
    solutes.outer_vapour = vapour / (vapour + air);
    solutes.outer_air = exchange_.solubility * air / water_.density;
}

template <>
Partition ExplicitMixture<Filling::exchange>::partition_of(size_t p) const {
    const auto soil = static_cast<size_t>(points_.soil[p]);
    const double per_pores = 1 / (points_[point_volume][p] - points_[solid_mass][p] * grain_volume_[soil]);
    const double liquid = points_[water_mass][p], gas = points_[gas_mass][p];
    const double passed = points_[vapour_mass][p] - points_[dissolved_mass][p];  // from the water to the gas
    return find_partition(tables_[soil], exchange_, (liquid + passed) * per_pores, (gas - passed) * per_pores,
                          liquid * per_pores / water_.density);
}

template <>
double ExplicitMixture<Filling::exchange>::relative_humidity(size_t point) const {
    return partition_of(point).vapour / exchange_.saturated_vapour;
}

template <>
double ExplicitMixture<Filling::exchange>::dissolved_air(size_t point) const {
    return partition_of(point).dissolved;
}

template <>
void ExplicitMixture<Filling::exchange>::find_partitions(size_t first, size_t count, FluidBlock& fluids) const {
    BlockValues pores;
    find_pores(first, count, pores);
    for (size_t k = 0; k < count; ++k) {
        const size_t p = first + k;
        const auto soil = static_cast<size_t>(points_.soil[p]);
        const Partition found = partition_of(p);
        const ExplicitHydraulics& hydraulics = hydraulics_[soil];
        fluids.pressure[k] = found.water_pressure;
        fluids.gas_pressure[k] = found.gas_pressure;
        fluids.suction[k] = found.state.suction;
        fluids.saturation[k] = found.saturation;
        fluids.effective_saturation[k] = std::clamp(tables_[soil].effective(found.saturation), 0.0, 1.0);
        fluids.mobility[k] = hydraulics.mobility * std::max(found.state.permeability, least_liquid_permeability);
        fluids.edge_mobility[k] =
            hydraulics.mobility * std::max(found.state.mean_permeability, least_liquid_permeability);
        fluids.gas_mobility[k] =
            hydraulics.gas_mobility * std::max(found.state.gas_permeability, least_gas_permeability);
        fluids.vapour[k] = found.vapour * (1 - found.saturation) * pores[k];
        fluids.dissolved[k] = found.dissolved * found.saturation * pores[k];
    }
}

/// Water evaporates and condenses, air dissolves and comes out, until the points are as was found.
template <>
void ExplicitMixture<Filling::exchange>::settle(size_t first, size_t count, const FluidBlock& fluids) {
    double* water = points_[water_mass] + first;
    double* gas = points_[gas_mass] + first;
    double* vapour = points_[vapour_mass] + first;
    double* dissolved = points_[dissolved_mass] + first;
    for (size_t k = 0; k < count; ++k) {
        const bool has_gas_left = fluids.saturation[k] < 1;
        const double air = gas[k] - vapour[k] + dissolved[k];
        const double taken_up = (has_gas_left ? fluids.dissolved[k] : air) - dissolved[k];
        const double evaporated = (has_gas_left ? fluids.vapour[k] : 0.0) - vapour[k];
        water[k] += taken_up - evaporated;
        gas[k] = has_gas_left ? gas[k] + (evaporated - taken_up) : 0.0;
        vapour[k] += evaporated;
        dissolved[k] += taken_up;
    }
}

template <>
void ExplicitMixture<Filling::exchange>::push_solutes(size_t first, size_t count, const SplineBlock& spline,
                                                      const FluidBlock& fluids) {
    BlockValues pores;
    find_pores(first, count, pores);
    FluidGiftBlock gift;
    for (size_t k = 0; k < count; ++k) {
        const size_t p = first + k;
        const double volume = points_[point_volume][p], liquid = points_[water_mass][p], gas = points_[gas_mass][p];
        const double wet = fluids.saturation[k], porosity = pores[k] / volume;
        const double dissolved = fraction_of(points_[dissolved_mass][p], liquid);
        const double vapour = fluids.gas_volume[k] * fraction_of(points_[vapour_mass][p], gas);
        gift[k].slope[0] = gift[k].slope[1] = volume * dissolved;
        gift[k].slope[2] = gift[k].slope[3] = gift[k].value[2] = vapour;
        gift[k].value[0] = points_[solid_mass][p] * dissolved;
        gift[k].value[1] = liquid * tortuosity(porosity * wet, wet);
        gift[k].value[3] = gas * tortuosity(porosity * (1 - wet), 1 - wet);
    }
    scatter_gradients(nodes_.grid, count, spline, gift, &nodes_.solutes.gradients.data()->dissolved.x);
    scatter_means(nodes_.grid, count, spline, gift, &nodes_.solutes.means.data()->dissolved);
}

/// What flowed in the last step, while the fluids' masses are still those that it started from.
template <>
void ExplicitMixture<Filling::exchange>::add_solutes(size_t first, size_t count, const SplineBlock& spline,
                                                     PointField dissolved, PointField vapour) {
    VelocityBlock air_rates, vapour_rates;
    BlockValues weight;
    gather_pairs(nodes_.grid, nodes_.solutes.rates, count, spline, air_rates, vapour_rates);
    find_gas_weights(first, count, weight);
    const double time = nodes_.flow_time;
    for (size_t k = 0; k < count; ++k) {
        const size_t p = first + k;
        points_[dissolved][p] +=
            time * (points_[solid_mass][p] * air_rates.x[k] + points_[dissolved_mass][p] * air_rates.y[k]);
        points_[vapour][p] += time * (weight[k] * vapour_rates.x[k] + points_[vapour_mass][p] * vapour_rates.y[k]);
    }
}

template <>
void ExplicitMixture<Filling::exchange>::take_solutes(size_t first, size_t count, const SplineBlock& spline) {
    if (!restarted_) return add_solutes(first, count, spline, dissolved_mass, vapour_mass);
    for (size_t p = first; p < first + count; ++p) {
        points_[dissolved_mass][p] += points_[dissolved_due][p];
        points_[vapour_mass][p] += points_[vapour_due][p];
    }
}

/// As the fluids' own, which take their solutes along; besides, fractions even out by what diffuses between the halves of a cell.
template <>
void ExplicitMixture<Filling::exchange>::even_out_solutes(size_t first, size_t count, const SplineBlock& spline,
                                                          double dt, const FluidBlock& fluids, PointField dissolved,
                                                          PointField vapour) {
    VelocityBlock liquid_carried, gas_carried, air_mixed, vapour_mixed;
    gather_pairs(nodes_.grid, nodes_.solutes.evenings, count, spline, liquid_carried, gas_carried);
    gather_pairs(nodes_.grid, nodes_.solutes.mixings, count, spline, air_mixed, vapour_mixed);
    const bool is_due = dissolved == dissolved_due;
    const double unit_weight = nodes_.gravity * water_.density;
    for (size_t k = 0; k < count; ++k) {
        const size_t p = first + k;
        const double head = fluids.pressure[k] + unit_weight * points_[position_y][p];
        const double air_fraction = fraction_of(points_[dissolved_mass][p], points_[water_mass][p]);
        const double vapour_fraction = fraction_of(points_[vapour_mass][p], points_[gas_mass][p]);
        const double air_passed =
            liquid_carried.y[k] - liquid_carried.x[k] * head + air_mixed.y[k] - air_mixed.x[k] * air_fraction;
        const double vapour_passed = gas_carried.y[k] - gas_carried.x[k] * fluids.gas_potential[k] + vapour_mixed.y[k] -
                                     vapour_mixed.x[k] * vapour_fraction;
        if (is_due) points_[dissolved][p] = points_[vapour][p] = 0;
        points_[dissolved][p] += dt * points_[solid_mass][p] * air_passed;
        points_[vapour][p] += dt * fluids.gas_volume[k] * vapour_passed;
    }
}

template <>
void ExplicitMixture<Filling::exchange>::give_solutes(size_t first, size_t count, const SplineBlock& spline,
                                                      const BlockValues& dissolved_outflow,
                                                      const BlockValues& vapour_outflow) {
    FluidGiftBlock gift;
    for (size_t k = 0; k < count; ++k) {
        const size_t p = first + k;
        gift[k].value[0] = points_[dissolved_mass][p];
        gift[k].value[1] = -points_[point_volume][p] * dissolved_outflow[k];
        gift[k].value[2] = points_[vapour_mass][p];
        gift[k].value[3] = -vapour_outflow[k];
    }
    scatter_means(nodes_.grid, count, spline, gift, &nodes_.solutes.gains.data()->dissolved);
}

}  // namespace talus
