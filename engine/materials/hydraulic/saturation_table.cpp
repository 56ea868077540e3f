#include "materials/hydraulic/saturation_table.hpp"

#include "materials/hydraulic/curves.hpp"

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
      per_range_(1 / (maximum_ - residual_)),
      rows_(saturation_rows::count - 1) {
    const HydraulicTable curves(hydraulics);
    chord_pressure_ = -soft_suction(curves, maximum_, bulk_modulus);
    const HydraulicState end = curves.at(chord_pressure_);
    chord_permeability_ = end.permeability;
    chord_effective_ = effective(end.saturation);
    const auto gas_at = [&](double at) { return gas_permeability(hydraulics.retention, -at); };
    chord_gas_permeability_ = gas_at(chord_pressure_);
    std::array<std::vector<double>, 4> values, slopes;
    for (int i = 0; i < saturation_rows::count; ++i) {
        const double logit = saturation_rows::lowest + i * saturation_rows::spacing;
        const double here = std::min(1 / (1 + std::exp(-logit)), chord_effective_);
        const double pressure = curves.pressure_of_saturation(residual_ + here * (maximum_ - residual_));
        const HydraulicState state = curves.at(pressure);
        values[0].push_back(-pressure);
        values[1].push_back(state.permeability);
        values[2].push_back(gas_at(pressure));
        values[3].push_back(state.potential / pressure);
    }
    for (size_t v = 0; v < 4; ++v) slopes[v] = row_slopes(values[v]);
    for (size_t i = 0; i < rows_.size(); ++i) {
        for (size_t v = 0; v < 4; ++v) {
            const auto lane = static_cast<Eigen::Index>(v);
            const Cubic cubic = cubic_between(values[v][i], values[v][i + 1], slopes[v][i], slopes[v][i + 1]);
            rows_[i].c0[lane] = cubic.c0;
            rows_[i].c1[lane] = cubic.c1;
            rows_[i].c2[lane] = cubic.c2;
            rows_[i].c3[lane] = cubic.c3;
        }
    }
}

double SaturationTable::stiffness(double saturation) const {
    const double held = std::clamp(effective(saturation), saturation_rows::least, chord_effective_);
    return -suction_slope(held, std::log(odds(held)));
}

}  // namespace talus
