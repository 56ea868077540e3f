#include "runner/run.hpp"

#include "runner/atomic_file.hpp"
#include "runner/host.hpp"
#include "runner/progress.hpp"
#include "runner/records.hpp"
#include "runner/table.hpp"
#include "runner/vtu.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <utility>
#include <vector>

namespace runner {
namespace {

// --- Ctrl-C ----------------------------------------------------------------------------------------------------------

std::atomic<talus_engine*> running = nullptr;

/// Cancels the step that runs, which is undone; a second Ctrl-C ends the program as usual.
extern "C" void cancel_running(int signal) {
    talus_engine_cancel(running);
    std::signal(signal, SIG_DFL);
}

class Interruptible {
public:
    explicit Interruptible(const Engine& engine) {
        running = engine.get();
        std::signal(SIGINT, cancel_running);
    }
    ~Interruptible() {
        std::signal(SIGINT, SIG_DFL);
        running = nullptr;
    }
    Interruptible(const Interruptible&) = delete;
    Interruptible& operator=(const Interruptible&) = delete;
};

// --- schedule --------------------------------------------------------------------------------------------------------

struct Schedule {
    double duration = 0;          ///< s
    double step = 0;              ///< s
    double motion_step = 0;       ///< s, while ground of the regime auto moves; 0: as always
    std::vector<double> outputs;  ///< s
};

Schedule schedule_of(const Json& description, const RunSettings& settings) {
    const Json& given = description.at("schedule");
    if (given.at("duration").is_null()) {
        throw std::runtime_error(settings.scene + ": schedule.duration is missing, so there is nothing to follow");
    }
    Schedule schedule{given.at("duration"), 0, 0, given.at("outputs")};
    if (!settings.step && given.at("step").is_null()) {
        throw std::runtime_error(settings.scene + ": schedule.step is missing; give --step");
    }
    schedule.step = settings.step ? *settings.step : given.at("step").get<double>();
    if (!given.at("motion_step").is_null()) schedule.motion_step = given.at("motion_step");
    if (schedule.outputs.empty()) schedule.outputs = {0, schedule.duration};
    return schedule;
}

/// The next time to stop at: a multiple of the step, or a step of the motion from now on where the ground moves; an output; or the end. What is but
/// rounding away from an output is that output.
double next_stop(double time, const Schedule& schedule, bool moves) {
    const double slack = 1e-9 * (moves ? schedule.motion_step : schedule.step);
    double next = schedule.duration;
    for (const double output : schedule.outputs) {
        if (output > time + slack) next = std::min(next, output);
    }
    const double step_end =
        moves ? time + schedule.motion_step : (std::floor((time + slack) / schedule.step) + 1) * schedule.step;
    return step_end < next - slack ? step_end : next;
}

bool is_output(double time, const Schedule& schedule) {
    return std::find(schedule.outputs.begin(), schedule.outputs.end(), time) != schedule.outputs.end();
}

// --- run -------------------------------------------------------------------------------------------------------------

struct Run {
    Engine engine;
    Json description;
    Schedule schedule;
    FieldFiles fields;
    std::filesystem::path out;
    Json steps = Json::array();
    talus_step_report last = TALUS_STEP_REPORT_INIT;
    std::string status = "finished";
    std::string message{};
};

std::string now_text() {
    const std::time_t now = std::time(nullptr);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
    return text;
}

void write_probes(const Run& run) {
    const std::string csv = probes_csv(run.engine, run.description);
    if (!csv.empty()) write_file(run.out / "probes.csv", csv);
}

void advance(Run& run, Progress& progress) {
    if (is_output(0, run.schedule)) run.fields.write(run.engine);
    bool moves = false;
    for (double time = 0; time < run.schedule.duration; time = run.last.time) {
        const double next = next_stop(time, run.schedule, moves);
        progress.begin_step(time, next);
        const talus_status status = check(talus_engine_advance_to(run.engine.get(), next, &run.last));
        if (status == TALUS_CANCELLED) {
            run.status = "cancelled";
            run.message = talus_last_error();
            return;
        }
        run.steps.push_back(report_json(run.last));
        progress.end_step(run.last);
        const bool moved = std::exchange(moves, run.schedule.motion_step > 0 && run.last.regime == TALUS_DYNAMIC);
        if (moves || moved || is_output(run.last.time, run.schedule)) {
            run.fields.write(run.engine);
            write_probes(run);
        }
    }
}

void write_report(const Run& run, const RunSettings& settings, const std::string& started, double wall) {
    const Json report = {
        {"status", run.status},
        {"message", run.message},
        {"started", started},
        {"wall_seconds", wall},
        {"real_time_factor", wall > 0 ? run.last.time / wall : 0},
        {"scene_file", settings.scene},
        {"tolerance", settings.tolerance ? Json(*settings.tolerance) : Json(nullptr)},
        {"step", run.schedule.step},
        {"talus", Json::parse(talus_build_info())},
        {"engine", run.description},
        {"events", events_json(run.engine)},
        {"hash", hash_text(run.engine)},
        {"last", report_json(run.last)},
        {"steps", run.steps},
    };
    write_file(run.out / "report.json", report.dump(1) + "\n");
}

talus_options options_for(const RunSettings& settings, Progress*& progress) {
    talus_options options = TALUS_OPTIONS_INIT;
    options.stop_at_motion = 1;
    options.tolerance = settings.tolerance.value_or(0);
    options.threads = settings.threads;
    options.progress = [](void* user, double fraction) -> int32_t {
        if (Progress* shown = *static_cast<Progress**>(user)) shown->show_fraction(fraction);
        return 0;
    };
    options.progress_user = &progress;
    options.log = [](void* user, int32_t level, const char* text) {
        const std::string line = (level >= TALUS_LOG_WARNING ? "warning: " : "") + std::string(text);
        if (Progress* shown = *static_cast<Progress**>(user)) {
            shown->say(line);
        } else {
            std::fprintf(stderr, "%s\n", line.c_str());
        }
    };
    options.log_user = &progress;
    return options;
}

}  // namespace

int run(const RunSettings& settings) {
    Progress* shown = nullptr;  // the callbacks' way to the bar, which is there once the duration is known
    const std::string started = now_text();
    Engine engine = create_engine(load_scene(settings.scene), options_for(settings, shown));
    const Json description = describe(engine);
    const std::filesystem::path out = settings.out;
    std::filesystem::create_directories(out);
    Run run{std::move(engine), description, schedule_of(description, settings), FieldFiles(out), out};

    double wall = 0;
    {
        Progress progress(run.schedule.duration);
        shown = &progress;
        const Interruptible interruptible(run.engine);
        try {
            advance(run, progress);
        } catch (const Failure& failure) {
            run.status = talus_status_name(failure.status);
            run.message = failure.what();
        }
        wall = progress.wall_seconds();
        shown = nullptr;
    }
    write_probes(run);
    write_report(run, settings, started, wall);
    print_table(run.description, run.last, events_json(run.engine), wall);
    if (run.status == "finished") return 0;
    std::fprintf(stderr, "talus: %s\n", run.message.c_str());
    return run.status == "cancelled" ? 130 : 1;
}

}  // namespace runner
