#include "flow/mean_permeability.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace talus {
namespace {

constexpr double least_share =
    0.5;  // of the diffusion that stays in the slope by the lower pressure: see docs/theory.md

// 0 where it is drier than the chord, 1 on it, 2 where it is wet: the curves have a kink between two of them.
int piece(const HydraulicTable& table, double pressure) {
    return pressure > 0 ? 2 : pressure >= -table.chord() ? 1 : 0;
}

// Over the pressures. Where k_r hardly changes, the difference of the potentials has lost its digits and Hermite's rule, of fourth order, has not.
MeanPermeability integral_mean(const HydraulicTable& table, const LinkEnd& a, const LinkEnd& b) {
    const double step = b.pressure - a.pressure;
    const double hardly = 0.01 * a.state.permeability;
    if (piece(table, a.pressure) == piece(table, b.pressure) &&
        std::abs(b.state.permeability - a.state.permeability) <= hardly &&
        std::abs(step * a.state.permeability_slope) <= hardly &&
        std::abs(step * b.state.permeability_slope) <= hardly) {
        constexpr double apart = 1e-6;  // of the pressures: closer ones have lost the digits of their secant
        const double slope = std::abs(step) > apart * std::abs(a.pressure)
                                 ? (b.state.permeability - a.state.permeability) / step
                                 : 0.5 * (a.state.permeability_slope + b.state.permeability_slope);
        const double bend = (b.state.permeability_slope - a.state.permeability_slope) / 12.0;
        const double mean = 0.5 * (a.state.permeability + b.state.permeability) - bend * step;
        return {mean, 0.5 * slope - bend, 0.5 * slope + bend};
    }
    const auto [drier, wetter] = std::minmax(a.state.permeability, b.state.permeability);
    const double mean = (b.state.potential - a.state.potential) / step;
    // So dry that the difference has no digits left.
    if (mean <= drier || mean >= wetter) {
        const bool is_a = (mean <= drier) == (a.state.permeability <= b.state.permeability);
        return is_a ? MeanPermeability{a.state.permeability, a.state.permeability_slope, 0.0}
                    : MeanPermeability{b.state.permeability, 0.0, b.state.permeability_slope};
    }
    return {mean, (mean - a.state.permeability) / step, (b.state.permeability - mean) / step};
}

// The largest k_r' / k_r between two pressures: d(ln k_r)/d(ln s) grows with the suction in all curves, and the chord is steepest at its dry end.
double steepest(const HydraulicTable& table, const LinkEnd& drier, const LinkEnd& wetter) {
    const double chord = table.chord();
    const double power =
        std::max(-drier.pressure, chord) * drier.state.permeability_slope;  // d(ln k_r)/d(ln s), times k_r
    double steepness =
        drier.pressure < 0 ? power / (drier.state.permeability * std::max(-wetter.pressure, chord)) : 0.0;
    if (wetter.pressure > -chord) {
        const HydraulicState end = table.at(-chord);
        steepness = std::max(steepness, end.permeability_slope / std::max(end.permeability, drier.state.permeability));
    }
    return steepness;
}

// Cheap and certain: k_r is nowhere between the ends so steep that the flow could turn.
bool is_surely_monotone(const HydraulicTable& table, const LinkEnd& upper, const LinkEnd& lower, double fall) {
    if (upper.state.permeability == lower.state.permeability) return true;
    if (upper.pressure < lower.pressure) return fall * steepest(table, upper, lower) <= 2.0;
    return 0.5 * fall * steepest(table, lower, upper) * upper.state.permeability <=
           (1.0 - least_share) * lower.state.permeability;
}

// The flow from one upper pressure as a function of the lower one.
class Downflow {
public:
    Downflow(const HydraulicTable& table, const LinkEnd& upper, double fall, double share)
        : table_(table), upper_(upper), fall_(fall), share_(share) {}

    [[nodiscard]] LinkEnd at(double pressure) const { return {pressure, table_.at(pressure)}; }
    [[nodiscard]] double flow(const LinkEnd& lower) const {
        return integral_mean(table_, upper_, lower).value * head(lower) + share_ * lower.state.potential;
    }
    /// By the upper pressure.
    [[nodiscard]] double slope(const LinkEnd& lower) const {
        const MeanPermeability mean = integral_mean(table_, upper_, lower);
        return mean.value + head(lower) * mean.slope_upper;
    }
    /// How much it falls as the lower pressure rises.
    [[nodiscard]] double descent(const LinkEnd& lower) const {
        const MeanPermeability mean = integral_mean(table_, upper_, lower);
        return mean.value - head(lower) * mean.slope_lower - share_ * lower.state.permeability;
    }

private:
    [[nodiscard]] double head(const LinkEnd& lower) const { return upper_.pressure + fall_ - lower.pressure; }

