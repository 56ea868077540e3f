#include "materials/hydraulic/hydraulic_table.hpp"

#include "materials/hydraulic/curves.hpp"

#include <algorithm>
#include <array>

namespace talus {
namespace {

constexpr double chord_share = 4e-4;  // of the suction scale

// Four-point Gauss-Legendre on [-1, 1].
constexpr std::array<double, 4> gauss_place{-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                            0.8611363115940526};
constexpr std::array<double, 4> gauss_weight{0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                             0.3478548451374538};

double suction_at(double chord, double place) { return chord * std::exp(place * table_spacing); }

// Slope per row of f(ln s) by a central difference of fourth order; its error, about 1e-9 of the curve's change a row, is below the table's.
template <class Curve>
double row_slope(const Curve& curve, double place) {
    constexpr double h = 0.1;
    return (8.0 * (curve(place + h) - curve(place - h)) - (curve(place + 2 * h) - curve(place - 2 * h))) / (12.0 * h);
}

}  // namespace

HydraulicTable::HydraulicTable(const Hydraulics& hydraulics)
    : chord_(chord_share * suction_scale(hydraulics.retention)),
      residual_(hydraulics.retention.residual_saturation),
      maximum_(hydraulics.retention.maximum_saturation),
      rows_(table_rows) {
    fill_curves(hydraulics);
    fill_potential(hydraulics);
    find_switch();
}

void HydraulicTable::fill_curves(const Hydraulics& hydraulics) {
    const auto s = [&](double place) { return saturation(hydraulics.retention, suction_at(chord_, place)); };
    const auto k = [&](double place) { return relative_permeability(hydraulics, suction_at(chord_, place)); };
    std::vector<double> value(table_rows);
    std::vector<double> slope(table_rows);
    const auto tabulate = [&](const auto& curve) {
        for (int i = 0; i < table_rows; ++i) {
            value[static_cast<size_t>(i)] = curve(i);
            slope[static_cast<size_t>(i)] = row_slope(curve, i);
        }
        limit_slopes(value, slope);
    };
    tabulate(s);
    for (size_t i = 0; i < rows_.size(); ++i) {
        rows_[i].saturation = value[i];
        rows_[i].saturation_slope = slope[i];
    }
    tabulate(k);
    for (size_t i = 0; i < rows_.size(); ++i) {
        rows_[i].permeability = value[i];
        rows_[i].permeability_slope = slope[i];
    }
}

// Potential(p) = integral of k_r dp from saturation.
void HydraulicTable::fill_potential(const Hydraulics& hydraulics) {
    const auto slope_at = [&](double place) {  // d(potential)/d(place) = -k_r s spacing
        const double s = suction_at(chord_, place);
        return -relative_permeability(hydraulics, s) * s * table_spacing;
    };
    double potential = -0.5 * chord_ * (1.0 + rows_.front().permeability);
    for (int i = 0; i < table_rows; ++i) {
        rows_[static_cast<size_t>(i)].potential = potential;
        rows_[static_cast<size_t>(i)].potential_slope = slope_at(i);
        for (size_t g = 0; g < gauss_place.size(); ++g)
            potential += 0.5 * gauss_weight[g] * slope_at(i + 0.5 * (1.0 + gauss_place[g]));
    }
}

void HydraulicTable::find_switch() {
    double steepest = 0;
    switch_pressure_ = -chord_;
    for (int i = 0; i < table_rows; ++i) {
        const double p = -suction_at(chord_, i);
        const double capacity = at(p).capacity;
        if (capacity > steepest) {
            steepest = capacity;
            switch_pressure_ = p;
        }
    }
}

double HydraulicTable::pressure_of_saturation(double saturation) const {
    const Row& end = rows_.front();
    if (saturation < end.saturation) return pressure_of_row_value(saturation, &Row::saturation, &Row::saturation_slope);
    const double capacity = (maximum_ - end.saturation) / chord_;
    return capacity > 0 ? std::min(0.0, (saturation - maximum_) / capacity) : -chord_;
}

double HydraulicTable::pressure_of_potential(double potential) const {
    if (potential >= 0) return potential;
    if (potential < rows_.front().potential)
        return pressure_of_row_value(potential, &Row::potential, &Row::potential_slope);
    // On the chord potential = p (1 + slope p / 2).
    const double slope = (1.0 - rows_.front().permeability) / chord_;
    return 2.0 * potential / (1.0 + std::sqrt(std::max(0.0, 1.0 + 2.0 * slope * potential)));
}

// Row values fall with the suction: bisect the rows, then Newton within one cubic, kept between its ends.
double HydraulicTable::pressure_of_row_value(double value, double Row::*field, double Row::*slope) const {
    const auto after = std::partition_point(rows_.begin(), rows_.end(), [&](const Row& r) { return r.*field > value; });
    if (after == rows_.end()) return -suction_at(chord_, table_rows - 1);
    const auto row = static_cast<size_t>(after - rows_.begin()) - 1;
    const Row& a = rows_[row];
    const Row& b = rows_[row + 1];
    double low = 0;
    double high = 1;
    double t = (a.*field - value) / (a.*field - b.*field);
    for (int iteration = 0; iteration < 20; ++iteration) {
        const Hermite at = hermite(a.*field, b.*field, a.*slope, b.*slope, t);
        (at.value > value ? low : high) = t;
        const double newton = t - (at.value - value) / at.slope;
        const double next = (newton > low && newton < high) ? newton : 0.5 * (low + high);
        if (std::abs(next - t) < 1e-10) break;
        t = next;
    }
    return -suction_at(chord_, static_cast<double>(row) + t);
}

}  // namespace talus
