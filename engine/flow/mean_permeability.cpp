#include "flow/mean_permeability.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace talus {
namespace {
constexpr double least_share = 0.5;

// Of the pressures. Where k_r hardly changes, the difference of the potentials has lost its digits and Hermite's rule, of fourth order, has not.
MeanPermeability integral_mean(const LinkEnd& a, const LinkEnd& b) {
    const double step = b.pressure - a.pressure;
    const double hardly = 0.01 * a.state.permeability;
    if (std::abs(b.state.permeability - a.state.permeability) <= hardly && std::abs(step * a.state.permeability_slope) <= hardly &&
        std::abs(step * b.state.permeability_slope) <= hardly) {
        const double mean = 0.5 * (a.state.permeability + b.state.permeability) -
                            (b.state.permeability_slope - a.state.permeability_slope) * step / 12.0;
        return {mean, 0.5 * a.state.permeability_slope, 0.5 * b.state.permeability_slope};
    }
    const double mean = (b.state.potential - a.state.potential) / step;
    return {mean, (mean - a.state.permeability) / step, (b.state.permeability - mean) / step};
}

// Cheap and certain: k_r nearly the same at both ends, not steep there, and what flows on the side of what falls that it must lie on.
bool is_surely_monotone(const LinkEnd& upper, const LinkEnd& lower, double fall, double flow) {
    constexpr double largest_ratio = 2.0;
    constexpr double largest_peclet = 1.0;
    const auto is_gentle = [&](const HydraulicState& end) { return fall * end.permeability_slope <= largest_peclet * end.permeability; };
    const auto [less, more] = std::minmax(upper.state.permeability, lower.state.permeability);
    const double excess = flow - fall * upper.state.permeability;
    return more <= largest_ratio * less && is_gentle(upper.state) && is_gentle(lower.state) &&
           (lower.pressure < upper.pressure ? excess >= 0 : excess <= 0);
}

// The flow from one upper pressure as a function of the lower one.
class Downflow {
public:
    Downflow(const HydraulicTable& table, const LinkEnd& upper, double fall, double share) : table_(table), upper_(upper), fall_(fall), share_(share) {}

    [[nodiscard]] LinkEnd at(double pressure) const { return {pressure, table_.at(pressure)}; }
    [[nodiscard]] double flow(const LinkEnd& lower) const { return integral_mean(upper_, lower).value * head(lower) + share_ * lower.state.potential; }
    /// By the upper pressure.
    [[nodiscard]] double slope(const LinkEnd& lower) const {
        const MeanPermeability mean = integral_mean(upper_, lower);
        return mean.value + head(lower) * mean.slope_upper;
    }
    /// Whether the flow falls as the lower pressure rises.
    [[nodiscard]] bool is_monotone(const LinkEnd& lower) const {
        const MeanPermeability mean = integral_mean(upper_, lower);
        return mean.value >= head(lower) * mean.slope_lower + share_ * lower.state.permeability;
    }
    [[nodiscard]] double head(const LinkEnd& lower) const { return upper_.pressure + fall_ - lower.pressure; }

private:
    const HydraulicTable& table_;
    const LinkEnd& upper_;
    double fall_, share_;
};

// The lower pressure of the extreme flow, between two places on whose first the flow is monotone and on whose second it is not.
double turning_pressure(const Downflow& downflow, double monotone, double turned) {
    constexpr int halvings = 40;
    for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (monotone + turned);
        (downflow.is_monotone(downflow.at(middle)) ? monotone : turned) = middle;
    }
    return 0.5 * (monotone + turned);
}

}  // namespace

MeanPermeability mean_permeability(const HydraulicTable& table, const LinkEnd& upper, const LinkEnd& lower, double fall) {
    const double rise = lower.pressure - upper.pressure;
    const MeanPermeability central = integral_mean(upper, lower);
    const double head = fall - rise;
    if (head <= 0 || is_surely_monotone(upper, lower, fall, central.value * head)) return central;

    // Places from the upper pressure to the lower one, evenly apart in ln(suction), where the curves are straightest.
    constexpr size_t places = 9;
    std::array<double, places> place{};
    const double from = std::log(std::max(-upper.pressure, table.chord()));
    const double to = std::log(std::max(-lower.pressure, table.chord()));
    const auto [driest, wettest] = std::minmax(upper.pressure, lower.pressure);
    for (size_t i = 0; i < places; ++i) {
        const double share = static_cast<double>(i) / static_cast<double>(places - 1);
        place[i] = std::clamp(-std::exp(from + (to - from) * share), driest, wettest);
    }
    place.front() = upper.pressure;
    place.back() = lower.pressure;

    const double share = rise < 0 ? least_share : 0.0;
    const Downflow downflow(table, upper, fall, share);
    const double sign = rise < 0 ? 1.0 : -1.0;  // drier below: the largest flow; wetter below: the least
    size_t extreme = places - 1;
    double extreme_flow = sign * downflow.flow(lower);
    for (size_t i = 0; i + 1 < places; ++i) {
        const double flow = sign * downflow.flow(downflow.at(place[i]));
        if (flow <= extreme_flow) continue;
        extreme = i;
        extreme_flow = flow;
    }
    if (extreme == places - 1 && downflow.is_monotone(lower)) return central;
    double flow, slope_upper;
    if (extreme == 0) {  // what falls from the upper end alone
        flow = fall * upper.state.permeability + share * upper.state.potential;
        slope_upper = fall * upper.state.permeability_slope + share * upper.state.permeability;
    } else {
        const size_t after = std::min(extreme + 1, places - 1);
        const LinkEnd turning = downflow.at(turning_pressure(downflow, place[extreme - 1], place[after]));
        flow = downflow.flow(turning);
        slope_upper = downflow.slope(turning);
    }
    const double value = (flow - share * lower.state.potential) / head;
    return {value, (slope_upper - value) / head, (value - share * lower.state.permeability) / head};
}

}  // namespace talus
