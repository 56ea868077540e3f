// One exchange between flow and motion.
#include "coupling/simulation.hpp"
#include "coupling/stopwatch.hpp"
#include "points/quadrature.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talus {
namespace {

constexpr int most_iterations = 40;
// In which the disagreement is to halve: the flow's own error may keep it from ever falling further in so long an exchange.
constexpr int patience = 12;
// Of ground that yields, beyond which flow and skeleton are solved for together.
constexpr int most_plain_iterations = 15;
// Steps of creep within which the two settle soon (of the last creep, where the skeleton settled beside the water): the next exchange starts
// with it, and is longer however bad the forecast was.
constexpr int32_t soon = 15;
constexpr double growth_if_soon = 1.5;
// Disagreement of the first iteration at which the next exchange is as long as this one.
constexpr double well_expected = 100.0;

// How much longer the next exchange may be: the expectation is linear in time, its error quadratic in the exchange's length.
double growth(double first_disagreement, double most) {
    return std::clamp(0.9 * std::sqrt(well_expected / std::max(first_disagreement, 1e-12)), 0.2, most);
}

}  // namespace

Simulation::Exchange Simulation::exchange(double duration, bool is_short, const Cancelled& cancelled) {
    const bool moves = skeleton_moves();
    const bool is_below_given_up = duration < state_.given_up_exchange;
    // Below the length given up last it grows slowly: the next one to be given up costs more than shorter ones do.
    const double most_growth = is_below_given_up ? 1.5 : 4.0;
    FlowPath path{state_.flow, state_.watch, {}};
    if (flow_) set_flow_forcing(duration);
    ++counts.exchanges;
    Settled settled;
    Exchange result = Exchange::disagreed;
    if (moves && state_.goes_on_jointly) result = go_on_jointly(duration, path, cancelled, settled);
    if (result == Exchange::disagreed) result = settle_in_turn(duration, path, is_short, cancelled, settled);
    if (result != Exchange::agreed) return result;
    state_.goes_on_jointly = settled.jointly && is_as_expected(duration);
    accept(duration, path.flow);
    state_.watch = path.watch;
    happenings.insert(happenings.end(), path.noticed.begin(), path.noticed.end());
    // No forecast that errs may keep exchanges short.
    const bool is_soon = settled.jointly && outcome_.pseudo_steps <= soon;
    const double least_growth = is_short ? std::min(2.0, most_growth) : is_soon ? growth_if_soon : 0.0;
    if (flow_ && moves)
        state_.exchange_step = duration * std::max(growth(settled.first_disagreement, most_growth), least_growth);
    state_.settles_jointly_soon = is_soon;
    if (!is_below_given_up) state_.given_up_exchange = 0;
    return Exchange::agreed;
}

// Flow and skeleton by turns, the two together where that does not settle.
Simulation::Exchange Simulation::settle_in_turn(double duration, FlowPath& path, bool is_short,
                                                const Cancelled& cancelled, Settled& settled) {
    const bool moves = skeleton_moves();
    double least_disagreement = std::numeric_limits<double>::infinity();
    int least_at = 0;
    if (flow_) expect_skeleton(duration);
    for (int iteration = 0;; ++iteration) {
        ++counts.exchange_iterations;
        if (flow_) {
            const AdvanceResult result = advance_flow(duration, path, cancelled);
            if (result == AdvanceResult::cancelled) return Exchange::cancelled;
            if (result == AdvanceResult::failed) return Exchange::flow_stopped;
        }
        if (!moves) return Exchange::agreed;
        outcome_ = find_equilibrium(path.flow, state_.time + duration);
        if (cancelled(duration)) return Exchange::cancelled;
        const bool is_found = outcome_.status == EquilibriumStatus::converged;
        if (!flow_ && !is_found) return end_of(outcome_);
        if (!flow_) return Exchange::agreed;
        if (is_found) compare_pore_volumes(path.flow);
        if (iteration == 0) settled.first_disagreement = disagreement_;
        if (is_found && disagreement_ <= 1.0) return Exchange::agreed;
        // Under pressures that are not those of the two, ground that yields may find no equilibrium, or one that is farther off.
        const bool yields = outcome_.yielding > 0;
        if (!is_found && !is_short && !state_.settles_jointly) return end_of(outcome_);
        // Ground that softens as it slips goes no way that creep at a given strength would: inertia is to show where it comes to.
        if (!is_found && is_short && !lost_strength_.empty()) return Exchange::gave_way;
        if (!is_found || (yields && (state_.settles_jointly_soon || disagreement_ > settled.first_disagreement ||
                                     iteration == most_plain_iterations))) {
            const Exchange result = settle_jointly(duration, path, is_short, cancelled);
            if (result == Exchange::agreed || is_short) state_.settles_jointly = result == Exchange::agreed;
            settled = {forecast_error_, true};
            return result;
        }
        if (disagreement_ < 0.5 * least_disagreement) {
            least_disagreement = disagreement_;
            least_at = iteration;
        }
        if (iteration == most_iterations || iteration - least_at == patience) return Exchange::disagreed;
        correct_expectation();
        expect_skeleton_at(duration, end_volume_, end_stress_);
    }
}

