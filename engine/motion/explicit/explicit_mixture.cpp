#include "motion/explicit/explicit_mixture.hpp"

#include "materials/hydraulic/curves.hpp"
#include "motion/explicit/fluid_gifts.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace talus {
namespace {

/// The volumetric strain of the points becomes the nodes' mean of it.
void smooth_dilation(size_t count, const BlockValues& __restrict mean, GradientBlock& __restrict gradient) {
    for (size_t k = 0; k < count; ++k) {
        const double missing = 0.5 * (mean[k] - gradient.xx[k] - gradient.yy[k]);
        gradient.xx[k] += missing;
        gradient.yy[k] += missing;
    }
}

void add_apparent_cohesion(const std::vector<ExplicitHydraulics>& hydraulics, const FreePoints& points, size_t first,
                           size_t count, const BlockValues& __restrict suction,
                           const BlockValues& __restrict effective_saturation, MaterialBlock& __restrict material) {
    for (size_t k = 0; k < count; ++k) {
        const ExplicitHydraulics& soil = hydraulics[static_cast<size_t>(points.soil[first + k])];
        const double weight = soil.weighs_suction ? effective_saturation[k] : 1.0;
        material.cohesion[k] += soil.suction_tangent * weight * suction[k];
    }
}

void add_exponential_strength(const std::vector<ExplicitHydraulics>& hydraulics, const FreePoints& points, size_t first,
                              size_t count, const BlockValues& suction, MaterialBlock& material) {
    for (size_t k = 0; k < count; ++k) {
        const Strength& strength = hydraulics[static_cast<size_t>(points.soil[first + k])].strength;
        if (strength.model != StrengthModel::exponential) continue;
        const ShearStrength gained = shear_strength(strength, suction[k], 1.0);
        material.cohesion[k] += gained.cohesion - strength.cohesion;
        material.sin_friction[k] += sin_degrees(gained.friction_angle) - sin_degrees(strength.friction_angle);
        material.cos_friction[k] = std::sqrt(1 - material.sin_friction[k] * material.sin_friction[k]);
    }
}

/// Air in pores that it left is never thinner than this share of the atmosphere.
constexpr double least_gas_pressure = 1e-6;
constexpr double least_room_share = 1e-6;  // of the pores: no point counts less as room for gas

using LogValues = Eigen::Map<Eigen::Array<double, block_size, 1>>;  // logarithms of a block at once

}  // namespace

template <Filling filling>
ExplicitMixture<filling>::ExplicitMixture(double cell_size, const Walls& walls, double gravity,
                                          std::vector<ExplicitSoil> soils, std::vector<ExplicitHydraulics> hydraulics,
                                          std::vector<SaturationTable> tables, const ExplicitWater& water,
                                          FreePoints points, int32_t threads, const ExplicitGas& gas,
                                          [[maybe_unused]] const ExplicitExchange& exchange, double rest_speed)
    : soils_(std::move(soils)),
      hydraulics_(std::move(hydraulics)),
      tables_(std::move(tables)),
      water_(water),
      points_(std::move(points)),
      gas_(gas),
      arrangement_(Threads(threads), rest_speed) {
    assert(!has_gas || rest_speed == 0);
    for (const ExplicitSoil& soil : soils_) {
        yields_ = yields_ || soil.yields;
        is_inertial_ = is_inertial_ || soil.friction_rise > 0;
    }
    for (const ExplicitHydraulics& soil : hydraulics_) {
        grain_volume_.push_back(1 / soil.grain_density);
        gains_exponentially_ = gains_exponentially_ || soil.strength.model == StrengthModel::exponential;
        follows_porosity_ = follows_porosity_ || soil.initial_conductance > 0;
        nodes_.has_bedding = nodes_.has_bedding || size_of(soil.anisotropy) > 0;
    }
    nodes_.threads = arrangement_.threads();
    nodes_.grid.cell_size = cell_size;
    nodes_.walls = walls;
    nodes_.gravity = gravity;
    nodes_.liquid_density = water.density;
    nodes_.gas.density = gas.density;
    nodes_.gas.specific = gas.atmosphere / gas.density;
    if constexpr (exchanges) set_exchange(exchange);
    nodes_.least_mass = points_.least(solid_mass);
    nodes_.evens = filling != Filling::saturated;
    restart();
}

template <Filling filling>
void ExplicitMixture<filling>::restart() {
    start_anew();
    nodes_.rained = nodes_.run_off = nodes_.seepage = nodes_.gas.escaped = 0;
    nodes_.solutes.evaporated = 0;
}

template <Filling filling>
void ExplicitMixture<filling>::keep(const std::vector<int32_t>& staying) {
    points_.arrange(staying);
    if (points_.count > 0) start_anew();
}

