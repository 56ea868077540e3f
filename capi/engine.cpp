// Create, push, step: the calls that change an engine.
#include "handles.hpp"
#include "structs.hpp"

#include <cmath>
#include <limits>
#include <span>

namespace talus::capi {
namespace {

/// The host's callbacks, called as the host left its floating-point environment.
Options options_of(talus_engine& engine) {
    Options options;
    options.tolerance = engine.options.tolerance;
    options.threads = engine.options.threads;
    options.stop_at_motion = engine.options.stop_at_motion != 0;
    if (engine.options.log != nullptr) {
        options.log = [&engine](int32_t level, const std::string& text) {
            const HostFloatingPoint floating_point(*engine.host);
            engine.options.log(engine.options.log_user, level, text.c_str());
        };
    }
    if (engine.options.progress != nullptr) {
        options.progress = [&engine](double fraction) {
            const HostFloatingPoint floating_point(*engine.host);
            return engine.options.progress(engine.options.progress_user, fraction) != 0;
        };
    }
    return options;
}

talus_options checked(const talus_options* given) {
    if (given == nullptr) {
        return TALUS_OPTIONS_INIT;
    }
    const talus_options options = read_struct(given, "TALUS_OPTIONS_INIT");
    if (options.rain_policy < TALUS_RAIN_REJECT || options.rain_policy > TALUS_RAIN_ZERO) {
        throw Error(Status::invalid_argument, "options.rain_policy is " + std::to_string(options.rain_policy) +
                                                  ", which must be TALUS_RAIN_REJECT, _HOLD or _ZERO");
    }
    if (options.threads < 0 || options.threads > 1024) {
        throw Error(Status::invalid_argument, "options.threads is " + std::to_string(options.threads) +
                                                  ", which must be 0 (one) or between 1 and 1024");
    }
    if (!(options.tolerance >= 0 && options.tolerance < 1)) {
        throw Error(Status::invalid_argument, "options.tolerance is " + std::to_string(options.tolerance) +
                                                  ", which must be 0 (the scene's) or between 0 and 1");
    }
    return options;
}

std::span<const double> values(const double* first, int64_t count) { return {first, static_cast<size_t>(count)}; }

// --- rain ------------------------------------------------------------------------------------------------------------

/// Rates with the bad ones replaced as the host's policy says, and how many were.
struct CleanRates {
    std::vector<double> rate;
    double last = 0;  ///< m/s, the last good one; NaN: none
    int64_t substitutions = 0;
};

double& last_rate(talus_engine& engine, int32_t zone) {
    const auto index = static_cast<size_t>(zone);
    if (engine.last_rate.size() <= index) {
        engine.last_rate.resize(index + 1, std::numeric_limits<double>::quiet_NaN());
    }
    return engine.last_rate[index];
}

CleanRates clean(std::span<const double> rate, double last, int32_t policy) {
    CleanRates clean{{rate.begin(), rate.end()}, last, 0};
    for (double& value : clean.rate) {
        const bool good = std::isfinite(value) && value >= 0;
        const bool held = policy == TALUS_RAIN_HOLD && std::isfinite(clean.last);
        if (good) {
            clean.last = value;
        } else if (policy == TALUS_RAIN_ZERO || held) {
            value = held ? clean.last : 0;
            ++clean.substitutions;
        }
    }
    return clean;
}

/// Pushes rates by `push(clean rates)`; what the engine refuses is not counted.
template <class Push>
talus_status push_clean(talus_engine& engine, int32_t zone, std::span<const double> rate, Push push) {
    if (zone < 0 || static_cast<size_t>(zone) >= engine.run->scene().surface.zones.size()) {
        throw Error(Status::invalid_argument,
                    "zone is " + std::to_string(zone) + "; the scene has the rain zones 0 to " +
                        std::to_string(static_cast<int64_t>(engine.run->scene().surface.zones.size()) - 1));
    }
    const CleanRates rates = clean(rate, last_rate(engine, zone), engine.options.rain_policy);
    push(rates.rate);
    last_rate(engine, zone) = rates.last;
    engine.rain_substitutions += rates.substitutions;
    return TALUS_OK;
}

// --- step ------------------------------------------------------------------------------------------------------------

talus_step_report report_of(const talus_engine& engine, const StepReport& step) {
    talus_step_report report = TALUS_STEP_REPORT_INIT;
    report.regime = static_cast<int32_t>(step.regime);
    report.time = step.time;
    report.flow_substeps = step.flow_substeps;
    report.flow_failures = step.flow_failures;
    report.flow_iterations = step.flow_iterations;
    report.coupling_steps = step.coupling_steps;
    report.coupling_iterations = step.coupling_iterations;
    report.motion_iterations = step.motion_iterations;
    report.rain_substitutions = engine.rain_substitutions;
    report.water_rain = step.water.rain;
    report.water_infiltrated = step.water.infiltrated;
    report.water_run_off = step.water.run_off;
    report.water_seepage = step.water.seepage;
    report.water_inflow = step.water.inflow;
    report.water_drained = step.water.drained;
    report.water_stored = step.water.stored;
    report.water_initial = step.water.initial;
    report.water_residual = step.water.residual;
    report.largest_displacement = step.largest_displacement;
    report.largest_velocity = step.largest_velocity;
    report.least_factor_of_safety = step.least_factor_of_safety;
    report.seconds_flow = step.seconds_flow;
    report.seconds_motion = step.seconds_motion;
    report.seconds_total = step.seconds_total;
    report.motion_substeps = step.motion.substeps;
    report.kinetic_energy = step.motion.kinetic_energy;
    report.elastic_energy = step.motion.elastic_energy;
    report.potential_energy = step.motion.potential_energy;
    report.dissipated_energy = step.motion.dissipated_energy;
    report.peak_velocity = step.motion.peak_velocity;
    report.sliding_volume = step.motion.sliding_volume;
    report.front_x = step.motion.front_x;
    report.run_out = step.motion.run_out;
    return report;
}

/// A step by `advance(StepReport&)`. The host's struct is checked first: a step that was done must be reported.
template <class Advance>
talus_status step(talus_engine& engine, talus_step_report* report, Advance advance) {
    if (report != nullptr) {
        static_cast<void>(struct_size(report, "TALUS_STEP_REPORT_INIT"));
    }
    StepReport done;
    const Status status = advance(done);
    if (report != nullptr && status != Status::cancelled) {
        write_struct(report_of(engine, done), report, "TALUS_STEP_REPORT_INIT");
    }
    if (status == Status::cancelled) {
        engine.message.set("cancelled: the step was undone");
        thread_message().set(engine.message.text());
    }
    return static_cast<talus_status>(status);
}

}  // namespace
}  // namespace talus::capi

