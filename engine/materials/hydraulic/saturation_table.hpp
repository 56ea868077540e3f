// Pressure and relative permeability of one soil as functions of its saturation: what explicit motion reads, whose points hold water and
// not pressure. The inverse of HydraulicTable, its chord near saturation included.
//
// Rows are uniform in ln(S_e / (1 - S_e)), which resolves both ends of the curve.
#pragma once

#include "materials/hydraulic/hydraulic_table.hpp"

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

    /// Of a saturation (-). At the maximum one and above: no suction; at the residual one and below: the dry end of the table.
    [[nodiscard]] State at(double saturation) const;

    /// Slope of the pressure with the saturation, Pa, below the maximum one.
    [[nodiscard]] double stiffness(double saturation) const;

    [[nodiscard]] double effective(double saturation) const {
        return (saturation - residual_) / (maximum_ - residual_);
    }
    [[nodiscard]] double maximum() const { return maximum_; }

private:
    struct Row {
        double pressure, pressure_slope, permeability, permeability_slope;  // slopes per row
    };

    struct Place {  // in the rows
        size_t row;
        double share;
    };
    [[nodiscard]] static Place place_of(double effective);

    double residual_, maximum_;
    double chord_pressure_, chord_permeability_, chord_effective_;  // where the chord begins
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
    const auto [row, t] = place_of(effective);
    const Row &a = rows_[row], &b = rows_[row + 1];
    return {hermite(a.pressure, b.pressure, a.pressure_slope, b.pressure_slope, t).value,
            hermite(a.permeability, b.permeability, a.permeability_slope, b.permeability_slope, t).value};
}

inline SaturationTable::Place SaturationTable::place_of(double effective) {
    const double logit = effective > 0 ? std::log(effective / (1 - effective)) : saturation_rows::lowest;
    const double place = std::max((logit - saturation_rows::lowest) / saturation_rows::spacing, 0.0);
    const auto row = static_cast<size_t>(std::min(place, saturation_rows::count - 2.0));
    return {row, place - static_cast<double>(row)};
}

}  // namespace talus
