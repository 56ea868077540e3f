// How far a run is: a bar on a terminal, a line every tenth elsewhere.
#pragma once

#include <talus/talus.h>
#include <chrono>
#include <string>

namespace runner {

class Progress {
public:
    explicit Progress(double duration);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// The step that begins: from `time` on to `next`, s.
    void begin_step(double time, double next);
    /// Within a step: the fraction of it that is done.
    void show_fraction(double fraction);
    /// A step that is done.
    void end_step(const talus_step_report& report);
    /// A line of its own above the bar.
    void say(const std::string& line);

    [[nodiscard]] double wall_seconds() const;

private:
    void show(double time);
    [[nodiscard]] std::string state(double time) const;

    using Clock = std::chrono::steady_clock;
    double duration_;
    double begin_ = 0;
    double end_ = 0;
    std::string water_;
    Clock::time_point started_ = Clock::now();
    Clock::time_point shown_{};
    int tenth_ = 0;
    bool terminal_;
    bool drawn_ = false;
};

/// "90 s", "12.5 min", "36 h", "14 d".
[[nodiscard]] std::string duration_text(double seconds);

/// printf's formats in a string.
[[nodiscard]] std::string formatted(const char* format, ...) __attribute__((format(printf, 1, 2)));

}  // namespace runner
