#include "engine.hpp"

#include "engine_state.hpp"
#include "scene/problems.hpp"
#include "scene/validate.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>

namespace talus {
namespace {

constexpr double largest_rain = 1e-3;  // m/s: 3600 mm/h, beyond any storm; more is mm/h given as m/s

std::shared_ptr<const Scene> validated(std::shared_ptr<const Scene> scene) {
    validate(*scene);
    return scene;
}

size_t checked_index(int32_t index, size_t count, const char* what) {
    if (index >= 0 && static_cast<size_t>(index) < count) return static_cast<size_t>(index);
    throw Error(Status::invalid_argument, std::string(what) + " is " + std::to_string(index) + ": the scene has " +
                                              std::to_string(count) + " of them");
}

void check_series(const std::string& what, std::span<const double> time, std::span<const double> value, double now) {
    if (time.empty() || time.size() != value.size()) {
        throw Error(Status::invalid_argument, what + ": " + std::to_string(time.size()) + " times and " +
                                                  std::to_string(value.size()) +
                                                  " values; must be as many, and one at least");
    }
    for (size_t k = 0; k < time.size(); ++k) {
        const std::string place = what + ": time[" + std::to_string(k) + "] = " + value_text(time[k]) + " s";
        if (!std::isfinite(time[k])) throw Error(Status::invalid_argument, place + " must be finite");
        if (k == 0 && time[k] < now)
            throw Error(Status::invalid_argument, place + " must not lie before now, " + value_text(now) + " s");
        if (k > 0 && time[k] <= time[k - 1])
            throw Error(Status::invalid_argument, place + " must be after time[" + std::to_string(k - 1) + "]");
        if (!std::isfinite(value[k])) {
            throw Error(Status::invalid_argument,
                        what + ": value[" + std::to_string(k) + "] = " + value_text(value[k]) + " must be finite");
        }
    }
}

double largest_length(const std::vector<double>& vectors, int32_t dimension) {
    const auto components = static_cast<size_t>(dimension);
    double largest = 0;
    for (size_t i = 0; i < vectors.size(); i += components) {
        double square = 0;
        for (size_t k = 0; k < components; ++k) square += vectors[i + k] * vectors[i + k];
        largest = std::max(largest, square);
    }
    return std::sqrt(largest);
}

EventKind event_kind(HappeningKind kind) {
    switch (kind) {
        case HappeningKind::saturated: return EventKind::saturated;
        case HappeningKind::ponding_started: return EventKind::ponding_started;
        case HappeningKind::ponding_ended: return EventKind::ponding_ended;
        case HappeningKind::seepage_started: return EventKind::seepage_started;
        case HappeningKind::loss_of_equilibrium: return EventKind::loss_of_equilibrium;
        case HappeningKind::motion_started: return EventKind::motion_started;
        case HappeningKind::came_to_rest: return EventKind::came_to_rest;
        case HappeningKind::settled: return EventKind::settled;
        case HappeningKind::left_background: return EventKind::left_background;
        case HappeningKind::rain_ended: return EventKind::rain_ended;
    }
    return EventKind::rain_ended;
}

std::string event_message(const Happening& happening) {
    const std::string when = " at t = " + value_text(happening.time) + " s";
    const std::string where = ", (" + value_text(happening.place[0]) + ", " + value_text(happening.place[1]) + ") m";
    switch (happening.kind) {
        case HappeningKind::saturated: return "the last pore filled" + when;
        case HappeningKind::ponding_started: return "water stands on the surface or runs off" + when + where;
        case HappeningKind::ponding_ended: return "no more water stands on the surface" + when;
        case HappeningKind::seepage_started: return "water comes out of the surface" + when + where;
        case HappeningKind::loss_of_equilibrium:
            return "no equilibrium exists any more: the ground fails" + when + where;
        case HappeningKind::motion_started: return "the ground moves by its momentum" + when + where;
        case HappeningKind::came_to_rest:
            return "the ground rests" + when + ", its front at x = " + value_text(happening.place[0]) + " m; " +
                   value_text(happening.value) + " m3 per metre of thickness moved by more than a cell";
        case HappeningKind::settled:
            return std::string(happening.value > 0
                                   ? "the ground that rests is in equilibrium"
                                   : "the ground rests, but no equilibrium was found: its skeleton stands") +
                   when + "; water moves in it again";
        case HappeningKind::left_background:
            return "ground came to an end of the background" + when + where +
                   (happening.value > 0
                        ? ": " + value_text(happening.value) + " m3 per metre of thickness were taken out"
                        : std::string());
        case HappeningKind::rain_ended: return "the rain series ended" + when + "; its last rate is held";
    }
    return {};
}

void check_boundaries_touch(const Simulation& simulation, const Scene& scene) {
    std::string untouched;
    const Mesh& mesh = simulation.reference_mesh();
    for (size_t b = 0; b < scene.boundaries.size(); ++b) {
        const auto touches = [&](const Facet& facet) { return covers(scene.boundaries[b], mesh, facet); };
        if (std::any_of(mesh.facets.begin(), mesh.facets.end(), touches)) continue;
        untouched += (untouched.empty() ? "" : "\n") + item_path("boundaries", b) +
                     ": no edge of the ground lies on this part of side " + scene.boundaries[b].side;
    }
    if (!untouched.empty()) throw Error(Status::invalid_scene, untouched);
}

bool lies_in_ground(const ProbeTrack& probe) { return probe.cell_place.cell >= 0 || probe.point >= 0; }

}  // namespace

Engine::State::State(std::shared_ptr<const Scene> scene_in, Options options_in)
    : scene(validated(std::move(scene_in))),
      options(std::move(options_in)),
      simulation(std::make_unique<Simulation>(*scene,
                                              options.tolerance > 0 ? options.tolerance : scene->numerics.tolerance,
                                              options.threads, options.stop_at_motion)),
      locator(simulation->reference_mesh()) {
    check_boundaries_touch(*simulation, *scene);
    if (simulation->dynamic() != nullptr) number_point_soils();
    quantities = probe_quantities();
    for (size_t k = 0; k < scene->probes.size(); ++k) {
        const auto [x, y] = scene->probes[k].place;
        probes.push_back(make_probe(scene->probes[k].name, {x, y}));
        if (!lies_in_ground(probes.back())) {
            throw Error(Status::invalid_scene, item_path("probes", k) + ".place = (" + value_text(x) + ", " +
                                                   value_text(y) + ") m: must lie in the ground");
        }
    }
    record_probes();
    if (simulation->dynamic() != nullptr) report_motion();
    report_water(report.water);
    report.least_factor_of_safety = simulation->least_factor_of_safety();
    description = describe();
}

Engine::Engine(std::shared_ptr<const Scene> scene, Options options)
    : state_(std::make_unique<State>(std::move(scene), std::move(options))) {}

Engine::~Engine() = default;

const std::string& Engine::describe() const { return state_->description; }

// --- push ------------------------------------------------------------------------------------------------------------

int32_t Engine::zone(std::string_view name) const {
    const auto& zones = state_->scene->surface.zones;
    const auto found =
        std::find_if(zones.begin(), zones.end(), [&](const RainZone& zone) { return zone.name == name; });
    if (found == zones.end()) throw Error(Status::unknown_field, "no rain zone is named '" + std::string(name) + "'");
    return static_cast<int32_t>(found - zones.begin());
}

void Engine::push_rain(int32_t zone, std::span<const double> time, std::span<const double> rate) {
    const size_t index = checked_index(zone, state_->scene->surface.zones.size(), "zone");
    const std::string what = "rain of zone '" + state_->scene->surface.zones[index].name + "'";
    check_series(what, time, rate, this->time());
    for (size_t k = 0; k < rate.size(); ++k) {
        if (rate[k] >= 0 && rate[k] <= largest_rain) continue;
        throw Error(Status::invalid_argument, what + ": rate[" + std::to_string(k) + "] = " + value_text(rate[k]) +
                                                  " m/s must be between 0 and " + value_text(largest_rain) +
                                                  (rate[k] > 0 ? " (mm/h given as m/s? 1 mm/h is 2.78e-7 m/s)" : ""));
    }
    state_->simulation->forcing.push_rain(index, time, rate);
}

void Engine::set_rain(int32_t zone, double rate) {
    const double now = time();
    push_rain(zone, {&now, 1}, {&rate, 1});
}

int32_t Engine::boundary(std::string_view name) const {
    const auto& boundaries = state_->scene->boundaries;
    const auto found = std::find_if(boundaries.begin(), boundaries.end(),
                                    [&](const Boundary& boundary) { return boundary.name == name; });
    if (found == boundaries.end())
        throw Error(Status::unknown_field, "no boundary is named '" + std::string(name) + "'");
    return static_cast<int32_t>(found - boundaries.begin());
}

void Engine::push_flow_value(int32_t boundary, std::span<const double> time, std::span<const double> value) {
    const auto& boundaries = state_->scene->boundaries;
    const size_t index = checked_index(boundary, boundaries.size(), "boundary");
    const std::string what = "flow value of boundary '" + boundaries[index].name + "'";
    const FlowCondition flow = boundaries[index].flow;
    const bool takes =
        flow == FlowCondition::pressure || flow == FlowCondition::hydrostatic || flow == FlowCondition::flux;
    if (!boundaries[index].has_flow || !takes || !state_->scene->physics.water) {
        throw Error(Status::invalid_argument,
                    what + ": it has none; only pressure, hydrostatic and flux conditions take values in time");
    }
    check_series(what, time, value, this->time());
    state_->simulation->forcing.push_flow_value(index, time, value);
}

void Engine::push_motion_value(int32_t boundary, int32_t component, std::span<const double> time,
                               std::span<const double> value) {
    const auto& boundaries = state_->scene->boundaries;
    const size_t index = checked_index(boundary, boundaries.size(), "boundary");
    const std::string what = "motion value of boundary '" + boundaries[index].name + "'";
    if (component < 0 || component > 1) {
        throw Error(Status::invalid_argument,
                    what + ": component is " + std::to_string(component) + ": must be 0 (x) or 1 (y)");
    }
    const auto axis = static_cast<size_t>(component);
    if (!state_->scene->physics.deforming || !state_->simulation->forcing.has_motion_value(index, axis)) {
        throw Error(
            Status::invalid_argument,
            what + ": it has none in this direction; only displacements and tractions of the scene change in time");
    }
    check_series(what, time, value, this->time());
    state_->simulation->forcing.push_motion_value(index, axis, time, value);
}

// --- step ------------------------------------------------------------------------------------------------------------

Status Engine::step(double dt, StepReport& report) {
    if (!(dt > 0) || !std::isfinite(dt))
        throw Error(Status::invalid_argument, "dt = " + value_text(dt) + " s: must be positive and finite");
    return advance_to(time() + dt, report);
}

Status Engine::advance_to(double until, StepReport& report) {
    State& state = *state_;
    const double from = time();
    constexpr double longest_step = 1e11;  // s: three thousand years
    if (!(until > from) || !(until - from < longest_step)) {
        throw Error(Status::invalid_argument, "a step from " + value_text(from) + " s to " + value_text(until) +
                                                  " s: must go forward, by less than " + value_text(longest_step) +
                                                  " s");
    }
    const auto start = std::chrono::steady_clock::now();
    const GroundState before = state.simulation->save();
    const FlowStatistics flow_before = state.simulation->flow_statistics();
    state.simulation->happenings.clear();
    state.simulation->counts = {};
    const auto cancelled = [&](double fraction) {
        if (state.options.progress && state.options.progress(std::min(fraction, 1.0))) return true;
        return state.cancel_asked.exchange(false);
    };
    Replaced replaced;
    const auto undo = [&] {
        if (replaced.first) state.simulation = std::move(replaced.first);
        state.simulation->restore(before);
    };
    bool finished = false;
    try {
        finished = !state.cancel_asked.exchange(false) && state.advance(until, cancelled, replaced);
    } catch (...) {
        undo();
        throw;
    }
    if (!finished) {
        undo();
        return Status::cancelled;
    }

    if (replaced.first) state.follow_mesh();
    const double reached = state.simulation->state().time;
    const bool out_of_rain = reached > state.simulation->forcing.rain_end();
    if (out_of_rain) state.simulation->note_rain_end();
    state.time = reached;
    ++state.epoch;
    state.derived.clear();
    state.nearest.reset();
    const StepCounts& counts = state.simulation->counts;
    const FlowStatistics flow = state.simulation->flow_statistics();
    StepReport& last = state.report;
    last.time = reached;
    last.regime = state.simulation->state().equilibrium_lost ? Regime::equilibrium_lost : Regime::quasi_static;
    last.flow_substeps = flow.substeps - flow_before.substeps;
    last.flow_failures = flow.failures - flow_before.failures;
    last.flow_iterations = flow.iterations - flow_before.iterations;
    last.coupling_steps = counts.exchanges;
    last.coupling_iterations = counts.exchange_iterations;
    last.motion_iterations = counts.motion_iterations;
    state.report_water(last.water);
    last.largest_displacement =
        largest_length(state.simulation->state().displacement, state.simulation->mesh().dimension);
    last.largest_velocity = largest_length(state.simulation->state().velocity, state.simulation->mesh().dimension);
    last.least_factor_of_safety = state.simulation->least_factor_of_safety();
    last.seconds_flow = counts.seconds_flow;
    last.seconds_motion = counts.seconds_motion;
    last.motion = replaced.motion;
    if (state.simulation->dynamic() != nullptr) {
        if (state.point_soil.empty()) state.follow_points();
        state.report_motion();
    }
    state.tell_happenings();
    state.record_probes();
    last.seconds_total = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    report = last;
    if (reached < until) return Status::ended_early;
    return out_of_rain ? Status::out_of_rain : Status::ok;
}

// Ground that came to rest goes on as a simulation of its own, in equilibrium, where it can.
bool Engine::State::advance(double until, const Cancelled& cancelled, Replaced& replaced) {
    const double from = simulation->state().time;
    while (true) {
        if (simulation->may_settle()) {
            if (std::unique_ptr<Simulation> settled = simulation->settle()) {
                std::swap(simulation, settled);
                replaced.motion = settled->dynamic()->report();
                if (!replaced.first) replaced.first = std::move(settled);
            }
        }
        const double start = simulation->state().time;
        const auto watched = [&](double fraction) {
            return cancelled((start + fraction * (until - start) - from) / (until - from));
        };
        if (!simulation->advance(until, watched)) return false;
        if (simulation->state().time >= until || options.stop_at_motion) return true;
    }
}

void Engine::State::report_water(WaterBalance& water) const {
    if (!scene->physics.water) return;
    const FlowTotals& totals = simulation->state().flow.totals;
    water.rain = totals[rain_total];
    water.run_off = totals[run_off_total];
    water.infiltrated = water.rain - water.run_off;
    water.seepage = totals[seepage_total];
    water.inflow = totals[inflow_total];
    water.drained = totals[drained_total];
    water.initial = simulation->initial_water();
    water.stored = simulation->water_now();
    water.residual = water.stored - water.initial - (water.infiltrated - water.seepage + water.inflow - water.drained);
}

void Engine::State::tell_happenings() {
    for (const Happening& happening : simulation->happenings) {
        events.push_back(
            {event_kind(happening.kind), happening.time, happening.place, happening.value, event_message(happening)});
        if (options.log) options.log(2, events.back().message);
    }
}

void Engine::cancel() noexcept { state_->cancel_asked = true; }
double Engine::time() const noexcept { return state_->time; }
const StepReport& Engine::last_report() const { return state_->report; }

// --- query -----------------------------------------------------------------------------------------------------------

int64_t Engine::epoch() const noexcept { return state_->epoch; }
std::vector<std::string> Engine::field_names() const { return state_->field_names(); }
FieldView Engine::view(std::string_view field) const { return state_->view(field); }
const std::vector<Event>& Engine::events() const { return state_->events; }
const Scene& Engine::scene() const { return *state_->scene; }

bool Engine::sample(std::string_view field, std::span<const double> places, std::span<double> values) const {
    const FieldView view = state_->view(field);
    if (view.location == Location::mesh || view.type != DataType::float64) {
        throw Error(Status::invalid_argument,
                    "field '" + std::string(field) + "' cannot be sampled: it is not a field over the ground");
    }
    const auto dimension = static_cast<size_t>(state_->simulation->mesh().dimension);
    const auto components = static_cast<size_t>(view.components);
    bool all_inside = true;
    for (size_t i = 0; i < places.size() / dimension; ++i) {
        const double x = dimension == 1 ? 0.0 : places[2 * i];
        const double y = places[i * dimension + dimension - 1];
        const std::span<double> value = values.subspan(i * components, components);
        if (state_->sample(view, x, y, value)) continue;
        std::fill(value.begin(), value.end(), std::numeric_limits<double>::quiet_NaN());
        all_inside = false;
    }
    return all_inside;
}

int32_t Engine::probe(std::string_view name) const {
    const auto found = std::find_if(state_->probes.begin(), state_->probes.end(),
                                    [&](const ProbeTrack& probe) { return probe.name == name; });
    if (found == state_->probes.end())
        throw Error(Status::unknown_field, "no probe is named '" + std::string(name) + "'");
    return static_cast<int32_t>(found - state_->probes.begin());
}

int32_t Engine::add_probe(const std::string& name, Place place) {
    ProbeTrack probe = state_->make_probe(name, place);
    if (!lies_in_ground(probe)) {
        throw Error(Status::invalid_argument, "probe '" + name + "' at (" + value_text(place[0]) + ", " +
                                                  value_text(place[1]) + ") m: must lie in the ground");
    }
    const std::vector<double> unknown(state_->probe_times.size() - 1, std::numeric_limits<double>::quiet_NaN());
    for (auto& history : probe.history) history = unknown;
    state_->record(probe);
    state_->probes.push_back(std::move(probe));
    return static_cast<int32_t>(state_->probes.size()) - 1;
}

std::span<const double> Engine::probe_times() const { return state_->probe_times; }

std::span<const double> Engine::probe_history(int32_t probe, std::string_view quantity) const {
    const size_t index = checked_index(probe, state_->probes.size(), "probe");
    const auto found = std::find(state_->quantities.begin(), state_->quantities.end(), quantity);
    if (found == state_->quantities.end()) {
        throw Error(Status::unknown_field,
                    "probes record no '" + std::string(quantity) + "'; they record " + joined(state_->quantities));
    }
    return state_->probes[index].history[static_cast<size_t>(found - state_->quantities.begin())];
}

// FNV-1a over the bytes of the state.
uint64_t Engine::hash() const {
    uint64_t hash = 14695981039346656037u;
    const auto mix = [&](const std::vector<double>& values) {
        for (const double value : values) {
            uint64_t bits = 0;
            std::memcpy(&bits, &value, sizeof bits);
            for (int byte = 0; byte < 8; ++byte) hash = (hash ^ ((bits >> (8 * byte)) & 0xff)) * 1099511628211u;
        }
    };
    const GroundState& ground = state_->simulation->state();
    mix({ground.time, ground.exchange_step, ground.given_up_exchange, ground.flow.substep});
    mix({double(ground.settles_jointly), double(ground.goes_on_jointly), double(ground.settles_jointly_soon)});
    for (const auto* field :
         {&ground.node_position, &ground.displacement, &ground.velocity, &ground.flow.pressure, &ground.flow.stored,
          &ground.pore_volume, &ground.flow_pore_volume, &ground.pore_volume_rate, &ground.pore_stress_rate,
          &ground.displacement_rate, &ground.points.position, &ground.points.volume, &ground.points.displacement,
          &ground.points.skeleton_stress, &ground.points.strain, &ground.points.plastic_strain,
          &ground.points.mobilised_strength})
        mix(*field);
    mix({ground.flow.totals.begin(), ground.flow.totals.end()});
    if (state_->simulation->dynamic() == nullptr) return hash;
    const FreePoints& points = state_->simulation->dynamic()->points();
    for (const auto& field : points.field) mix(field);
    mix({points.number.begin(), points.number.end()});
    mix({points.quiet.begin(), points.quiet.end()});
    return hash;
}

}  // namespace talus
