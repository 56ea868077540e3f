// What the host pushes in: rain, and values of the boundaries in time.
#pragma once

#include "scene/scene.hpp"

#include <array>
#include <span>
#include <vector>

namespace talus {

class Forcing {
public:
    explicit Forcing(const Scene& scene);

    /// Replaces what is known from time[0] on. The rain is known for good afterwards unless `end` (s) says until when.
    void push_rain(size_t zone, std::span<const double> time, std::span<const double> rate);
    void push_flow_value(size_t boundary, std::span<const double> time, std::span<const double> value);
    void push_motion_value(size_t boundary, size_t component, std::span<const double> time,
                           std::span<const double> value);

    [[nodiscard]] double rain(size_t zone, double time) const;  ///< m/s, from `time` on until the next break
    [[nodiscard]] double flow_value(size_t boundary, double time) const;
    [[nodiscard]] bool has_motion_value(size_t boundary, size_t component) const {
        return !motion_[boundary][component].time.empty();
    }
    [[nodiscard]] double motion_value(size_t boundary, size_t component, double time) const;

    /// The first time after `time`, and not after `until`, at which a rate or a slope changes; `until` when there is none.
    [[nodiscard]] double next_break(double time, double until) const;
    /// When the first rain series ends, s; infinite when none does.
    [[nodiscard]] double rain_end() const;

private:
    struct Rain {
        std::vector<double> time;
        std::vector<double> rate;
        double end;
    };
    std::vector<Rain> rain_;
    std::vector<Series> flow_;
    std::vector<std::array<Series, 2>> motion_;
};

}  // namespace talus