using namespace talus;
using namespace talus::capi;

talus_status talus_engine_create(talus_scene* scene, const talus_options* options, talus_engine** out) {
    std::fenv_t host;
    Message* message = nullptr;
    return guarded(host, message, [&] {
        require(out, "out");
        *out = nullptr;
        require_scene(scene);
        auto engine = std::make_unique<talus_engine>();
        engine->host = &host;
        engine->options = checked(options);
        engine->run = std::make_unique<Engine>(scene->scene, options_of(*engine));
        engine->magic = engine_magic;
        *out = engine.release();
        return talus_status{TALUS_OK};
    });
}

void talus_engine_destroy(talus_engine* engine) {
    if (engine == nullptr) {
        return;
    }
    guarded([&] {
        require_engine(engine);
        {
            const Busy busy(*engine);
            engine->magic = 0;
        }
        delete engine;
        return talus_status{TALUS_OK};
    });
}

talus_status talus_engine_zone(talus_engine* engine, const char* name, int32_t* zone) {
    return on_engine(engine, [&](talus_engine& self) {
        require(name, "name");
        require(zone, "zone");
        *zone = self.run->zone(name);
        return talus_status{TALUS_OK};
    });
}

talus_status talus_engine_push_rain(talus_engine* engine, int32_t zone, int64_t count, const double* time,
                                    const double* rate) {
    return on_engine(engine, [&](talus_engine& self) {
        require_count(count, "count", 1);
        require(time, "time");
        require(rate, "rate");
        return push_clean(self, zone, values(rate, count), [&](const std::vector<double>& clean) {
            self.run->push_rain(zone, values(time, count), clean);
        });
    });
}

talus_status talus_engine_set_rain(talus_engine* engine, int32_t zone, double rate) {
    return on_engine(engine, [&](talus_engine& self) {
        return push_clean(self, zone, values(&rate, 1),
                          [&](const std::vector<double>& clean) { self.run->set_rain(zone, clean.front()); });
    });
}

talus_status talus_engine_boundary(talus_engine* engine, const char* name, int32_t* boundary) {
    return on_engine(engine, [&](talus_engine& self) {
        require(name, "name");
        require(boundary, "boundary");
        *boundary = self.run->boundary(name);
        return talus_status{TALUS_OK};
    });
}

talus_status talus_engine_push_flow_value(talus_engine* engine, int32_t boundary, int64_t count, const double* time,
                                          const double* value) {
    return on_engine(engine, [&](talus_engine& self) {
        require_count(count, "count", 1);
        require(time, "time");
        require(value, "value");
        self.run->push_flow_value(boundary, values(time, count), values(value, count));
        return talus_status{TALUS_OK};
    });
}

talus_status talus_engine_push_motion_value(talus_engine* engine, int32_t boundary, int32_t component, int64_t count,
                                            const double* time, const double* value) {
    return on_engine(engine, [&](talus_engine& self) {
        require_count(count, "count", 1);
        require(time, "time");
        require(value, "value");
        self.run->push_motion_value(boundary, component, values(time, count), values(value, count));
        return talus_status{TALUS_OK};
    });
}

talus_status talus_engine_step(talus_engine* engine, double dt, talus_step_report* report) {
    return on_engine(engine, [&](talus_engine& self) {
        return step(self, report, [&](StepReport& done) { return self.run->step(dt, done); });
    });
}

talus_status talus_engine_advance_to(talus_engine* engine, double time, talus_step_report* report) {
    return on_engine(engine, [&](talus_engine& self) {
        return step(self, report, [&](StepReport& done) { return self.run->advance_to(time, done); });
    });
}

talus_status talus_engine_report(talus_engine* engine, talus_step_report* report) {
    return on_engine(engine, [&](talus_engine& self) {
        require(report, "report");
        write_struct(report_of(self, self.run->last_report()), report, "TALUS_STEP_REPORT_INIT");
        return talus_status{TALUS_OK};
    });
}

// These need no guard: one access each, no arithmetic, no text, no exception. Any thread, or a signal handler, may cancel.

void talus_engine_cancel(talus_engine* engine) {
    if (is_engine(engine)) {
        engine->run->cancel();
    }
}

double talus_engine_time(talus_engine* engine) {
    return is_engine(engine) ? engine->run->time() : std::numeric_limits<double>::quiet_NaN();
}

int64_t talus_engine_epoch(talus_engine* engine) { return is_engine(engine) ? engine->run->epoch() : -1; }
