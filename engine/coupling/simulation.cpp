#include "coupling/simulation.hpp"

#include "error.hpp"
#include "scene/problems.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talus {
namespace {

constexpr double first_exchange = 1e-4;     // of the host's first step: the start may be a sudden load
constexpr double shortest_exchange = 1e-9;  // of the host's step
constexpr double failure_window = 1e-3;     // of the host's step: how closely the time of failure is found

std::string at_time(double time) { return "t = " + value_text(time) + " s: "; }

}  // namespace

// The macro step. Everything that a host step does is named here once.
bool Simulation::advance(double until, const Cancelled& cancelled) {
    if (dynamic_) return advance_dynamically(until, cancelled);
    const double from = state_.time;
    const double whole = until - from;
    const std::vector<double> displacement_before = state_.displacement;
    if (!flow_ || !skeleton_moves()) {
        state_.exchange_step = whole;  // alone, each goes as far as the host asks
    } else if (state_.exchange_step <= 0) {
        state_.exchange_step = first_exchange * whole;
    }
    while (state_.time < until) {
        const double stop = forcing.next_break(state_.time, until);
        const double left = stop - state_.time;
        const bool is_last = state_.exchange_step >= left;
        const double duration = is_last ? left : std::min(state_.exchange_step, 0.5 * left);
        const auto watched = [&](double t) { return cancelled((state_.time + t - from) / whole); };
        const Exchange result = exchange(duration, duration < failure_window * whole, watched);
        const Place giving_way = result == Exchange::gave_way ? place_of_largest_increment() : Place{};
        if (result != Exchange::agreed && skeleton_moves()) equilibrium_->reject();
        if (result != Exchange::agreed) state_.given_up_exchange = duration;
        switch (result) {
            case Exchange::agreed: state_.time = is_last ? stop : state_.time + duration; break;
            case Exchange::cancelled: return false;
            case Exchange::disagreed:
                shorten_exchange(duration, whole, "the skeleton's equilibrium was neither found nor shown to be lost");
                break;
            case Exchange::equilibrium_lost:
                if (duration > failure_window * whole) {
                    state_.exchange_step = shorter_exchange(duration, whole);
                } else {
                    lose_equilibrium();
                    state_.exchange_step = whole;
                    if (scene_.physics.regime != MotionRegime::automatic) break;
                    start_motion(outcome_.collapse.place);
                    return stop_at_motion_ || advance_dynamically(until, cancelled);
                }
                break;
            case Exchange::gave_way:
                start_motion(giving_way);
                return stop_at_motion_ || advance_dynamically(until, cancelled);
            case Exchange::flow_stopped:
                shorten_exchange(duration, whole,
                                 "the flow's equations were not solved within " + value_text(duration) + " s");
                break;
        }
    }
    for (size_t i = 0; i < state_.velocity.size(); ++i)
        state_.velocity[i] = (state_.displacement[i] - displacement_before[i]) / whole;
    update_points();
    return true;
}

// From the last state in equilibrium. That stays as it is, so that a step that fails later can go back to it.
void Simulation::start_motion(Place place) {
    Handover handover{state_.flow.pressure, state_.displacement, {}, 0, state_.time, lost_strength_};
    handover.soil_mass.assign(scene_.soils.size(), 0.0);
    for (size_t p = 0; p < initial_volume_.size(); ++p) {
        const auto soil = static_cast<size_t>(state_.points.soil[p]);
        handover.soil_mass[soil] += scene_.soils[soil].dry_density * initial_volume_[p];
    }
    if (flow_) handover.water = water_now();
    dynamic_ = std::make_unique<DynamicGround>(scene_, mesh_, state_.points, handover, threads_);
    happenings.push_back({HappeningKind::motion_started, state_.time, place, 0.0});
}

// A dynamic ground: from one change of the rain to the next, in the regime `auto` until it rests. What cannot settle then lies still.
bool Simulation::advance_dynamically(double until, const Cancelled& cancelled) {
    const double from = state_.time;
    while (state_.time < until) {
        if (state_.lies_still) {
            lie_still(until);
            return true;
        }
        const double stop = forcing.next_break(state_.time, until);
        const double start = state_.time;
        const auto watched = [&](double fraction) {
            return cancelled((start + fraction * (stop - start) - from) / (until - from));
        };
        if (!dynamic_->advance(
                start, stop, [this, start](double x) { return rain_at(x, start); }, watched))
            return false;
        const WaterExchange water = dynamic_->water_exchange();
        state_.flow.totals[rain_total] += water.rain;
        state_.flow.totals[run_off_total] += water.run_off;
        state_.flow.totals[seepage_total] += water.seepage;
        state_.flow.totals[drained_total] += water.absorbed;
        state_.time = dynamic_->time();
        if (const std::optional<EndReached>& end = dynamic_->end_reached())
            happenings.push_back({HappeningKind::left_background, end->time, end->place, end->absorbed});
        if (dynamic_->rests()) {
            state_.rests = true;
            const MotionReport report = dynamic_->report();
            happenings.push_back(
                {HappeningKind::came_to_rest, state_.time, {report.front_x, 0.0}, report.sliding_volume});
            return true;
        }
    }
    return true;
}

