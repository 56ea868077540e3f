// Saturation, relative permeability and Kirchhoff potential of one soil as functions of the pore pressure, tabulated once: the flow
// reads nothing else, so that a new curve costs no code and no time in its loops.
//
// Over suction the table is uniform in ln(s) and holds monotone cubics. The last 4e-4 of the suction scale before saturation (10 Pa for
// alpha = 0.04 1/kPa) are the chord of S and k_r: Mualem's k_r has an infinite slope at saturation where n < 2, and this chord moves the
// pressure by some 2 Pa at most (docs/theory.md).
#pragma once

#include "materials/hydraulic/monotone_cubic.hpp"
#include "materials/hydraulic/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace talus {

/// What the flow needs of a soil at one pressure.
struct HydraulicState {
    double saturation;          ///< S, -
    double capacity;            ///< dS/dp, 1/Pa
    double permeability;        ///< k_r, -
    double permeability_slope;  ///< dk_r/dp, 1/Pa
    double potential;           ///< Kirchhoff potential, integral of k_r dp from saturation, Pa
    double
        row;  ///< where the pressure lies among the table's rows, ln(suction / chord) over their spacing; 0 if wetter
};

class HydraulicTable {
public:
    explicit HydraulicTable(const Hydraulics& hydraulics);

    /// At saturation itself (p = 0) the slopes are the unsaturated ones.
    [[nodiscard]] HydraulicState at(double pressure) const;
    /// The same where it is known among the rows: saves the logarithm.
    [[nodiscard]] HydraulicState at(double pressure, double row) const;

    /// The pressure below 0 with this saturation, between residual and maximum saturation (both excluded), Pa.
    [[nodiscard]] double pressure_of_saturation(double saturation) const;

    /// The pressure with this Kirchhoff potential, Pa; the dry end of the table where no pressure has one so low.
    [[nodiscard]] double pressure_of_potential(double potential) const;
    /// The potential of soil without any water, Pa.
    [[nodiscard]] double least_potential() const { return rows_.back().potential; }

    /// Where the unknown turns from pressure (wetter) to saturation (drier): the steepest point of the retention, Pa.
    [[nodiscard]] double switch_pressure() const { return switch_pressure_; }
    [[nodiscard]] double residual_saturation() const { return residual_; }
    /// The suction below which the curves are chords, Pa.
    [[nodiscard]] double chord() const { return chord_; }

private:
    struct Row {  // at s_k = chord exp(k spacing): values, and slopes per row
        double saturation, saturation_slope;
        double permeability, permeability_slope;
        double potential, potential_slope;
    };

    void fill_curves(const Hydraulics& hydraulics);
    void fill_potential(const Hydraulics& hydraulics);
    void find_switch();
    [[nodiscard]] double pressure_of_row_value(double value, double Row::*field, double Row::*slope) const;
    [[nodiscard]] HydraulicState wet(double pressure) const;

    double chord_;  ///< Pa
    double residual_;
    double maximum_;
    double switch_pressure_ = 0;
    std::vector<Row> rows_;
};

inline constexpr double table_spacing = 0.0115129254649702284;  // ln(10) / 200: 200 rows a decade of suction
inline constexpr int table_rows = 200 * 13 + 1;                 // 13 decades

inline HydraulicState HydraulicTable::at(double pressure) const {
    if (pressure >= -chord_) return wet(pressure);
    return at(pressure, std::log(-pressure / chord_) / table_spacing);
}

inline HydraulicState HydraulicTable::at(double pressure, double row) const {
    if (pressure >= -chord_) return wet(pressure);
    const auto whole = static_cast<size_t>(std::min(row, static_cast<double>(table_rows - 2)));
    const double t = std::min(row - static_cast<double>(whole), 1.0);
    const Row& a = rows_[whole];
    const Row& b = rows_[whole + 1];
    const double per_pressure = 1.0 / (pressure * table_spacing);  // d(row)/dp
    const Hermite s = hermite(a.saturation, b.saturation, a.saturation_slope, b.saturation_slope, t);
    const Hermite k = hermite(a.permeability, b.permeability, a.permeability_slope, b.permeability_slope, t);
    const Hermite phi = hermite(a.potential, b.potential, a.potential_slope, b.potential_slope, t);
    return {s.value, s.slope * per_pressure, k.value, k.slope * per_pressure, phi.value, row};
}

inline HydraulicState HydraulicTable::wet(double pressure) const {
    if (pressure > 0) return {maximum_, 0.0, 1.0, 0.0, pressure, 0.0};
    const Row& end = rows_.front();
    const double capacity = (maximum_ - end.saturation) / chord_;
    const double slope = (1.0 - end.permeability) / chord_;
    return {maximum_ + capacity * pressure,
            capacity,
            1.0 + slope * pressure,
            slope,
            pressure * (1.0 + 0.5 * slope * pressure),
            0.0};
}

}  // namespace talus
