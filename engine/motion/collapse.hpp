// When no equilibrium exists: the evidence.
#pragma once

#include <array>

namespace talus {

/// The motion that goes on while the unbalanced force does not fall.
struct CollapseEvidence {
    std::array<double, 2> place{};         ///< centroid of the moving mass, m
    std::array<double, 2> shear_place{};   ///< point of the largest plastic shear rate, m
    double displacement = 0;               ///< largest, in pseudo-time, m
};

}  // namespace talus