/// From points that hold all that there is, what is due to them included.
template <Filling filling>
void ExplicitMixture<filling>::start_anew() {
    std::fill(nodes_.returned.begin(), nodes_.returned.end(), 0.0);
    std::fill(nodes_.gas.returned.begin(), nodes_.gas.returned.end(), 0.0);
    std::fill(nodes_.solutes.returned.begin(), nodes_.solutes.returned.end(), SoluteReturn{});
    nodes_.start_grid();
    restarted_ = true;
    arrange_points();
    arrangement_.hold(points_);
    take_arrangement();
    arrangement_.for_each_strip([this](Strip strip) { give(strip); });
    nodes_.begin_step();
}

template <Filling filling>
bool ExplicitMixture<filling>::step(double dt, bool is_last) {
    arrangement_.for_each_strip([&](Strip strip) { stress_and_forces(strip, dt); });
    restarted_ = false;
    nodes_.end_step(dt);
    const double drift = dt * nodes_.speed / nodes_.grid.cell_size;
    if (!Arrangement::bears(drift)) return false;
    if (arrangement_.is_outgrown(drift)) arrange_points();
    arrangement_.count_substep(drift);
    arrangement_.for_each_strip([&](Strip strip) {
        if (is_last) {
            move_and_give<true>(strip, dt);
        } else {
            move_and_give<false>(strip, dt);
        }
    });
    nodes_.begin_step();
    if (!is_last) return true;
    arrangement_.for_each_strip([this](Strip strip) { owe_water(strip); });
    if (arrangement_.look_for_rest(points_)) {
        start_anew();
    } else if (filling != Filling::saturated) {
        find_wave_speed();
    }
    return true;
}

/// Points pass water and gas on to others around the same nodes, until all have the nodes' head; where the step `keeps` what it leaves, it is
/// due to them. With gas, `fluids` is filled from what keep_fluids() left. `missing` as in add_water().
template <Filling filling>
template <bool keeps>
void ExplicitMixture<filling>::even_out(size_t first, size_t count, const SplineBlock& spline, double dt,
                                        FluidBlock& fluids, [[maybe_unused]] BlockValues& missing) {
    VelocityBlock evening;
    if constexpr (has_gas) {
        VelocityBlock gas_evening;
        std::copy_n(points_[water_due] + first, count, fluids.pressure.begin());
        std::copy_n(points_[gas_due] + first, count, fluids.gas_potential.begin());
        std::copy_n(points_[gas_velocity_x] + first, count, fluids.gas_volume.begin());
        if constexpr (exchanges) {
            even_out_solutes(first, count, spline, dt, fluids, keeps ? dissolved_due : dissolved_mass,
                             keeps ? vapour_due : vapour_mass);
        }
        gather_pairs(nodes_.grid, nodes_.evening, count, spline, evening, gas_evening);
        for (size_t k = 0; k < count; ++k) {
            const double passed =
                dt * fluids.gas_volume[k] * (gas_evening.y[k] - gas_evening.x[k] * fluids.gas_potential[k]);
            if constexpr (keeps) {
                points_[gas_due][first + k] = passed;
            } else {
                points_[gas_mass][first + k] += passed;
            }
        }
    } else {
        find_fluids(first, count, fluids);
        gather_values(nodes_.grid, nodes_.evening, count, spline, evening);
    }
    const double unit_weight = nodes_.gravity * water_.density;
    BlockValues passed;
    for (size_t k = 0; k < count; ++k) {
        const double head = fluids.pressure[k] + unit_weight * points_[position_y][first + k];
        passed[k] = dt * points_[solid_mass][first + k] * (evening.y[k] - evening.x[k] * head);
    }
    if constexpr (keeps) {
        std::copy_n(passed.begin(), count, points_[water_due] + first);
    } else {
        add_water(first, count, passed, missing.data());
    }
}

/// Between the two passes of a step nothing is due and the gas's velocity is the nodes': their places hold what the second pass evens out by.
template <Filling filling>
void ExplicitMixture<filling>::keep_fluids(size_t first, size_t count, const FluidBlock& fluids) {
    std::copy_n(fluids.pressure.begin(), count, points_[water_due] + first);
    std::copy_n(fluids.gas_potential.begin(), count, points_[gas_due] + first);
    std::copy_n(fluids.gas_volume.begin(), count, points_[gas_velocity_x] + first);
}

/// What the flow of the last step brings to the points: they get it with the strain of the same time, in the next step.
template <Filling filling>
void ExplicitMixture<filling>::owe_water(Strip strip) {
    SplineBlock spline;
    VelocityBlock rates, gas_rates;
    for (size_t first = strip.first; first < strip.last; first += block_size) {
        const size_t count = std::min(block_size, strip.last - first);
        spline.find(nodes_.grid, points_[position_x] + first, points_[position_y] + first, count);
        gather_rates(count, spline, rates, gas_rates);
        for (size_t k = 0; k < count; ++k)
            points_[water_due][first + k] += nodes_.flow_time * points_[solid_mass][first + k] * rates.y[k];
        if constexpr (exchanges) add_solutes(first, count, spline, dissolved_due, vapour_due);
        if constexpr (has_gas) {
            BlockValues weight;
            find_gas_weights(first, count, weight);
            for (size_t k = 0; k < count; ++k) {
                points_[gas_due][first + k] +=
                    nodes_.flow_time * (weight[k] * gas_rates.x[k] + points_[gas_mass][first + k] * gas_rates.y[k]);
            }
        }
    }
}

