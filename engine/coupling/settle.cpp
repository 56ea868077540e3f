// The way back: ground that came to rest goes on in equilibrium, on a mesh made anew under its surface.
#include "coupling/simulation.hpp"
#include "error.hpp"
#include "motion/geostatic.hpp"
#include "points/quadrature.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace talus {

std::unique_ptr<Simulation> Simulation::settle() {
    state_.lies_still = true;
    // Gas that has moved and what it exchanged with the water are not of a ground in equilibrium.
    if (scene_.physics.gas) return nullptr;
    try {
        std::optional<Deposit> deposit = find_deposit(scene_, *dynamic_);
        if (!deposit) return nullptr;
        std::unique_ptr<Simulation> settled(new Simulation(*this, std::move(*deposit)));
        const bool stands = !settled->state_.equilibrium_lost;
        settled->happenings.push_back({HappeningKind::settled, state_.time, {}, stands ? 1.0 : 0.0});
        return settled;
    } catch (const Error&) {
        return nullptr;  // no sound mesh
    }
}

Simulation::Simulation(const Simulation& moved, Deposit deposit)
    : forcing(moved.forcing),
      happenings(moved.happenings),
      counts(moved.counts),
      scene_(moved.scene_),
      tolerance_(moved.tolerance_),
      threads_(moved.threads_),
      stop_at_motion_(moved.stop_at_motion_),
      mesh_(std::move(deposit.mesh)),
      reference_mesh_(mesh_),
      initial_water_(moved.initial_water_),
      past_statistics_(moved.flow_statistics()),
      agreement_pressure_(moved.agreement_pressure_) {
    state_.time = moved.state_.time;
    state_.rain_is_out = moved.state_.rain_is_out;
    state_.points = make_points(mesh_);
    state_.node_position = mesh_.position;
    take_grains(moved, deposit);
    if (scene_.physics.water) make_flow();
    make_motion();
    if (flow_) take_water(moved, deposit);
    take_stress(deposit);
    update_points();
}

// The mass of the points, and so their pores: cells that fit their ground less well than points have their porosity.
void Simulation::take_grains(const Simulation& moved, Deposit& deposit) {
    const FreePoints& free = moved.dynamic_->points();
    double mass = 0;
    for (size_t p = 0; p < free.count; ++p) mass += free[solid_mass][p];
    std::vector<double> porosity(state_.points.volume.size());
    const auto mass_taken = [&] {
        double found = 0;
        interpolate(mesh_, state_.points, mesh_.cell_nodes, deposit.porosity, porosity);
        initial_volume_ = state_.points.volume;
        for (size_t p = 0; p < porosity.size(); ++p) {
            const Soil& soil = scene_.soils[static_cast<size_t>(state_.points.soil[p])];
            initial_volume_[p] *= (1 - porosity[p]) / (1 - soil.porosity);
            found += soil.dry_density * initial_volume_[p];
        }
        return found;
    };
    const double share = mass / mass_taken();
    for (double& n : deposit.porosity) n = 1 - (1 - n) * share;
    [[maybe_unused]] const double found = mass_taken();
    assert(std::abs(found - mass) < 1e-12 * mass);
}

void Simulation::take_water(const Simulation& moved, const Deposit& deposit) {
    std::fill(state_.pore_volume.begin(), state_.pore_volume.end(), 0.0);
    for (size_t k = 0; k < mesh_.cell_nodes.size(); ++k) {
        state_.pore_volume[static_cast<size_t>(flow_->network.corner_portion[k])] +=
            deposit.porosity[static_cast<size_t>(mesh_.cell_nodes[k])] * flow_->network.corner_volume[k];
    }
    state_.flow_pore_volume = state_.pore_volume;
    state_.flow.totals = moved.state_.flow.totals;
    state_.flow.pressure = deposit.pressure;
    set_flow_forcing(1.0);
    for (size_t h = 0; h < flow_->boundaries.held.size(); ++h)
        state_.flow.pressure[static_cast<size_t>(flow_->boundaries.held[h].node)] = flow_->forcing.held[h].start;
    hold_water(moved.water_now());
    state_.flow.stored.assign(flow_->stored().begin(), flow_->stored().end());
    state_.watch.is_saturated = is_full(state_.flow.pressure);
}

