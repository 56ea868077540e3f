#include "materials/hydraulic/monotone_cubic.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace talus {
namespace {

// Weighted harmonic mean of the neighbouring secants; zero where they differ in sign (a sufficient condition of monotonicity).
double inner_slope(double left_width, double left, double right_width, double right) {
    if (left * right <= 0) return 0.0;
    const double left_weight = 2.0 * right_width + left_width;
    const double right_weight = right_width + 2.0 * left_width;
    return (left_weight + right_weight) / (left_weight / left + right_weight / right);
}

}  // namespace

double monotone_cubic(std::span<const double> x, std::span<const double> y, double at) {
    assert(!x.empty() && x.size() == y.size());
    if (at <= x.front()) return y.front();
    if (at >= x.back()) return y.back();
    const auto upper = static_cast<size_t>(std::upper_bound(x.begin(), x.end(), at) - x.begin());
    const size_t i = upper - 1;
    const auto secant = [&](size_t k) { return (y[k + 1] - y[k]) / (x[k + 1] - x[k]); };
    const auto slope = [&](size_t k) {
        if (k == 0) return secant(0);
        if (k + 1 == x.size()) return secant(k - 1);
        return inner_slope(x[k] - x[k - 1], secant(k - 1), x[k + 1] - x[k], secant(k));
    };
    const double width = x[i + 1] - x[i];
    return hermite(y[i], y[i + 1], slope(i) * width, slope(i + 1) * width, (at - x[i]) / width).value;
}

void limit_slopes(std::span<const double> y, std::span<double> m) {
    for (size_t i = 0; i + 1 < y.size(); ++i) {
        const double secant = y[i + 1] - y[i];
        for (double* slope : {&m[i], &m[i + 1]}) {
            if (*slope * secant <= 0) *slope = 0;
            if (std::abs(*slope) > 3.0 * std::abs(secant)) *slope = 3.0 * secant;
        }
    }
}

}  // namespace talus
