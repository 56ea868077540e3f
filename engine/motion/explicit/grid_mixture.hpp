// What the nodes of the Cartesian background hold of solid, liquid and gas, and their equations of motion with implicit drag.
//
// Per node, with f the force of the liquid's pressure, f_m that of the total stress, b gravity:
//     rho_l V (v_l' - v_l) / dt = f + rho_l V b - (n_l / lambda) V (v_l' - v_s')                    (Darcy's law with inertia)
//     m_s (v_s' - v_s) / dt + m_l (v_l' - v_l) / dt = f_m + (m_s + m_l) b
// A gas that moves has the like, in terms of its potential psi = R T / M ln(P / P_0) + g y, which is uniform where it is at rest:
//     V_g (v_g' - v_g) / dt = f_psi - (n_g / (lambda_g rho_g)) V_g (v_g' - v_s')
// and its momentum counts in the second line.
//
// Pressure force and storage are each other's adjoint, and no water is lost between them. With the liquid's weight in it, the pressure
// p + rho_l g y of the points pushes the nodes with sum V (p + rho_l g y - its mean at node j) grad N_j: no force on water at rest, no flow
// through the edge of the ground. The flux F leaves a node's surroundings with sum V N_j div F - F_j . e_j, e_j = sum V grad N_j, which adds
// up to zero over all nodes; points get their shares of it by N_j and their solid mass. Through the edge goes what the difference to p = 0
// there drives over the distance to the middle of the ground at the node, into full pores and at most what rain offers, or out. The gas alike,
// but with psi in place of the whole pressure and the volume V_g of the points' gas in place of V, and points get their shares of it by
// that volume: where there is none nothing flows, and the density of little gas changes as that of much. The edge is open to it both ways.
//
// Where the ground conducts along its bedding otherwise than across it, lambda is a tensor, and along either of its axes all this is as above.
#pragma once

#include "motion/explicit/conduction_axes.hpp"
#include "motion/explicit/grid_motion.hpp"
#include "motion/explicit/ground_edge.hpp"
#include "motion/explicit/node_solutes.hpp"
#include "motion/explicit/walled_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace talus {

/// Nodes do not see what one point of a cell has too much and its neighbour too little: it would grow by chance from step to step, until the
/// pressure of the fuller one counts (docs/verification.md). Points pass on to each other what Darcy's law lets pass between the halves of a cell.
/// Of smooth fields, the nodes' means seen by points again differ from the points' own by this many squares of a cell times the Laplacian: twice half
/// of the splines' second moment. As much of Darcy's flow does evening them out pass on already.
inline constexpr double smoothing = 0.25;

/// Gas that fills less than this share of the ground moves with the solid, as by a drag beyond all others.
inline constexpr double least_gas_share = 1e-6, locked = 1e30;

/// Sums over points with the gradients of the splines: N, and the edge's length times its normal, m.
struct NodeGradients {
    double push_x = 0, push_y = 0;  ///< of V (p + rho_l g y) grad N
    double edge_x = 0, edge_y = 0;  ///< of V grad N
};

/// Sums over points with the values of the splines.
struct NodeMeans {
    double push = 0;          ///< of N m (p + rho_l g y)
    double permeability = 0;  ///< of N m k_r
    double volume = 0;        ///< of N V
    double resistance = 0;    ///< of N m mu / kappa, the mean over all directions

    [[nodiscard]] double lambda(double) const { return permeability / resistance; }
    [[nodiscard]] double anisotropy_weight(double) const { return resistance; }  ///< anisotropy is one of resistances
    [[nodiscard]] double edge_lambda(double mass) const { return mass / resistance; }  ///< of full pores
};

/// The same beside a gas that moves.
struct NodeMeansBesideGas {
    double push = 0;           ///< of N m (p + rho_l g y)
    double mobility = 0;       ///< of N m lambda
    double volume = 0;         ///< of N V
    double edge_mobility = 0;  ///< of N m lambda on the way to the edge: the mean over the suctions on it

    [[nodiscard]] double lambda(double mass) const { return mobility / mass; }
    [[nodiscard]] static double anisotropy_weight(double mass) { return mass; }
    [[nodiscard]] double edge_lambda(double mass) const { return edge_mobility / mass; }
};

