#include "runner/progress.hpp"

#include <unistd.h>
#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace runner {

std::string formatted(const char* format, ...) {
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return text;
}

std::string duration_text(double seconds) {
    if (seconds < 120) return formatted("%.3g s", seconds);
    if (seconds < 7200) return formatted("%.3g min", seconds / 60);
    if (seconds < 48 * 3600) return formatted("%.3g h", seconds / 3600);
    return formatted("%.3g d", seconds / 86400);
}

Progress::Progress(double duration) : duration_(duration), terminal_(isatty(fileno(stderr)) != 0) {}

Progress::~Progress() {
    if (drawn_) std::fputc('\n', stderr);
}

double Progress::wall_seconds() const { return std::chrono::duration<double>(Clock::now() - started_).count(); }

void Progress::begin_step(double time, double next) {
    begin_ = time;
    end_ = next;
}

void Progress::show_fraction(double fraction) {
    constexpr auto interval = std::chrono::milliseconds(100);
    if (terminal_ && Clock::now() - shown_ > interval) show(begin_ + fraction * (end_ - begin_));
}

void Progress::end_step(const talus_step_report& report) {
    const double rain = report.water_rain;
    const double missed = std::abs(report.water_residual);
    water_ = report.regime == TALUS_DYNAMIC ? formatted("fastest %.3g m/s", report.largest_velocity)
             : rain > 0                     ? formatted("water balance %.1e of the rain", missed / rain)
                                            : formatted("water balance %.1e m3/m", missed);
    const int tenth = static_cast<int>(10 * report.time / duration_);
    const bool due = Clock::now() - shown_ > std::chrono::milliseconds(100) || report.time >= duration_;
    if (terminal_ ? due : tenth > tenth_) show(report.time);
    tenth_ = std::max(tenth, tenth_);
}

void Progress::say(const std::string& line) {
    std::fprintf(stderr, "%s%s\n", drawn_ ? "\r\033[K" : "", line.c_str());
    drawn_ = false;
}

std::string Progress::state(double time) const {
    const double wall = wall_seconds();
    return formatted("%3.0f %%  %s of %s  %.3g x real time  %s", 100 * time / duration_, duration_text(time).c_str(),
                     duration_text(duration_).c_str(), time / std::max(wall, 1e-9), water_.c_str());
}

void Progress::show(double time) {
    shown_ = Clock::now();
    if (!terminal_) {
        std::fprintf(stderr, "%s\n", state(time).c_str());
        return;
    }
    constexpr int width = 24;
    const int full = std::clamp(static_cast<int>(width * time / duration_), 0, width);
    const std::string bar =
        std::string(static_cast<size_t>(full), '#') + std::string(static_cast<size_t>(width - full), '.');
    std::fprintf(stderr, "\r\033[K[%s] %s", bar.c_str(), state(time).c_str());
    std::fflush(stderr);
    drawn_ = true;
}

}  // namespace runner