template <Filling filling>
void ExplicitMixture<filling>::gather_rates(size_t count, const SplineBlock& spline, VelocityBlock& rates,
                                            [[maybe_unused]] VelocityBlock& gas_rates) const {
    if constexpr (has_gas) {
        gather_pairs(nodes_.grid, nodes_.rates, count, spline, rates, gas_rates);
    } else {
        gather_values(nodes_.grid, nodes_.rates, count, spline, rates);
    }
}

template <Filling filling>
void ExplicitMixture<filling>::find_fluids(size_t first, size_t count, FluidBlock& fluids) const {
    for (size_t k = 0; k < count; ++k) {
        const size_t p = first + k;
        const auto soil = static_cast<size_t>(points_.soil[p]);
        if constexpr (filling == Filling::saturated) {
            fluids.pressure[k] = water_.bulk_modulus * (share_filled(p) - 1);
            fluids.permeability[k] = 1;
            fluids.resistance[k] = 1 / hydraulics_[soil].mobility;
        } else if constexpr (filling == Filling::unsaturated) {
            const double filled = share_filled(p);
            const SaturationTable& table = tables_[soil];
            const SaturationTable::State state = table.at(filled);
            const double excess = std::max(filled / table.maximum() - 1, 0.0);
            fluids.pressure[k] = state.pressure + water_.bulk_modulus * excess;
            fluids.permeability[k] = state.permeability;
            fluids.resistance[k] = 1 / hydraulics_[soil].mobility;
            fluids.suction[k] = -state.pressure;
            fluids.effective_saturation[k] = std::clamp(table.effective(filled), 0.0, 1.0);
        }
    }
    if constexpr (filling == Filling::three_phase) share_pores(first, count, fluids);
    if constexpr (exchanges) find_partitions(first, count, fluids);
    if (follows_porosity_) follow_porosity(first, count, fluids);
}

/// By which a point's ground conducts better than its soil does at the scene's porosity.
template <Filling filling>
double ExplicitMixture<filling>::conductance_factor(size_t p) const {
    const ExplicitHydraulics& soil = hydraulics_[static_cast<size_t>(points_.soil[p])];
    if (!(soil.initial_conductance > 0)) return 1;
    constexpr double least_porosity = 1e-6;
    const double grains = points_[solid_mass][p] / (soil.grain_density * points_[point_volume][p]);
    return kozeny_carman(std::max(1 - grains, least_porosity)) / soil.initial_conductance;
}

template <Filling filling>
void ExplicitMixture<filling>::follow_porosity(size_t first, size_t count, FluidBlock& fluids) const {
    for (size_t k = 0; k < count; ++k) {
        const double factor = conductance_factor(first + k);
        if constexpr (has_gas) {
            fluids.mobility[k] *= factor;
            fluids.edge_mobility[k] *= factor;
            fluids.gas_mobility[k] *= factor;
        } else {
            fluids.resistance[k] /= factor;
        }
    }
}

/// The nodes' sums of what the points' bedding makes of their conductivity: a mean of resistances where the gas is at rest, as their mobility is.
template <Filling filling>
void ExplicitMixture<filling>::tell_bedding(size_t first, size_t count, const SplineBlock& spline,
                                            const FluidBlock& fluids) {
    VelocityBlock sum;
    for (size_t k = 0; k < count; ++k) {
        const NodeVector& anisotropy = hydraulics_[static_cast<size_t>(points_.soil[first + k])].anisotropy;
        const double weight = points_[solid_mass][first + k] * (has_gas ? 1.0 : fluids.resistance[k]);
        sum.x[k] = weight * anisotropy.x;
        sum.y[k] = weight * anisotropy.y;
    }
    scatter_values(nodes_.grid, count, spline, sum, nodes_.anisotropy);
}

template <Filling filling>
void ExplicitMixture<filling>::find_strength(size_t first, size_t count, [[maybe_unused]] const FluidBlock& fluids,
                                             MaterialBlock& material) const {
    set_strength(soils_, points_, first, count, nodes_.grid.cell_size, material);
    if constexpr (filling != Filling::saturated) {
        add_apparent_cohesion(hydraulics_, points_, first, count, fluids.suction, fluids.effective_saturation,
                              material);
        if (gains_exponentially_)
            add_exponential_strength(hydraulics_, points_, first, count, fluids.suction, material);
    }
}

