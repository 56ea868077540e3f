// Pressure and relative permeability of one soil as functions of its saturation: what explicit motion reads, whose points hold water and
// not pressure. The inverse of HydraulicTable, its chord near saturation included.
//
// Rows are uniform in ln(S_e / (1 - S_e)), which resolves both ends of the curve.
#pragma once

#include "materials/hydraulic/hydraulic_table.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

namespace talus {

class SaturationTable {
public:
    /// Near saturation some soils hold their water more stiffly than water is. Where the curve is stiffer than the bulk modulus (Pa), from
    /// saturation on, it is its chord: it is the water that gives way there.
    SaturationTable(const Hydraulics& hydraulics, double bulk_modulus);

    struct State {
        double pressure;      ///< Pa, below or at zero
        double permeability;  ///< k_r, -
    };

    /// What pores that also hold moving gas need.
    struct MixedState {
        double suction;            ///< Pa
        double permeability;       ///< k_rl, -
        double gas_permeability;   ///< k_rg, -
        double mean_permeability;  ///< k_rl's mean over the suctions from this one to none, -
    };
    /// Of an effective saturation whose logit, ln(odds()), is known: logarithms of many at once are faster.
    [[nodiscard]] MixedState mixed_at(double effective, double logit) const;
    /// The suction's by the saturation, Pa; above the maximum none.
    [[nodiscard]] double suction_slope(double effective, double logit) const;
    [[nodiscard]] static double odds(double effective) { return effective / (1 - effective); }

    /// Of a saturation (-). At the maximum one and above: no suction; at the residual one and below: the dry end of the table.
    [[nodiscard]] State at(double saturation) const;

    /// Slope of the pressure with the saturation, Pa, below the maximum one.
    [[nodiscard]] double stiffness(double saturation) const;

    [[nodiscard]] double effective(double saturation) const { return (saturation - residual_) * per_range_; }
    [[nodiscard]] double maximum() const { return maximum_; }

private:
    /// A cubic from each row to the next, c0 + t (c1 + t (c2 + t c3)), of suction, k_rl, k_rg and mean k_rl side by side.
    struct Row {
        Eigen::Array4d c0, c1, c2, c3;
        [[nodiscard]] Eigen::Array4d at(double t) const { return c0 + t * (c1 + t * (c2 + t * c3)); }
    };
    struct Place {
        size_t row;
        double t;  // from it to the next
    };
    [[nodiscard]] static Place place_of(double logit);
    double residual_, maximum_, per_range_;
    double chord_pressure_, chord_permeability_, chord_effective_;  // where the chord begins
    double chord_gas_permeability_;
    std::vector<Row> rows_;
};

namespace saturation_rows {
inline constexpr double lowest = -25, spacing = 0.02;  // of ln(S_e / (1 - S_e)): S_e from 1e-11 to 1 - 1e-11
inline constexpr double least = 1e-11;
inline constexpr int count = 2501;
}  // namespace saturation_rows

inline SaturationTable::State SaturationTable::at(double saturation) const {
    const double effective = this->effective(saturation);
    if (effective >= chord_effective_) {
        const double share = std::max(1 - effective, 0.0) / (1 - chord_effective_);
        return {share * chord_pressure_, 1 - share * (1 - chord_permeability_)};
    }
    const auto [row, t] = place_of(effective > 0 ? std::log(odds(effective)) : saturation_rows::lowest);
    const Eigen::Array4d found = rows_[row].at(t);
    return {-found[0], found[1]};
}

inline SaturationTable::Place SaturationTable::place_of(double logit) {
    const double place =
        std::max(0.0, (logit - saturation_rows::lowest) * (1 / saturation_rows::spacing));  // 0 for NaN
    const auto row = static_cast<size_t>(std::min(place, saturation_rows::count - 2.0));
    return {row, place - static_cast<double>(row)};
}

inline SaturationTable::MixedState SaturationTable::mixed_at(double effective, double logit) const {
    if (effective >= 1) return {0, 1, 0, 1};
    if (effective >= chord_effective_) {
        const double share = (1 - effective) / (1 - chord_effective_);
        const double lost = share * (1 - chord_permeability_);
        return {-share * chord_pressure_, 1 - lost, share * chord_gas_permeability_, 1 - 0.5 * lost};
    }
    const auto [row, t] = place_of(logit);
    const Eigen::Array4d found = rows_[row].at(t);
    return {found[0], found[1], found[2], found[3]};
}

inline double SaturationTable::suction_slope(double effective, double logit) const {
    if (effective >= 1) return 0;
    if (effective >= chord_effective_) return chord_pressure_ / ((1 - chord_effective_) * (maximum_ - residual_));
    const auto [row, t] = place_of(logit);
    const Row& cubic = rows_[row];
    const double by_row = saturation_rows::spacing * effective * (1 - effective) * (maximum_ - residual_);
    return by_row > 0 ? (cubic.c1[0] + t * (2 * cubic.c2[0] + 3 * t * cubic.c3[0])) / by_row : 0;
}

}  // namespace talus