/// Sums over points of what concerns their gas.
struct GasMeans {
    double push = 0;      ///< of N V_g psi
    double mobility = 0;  ///< of N m lambda_g
    double volume = 0;    ///< of N V_g
    double mass = 0;      ///< of N m_g
};

/// What nodes hold of a gas that moves.
struct NodeGas {
    std::vector<NodeMomentum> momentum;    ///< more: less the sum of V_g N div F, kg/s
    std::vector<double> weight;            ///< sum of N times what points share their gas by, m2
    std::vector<NodeGradients> gradients;  ///< of the gas: V_g in place of V, psi in place of the whole pressure
    std::vector<GasMeans> means;           ///< of the points
    std::vector<double> returned;          ///< F_j . e_j and what crosses the surface, kg/s
    double density = 0;                    ///< at no gauge pressure, kg/m3
    double specific = 0;                   ///< R T / M, J/kg
    double escaped = 0;  ///< through the surface in the steps ended, kg; with exchange, air alone, in the liquid too

    /// Of gas whose R T / M ln(P / P_0) is so much, J/kg, above the atmosphere's, Pa.
    [[nodiscard]] double pressure(double energy) const { return density * specific * std::expm1(energy / specific); }
    void resize(size_t nodes);
};

/// How the liquid at a node answers to forces along an axis: v_l' = (v_l + response force + drag v_s') / (1 + drag).
struct LiquidAnswer {
    double drag = 0;         ///< -
    double moved = 0;        ///< mass / (1 + drag), kg
    double conductance = 0;  ///< flux per force and volume, kg s/m3
};

/// The same of the gas.
struct GasAnswer {
    double push = 0;      ///< the node's mean of psi, J/kg
    double response = 0;  ///< m/s per force
    double drag = 0;      ///< -
    double moved = 0;     ///< mass / (1 + drag), kg
    double density = 0;   ///< kg/m3
    double evened = 0;    ///< flux per force that evening out does, kg/(m2 s)
    double spread = 0;    ///< what points even out per weight and psi, kg/s

    void choke(const NodeVector& relative_velocity, double most);
};

/// How all that is at a node answers along an axis.
struct PhaseAnswer {
    LiquidAnswer liquid;
    GasAnswer gas;
    double coupled = 0;  ///< mass that a force on the solid moves, kg: the fluids' that drag takes along included
};
template <class Axes>
using PhaseAnswers = std::array<PhaseAnswer, Axes::count>;

/// find(answer) along each of the axes.
template <size_t count, class Find>
std::array<double, count> of_each(const std::array<PhaseAnswer, count>& answers, const Find& find) {
    std::array<double, count> values;
    for (size_t axis = 0; axis < count; ++axis) values[axis] = find(answers[axis]);
    return values;
}

/// Of a column of the grid: the edge that faces up.
struct OpenSurface {
    double width = 0;   ///< m
    double fallen = 0;  ///< of rain, kg/s
    double left = 0;    ///< of rain and seepage that nodes have not taken, kg/s
    double room = 0;    ///< in nodes that could take more, kg/s
};

/// What a node in moist ground tells its neighbours.
struct NodeSurroundings {
    double permeability = 0;  ///< mean k_r of the points, over that of full pores
    double share = 0;         ///< of its surroundings that is ground
};

/// Where the ground is on a wall with friction: two nodes whose sums have come together at the one inside.
struct Contact {
    const Wall* wall = nullptr;
    size_t axis = 0;                        ///< across the wall
    int32_t inwards = 0;                    ///< the direction in which the ground lies, 1 or -1
    int32_t other = -1;                     ///< contact of the same node; -1: none
    double solid = 0, liquid = 0, gas = 0;  ///< mass inside less mass beyond, kg
    double pushed = 0;    ///< momentum across the wall of all phases at both nodes, at the step's start, kg m/s
    double weight = 0;    ///< that came to the inner node's force with its momentum, N
    double force = 0;     ///< across the wall on both nodes, N
    double area = 0;      ///< of the wall, m
    double pressing = 0;  ///< impulse of the skeleton on the wall in the step, N s
};

