#include "coupling/forcing.hpp"

#include "flow/boundaries.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talus {
namespace {

void replace_from(std::vector<double>& time, std::vector<double>& value, std::span<const double> new_time,
                  std::span<const double> new_value) {
    const auto kept = std::lower_bound(time.begin(), time.end(), new_time.front()) - time.begin();
    time.resize(static_cast<size_t>(kept));
    value.resize(static_cast<size_t>(kept));
    time.insert(time.end(), new_time.begin(), new_time.end());
    value.insert(value.end(), new_value.begin(), new_value.end());
}

double first_after(const std::vector<double>& times, double time, double until) {
    const auto found = std::upper_bound(times.begin(), times.end(), time);
    return found == times.end() ? until : std::min(*found, until);
}

}  // namespace

Forcing::Forcing(const Scene& scene) {
    for (const RainZone& zone : scene.surface.zones)
        rain_.push_back({zone.time, zone.rate,
                         std::isnan(zone.rain_end) ? std::numeric_limits<double>::infinity() : zone.rain_end});
    for (const Boundary& boundary : scene.boundaries) {
        flow_.push_back(boundary.flow_value);
        motion_.push_back({boundary.motion_x, boundary.motion_y});
    }
}

void Forcing::push_rain(size_t zone, std::span<const double> time, std::span<const double> rate) {
    replace_from(rain_[zone].time, rain_[zone].rate, time, rate);
    rain_[zone].end = std::numeric_limits<double>::infinity();
}

void Forcing::push_flow_value(size_t boundary, std::span<const double> time, std::span<const double> value) {
    replace_from(flow_[boundary].time, flow_[boundary].value, time, value);
}

void Forcing::push_motion_value(size_t boundary, size_t component, std::span<const double> time,
                                std::span<const double> value) {
    replace_from(motion_[boundary][component].time, motion_[boundary][component].value, time, value);
}

double Forcing::rain(size_t zone, double time) const {
    const std::vector<double>& times = rain_[zone].time;
    const auto after = std::upper_bound(times.begin(), times.end(), time);
    return after == times.begin() ? 0.0 : rain_[zone].rate[static_cast<size_t>(after - times.begin()) - 1];
}

double Forcing::flow_value(size_t boundary, double time) const { return value_at(flow_[boundary], time); }

double Forcing::motion_value(size_t boundary, size_t component, double time) const {
    return value_at(motion_[boundary][component], time);
}

double Forcing::next_break(double time, double until) const {
    double next = until;
    for (const Rain& rain : rain_) next = first_after(rain.time, time, next);
    for (const Series& series : flow_) next = first_after(series.time, time, next);
    for (const auto& components : motion_)
        for (const Series& series : components) next = first_after(series.time, time, next);
    return next;
}

double Forcing::rain_end() const {
    double end = std::numeric_limits<double>::infinity();
    for (const Rain& rain : rain_) end = std::min(end, rain.end);
    return end;
}

}  // namespace talus