/// Water and gas of a block of points, from their masses.
template <Filling filling>
void ExplicitMixture<filling>::share_pores(size_t first, size_t count, FluidBlock& fluids) const {
    const double specific = nodes_.gas.specific;
    const PoreFluids pair{water_.bulk_modulus, gas_.atmosphere};
    BlockValues pores, filled, effective, logit{};
    find_pores(first, count, pores);
    const double water_volume = 1 / water_.density;
    const double* __restrict water = points_[water_mass] + first;
    const double* __restrict gas = points_[gas_mass] + first;
    for (size_t k = 0; k < count; ++k) {
        const double per_pores = 1 / pores[k];
        filled[k] = water[k] * water_volume * per_pores;
        const double alone = std::max(gas[k] * specific * per_pores, 0.0);
        fluids.gas_pressure[k] = shared_pressure(pair, filled[k], alone) - pair.atmosphere;
    }
    for (size_t k = 0; k < count; ++k)
        effective[k] = tables_[static_cast<size_t>(points_.soil[first + k])].effective(filled[k]);
    for (size_t k = 0; k < count; ++k) logit[k] = SaturationTable::odds(effective[k]);
    LogValues(logit.data()) = LogValues(logit.data()).log();
    for (size_t k = 0; k < count; ++k) {
        const auto soil = static_cast<size_t>(points_.soil[first + k]);
        const SaturationTable::MixedState state = tables_[soil].mixed_at(effective[k], logit[k]);
        fluids.pressure[k] = fluids.gas_pressure[k] - state.suction;
        fluids.mobility[k] = hydraulics_[soil].mobility * state.permeability;
        fluids.edge_mobility[k] = hydraulics_[soil].mobility * state.mean_permeability;
        fluids.suction[k] = state.suction;
        fluids.gas_mobility[k] =
            hydraulics_[soil].gas_mobility * std::max(state.gas_permeability, least_gas_permeability);
        fluids.effective_saturation[k] = std::clamp(effective[k], 0.0, 1.0);
    }
}

/// psi and the volume of the gas, as of gas that is never thinner than next to none.
template <Filling filling>
void ExplicitMixture<filling>::find_potential(size_t first, size_t count, FluidBlock& fluids) const {
    const double specific = nodes_.gas.specific, per_atmosphere = 1 / gas_.atmosphere;
    const double density = gas_.density, gravity = nodes_.gravity;
    const double* __restrict mass = points_[gas_mass] + first;
    const double* __restrict y = points_[position_y] + first;
    const double* __restrict pressure = fluids.gas_pressure.data();
    double* __restrict volume = fluids.gas_volume.data();
    double* __restrict potential = fluids.gas_potential.data();
    for (size_t k = 0; k < count; ++k) {
        const double relative = std::max(1 + per_atmosphere * pressure[k], least_gas_pressure);
        volume[k] = mass[k] / (density * relative);
        potential[k] = relative;
    }
    if constexpr (exchanges) {  // vapour is lighter
        const double lighter = exchange_.vapour / exchange_.air - 1;
        for (size_t k = 0; k < count; ++k)
            volume[k] += lighter * points_[vapour_mass][first + k] / (density * potential[k]);
    }
    LogValues logarithm(potential);
    logarithm = logarithm.log();
    for (size_t k = 0; k < count; ++k) potential[k] = specific * potential[k] + gravity * y[k];
}

/// Only mobile water is taken from a point: `missing` grows by what one at its residual saturation is short of.
template <Filling filling>
void ExplicitMixture<filling>::add_water(size_t first, size_t count, const BlockValues& __restrict gain,
                                         double* __restrict missing) {
    double* __restrict water = points_[water_mass] + first;
    const double* __restrict mass = points_[solid_mass] + first;
    const int32_t* __restrict soil = points_.soil.data() + first;
    for (size_t k = 0; k < count; ++k) {
        const double residual = hydraulics_[static_cast<size_t>(soil[k])].residual_water * mass[k];
        const double left = water[k] + gain[k];
        water[k] = std::max(left, std::min(water[k], residual));
        missing[k] += water[k] - left;
    }
}

/// What flowed to the points in the last step. What they are short of is left in place of the water's velocity, which is the nodes' between the two
/// passes of a step: the nodes then take it from the points around.
template <Filling filling>
void ExplicitMixture<filling>::take_water(size_t first, size_t count, const VelocityBlock& rates) {
    BlockValues gain;
    const double* __restrict mass = points_[solid_mass] + first;
    for (size_t k = 0; k < count; ++k) gain[k] = nodes_.flow_time * mass[k] * rates.y[k];
    if (restarted_) std::copy_n(points_[water_due] + first, count, gain.begin());
    if constexpr (filling == Filling::saturated) {
        for (size_t k = 0; k < count; ++k) points_[water_mass][first + k] += gain[k];
    } else {
        std::fill_n(points_[liquid_velocity_x] + first, count, 0.0);
        add_water(first, count, gain, points_[liquid_velocity_x] + first);
    }
}

/// What flowed to the points in the last step.
template <Filling filling>
void ExplicitMixture<filling>::take_gas(size_t first, size_t count, const VelocityBlock& rates) {
    double* __restrict mass = points_[gas_mass] + first;
    if (restarted_) {
        for (size_t k = 0; k < count; ++k) mass[k] += points_[gas_due][first + k];
        return;
    }
    BlockValues weight;
    find_gas_weights(first, count, weight);
    const double time = nodes_.flow_time;
    for (size_t k = 0; k < count; ++k) mass[k] += time * (weight[k] * rates.x[k] + mass[k] * rates.y[k]);
}