    const HydraulicTable& table_;
    const LinkEnd& upper_;
    double fall_, share_;
};

struct Sample {
    LinkEnd lower;
    double descent;
};

// Where the flow turns between two places, falling at the first and rising at the second: by false position, and halved where that leaves more
// than half. What the flow there misses of the extreme one is at most its slope times what is left.
LinkEnd turning_end(const Downflow& downflow, Sample falling, Sample rising) {
    constexpr int most_cuts = 80;
    constexpr double enough = 1e-14;  // of the flow
    double was_apart = std::numeric_limits<double>::infinity();
    LinkEnd end{};
    for (int cut = 0; cut < most_cuts; ++cut) {
        const double apart = rising.lower.pressure - falling.lower.pressure;
        const double share =
            std::abs(apart) > 0.5 * was_apart ? 0.5 : falling.descent / (falling.descent - rising.descent);
        was_apart = std::abs(apart);
        const double pressure = falling.lower.pressure + share * apart;
        end = downflow.at(pressure);
        const double descent = downflow.descent(end);
        if (std::abs(descent * apart) <= enough * std::abs(downflow.flow(end))) break;
        (descent >= 0 ? falling : rising) = {end, descent};
    }
    return end;
}

}  // namespace

MeanPermeability mean_permeability(const HydraulicTable& table, const LinkEnd& upper, const LinkEnd& lower,
                                   double fall) {
    const double rise = lower.pressure - upper.pressure;
    const MeanPermeability central = integral_mean(table, upper, lower);
    const double head = fall - rise;
    if (head <= 0 || is_surely_monotone(table, upper, lower, fall)) return central;

    // Evenly apart in ln(suction), where the curves are straightest, and on the chord, with its ends.
    constexpr int intervals = 8;
    constexpr int chord_intervals = 4;
    std::array<LinkEnd, intervals + chord_intervals + 2> place{};
    size_t places = 0;
    const auto [driest, wettest] = std::minmax(upper.pressure, lower.pressure);
    const auto add = [&, least = driest, most = wettest](double pressure, double row) {
        if (least < pressure && pressure < most) place[places++] = {pressure, table.at(pressure, row)};
    };
    const double chord = table.chord();
    place[places++] = upper;
    if (rise < 0)
        for (int i = 0; i <= chord_intervals; ++i) add(-chord * i / chord_intervals, 0.0);
    const double rows_apart = (lower.state.row - upper.state.row) / intervals;
    const double ratio = std::exp(rows_apart * table_spacing);
    double pressure = std::min(upper.pressure, -chord);
    for (int i = 1; i < intervals; ++i) {
        pressure *= ratio;
        add(pressure, upper.state.row + i * rows_apart);
    }
    if (rise > 0) {
        // From drier soil the flow is a rational function on the chord, which turns about its inflection if it does.
        add(-chord, 0.0);
        const double slope = table.at(-chord).permeability_slope;
        const double offset = upper.pressure * (1.0 + 0.5 * slope * upper.pressure) - upper.state.potential;
        const double inflection = upper.pressure + std::cbrt(2.0 * offset * fall / slope);
        if (upper.pressure < -chord && inflection > -chord && inflection < 0) add(inflection, 0.0);
        add(0.0, 0.0);
    }
    place[places++] = lower;

    const double share = rise < 0 ? least_share : 0.0;
    const Downflow downflow(table, upper, fall, share);
    const double sign = rise < 0 ? 1.0 : -1.0;  // drier below: the largest flow; wetter below: the least
    // Candidates are the upper end, turns on the way and the lower end.
    double flow =
        fall * upper.state.permeability + share * upper.state.potential;  // what falls from the upper end alone
    double slope_upper = fall * upper.state.permeability_slope + share * upper.state.permeability;
    Sample before{upper, downflow.descent(upper)};
    for (size_t i = 1; i < places; ++i) {
        const Sample here{place[i], downflow.descent(place[i])};
        if (before.descent >= 0 && here.descent < 0) {
            const LinkEnd turn = turning_end(downflow, before, here);
            const double turn_flow = downflow.flow(turn);
            if (sign * turn_flow > sign * flow) {
                flow = turn_flow;
                slope_upper = downflow.slope(turn);
            }
        }
        before = here;
    }
    if (before.descent >= 0 && sign * downflow.flow(lower) >= sign * flow) return central;
    const double value = (flow - share * lower.state.potential) / head;
    return {value, (slope_upper - value) / head, (value - share * lower.state.permeability) / head};
}

}  // namespace talus
