// Monotone piecewise cubic interpolation. Source: Fritsch & Carlson, SIAM J. Numer. Anal. 17 (1980).
#pragma once

#include <span>
#include <vector>

namespace talus {

/// Value at `at` of the monotone cubic through (x, y), x increasing; constant beyond its ends. One point or more.
double monotone_cubic(std::span<const double> x, std::span<const double> y, double at);

/// Value and slope of the cubic on [0, 1] with end values y0, y1 and end slopes m0, m1.
struct Hermite {
    double value;
    double slope;
};

inline Hermite hermite(double y0, double y1, double m0, double m1, double t) {
    const double rise = y1 - y0;
    const double c2 = 3.0 * rise - 2.0 * m0 - m1;
    const double c3 = m0 + m1 - 2.0 * rise;
    return {y0 + t * (m0 + t * (c2 + t * c3)), m0 + t * (2.0 * c2 + 3.0 * t * c3)};
}

/// Limits the end slopes m (per unit of the uniform spacing) of monotone data y so that no cubic overshoots.
void limit_slopes(std::span<const double> y, std::span<double> m);

}  // namespace talus