template <Filling filling>
void ExplicitMixture<filling>::find_pores(size_t first, size_t count, BlockValues& __restrict pores) const {
    const double* __restrict volume = points_[point_volume] + first;
    const double* __restrict mass = points_[solid_mass] + first;
    const int32_t* __restrict soil = points_.soil.data() + first;
    const double* __restrict grain_volume = grain_volume_.data();
    for (size_t k = 0; k < count; ++k) pores[k] = volume[k] - mass[k] * grain_volume[soil[k]];
}

/// What points share a gain of gas by: the volume that water without pressure leaves to it, m2.
template <Filling filling>
void ExplicitMixture<filling>::find_gas_weights(size_t first, size_t count, BlockValues& __restrict weight) const {
    const double* __restrict water = points_[water_mass] + first;
    const double water_volume = 1 / water_.density;
    find_pores(first, count, weight);
    for (size_t k = 0; k < count; ++k)
        weight[k] = std::max(weight[k] - water[k] * water_volume, least_room_share * weight[k]);
}

/// What pushes the gas of the nodes.
template <Filling filling>
void ExplicitMixture<filling>::push_gas(size_t first, size_t count, const SplineBlock& spline,
                                        const FluidBlock& fluids) {
    FluidGiftBlock gift;
    for (size_t k = 0; k < count; ++k) {
        const double volume = fluids.gas_volume[k], push = volume * fluids.gas_potential[k];
        gift[k].slope[0] = gift[k].slope[1] = gift[k].value[0] = push;
        gift[k].slope[2] = gift[k].slope[3] = gift[k].value[2] = volume;
        gift[k].value[1] = points_[solid_mass][first + k] * fluids.gas_mobility[k];
        gift[k].value[3] = points_[gas_mass][first + k];
        if constexpr (exchanges)  // as of air: Darcy's law is of the pressure, psi that of air
            gift[k].value[3] = volume * (gas_.atmosphere + fluids.gas_pressure[k]) / exchange_.air;
    }
    scatter_gradients(nodes_.grid, count, spline, gift, &nodes_.gas.gradients.data()->push_x);
    scatter_means(nodes_.grid, count, spline, gift, &nodes_.gas.means.data()->push);
}

template <Filling filling>
void ExplicitMixture<filling>::give_gas(size_t first, size_t count, const SplineBlock& spline, const GiftBlock& gift) {
    BlockValues weight;
    find_gas_weights(first, count, weight);
    give_momentum(nodes_.grid, count, spline, gift, nodes_.gas.momentum);
    scatter_value(nodes_.grid, count, spline, weight, nodes_.gas.weight);
}

template <Filling filling>
void ExplicitMixture<filling>::stress_and_forces(Strip strip, double dt) {
    SplineBlock spline;
    GradientBlock gradient;
    VelocityBlock rates, gas_rates;
    MaterialBlock material;
    FluidBlock fluids;
    BlockValues total_xx, total_yy;
    FluidGiftBlock gift;
    for (size_t first = strip.first; first < strip.last; first += block_size) {
        const size_t count = std::min(block_size, strip.last - first);
        const double* mass = points_[solid_mass] + first;
        spline.find(nodes_.grid, points_[position_x] + first, points_[position_y] + first, count);
        gather_gradient(nodes_.grid, nodes_.velocity, count, spline, gradient);
        if constexpr (exchanges) take_solutes(first, count, spline);
        gather_rates(count, spline, rates, gas_rates);
        if constexpr (has_gas) take_gas(first, count, gas_rates);
        take_water(first, count, rates);
        smooth_dilation(count, rates.x, gradient);
        set_elasticity(soils_, points_, first, count, material);
        strain_elastically(points_, first, count, dt, gradient, material);
        find_fluids(first, count, fluids);
        if constexpr (exchanges) settle(first, count, fluids);
        if constexpr (has_gas) find_potential(first, count, fluids);
        if (yields_) {
            find_strength(first, count, fluids, material);
            if (is_inertial_) add_inertial_friction(soils_, points_, first, count, gradient, material);
            return_stresses(points_, first, count, material);
        }
        for (size_t k = 0; k < count; ++k) {
            const double pore_stress = this->pore_stress(fluids, k);
            total_xx[k] = points_[stress_xx][first + k] - pore_stress;
            total_yy[k] = points_[stress_yy][first + k] - pore_stress;
        }
        const double* volume = points_[point_volume] + first;
        scatter_force(nodes_.grid, count, spline, volume, total_xx.data(), total_yy.data(), points_[stress_xy] + first,
                      nodes_.force);
        const double* y = points_[position_y] + first;
        fill_gifts(count, y, volume, mass, nodes_.gravity * water_.density, fluids.pressure,
                   has_gas ? fluids.mobility : fluids.permeability, has_gas ? fluids.edge_mobility : fluids.resistance,
                   gift);
        scatter_gradients(nodes_.grid, count, spline, gift, &nodes_.gradients.data()->push_x);
        scatter_means(nodes_.grid, count, spline, gift, &nodes_.means.data()->push);
        if (nodes_.has_bedding) tell_bedding(first, count, spline, fluids);
        if constexpr (filling == Filling::unsaturated) {
            scatter_moments(nodes_.grid, count, spline, volume, mass, &nodes_.moments.data()->xx,
                            &nodes_.places.data()->x);
        }
        if constexpr (exchanges) push_solutes(first, count, spline, fluids);
        if constexpr (has_gas) {
            push_gas(first, count, spline, fluids);
            keep_fluids(first, count, fluids);
        }
    }
}