Simulation::Exchange Simulation::end_of(const EquilibriumOutcome& outcome) {
    switch (outcome.status) {
        case EquilibriumStatus::converged: return Exchange::agreed;
        case EquilibriumStatus::no_equilibrium: return Exchange::equilibrium_lost;
        case EquilibriumStatus::not_converged: break;
    }
    return Exchange::disagreed;
}

AdvanceResult Simulation::advance_flow(double duration, FlowPath& path, const Cancelled& cancelled) {
    const Stopwatch stopwatch(counts.seconds_flow);
    path = {state_.flow, state_.watch, {}};
    const auto after_substep = [&](double t, std::span<const double> pressure) {
        notice(state_.time + t, pressure, path.watch, path.noticed);
        return cancelled(t);
    };
    return integrator_->advance(path.flow, duration, after_substep);
}

void Simulation::set_flow_forcing(double duration) {
    const FlowBoundaries& boundaries = flow_->boundaries;
    std::fill(flow_->forcing.rain.begin(), flow_->forcing.rain.end(), 0.0);
    for (const ZoneShare& share : boundaries.zone_shares) {
        flow_->forcing.rain[static_cast<size_t>(share.surface_node)] +=
            share.area * forcing.rain(static_cast<size_t>(share.zone), state_.time);
    }
    const auto ramp = [&](int32_t boundary, auto&& value_of) {
        const double start = value_of(forcing.flow_value(static_cast<size_t>(boundary), state_.time));
        const double end = value_of(forcing.flow_value(static_cast<size_t>(boundary), state_.time + duration));
        return Ramp{start, (end - start) / duration};
    };
    for (size_t h = 0; h < boundaries.held.size(); ++h) {
        const HeldNode& held = boundaries.held[h];
        const bool hydrostatic =
            scene_.boundaries[static_cast<size_t>(held.boundary)].flow == FlowCondition::hydrostatic;
        const double height = place_of(held.node)[1];
        flow_->forcing.held[h] = ramp(held.boundary, [&](double value) {
            return hydrostatic ? scene_.water.density * scene_.gravity * (value - height) : value;
        });
    }
    for (size_t f = 0; f < boundaries.flux_shares.size(); ++f) {
        const FluxShare& share = boundaries.flux_shares[f];
        flow_->forcing.flux[f] = ramp(share.boundary, [&](double value) { return value * share.area; });
    }
}

// As it lies: what the flow's state is evaluated with between exchanges.
void Simulation::hold_skeleton() const {
    if (!equilibrium_) return;
    const auto& portions = flow_->network.portions;
    for (size_t i = 0; i < portions.size(); ++i) {
        const double pressure = state_.flow.pressure[static_cast<size_t>(portions[i].node)];
        flow_->skeleton.pore_volume[i] = {state_.flow_pore_volume[i], 0.0};
        flow_->skeleton.expected_stress[i] = {flow_->pore_stress(static_cast<size_t>(portions[i].soil), pressure), 0.0};
    }
}

