#pragma once

#include <algorithm>
#include <cmath>
#include <span>

namespace talus {

inline double dot(std::span<const double> a, std::span<const double> b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

inline double norm(std::span<const double> a) { return std::sqrt(dot(a, a)); }

inline double largest(std::span<const double> a) {
    double value = 0;
    for (const double x : a) value = std::max(value, std::abs(x));
    return value;
}

}  // namespace talus