template <Filling filling>
template <bool keeps>
void ExplicitMixture<filling>::move_and_give(Strip strip, double dt) {
    SplineBlock spline;
    VelocityBlock taken;
    [[maybe_unused]] VelocityBlock liquid_taken;
    BlockValues dilation, outflow, missing;
    GiftBlock gift, liquid_gift;
    [[maybe_unused]] GiftBlock gas_gift;
    [[maybe_unused]] FluidBlock fluids;
    [[maybe_unused]] BlockValues dissolved_outflow, vapour_outflow;
    for (size_t first = strip.first; first < strip.last; first += block_size) {
        const size_t count = std::min(block_size, strip.last - first);
        const Grid& grid = nodes_.grid;
        double* x = points_[position_x] + first;
        double* y = points_[position_y] + first;
        spline.find(grid, x, y, count);
        if constexpr (filling == Filling::saturated) {
            if (keeps) std::fill_n(points_[water_due] + first, count, 0.0);
        } else {
            std::copy_n(points_[liquid_velocity_x] + first, count, missing.begin());
            even_out<keeps>(first, count, spline, dt, fluids, missing);
        }
        gather_divergence(grid, nodes_.velocity, count, spline, dilation);
        take_velocity<keeps>(grid, nodes_.velocity, points_, first, count, spline, points_[solid_mass] + first,
                             {velocity_x, affine_xx}, gift, taken);
        constexpr VelocityFields liquid_fields{liquid_velocity_x, liquid_affine_xx};
        if constexpr (has_gas) {
            BlockValues gas_outflow;
            gather_divergences(grid, nodes_.flux, count, spline, outflow, gas_outflow);
            take_velocities<keeps>(grid, nodes_.fluid_velocity, points_, first, count, spline,
                                   {points_[water_mass] + first, points_[gas_mass] + first},
                                   {liquid_fields, {gas_velocity_x, gas_affine_xx}}, {&liquid_gift, &gas_gift});
            for (size_t k = 0; k < count; ++k) gas_gift[k].own[3] = -fluids.gas_volume[k] * gas_outflow[k];
            if constexpr (exchanges) {
                gather_divergences(grid, nodes_.solutes.fluxes, count, spline, dissolved_outflow, vapour_outflow);
                for (size_t k = 0; k < count; ++k) vapour_outflow[k] *= fluids.gas_volume[k];
            }
        } else {
            gather_divergence(grid, nodes_.flux, count, spline, outflow);
            take_velocity<keeps>(grid, nodes_.fluid_velocity, points_, first, count, spline,
                                 points_[water_mass] + first, liquid_fields, liquid_gift, liquid_taken);
        }
        for (size_t k = 0; k < count; ++k) {
            gift[k].own[3] = points_[solid_mass][first + k] * dilation[k];
            liquid_gift[k].own[3] = -points_[point_volume][first + k] * outflow[k];
            if constexpr (filling != Filling::saturated) liquid_gift[k].own[3] -= missing[k] / dt;
            x[k] += dt * taken.x[k];
            y[k] += dt * taken.y[k];
        }
        spline.find(grid, x, y, count);
        give_momentum(grid, count, spline, gift, nodes_.momentum);
        give_momentum(grid, count, spline, liquid_gift, nodes_.liquid_momentum);
        if constexpr (has_gas) give_gas(first, count, spline, gas_gift);
        if constexpr (exchanges) give_solutes(first, count, spline, dissolved_outflow, vapour_outflow);
    }
}

/// The momenta of points that have velocities of their own, at the start, when no water flows yet.
template <Filling filling>
void ExplicitMixture<filling>::give(Strip strip) {
    SplineBlock spline;
    GiftBlock gift;
    const double size = nodes_.grid.cell_size;
    const auto give_phase = [&](size_t first, size_t count, PointField mass, PointField v, PointField a, double share,
                                std::vector<NodeMomentum>& momentum) {
        for (size_t k = 0; k < count; ++k) {
            const size_t p = first + k;
            const auto field = [&](size_t name) { return points_.field[name][p]; };
            gift[k].set(field(mass), {field(v), field(v + 1)}, {size * field(a), size * field(a + 2)},
                        {size * field(a + 1), size * field(a + 3)});
            gift[k].own[3] = share * field(mass) * (field(a) + field(a + 3));
        }
        give_momentum(nodes_.grid, count, spline, gift, momentum);
    };
    for (size_t first = strip.first; first < strip.last; first += block_size) {
        const size_t count = std::min(block_size, strip.last - first);
        spline.find(nodes_.grid, points_[position_x] + first, points_[position_y] + first, count);
        give_phase(first, count, solid_mass, velocity_x, affine_xx, 1, nodes_.momentum);
        give_phase(first, count, water_mass, liquid_velocity_x, liquid_affine_xx, 0, nodes_.liquid_momentum);
        if constexpr (has_gas)
            give_phase(first, count, gas_mass, gas_velocity_x, gas_affine_xx, 0, nodes_.gas.momentum);
    }
}