/// How a node answers to an impulse that changes its solid's velocity along x or along y.
struct ImpulseAnswer {
    double mass = 0;         ///< that it moves, the fluids' that drag takes along included, kg
    NodeVector liquid, gas;  ///< change of their velocities per the solid's
};

struct ImpulseAnswers {
    ImpulseAnswer x, y;
    double liquid_density = 0;  ///< flux per velocity through the solid, kg/m3
    double head = 0;            ///< p + rho_l g y, Pa
    double gas_density = 0;
    double gas_potential = 0;  ///< psi, J/kg
};

struct EdgeNode {
    size_t node;
    double facing_up;  ///< m
};

/// `exchanges`: water evaporates into the gas, air dissolves in the liquid.
template <bool has_gas, bool exchanges = false>
struct GridMixture : WalledGrid {
    using Means = std::conditional_t<has_gas, NodeMeansBesideGas, NodeMeans>;
    using Fluids = NodeFluids<has_gas>;

    double gravity = 0;         ///< m/s2, downwards
    double liquid_density = 0;  ///< kg/m3
    double edge_pressure = 0;   ///< on the ground's edge, Pa
    double least_mass = 0;      ///< kg, of a point's solid
    double speed = 0;           ///< m/s, a bound of the points' solid in the step, from its end
    double start_speed = 0;     ///< likewise, from its start
    bool evens = false;         ///< points of a cell even out what they hold
    bool has_bedding = false;   ///< some of the ground has an anisotropy
    bool immersed = false;      ///< the edge stands in water without pressure: it may enter too
    double cell_volume() const { return grid.cell_size * grid.cell_size; }
    double height_of(size_t node) const {  ///< y, m
        const size_t row = node / static_cast<size_t>(grid.cells[0]);
        return grid.corner[1] + (static_cast<double>(row) + 0.5) * grid.cell_size;
    }

    std::vector<NodeMomentum> momentum;         ///< of the solid; more: sum of m div v
    std::vector<NodeMomentum> liquid_momentum;  ///< more: less the sum of V N div F, kg/s
    std::vector<NodeVector> velocity;           ///< of the solid, m/s
    std::vector<Fluids> fluid_velocity;         ///< m/s
    std::vector<Fluids> flux;                   ///< F, through the solid, kg/(m2 s); the gas's of its own area
    /// That points share. Liquid: x, volumetric strain, 1/s; y, water gained, kg/s per kg of solid. Gas: x, gain that they share by weight,
    /// kg/(m2 s); y, loss that they share by their gas, 1/s.
    std::vector<Fluids> rates;
    /// Of the points' heads: x, kg/s per kg of solid and Pa; y, times the node's. Of their psi: x, kg/s per weight and J/kg; y, times the node's.
    std::vector<Fluids> evening;
    std::vector<NodeVector> force;  ///< of the total stress, and of the weight what mirrors change, N
    std::vector<NodeGradients> gradients;
    std::vector<Means> means;
    std::vector<NodeVector>
        anisotropy;  ///< sum of N times that of the points and what Means weigh it by; empty: none has any
    std::vector<NodeMoments> moments;            ///< empty where evens is not set or gas moves, as the next two
    std::vector<NodeVector> places;              ///< sum of N m r, r from the node, kg m
    std::vector<NodeSurroundings> surroundings;  ///< in the step that ends
    std::vector<double> returned;                ///< F_j . e_j and what crosses the surface, kg/s
    std::vector<double> capacity;  ///< of the edge at no pressure there to let water in, kg/s; negative: it comes out
    std::vector<double> rain;      ///< onto each column of the grid that holds ground, kg/(m2 s); empty: none
    double flow_time = 0;          ///< s that the rates of water are of: what points have not got yet
    double rained = 0;             ///< kg, in the steps ended
    double run_off = 0;            ///< kg, likewise
    double seepage = 0;            ///< kg, likewise; negative where an immersed ground drank

    NodeGas gas;          ///< empty where it is at rest
    NodeSolutes solutes;  ///< empty where fluids exchange nothing

