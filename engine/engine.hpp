// The facade: one run in time. Create it from a scene, push rain, step, query. Used by one thread at a time; cancel() and time()
// from any. Everything throws talus::Error; a call that throws leaves the engine as it was before the call.
#pragma once

#include "coupling/motion_report.hpp"
#include "error.hpp"
#include "scene/load.hpp"

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// Water in m3 per metre of thickness (plane strain) or m3 per m2 (column), since the start of the run.
/// infiltrated + run_off = rain + (change of ponded, counted in stored); stored - initial = infiltrated + inflow - drained + residual.
struct WaterBalance {
    double rain = 0;         ///< fallen on the ground surface
    double infiltrated = 0;  ///< taken by the ground surface, what ponds on it included
    double run_off = 0;      ///< rain that the ground surface did not take
    double seepage = 0;      ///< come out of the ground surface
    double inflow = 0;       ///< come in through the other boundaries
    double drained = 0;      ///< gone out through the other boundaries
    double stored = 0;       ///< in the pores and ponded, now
    double initial = 0;      ///< in the pores and ponded, at the start
    double residual = 0;     ///< what the balance misses
};

enum class Regime : int32_t {
    quasi_static = 0,
    equilibrium_lost = 1,  ///< failure was found: the skeleton stands as it was, the flow goes on
    dynamic = 2,           ///< the ground moves by its momentum
    at_rest = 3,  ///< it failed, moved and rests: it lies as it came to lie, and no water moves until it settles
};

struct StepReport {
    double time = 0;  ///< s, after the step
    Regime regime = Regime::quasi_static;
    int64_t flow_substeps = 0;    ///< of this step
    int64_t flow_failures = 0;    ///< substeps tried again, smaller
    int64_t flow_iterations = 0;  ///< Newton iterations of the flow
    int64_t coupling_steps = 0;   ///< exchanges between flow and motion
    int64_t coupling_iterations = 0;
    int64_t motion_iterations = 0;  ///< Newton iterations of the equilibrium
    WaterBalance water;
    double largest_displacement = 0;    ///< m, since the start
    double largest_velocity = 0;        ///< m/s, mean over the step
    double least_factor_of_safety = 0;  ///< least local one; 0 where none is known
    double seconds_flow = 0;            ///< wall seconds of this step
    double seconds_motion = 0;
    double seconds_total = 0;
    MotionReport motion;  ///< of a dynamic ground
};

enum class EventKind : int32_t {
    saturated = 1,        ///< the last pore of the ground filled
    ponding_started = 2,  ///< water stands on the surface, or runs off
    ponding_ended = 3,
    seepage_started = 4,      ///< water comes out of the surface
    loss_of_equilibrium = 5,  ///< no equilibrium exists: failure
    rain_ended = 6,           ///< the step went past the end of the rain series
    motion_started = 7,       ///< the ground that failed moves by its momentum
    came_to_rest = 8,         ///< the ground that moved rests
    settled = 9,              ///< it lies on a mesh again; value 1: in equilibrium, 0: none found, its skeleton stands
    left_background = 10,     ///< moving ground came to an end of its background; value: what was taken out there, m3
};

struct Event {
    EventKind kind{};
    double time = 0;   ///< s
    Place place{};     ///< where, m
    double value = 0;  ///< what the kind says
    std::string message;
};

enum class Location : int32_t { node = 0, point = 1, cell = 2, mesh = 3 };
enum class DataType : int32_t { float64 = 0, int32 = 1 };

/// A view into the engine's memory, valid until epoch() changes (step, restore and destroy change it).
struct FieldView {
    const char* name = nullptr;
    const char* units = nullptr;          ///< UDUNITS text
    const char* standard_name = nullptr;  ///< CSDMS standard name
    Location location{};
    DataType type{};
    const void* data = nullptr;
    int64_t count = 0;       ///< rows: nodes, points or cells
    int64_t components = 1;  ///< consecutive values a row
};

struct Options {
    double tolerance = 0;  ///< 0: the scene's
    int32_t threads = 1;   ///< of a dynamic ground; 0: one. Results do not depend on it
    bool stop_at_motion =
        false;  ///< whether a step ends where ground of the regime auto starts to move or comes to rest
    std::function<void(int32_t level, const std::string& text)> log;
    /// Called inside a step with the fraction done; true cancels.
    std::function<bool(double fraction)> progress;
};

class Engine {
public:
    Engine(std::shared_ptr<const Scene> scene, Options options);
    ~Engine();
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;

    /// JSON: physics composed, what was left out, sizes, bytes held, schedule, zones, boundaries, probes, fields.
    [[nodiscard]] const std::string& describe() const;

    // push
    [[nodiscard]] int32_t zone(std::string_view name) const;
    void push_rain(int32_t zone, std::span<const double> time,
                   std::span<const double> rate);  ///< replaces from time[0] on
    void set_rain(int32_t zone, double rate);      ///< m/s, from now until changed
    [[nodiscard]] int32_t boundary(std::string_view name) const;
    void push_flow_value(int32_t boundary, std::span<const double> time, std::span<const double> value);
    void push_motion_value(int32_t boundary, int32_t component, std::span<const double> time,
                           std::span<const double> value);

    // step
    /// Carries the state dt seconds on. ok, or cancelled (undone), out_of_rain (done, with the last rate held), or ended_early (done up to
    /// the report's time, where stop_at_motion asks for it).
    Status step(double dt, StepReport& report);
    Status advance_to(double time, StepReport& report);  ///< the same, landing on the time bit for bit
    void cancel() noexcept;                              ///< any thread: ends the step that runs, or else the next one
    [[nodiscard]] double time() const noexcept;          ///< any thread
    [[nodiscard]] const StepReport& last_report() const;

    // query
    [[nodiscard]] int64_t epoch() const noexcept;
    [[nodiscard]] std::vector<std::string> field_names() const;
    [[nodiscard]] FieldView view(std::string_view field) const;
    /// Values at places (n x dimension), n x components; NaN outside the ground. True when all lay inside.
    bool sample(std::string_view field, std::span<const double> places, std::span<double> values) const;
    [[nodiscard]] const std::vector<Event>& events() const;

    // probes: a history of every scene probe, one row a step (the start included)
    [[nodiscard]] int32_t probe(std::string_view name) const;
    int32_t add_probe(const std::string& name, Place place);
    /// Times and values of a field at a probe. Scalars, or one component of a vector.
    [[nodiscard]] std::span<const double> probe_times() const;
    [[nodiscard]] std::span<const double> probe_history(int32_t probe, std::string_view quantity) const;

    [[nodiscard]] uint64_t hash() const;  ///< of the state, bit for bit

    [[nodiscard]] const Scene& scene() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace talus