/// Nothing comes back to the points from nodes that they have left: it is out of the ground.
template <Filling filling>
template <class Returned>
void ExplicitMixture<filling>::forget_left_nodes(std::vector<Returned>& returned) const {
    std::vector<Returned> kept(returned.size());
    nodes_.for_each_node([&](size_t i) { kept[i] = returned[i]; });
    returned = std::move(kept);
}

template <Filling filling>
void ExplicitMixture<filling>::move_gas_nodes(const Grid& old) {
    NodeGas& gas = nodes_.gas;
    move_nodes(gas.returned, old, nodes_.grid);
    if constexpr (!exchanges) return;
    NodeSolutes& solutes = nodes_.solutes;
    for (auto* field : {&solutes.fluxes, &solutes.evenings, &solutes.mixings}) move_nodes(*field, old, nodes_.grid);
    move_nodes(solutes.returned, old, nodes_.grid);
}

template <Filling filling>
void ExplicitMixture<filling>::arrange_points() {
    const Grid old = nodes_.grid;
    forget_left_nodes(nodes_.returned);
    const double returned = nodes_.total(nodes_.returned);
    double gas_returned = 0;
    [[maybe_unused]] SoluteReturn solutes_returned;
    if constexpr (has_gas) {
        forget_left_nodes(nodes_.gas.returned);
        gas_returned = nodes_.total(nodes_.gas.returned);
    }
    if constexpr (exchanges) {
        forget_left_nodes(nodes_.solutes.returned);
        solutes_returned = nodes_.returned_solutes();
    }
    if (arrangement_.arrange(points_, nodes_.grid)) {
        move_nodes(nodes_.velocity, old, nodes_.grid);
        for (auto* field : {&nodes_.fluid_velocity, &nodes_.flux, &nodes_.rates, &nodes_.evening})
            move_nodes(*field, old, nodes_.grid);
        move_nodes(nodes_.returned, old, nodes_.grid);
        if constexpr (has_gas) move_gas_nodes(old);
        nodes_.resize();
    }
    take_arrangement();
    nodes_.seepage += nodes_.flow_time * (returned - nodes_.total(nodes_.returned));
    if constexpr (has_gas) nodes_.gas.escaped += nodes_.flow_time * (gas_returned - nodes_.total(nodes_.gas.returned));
    if constexpr (exchanges) {
        const SoluteReturn left = nodes_.returned_solutes();
        nodes_.lose({solutes_returned.dissolved - left.dissolved, solutes_returned.vapour - left.vapour});
    }
    fall_rain();
    find_wave_speed();
}

template <Filling filling>
void ExplicitMixture<filling>::take_arrangement() {
    arrangement_.tell(points_, nodes_);
    std::fill(nodes_.surroundings.begin(), nodes_.surroundings.end(), NodeSurroundings{});
}

template <Filling filling>
void ExplicitMixture<filling>::set_rain(std::function<double(double)> rate) {
    rain_ = std::move(rate);
    fall_rain();
}

/// Onto the grid's columns that hold ground.
template <Filling filling>
void ExplicitMixture<filling>::fall_rain() {
    nodes_.rain.clear();
    if (!rain_) return;
    const Grid& grid = nodes_.grid;
    nodes_.rain.assign(static_cast<size_t>(grid.cells[0]), 0.0);
    for (size_t p = 0; p < points_.count; ++p) {
        const int32_t column = grid.cell_of(points_[position_x][p], 0);
        nodes_.rain[static_cast<size_t>(column)] =
            water_.density * rain_(grid.corner[0] + (column + 0.5) * grid.cell_size);
    }
}