    void resize();
    void begin_step();
    void end_step(double dt);
    [[nodiscard]] double total(const std::vector<double>& values) const;  ///< over the nodes
    [[nodiscard]] SoluteReturn returned_solutes() const;                  ///< over the nodes, kg/s
    void lose(const SoluteReturn&
                  rate);  ///< of water and gas counted as lost in the last step, so much is air and vapour, kg/s

private:
    /// What a part of the grid adds to the whole's.
    struct PartSums {
        SpeedBound bound;
        double seepage = 0, escaped = 0, evaporated = 0;  // kg
    };
    template <class Use>
    double for_each_part(const Use& use);
    void add_to_totals(const PartSums& part) {
        seepage += part.seepage;
        gas.escaped += part.escaped;
        solutes.evaporated += part.evaporated;
    }
    [[nodiscard]] bool is_at_edge(size_t node) const;
    template <class Use>
    void for_each_meeting(const Use& use) const;
    template <class Use>
    void for_each_meeting_of(size_t part, const Use& use) const;
    [[nodiscard]] std::ptrdiff_t to_inner(size_t node, size_t axis) const;
    template <class Use>
    void for_each_wall_pair(const Use& use) const;
    [[nodiscard]] bool is_held_below(size_t node, size_t axis, std::ptrdiff_t inner) const;
    void forget_contacts();
    bool touch(const Wall& wall, size_t axis, int32_t inwards, NodePair nodes, double dt);
    [[nodiscard]] double force_across(NodePair nodes, size_t axis, double weight) const;
    bool presses(const Wall& wall, size_t axis, int32_t inwards, NodePair nodes, double dt);
    void join_contacts(NodePair nodes);
    void rub(size_t node, double dt, const ImpulseAnswers& answers);
    void fold_momenta(NodePair nodes, const Mirror& mirror, const Mirror& even);
    void meet_contacts();
    void fold_momenta();
    void fold_momenta_of(size_t part);
    void find_velocities(size_t node);
    void start(size_t node, PartSums& part);
    void fold_forces(NodePair nodes, const Mirror& mirror, const Mirror& even);
    void fold_forces(double dt);
    void fold_forces_of(size_t part);
    void find_surroundings();
    void finish_edge(size_t part);
    void clear_sums(size_t node);
    [[nodiscard]] double facing_up(size_t node) const { return std::max(gradients[node].edge_y, 0.0); }  // at the edge
    void solve_inner_nodes(size_t number, double dt, PartSums& part);
    void find_surface();
    [[nodiscard]] double falls_on(size_t node, double up) const;
    [[nodiscard]] bool lies_still(size_t column) const;
    void cross_surface(double dt);
    [[nodiscard]] LiquidAnswer answer_of_liquid(size_t node, double dt, double lambda) const;
    [[nodiscard]] GasAnswer answer_of_gas(size_t node, double dt, double anisotropy) const;
    void solve(size_t node, double dt, PartSums& part);
    template <class Axes>
    void solve(const Axes& axes, size_t node, double dt, PartSums& part);
    [[nodiscard]] double falls_more(size_t node, double lambda_down, double pushed_up, double velocity_up) const;
    [[nodiscard]] GroundEdge edge_at(size_t node) const;
    [[nodiscard]] NodeVector drive_at(size_t node) const;
    [[nodiscard]] size_t into_ground(size_t node, const NodeVector& outwards) const;
    [[nodiscard]] double wetted_share(size_t node) const;
    [[nodiscard]] double gas_distance(size_t node, const GroundEdge& edge) const;
    template <class Axes>
    void breathe(const Axes& axes, size_t node, double dt, const GroundEdge& edge, const PhaseAnswers<Axes>& answers,
                 const NodeVector& pushed, const NodeVector& through, PartSums& part);
    void mirror(NodePair nodes, const Mirror& mirror, const Mirror& even);
    void mirror();
    void mirror_part(size_t part);
    void lose(const SoluteReturn& rate, PartSums& part) const;
    void fold_solutes(NodePair nodes);
    void fold_solute_means(NodePair nodes, const Mirror& even);
    void find_solute_rates(size_t node, PartSums& part);
    void carry_solutes(size_t node, double dt, PartSums& part);
    void carry_dissolved(size_t node, const GroundEdge& edge, double dt, PartSums& part);
    void carry_vapour(size_t node, const GroundEdge& edge, double dt, PartSums& part);
    void mirror_solutes(NodePair nodes, const Mirror& even);

