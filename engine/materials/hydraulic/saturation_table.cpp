#include "materials/hydraulic/saturation_table.hpp"

#include <limits>

namespace talus {
namespace {

constexpr double largest_chord = 1e9;  // Pa, of suction

/// Monotone slopes of the rows' values, per row.
std::vector<double> row_slopes(const std::vector<double>& value) {
    std::vector<double> slope(value.size());
    for (size_t i = 0; i < value.size(); ++i) {
        const size_t before = i == 0 ? 0 : i - 1, after = std::min(i + 1, value.size() - 1);
        slope[i] = (value[after] - value[before]) / static_cast<double>(after - before);
    }
    limit_slopes(value, slope);
    return slope;
}

/// The suction to which the chord of the curve from saturation on is no stiffer than the bulk modulus; where none is, that of the softest chord.
double soft_suction(const HydraulicTable& curves, double maximum, double bulk_modulus) {
    constexpr double growth = 1.1;
    double softest = curves.chord(), least = std::numeric_limits<double>::infinity();
    for (double suction = curves.chord(); suction < largest_chord; suction *= growth) {
        const double stiffness = suction / (1 - curves.at(-suction).saturation / maximum);
        if (stiffness <= bulk_modulus) return suction;
        if (stiffness < least) softest = suction;
        least = std::min(least, stiffness);
    }
    return softest;
}

}  // namespace

SaturationTable::SaturationTable(const Hydraulics& hydraulics, double bulk_modulus)
    : residual_(hydraulics.retention.residual_saturation),
      maximum_(hydraulics.retention.maximum_saturation),
      rows_(saturation_rows::count) {
    const HydraulicTable curves(hydraulics);
    chord_pressure_ = -soft_suction(curves, maximum_, bulk_modulus);
    const HydraulicState end = curves.at(chord_pressure_);
    chord_permeability_ = end.permeability;
    chord_effective_ = effective(end.saturation);
    std::vector<double> pressure, permeability;
    for (int i = 0; i < saturation_rows::count; ++i) {
        const double logit = saturation_rows::lowest + i * saturation_rows::spacing;
        const double here = std::min(1 / (1 + std::exp(-logit)), chord_effective_);
        pressure.push_back(curves.pressure_of_saturation(residual_ + here * (maximum_ - residual_)));
        permeability.push_back(curves.at(pressure.back()).permeability);
    }
    const std::vector<double> pressure_slope = row_slopes(pressure), permeability_slope = row_slopes(permeability);
    for (size_t i = 0; i < rows_.size(); ++i)
        rows_[i] = {pressure[i], pressure_slope[i], permeability[i], permeability_slope[i]};
}

double SaturationTable::stiffness(double saturation) const {
    const double range = maximum_ - residual_, effective = this->effective(saturation);
    if (effective >= chord_effective_) return -chord_pressure_ / (range * (1 - chord_effective_));
    const auto [row, t] = place_of(effective);
    const Row &a = rows_[row], &b = rows_[row + 1];
    const double held = std::max(effective, saturation_rows::least);
    const double rows = 1 / (saturation_rows::spacing * range * held * (1 - held));  // per saturation
    return rows * hermite(a.pressure, b.pressure, a.pressure_slope, b.pressure_slope, t).slope;
}

}  // namespace talus