// What the nodes' pressures hold less than there is goes to those that are neither full nor empty; what they have no room for is pressed into those that are full.
void Simulation::hold_water(double water) {
    constexpr double rounding = 1e-14;
    constexpr int most_rounds = 50;
    std::vector<double>& pressure = state_.flow.pressure;
    for (int round = 0; round < most_rounds; ++round) {
        hold_skeleton();
        flow_->evaluate(0.0, pressure);
        double missing = water, room = 0, full = 0;
        for (const double stored : flow_->stored()) missing -= stored;
        if (std::abs(missing) <= rounding * water) return;
        std::vector<double> share(pressure.size(), 0.0), saturation(pressure.size(), 0.0);
        std::vector<size_t> soil(pressure.size(), 0);
        for (size_t i = 0; i < flow_->network.portions.size(); ++i) {
            const auto node = static_cast<size_t>(flow_->network.portions[i].node);
            if (flow_->is_held(node)) continue;
            if (pressure[node] >= 0) {
                full += state_.pore_volume[i];
                continue;
            }
            soil[node] = static_cast<size_t>(flow_->network.portions[i].soil);
            saturation[node] = flow_->state()[i].saturation;
            const Retention& retention = scene_.soils[soil[node]].hydraulics.retention;
            share[node] =
                (retention.maximum_saturation - saturation[node]) * (saturation[node] - retention.residual_saturation);
            room += state_.pore_volume[i] * share[node];
        }
        const double moved = std::clamp(missing, -0.5 * room, 0.5 * room);
        const double pressed = full > 0 ? scene_.water.bulk_modulus * (missing - moved) / full : 0;
        for (size_t node = 0; node < pressure.size(); ++node) {
            if (flow_->is_held(node)) continue;
            if (pressure[node] >= 0) {
                pressure[node] = std::max(pressure[node] + pressed, 0.0);
            } else if (share[node] > 0) {
                pressure[node] =
                    flow_->table(soil[node]).pressure_of_saturation(saturation[node] + moved / room * share[node]);
            }
        }
    }
}

void Simulation::take_stress(const Deposit& deposit) {
    Points& points = state_.points;
    const auto count = static_cast<size_t>(points.count);
    const auto interpolate_component = [&](const std::vector<double>& node_value, size_t components,
                                           std::vector<double>& value) {
        std::vector<double> of_nodes(node_value.size() / components), of_points(count);
        value.resize(count * components);
        for (size_t k = 0; k < components; ++k) {
            for (size_t i = 0; i < of_nodes.size(); ++i) of_nodes[i] = node_value[i * components + k];
            interpolate(mesh_, points, mesh_.cell_nodes, of_nodes, of_points);
            for (size_t p = 0; p < count; ++p) value[p * components + k] = of_points[p];
        }
    };
    interpolate_component(deposit.stress, 4, points.skeleton_stress);
    interpolate_component(deposit.displacement, 2, points.displacement);
    if (!lost_strength_.empty()) interpolate_component(deposit.lost_strength, 1, lost_strength_);
    settled_lost_strength_ = lost_strength_;

    state_.displacement = deposit.displacement;
    for (const GivenDisplacement& given : given_displacements_)
        state_.displacement[given.freedom] = forcing.motion_value(given.boundary, given.component, state_.time);
    equilibrium_->restore(state_.displacement);
    set_loads(state_.flow, state_.time);
    constexpr int32_t most_creep_steps = 400;  // what rests is not far from equilibrium, or in none
    outcome_ = settle_in_place(*equilibrium_, loads(), most_creep_steps);
    if (outcome_.status != EquilibriumStatus::converged) {
        state_.equilibrium_lost = true;
        equilibrium_->reject();
    }
    interpolate_component(deposit.plastic_strain, 1, points.plastic_strain);
    if (!lost_strength_.empty()) settled_plastic_strain_ = points.plastic_strain;
    equilibrium_->restore(state_.displacement);
}

}  // namespace talus