    std::vector<PartSums> part_sums_;                // one a part
    std::vector<std::vector<EdgeNode>> part_edges_;  // likewise
    std::vector<EdgeNode> edge_;                     // of all
    std::vector<OpenSurface> surfaces_;              // one a column

    bool rubs_ = false;  // whether any wall has friction; what follows is empty where none has
    std::vector<Contact> contacts_;
    std::vector<int32_t> contact_at_;  // one a node: the first of those whose sums come to it; -1: none
    std::array<std::vector<int32_t>, 2>
        contact_beyond_;  // likewise, by the axis across the wall: that it is the outer node of
};

/// use(wall, axis, inwards, nodes) for every pair along every wall; along one with friction, those beyond another wall last.
template <bool has_gas, bool exchanges>
template <class Use>
void GridMixture<has_gas, exchanges>::for_each_wall_pair(const Use& use) const {
    for_each_wall([&](const Wall& wall, size_t axis, int32_t inwards) {
        if (wall.kind == WallKind::none) return;
        const auto use_pair = [&](NodePair nodes) { use(wall, axis, inwards, nodes); };
        if (wall.kind != WallKind::friction) return for_each_pair(wall, axis, inwards, use_pair);
        for (const bool is_last : {false, true}) {
            for_each_pair(wall, axis, inwards, [&](NodePair nodes) {
                if ((to_inner(nodes.inside, axis) != 0) == is_last) use_pair(nodes);
            });
        }
    });
}

/// use(nodes, mirror, even) for every pair that meets, but for those that for_each_meeting_of() has. `even` is what water and scalars see, to which every
/// wall is a roller. Where a wall rubs, pairs may meet in any order of the walls: all of them here.
template <bool has_gas, bool exchanges>
template <class Use>
void GridMixture<has_gas, exchanges>::for_each_meeting(const Use& use) const {
    if (!rubs_) return for_each_level_mirror(use);
    for_each_wall_pair([&](const Wall& wall, size_t axis, int32_t, NodePair nodes) {
        if (wall.kind != WallKind::friction || contact_beyond_[axis][nodes.beyond] >= 0)
            use(nodes, mirror_of(wall, axis), even_mirror(axis));
    });
}

/// The same for the pairs within the rows of a part of the grid.
template <bool has_gas, bool exchanges>
template <class Use>
void GridMixture<has_gas, exchanges>::for_each_meeting_of(size_t part, const Use& use) const {
    if (!rubs_) for_each_upright_mirror_of(part, use);
}

/// use(part, its sums), for the parts of the grid at the same time. The bound of their speeds, m/s.
template <bool has_gas, bool exchanges>
template <class Use>
double GridMixture<has_gas, exchanges>::for_each_part(const Use& use) {
    part_sums_.assign(parts(), PartSums{SpeedBound(least_mass)});
    threads.for_each(parts(), [&](size_t number) {
        PartSums part{SpeedBound(least_mass)};
        use(number, part);
        part_sums_[number] = part;
    });
    SpeedBound bound(least_mass);
    for (const PartSums& part : part_sums_) {
        bound.add(part.bound);
        add_to_totals(part);
    }
    return bound.value();
}

// grid_solutes.cpp
template <>
SoluteReturn GridMixture<true, true>::returned_solutes() const;
template <>
void GridMixture<true, true>::lose(const SoluteReturn& rate);
template <>
void GridMixture<true, true>::lose(const SoluteReturn& rate, PartSums& part) const;
template <>
void GridMixture<true, true>::fold_solutes(NodePair nodes);
template <>
void GridMixture<true, true>::fold_solute_means(NodePair nodes, const Mirror& even);
template <>
void GridMixture<true, true>::find_solute_rates(size_t node, PartSums& part);
template <>
void GridMixture<true, true>::carry_solutes(size_t node, double dt, PartSums& part);
template <>
void GridMixture<true, true>::carry_dissolved(size_t node, const GroundEdge& edge, double dt, PartSums& part);
template <>
void GridMixture<true, true>::carry_vapour(size_t node, const GroundEdge& edge, double dt, PartSums& part);
template <>
void GridMixture<true, true>::mirror_solutes(NodePair nodes, const Mirror& even);

}  // namespace talus
