// What the nodes of the Cartesian background hold of the solutes of the fluids: air dissolved in the liquid, and vapour in the gas.
//
// A solute goes with its fluid, at the node's mean w of its mass fraction, and diffuses through it (Fick):
//     F_w = w F - rho D tau grad w,   tau = n^(1/3) S^(7/3)   (Millington & Quirk 1961), S the share of the pores that the fluid fills
// Vapour diffuses against the gas's air, so that the fluid's own F stays as it is. Where a fluid carries its solute farther than diffusion spreads
// it over half a cell, that much does spread it (Spalding's hybrid scheme, 1972), or fractions would overshoot. Sums over points, losses and gains as the
// fluids' own (grid_mixture.hpp).
#pragma once

#include "motion/explicit/grid_motion.hpp"

#include <vector>

namespace talus {

/// Sums over points where they have come to lie.
struct SoluteGains {
    double dissolved = 0;       ///< of N times the mass of dissolved air, kg
    double dissolved_gain = 0;  ///< less those of N V div F_w, kg/s
    double vapour = 0;          ///< of N times the mass of vapour, kg
    double vapour_gain = 0;     ///< less those of N V_g div F_w, kg/s
};

/// Sums over points with the gradients of the splines.
struct SoluteGradients {
    NodeVector dissolved;  ///< of V w grad N, m
    NodeVector vapour;     ///< of V_g w grad N, m
};

/// Sums over points with the values of the splines.
struct SoluteMeans {
    double dissolved = 0;         ///< of N m w, kg
    double dissolved_spread = 0;  ///< of N m_l tau, kg
    double vapour = 0;            ///< of N V_g w, m2
    double vapour_spread = 0;     ///< of N m_g tau, kg
};

/// What crosses the surface, and e_j . F_w, kg/s.
struct SoluteReturn {
    double dissolved = 0;
    double vapour = 0;
};

struct NodeSolutes {
    std::vector<SoluteGains> gains;
    std::vector<SoluteGradients> gradients;
    std::vector<SoluteMeans> means;
    std::vector<SoluteReturn> returned;
    // Of both at once, in the place of their fluids: dissolved air in that of the liquid, vapour in that of the gas.
    std::vector<NodePairOfVectors> fluxes;    ///< F_w, kg/(m2 s); of the vapour, of the gas's own area
    std::vector<NodePairOfVectors> evenings;  ///< w times the fluid's
    std::vector<NodePairOfVectors> mixings;   ///< of the points' w: x, kg/s per weight; y, times the node's
    std::vector<NodePairOfVectors> rates;  ///< x, gain that points share as the fluid's; y, loss by what they hold, 1/s

    double air_diffusivity = 0;     ///< in the liquid, m2/s
    double vapour_diffusivity = 0;  ///< in the gas, m2/s
    double outer_air = 0;           ///< dissolved in water at the surface, per mass of water
    double outer_vapour = 0;        ///< mass fraction in the atmosphere
    double evaporated = 0;          ///< vapour gone through the surface in the steps ended, kg

    void resize(size_t nodes);
};

}  // namespace talus
