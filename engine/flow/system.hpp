// The equations of the flow on the network: water stored at each node and water flowing into it, as functions of the nodes' pore pressure,
// with their derivatives. d(stored)/dt = inflow is physics.md's water balance, integrated over the node's share of the ground.
#pragma once

#include "flow/boundaries.hpp"
#include "flow/mean_permeability.hpp"
#include "flow/network.hpp"
#include "linear/klu_solver.hpp"
#include "materials/hydraulic/hydraulic_table.hpp"
#include "scene/scene.hpp"

#include <array>
#include <span>
#include <vector>

namespace talus {

/// Water that crossed the edge of the ground, m3: see WaterBalance in engine.hpp.
enum FlowTotal : size_t { rain_total, run_off_total, seepage_total, inflow_total, drained_total, flow_total_count };
using FlowTotals = std::array<double, flow_total_count>;

/// A value that is linear in time over one advance: start + rate t, t in s since the advance began.
struct Ramp {
    double start = 0;
    double rate = 0;

    [[nodiscard]] double at(double t) const { return start + rate * t; }
};

/// What drives the flow during one advance.
struct FlowForcing {
    std::vector<double> rain;  ///< per surface node, m3/s
    std::vector<Ramp> held;    ///< per held node, Pa
    std::vector<Ramp> flux;    ///< per flux share, m3/s
};

/// How the skeleton moves during one advance: pore volume = ramp + softness (pi - expected pi), where pi is the pore stress that loads the
/// skeleton. The last term is the fixed-stress split's and vanishes when flow and motion agree.
struct SkeletonMotion {
    std::vector<Ramp> pore_volume;      ///< per portion, m3
    std::vector<double> softness;       ///< per portion, m3/Pa; empty: rigid
    std::vector<Ramp> expected_stress;  ///< per portion, Pa
    std::vector<double>
        projection;  ///< per neighbours, m3/Pa: pressure projection, which keeps equal-order elements from oscillating; it fades
                     ///< with the effective saturation of either end, which has only that water to give
};

class FlowSystem {
public:
    FlowSystem(const Scene& scene, int32_t nodes, Network network, FlowBoundaries boundaries);

    /// A matrix with the pattern that assemble() fills.
    [[nodiscard]] SparseMatrix make_matrix();

    /// Stored water and inflow at every node, t seconds into the advance, at pressure p (Pa, one a node). `beyond` holds digits of the
    /// pressures that a double has no place for, which long steps through thin cells turn into water; empty: none.
    void evaluate(double t, std::span<const double> pressure, std::span<const double> beyond = {});
    /// d(stored - step inflow)/dp at the last evaluate(); the rows of held nodes are the identity.
    void assemble(double step, SparseMatrix& matrix) const;
    /// d(-inflow)/dp, likewise.
    void assemble_steady(SparseMatrix& matrix) const;

    [[nodiscard]] int32_t node_count() const { return static_cast<int32_t>(stored_.size()); }
    [[nodiscard]] std::span<const double> stored() const { return stored_; }  ///< m3, ponds included
    [[nodiscard]] std::span<const double> inflow() const {
        return inflow_;
    }  ///< m3/s, without what holds the held nodes
    [[nodiscard]] const FlowTotals& total_rates() const { return total_rates_; }             ///< m3/s, likewise
    [[nodiscard]] std::span<const double> pore_volume() const { return node_pore_volume_; }  ///< m3, one a node
    [[nodiscard]] std::span<const double> storage() const {
        return stored_slope_;
    }  ///< d(stored)/dp, m3/Pa, by its own pressure
    [[nodiscard]] std::span<const HydraulicState> state() const { return state_; }  ///< one a portion
    [[nodiscard]] bool is_held(size_t node) const { return held_node_[node] != 0; }

    /// Largest net inflow of a free node at the last evaluate(), relative to what passes through it or would under gravity alone.
    [[nodiscard]] double imbalance() const;

    /// Carries a node's pressure by a Newton change, in the variable whose curves are straight: the pressure where it is wet, the
    /// saturation where it is dry; for a steady state, which stores nothing, the Kirchhoff potential.
    [[nodiscard]] double moved(size_t node, double pressure, double change) const;
    [[nodiscard]] double moved_steadily(size_t node, double pressure, double change) const;

    [[nodiscard]] const HydraulicTable& table(size_t soil) const { return tables_[soil]; }

    /// Pore stress pi that loads the skeleton of a soil, Pa: max(p, 0) of net stress, S_e p of Bishop's.
    [[nodiscard]] double pore_stress(size_t soil, double pressure) const;

    FlowForcing forcing;
    SkeletonMotion skeleton;
    Network network;
    FlowBoundaries boundaries;

private:
    void assemble(double storage, double step, SparseMatrix& matrix) const;
    void list_portions(size_t nodes);
    [[nodiscard]] const HydraulicTable& storing_table(size_t node, double pressure) const;
    void evaluate_rigid(std::span<const double> pressure);
    void evaluate_deforming(double t, std::span<const double> pressure);
    void evaluate_links(std::span<const double> pressure, std::span<const double> beyond);
    void evaluate_common_permeability();
    void evaluate_crossings();
    void add_flow(const Link& link, double flow);
    void evaluate_surface(std::span<const double> pressure, std::span<const double> beyond);
    void evaluate_flux(double t);

    const Scene& scene_;
    std::vector<HydraulicTable> tables_;  // one a soil
    std::vector<char> held_node_;
    std::vector<char> surface_node_;
    struct NodePortion {
        double volume;  // m3, of ground
        int32_t soil;
    };
    std::vector<NodePortion> node_portions_;   // of node 0, of node 1, ...; the largest first
    std::vector<size_t> node_portions_start_;  // one a node, and the end

    // At the last evaluate()
    std::vector<HydraulicState> state_;  // per portion
    std::vector<double> stored_slope_;   // per node, by its own pressure
    std::vector<double> inflow_slope_;   // per node, by its own pressure, of the surface
    struct LinkState {
        double head;          ///< lost from a to b, Pa
        double permeability;  ///< mean k_r, -
        std::array<double, 2> permeability_slope;
        double
            common_permeability;  ///< of the mean and the geometric mean of the ends' k_r the lesser: what crosses meets it
        std::array<double, 2> common_slope;
    };
    std::vector<LinkState> link_state_;
    std::vector<double> pore_stress_, pore_stress_slope_;                    // per portion, deforming only
    std::vector<double> effective_saturation_, effective_saturation_slope_;  // likewise
    std::vector<double> stored_, inflow_, node_pore_volume_;
    FlowTotals total_rates_{};

    struct Places {
        int32_t aa, ab, ba, bb;
    };
    void assemble_links(double step, SparseMatrix& matrix) const;
    void assemble_crossings(double step, SparseMatrix& matrix) const;
    void add_exchange(const Link& link, const Places& place, std::array<double, 2> slope, SparseMatrix& matrix) const;

    std::vector<Places> link_places_, neighbour_places_, cross_places_;  // in the matrix's values
    std::vector<int32_t> diagonal_;
};

/// Height of water above a surface node that leaves as run-off or seepage, as a depth over which the soil would conduct it, m: so small
/// that the pressure it adds (0.1 Pa at an excess of the soil's conductivity) does not count, so large that Newton does not see a wall.
inline constexpr double weir_thickness = 1e-5;

}  // namespace talus
