// The mean k_r of a link: what the head lost along it is multiplied with.
//
// Along the link k_r is averaged over the pressure, k = (Phi(p_a) - Phi(p_b)) / (p_a - p_b), Phi being the Kirchhoff potential: second order,
// exact where gravity does not act, and no flow at hydrostatic pressure. The flow k (p_a + fall - p_b) must grow with the upper pressure p_a and
// fall with the lower one p_b, or water would oscillate and Newton's method cycle. Upwards it does. Downwards, where k_r is so steep that
// it does not (a cell Peclet number, fall k_r'/k_r, above some 2), the flow is the extreme one of all lower pressures between p_a and p_b:
// Godunov's flux, the nearest monotone one. Over a drier lower end that is the envelope of the flow plus half of the diffusion, so that a filled
// cell's flow keeps a slope by the pressure below. See docs/theory.md.
#pragma once

#include "materials/hydraulic/hydraulic_table.hpp"

namespace talus {

/// One end of a link.
struct LinkEnd {
    double pressure;  ///< Pa
    HydraulicState state;
};

struct MeanPermeability {
    double value;        ///< -
    double slope_upper;  ///< by the upper end's pressure, 1/Pa
    double slope_lower;  ///< by the lower end's pressure, 1/Pa
};

/// fall: weight of a water column as high as the upper end lies above the lower one, Pa, >= 0.
MeanPermeability mean_permeability(const HydraulicTable& table, const LinkEnd& upper, const LinkEnd& lower,
                                   double fall);

}  // namespace talus
