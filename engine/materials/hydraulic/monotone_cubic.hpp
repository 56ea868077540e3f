// Monotone piecewise cubic interpolation. Source: Fritsch & Carlson, SIAM J. Numer. Anal. 17 (1980).
#pragma once

#include <span>
#include <vector>

namespace talus {

/// Value at `at` of the monotone cubic through (x, y), x increasing; constant beyond its ends. One point or more.
double monotone_cubic(std::span<const double> x, std::span<const double> y, double at);

/// c0 + t (c1 + t (c2 + t c3)).
struct Cubic {
    double c0, c1, c2, c3;
};

/// On [0, 1], with end values y0, y1 and end slopes m0, m1.
inline Cubic cubic_between(double y0, double y1, double m0, double m1) {
    const double rise = y1 - y0;
    return {y0, m0, 3.0 * rise - 2.0 * m0 - m1, m0 + m1 - 2.0 * rise};
}

/// Value and slope of that cubic.
struct Hermite {
    double value;
    double slope;
};

inline Hermite hermite(double y0, double y1, double m0, double m1, double t) {
    const auto [c0, c1, c2, c3] = cubic_between(y0, y1, m0, m1);
    return {c0 + t * (c1 + t * (c2 + t * c3)), c1 + t * (2.0 * c2 + 3.0 * t * c3)};
}

/// Limits the end slopes m (per unit of the uniform spacing) of monotone data y so that no cubic overshoots.
void limit_slopes(std::span<const double> y, std::span<double> m);

}  // namespace talus