/// Retention may hold water more stiffly than water is. Bishop's stress feels that; flow does as far as drag lets it, which it is slower by:
/// half the step that would just be stable is size^2 n / (2 stiffness lambda). Suction and the pressure of pores shared with gas add up.
template <Filling filling>
typename ExplicitMixture<filling>::PoreStiffness ExplicitMixture<filling>::pore_stiffness(size_t p,
                                                                                          double porosity) const {
    const double bulk_modulus = water_.bulk_modulus;
    if constexpr (filling == Filling::saturated) return {bulk_modulus, bulk_modulus / water_.density};
    const auto soil = static_cast<size_t>(points_.soil[p]);
    const SaturationTable& table = tables_[soil];
    const double filled = share_filled(p), stiffness = filled * table.stiffness(filled);
    const bool is_borne = water_.pore_stress == PoreStress::bishop;
    const double borne = is_borne ? std::clamp(table.effective(filled), 0.0, 1.0) * stiffness : 0.0;
    const double full_mobility = hydraulics_[soil].mobility / (1 - size_of(hydraulics_[soil].anisotropy));
    const double mobility = full_mobility * conductance_factor(p) * table.at(filled).permeability;
    const double creep = 2 * stiffness * mobility / (porosity * nodes_.grid.cell_size);
    const auto both = [](double pores, double retention) {
        return has_gas ? pores + retention : std::max(pores, retention);
    };
    return {both(bulk_modulus, borne),
            both(bulk_modulus / water_.density, std::min(stiffness / water_.density, creep * creep))};
}

/// Of the points as they are: the square root of the sum of the waves' squares without drag, which bounds each. The gas's own is R T / M at
/// any pressure, and less where the water gives way.
template <Filling filling>
void ExplicitMixture<filling>::find_wave_speed() {
    wave_speed_ = 0;
    for (size_t p = 0; p < points_.count; ++p) {
        const auto soil = static_cast<size_t>(points_.soil[p]);
        const double solid_density = points_[solid_mass][p] / points_[point_volume][p];
        const double grains = solid_density / hydraulics_[soil].grain_density;
        const double frame = soils_[soil].elastic.lame + 2 * soils_[soil].elastic.shear;
        const PoreStiffness pores = pore_stiffness(p, 1 - grains);
        const double fluid = pores.borne / (1 - grains);
        double squares = (frame + grains * grains * fluid) / solid_density + pores.flow_speed_squared;
        if constexpr (has_gas) squares += nodes_.gas.specific;
        wave_speed_ = std::max(wave_speed_, std::sqrt(squares));
    }
}

template <Filling filling>
double ExplicitMixture<filling>::critical_step() const {
    constexpr double share = 1.0;  // stable to 1.4: the bound of the speed is above any wave's
    return share * nodes_.grid.cell_size / (wave_speed_ + nodes_.start_speed);
}

template <Filling filling>
Energies ExplicitMixture<filling>::energies() const {
    Energies sum = energies_of(points_, soils_, nodes_.gravity);
    for (size_t p = 0; p < points_.count; ++p) {
        const double x = points_[liquid_velocity_x][p], y = points_[liquid_velocity_y][p];
        sum.kinetic += 0.5 * points_[water_mass][p] * (x * x + y * y);
        sum.potential += points_[water_mass][p] * nodes_.gravity * points_[position_y][p];
        if constexpr (has_gas) {
            const double gas_x = points_[gas_velocity_x][p], gas_y = points_[gas_velocity_y][p];
            sum.kinetic += 0.5 * points_[gas_mass][p] * (gas_x * gas_x + gas_y * gas_y);
            sum.potential += points_[gas_mass][p] * nodes_.gravity * points_[position_y][p];
        }
    }
    return sum;
}

template <Filling filling>
double ExplicitMixture<filling>::pressure(size_t point) const {
    FluidBlock fluids{};
    find_fluids(point, 1, fluids);
    return fluids.pressure[0];
}

template <Filling filling>
double ExplicitMixture<filling>::pore_stress(const FluidBlock& fluids, size_t k) const {
    const double pressure = fluids.pressure[k];
    if constexpr (has_gas) {
        const double share = water_.pore_stress == PoreStress::bishop ? fluids.effective_saturation[k] : 0.0;
        return share * pressure + (1 - share) * fluids.gas_pressure[k];
    }
    if (filling == Filling::saturated || pressure > 0) return pressure;
    return water_.pore_stress == PoreStress::bishop ? fluids.effective_saturation[k] * pressure : 0.0;
}

template <Filling filling>
MohrCoulomb ExplicitMixture<filling>::strength(size_t point) const {
    FluidBlock fluids{};
    MaterialBlock material;
    find_fluids(point, 1, fluids);
    find_strength(point, 1, fluids, material);
    return material.at(0);
}

template <Filling filling>
double ExplicitMixture<filling>::pore_stress(size_t point) const {
    FluidBlock fluids{};
    find_fluids(point, 1, fluids);
    return pore_stress(fluids, 0);
}

template <Filling filling>
double ExplicitMixture<filling>::gas_pressure(size_t point) const {
    if constexpr (!has_gas) return 0;
    FluidBlock fluids{};
    find_fluids(point, 1, fluids);
    return fluids.gas_pressure[0];
}

template <Filling filling>
double ExplicitMixture<filling>::saturation(size_t point) const {
    if constexpr (exchanges) return partition_of(point).saturation;
    return std::min(share_filled(point), 1.0);
}

template class ExplicitMixture<Filling::saturated>;
template class ExplicitMixture<Filling::unsaturated>;
template class ExplicitMixture<Filling::three_phase>;
template class ExplicitMixture<Filling::exchange>;

}  // namespace talus