// No water moves in ground that lies still: all rain runs off.
void Simulation::lie_still(double until) {
    while (state_.time < until) {
        const double stop = forcing.next_break(state_.time, until);
        const double now = state_.time;
        const double fallen = (stop - now) * dynamic_->rain_on([this, now](double x) { return rain_at(x, now); });
        state_.flow.totals[rain_total] += fallen;
        state_.flow.totals[run_off_total] += fallen;
        state_.time = stop;
    }
}

double Simulation::rain_at(double x, double time) const {
    for (size_t zone = 0; zone < scene_.surface.zones.size(); ++zone) {
        const RainZone& here = scene_.surface.zones[zone];
        if (x >= here.x_from && x < here.x_to) return forcing.rain(zone, time);
    }
    return 0;
}

// Ground that softens gives way at once or not for a while: what lies between is dear to try.
double Simulation::shorter_exchange(double duration, double whole) const {
    const double window = 0.5 * failure_window * whole;
    return lost_strength_.empty() || duration < window ? 0.25 * duration : std::min(0.25 * duration, window);
}

// What was expected of the skeleton may be what stopped the solvers, and is the less wrong the shorter the exchange.
void Simulation::shorten_exchange(double duration, double whole, const std::string& problem) {
    state_.exchange_step = shorter_exchange(duration, whole);
    if (skeleton_moves() && state_.exchange_step >= shortest_exchange * whole) return;
    throw Error(Status::not_converged, at_time(state_.time) + problem + "; this says nothing about the slope");
}

void Simulation::lose_equilibrium() {
    state_.equilibrium_lost = true;
    happenings.push_back(
        {HappeningKind::loss_of_equilibrium, state_.time, outcome_.collapse.place, outcome_.collapse.displacement});
}

void Simulation::note_rain_end() {
    if (!state_.rain_is_out) happenings.push_back({HappeningKind::rain_ended, forcing.rain_end(), {}, 0.0});
    state_.rain_is_out = true;
}

GroundState Simulation::save() const {
    GroundState state = state_;
    if (!dynamic_) return state;
    state.moving = dynamic_->save();
    return state;
}

void Simulation::restore(const GroundState& state) {
    state_ = state;
    if (state.moving) {
        dynamic_->restore(*state.moving);
        state_.moving.reset();
        return;
    }
    dynamic_.reset();  // the motion began in the step that is undone
    mesh_.position = state.node_position;
    if (equilibrium_) equilibrium_->restore(state.displacement);
    soften();
    refresh_geometry();
}

double Simulation::water_now() const {
    if (dynamic_) return dynamic_->water();
    hold_skeleton();
    flow_->evaluate(0.0, state_.flow.pressure);
    double sum = 0;
    for (const double water : flow_->stored()) sum += water;
    return sum;
}

double Simulation::least_factor_of_safety() const {
    const double least =
        equilibrium_ ? equilibrium_->least_factor_of_safety() : std::numeric_limits<double>::infinity();
    return std::isfinite(least) ? least : 0.0;
}

Place Simulation::place_of_largest_increment() const {
    const std::span<const double> increment = equilibrium_->increment();
    const auto dimension = static_cast<size_t>(mesh_.dimension);
    double largest = 0;
    size_t place = 0;
    for (size_t i = 0; i < increment.size(); ++i) {
        if (std::abs(increment[i]) <= largest) continue;
        largest = std::abs(increment[i]);
        place = i / dimension;
    }
    return place_of(static_cast<int32_t>(place));
}

Place Simulation::place_of(int32_t node) const {
    const auto index = static_cast<size_t>(node);
    if (mesh_.dimension == 1) return {0.0, mesh_.position[index]};
    return {mesh_.position[2 * index], mesh_.position[2 * index + 1]};
}

}  // namespace talus