// As it went on last: the expectation that the first iteration starts from.
void Simulation::expect_skeleton(double duration) {
    if (!equilibrium_) return;
    const auto& portions = flow_->network.portions;
    for (size_t i = 0; i < portions.size(); ++i) {
        start_stress_[i] = flow_->pore_stress(static_cast<size_t>(portions[i].soil),
                                              state_.flow.pressure[static_cast<size_t>(portions[i].node)]);
        const bool stands = state_.equilibrium_lost;
        end_volume_[i] =
            stands ? state_.flow_pore_volume[i] : state_.pore_volume[i] + state_.pore_volume_rate[i] * duration;
        end_stress_[i] = start_stress_[i] + (stands ? 0.0 : state_.pore_stress_rate[i] * duration);
        if (stands) flow_->skeleton.softness[i] = 0.0;
    }
    forecast_volume_ = end_volume_;
    forecast_stress_ = end_stress_;
    acceleration_.restart();
    expect_skeleton_at(duration, end_volume_, end_stress_);
}

void Simulation::expect_skeleton_at(double duration, std::span<const double> volume, std::span<const double> stress) {
    SkeletonMotion& skeleton = flow_->skeleton;
    for (size_t i = 0; i < volume.size(); ++i) {
        skeleton.pore_volume[i] = {state_.flow_pore_volume[i], (volume[i] - state_.flow_pore_volume[i]) / duration};
        skeleton.expected_stress[i] = {start_stress_[i], (stress[i] - start_stress_[i]) / duration};
    }
}

EquilibriumOutcome Simulation::find_equilibrium(const FlowState& flow, double until, int32_t most_creep_steps) {
    const Stopwatch stopwatch(counts.seconds_motion);
    set_loads(flow, until);
    const EquilibriumOutcome outcome = equilibrium_->solve(loads(), Equilibrium::tolerance, most_creep_steps);
    counts.motion_iterations += outcome.iterations;
    return outcome;
}

// The pore volume that the skeleton found, beside the one that the flow took for it; the difference in pressures that would undo it.
void Simulation::compare_pore_volumes(const FlowState& flow) {
    const SkeletonMotion& skeleton = flow_->skeleton;
    const auto& portions = flow_->network.portions;
    std::vector<double>& found = found_volume_;
    found = state_.pore_volume;
    for (size_t c = 0; c < mesh_.cell_soil.size(); ++c) {
        const double strain = equilibrium_->volumetric_increment(static_cast<int32_t>(c));
        for (auto corner = static_cast<size_t>(mesh_.cell_start[c]);
             corner < static_cast<size_t>(mesh_.cell_start[c + 1]); ++corner) {
            found[static_cast<size_t>(flow_->network.corner_portion[corner])] +=
                strain * flow_->network.corner_volume[corner];
        }
    }
    disagreement_ = forecast_error_ = 0;
    for (size_t i = 0; i < portions.size(); ++i) {
        const double pressure = flow.pressure[static_cast<size_t>(portions[i].node)];
        const double stress = flow_->pore_stress(static_cast<size_t>(portions[i].soil), pressure);
        const double taken = end_volume_[i] + skeleton.softness[i] * (stress - end_stress_[i]);
        const double forecast = forecast_volume_[i] + skeleton.softness[i] * (stress - forecast_stress_[i]);
        disagreement_ = std::max(disagreement_, agreement_pressures(i, pressure, found[i], taken));
        forecast_error_ = std::max(forecast_error_, agreement_pressures(i, pressure, found[i], forecast));
        correction_[i] = (found[i] - taken) / skeleton.softness[i];
        end_stress_[i] = stress;
        taken_volume_[i] = taken;
    }
}

// The difference of a portion's pore volumes over the one that the agreement pressure makes good. That is asked over the whole of that
// pressure: pores that lack a hundredth of a pascal of being full have no room for what their capacity there would hold (random/13202).
double Simulation::agreement_pressures(size_t portion, double pressure, double found, double taken) const {
    const HydraulicTable& table = flow_->table(static_cast<size_t>(flow_->network.portions[portion].soil));
    const double step = found < taken ? agreement_pressure_ : -agreement_pressure_;
    const double stored =
        table.at(pressure + step).saturation / table.at(pressure).saturation - 1.0 + step / scene_.water.bulk_modulus;
    return (taken - found) / (found * stored + flow_->skeleton.softness[portion] * step);
}

