// What the nodes of the Cartesian background hold of solid and liquid, and their equations of motion with implicit drag.
//
// Per node, with f the force of the liquid's pressure, f_m that of the total stress, b gravity:
//     rho_l V (v_l' - v_l) / dt = f + rho_l V b - (n_l / lambda) V (v_l' - v_s')                    (Darcy's law with inertia)
//     m_s (v_s' - v_s) / dt + m_l (v_l' - v_l) / dt = f_m + (m_s + m_l) b
//
// Pressure force and storage are each other's adjoint, and no water is lost between them. With the liquid's weight in it, the pressure
// p + rho_l g y of the points pushes the nodes with sum V (p + rho_l g y - its mean at node j) grad N_j: no force on water at rest, no flow
// through the edge of the ground. The flux F leaves a node's surroundings with sum V N_j div F - F_j . e_j, e_j = sum V grad N_j, which adds
// up to zero over all nodes; points get their shares of it by N_j and their solid mass. Where water may leave, at the edge where p_j > 0,
// the edge has p = 0 in place of the mean, and F_j . e_j seeps out.
#pragma once

#include "motion/explicit/grid_motion.hpp"
#include "motion/explicit/walled_grid.hpp"

#include <vector>

namespace talus {

/// Sums over points with the gradients of the splines: N, and the edge's length times its normal, m.
struct NodeGradients {
    double push_x = 0, push_y = 0;  ///< of V (p + rho_l g y) grad N
    double edge_x = 0, edge_y = 0;  ///< of V grad N
};

/// Sums over points with the values of the splines.
struct NodeMeans {
    double push = 0;      ///< of N m (p + rho_l g y)
    double mobility = 0;  ///< of N m lambda, lambda = kappa / mu
    double volume = 0;    ///< of N V
    double height = 0;    ///< of N m y
};

struct GridMixture : WalledGrid {
    double gravity = 0;         ///< m/s2, downwards
    double liquid_density = 0;  ///< kg/m3
    double edge_pressure = 0;   ///< on the ground's edge, Pa
    bool immersed = false;      ///< the edge stands in water without pressure: it may enter too
    double cell_volume() const { return grid.cell_size * grid.cell_size; }

    std::vector<NodeMomentum> momentum;         ///< of the solid; more: sum of m div v
    std::vector<NodeMomentum> liquid_momentum;  ///< more: less the sum of V N div F, kg/s
    std::vector<NodeVector> velocity, liquid_velocity;
    std::vector<NodeVector> flux;  ///< F, of water through the solid, kg/(m2 s)
    std::vector<NodeVector>
        rates;  ///< that points share: x, volumetric strain, 1/s; y, water gained, kg/s per kg of solid
    std::vector<NodeVector> force;  ///< of the total stress, and the weight
    std::vector<NodeGradients> gradients;
    std::vector<NodeMeans> means;
    std::vector<NodeVector> edge_height;  ///< sum of V (y grad N + N grad y), the edge's y times its normal, m2
    std::vector<double> returned;         ///< F_j . e_j, kg/s
    std::vector<double> rain;             ///< onto each column of the grid that holds ground, kg/(m2 s); empty: none
    double rained = 0;                    ///< that the points got so far, kg
    double raining = 0;                   ///< what they will get in the next step, kg
    double seepage = 0;                   ///< that left the points so far, kg
    double seeping = 0;                   ///< what they will lose in the next step, kg

    void resize();
    void begin_step();
    void end_step(double dt);
    [[nodiscard]] double largest_speed() const;

private:
    [[nodiscard]] bool is_at_edge(size_t node) const;
    void fold_forces();
    void rain_on(double dt);
    void solve(size_t node, double dt);
    void mirror();

    std::vector<double> column_width_;  // m
};

}  // namespace talus