// The next expectation. Plainly it would be what the skeleton found; where that diverges, in undrained ground that yields and is softer than
// the split takes it for, or creeps, in ground so confined that it is stiffer, the last iterations tell how to correct it. They fail where
// the ground turns from elastic to yielding and back between them: joint.cpp.
void Simulation::correct_expectation() {
    acceleration_.accelerate(correction_);
    for (size_t i = 0; i < end_volume_.size(); ++i)
        end_volume_[i] = taken_volume_[i] + flow_->skeleton.softness[i] * correction_[i];
}

void Simulation::accept(double duration, const FlowState& flow) {
    state_.flow = flow;
    if (!equilibrium_ || state_.equilibrium_lost) return;
    if (flow_) {
        for (size_t i = 0; i < found_volume_.size(); ++i) {
            state_.pore_volume_rate[i] = (found_volume_[i] - state_.pore_volume[i]) / duration;
            state_.pore_stress_rate[i] = (end_stress_[i] - start_stress_[i]) / duration;
        }
        const std::span<const double> increment = equilibrium_->increment();
        for (size_t i = 0; i < increment.size(); ++i) state_.displacement_rate[i] = increment[i] / duration;
        state_.pore_volume = found_volume_;
        state_.flow_pore_volume = taken_volume_;
    }
    equilibrium_->accept();
    soften();
    state_.node_position = mesh_.position;
    state_.displacement.assign(equilibrium_->displacement().begin(), equilibrium_->displacement().end());
    refresh_geometry();
}

bool Simulation::is_full(std::span<const double> pressure) {
    constexpr double full = -1.0;  // Pa: no suction to speak of
    return *std::min_element(pressure.begin(), pressure.end()) >= full;
}

void Simulation::notice(double time, std::span<const double> pressure, FlowWatch& watch,
                        std::vector<Happening>& noticed) const {
    const FlowWatch before = watch;
    const FlowTotals& rates = flow_->total_rates();
    const std::span<const HydraulicState> states = flow_->state();
    watch.air = 0;
    for (size_t i = 0; i < states.size(); ++i) {
        const Retention& retention =
            scene_.soils[static_cast<size_t>(flow_->network.portions[i].soil)].hydraulics.retention;
        watch.air += flow_->skeleton.pore_volume[i].start * (retention.maximum_saturation - states[i].saturation);
    }
    watch.gain =
        rates[rain_total] + rates[inflow_total] - rates[run_off_total] - rates[seepage_total] - rates[drained_total];
    double highest = -std::numeric_limits<double>::infinity();
    int32_t wettest = 0;
    for (const SurfaceNode& surface : flow_->boundaries.surface) {
        const double p = pressure[static_cast<size_t>(surface.node)];
        if (p > highest) wettest = surface.node;
        highest = std::max(highest, p);
    }
    constexpr double standing = 10.0;    // Pa: a millimetre of water
    constexpr double noticeable = 0.01;  // of the rain
    watch.time = time;
    watch.is_saturated = is_full(pressure);
    watch.is_ponding = highest > standing || rates[run_off_total] > noticeable * rates[rain_total];
    watch.is_seeping = rates[seepage_total] > 0 && rates[seepage_total] > noticeable * rates[rain_total];
    if (watch.is_saturated && !before.is_saturated) {
        const double filled = before.gain > 0 ? before.time + before.air / before.gain : time;
        noticed.push_back({HappeningKind::saturated, std::clamp(filled, before.time, time), place_of(wettest), 0.0});
    }
    if (watch.is_ponding != before.is_ponding) {
        noticed.push_back({watch.is_ponding ? HappeningKind::ponding_started : HappeningKind::ponding_ended, time,
                           place_of(wettest), rates[run_off_total]});
    }
    if (watch.is_seeping && !before.is_seeping)
        noticed.push_back({HappeningKind::seepage_started, time, place_of(wettest), rates[seepage_total]});
}

}  // namespace talus
