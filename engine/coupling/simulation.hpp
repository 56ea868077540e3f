// Flow and motion of one ground, carried through time together.
//
// One host step is a sequence of exchanges. In each, the flow runs ahead with the pore volume that the skeleton is expected to have, the
// skeleton finds its equilibrium under the pressures that result, and the two repeat until they agree (fixed-stress split: Kim, Tchelepi &
// Juanes, Comput. Methods Appl. Mech. Eng. 200, 2011). The exchanges' length follows from how well the expectation was met.
#pragma once

#include "coupling/deposit.hpp"
#include "coupling/dynamic.hpp"
#include "coupling/forcing.hpp"
#include "coupling/ground_state.hpp"
#include "coupling/progress.hpp"
#include "flow/integrator.hpp"
#include "ground/mesh.hpp"
#include "motion/anderson.hpp"
#include "motion/equilibrium.hpp"
#include "scene/scene.hpp"

#include <memory>
#include <string>
#include <vector>

namespace talus {

/// Counts and seconds of one host step.
struct StepCounts {
    int64_t exchanges = 0;
    int64_t exchange_iterations = 0;
    int64_t motion_iterations = 0;
    double seconds_flow = 0;
    double seconds_motion = 0;
};

enum class HappeningKind {
    saturated,
    ponding_started,
    ponding_ended,
    seepage_started,
    loss_of_equilibrium,
    motion_started,
    came_to_rest,
    settled,
    left_background,
    rain_ended
};

/// Something the host should know, noticed inside a step.
struct Happening {
    HappeningKind kind;
    double time;  ///< s
    Place place;  ///< m
    /// Of loss_of_equilibrium: largest displacement of the moving mass while it was watched, m. Of came_to_rest: volume that moved by more than a cell, m3.
    /// Of settled: 1 in equilibrium, 0 where none was found. Of left_background: volume taken out, m3.
    double value;
};

class Simulation {
public:
    /// Builds the ground and its initial state. Throws Error(invalid_scene) where there is none.
    Simulation(const Scene& scene, double tolerance, int32_t threads, bool stop_at_motion);

    /// Carries the state to `until` (s), or with stop_at_motion to where ground of the regime auto starts to move or comes to rest.
    /// False when `cancelled(fraction)` said so. Throws Error(not_converged) when a solver stops. In both
    /// cases the caller puts the state back with restore().
    bool advance(double until, const Cancelled& cancelled);

    /// Of ground that came to rest: what goes on from there quasi-statically, on a mesh under the surface as it lies now; its skeleton stands where no equilibrium
    /// was found. Empty where there is no such mesh: the ground then lies still, and no water moves in it.
    std::unique_ptr<Simulation> settle();
    [[nodiscard]] bool may_settle() const { return state_.rests && !state_.lies_still; }

    [[nodiscard]] GroundState save() const;
    void restore(const GroundState& state);

    /// To be told, once, that the rain series ended within the last advance.
    void note_rain_end();

    Forcing forcing;
    std::vector<Happening> happenings;  ///< of the last advance; the caller clears it
    StepCounts counts;                  ///< likewise

    [[nodiscard]] const GroundState& state() const { return state_; }
    [[nodiscard]] const Mesh& mesh() const { return mesh_; }
    [[nodiscard]] const Mesh& reference_mesh() const { return reference_mesh_; }
    [[nodiscard]] const FlowSystem* flow() const { return flow_.get(); }
    [[nodiscard]] FlowStatistics flow_statistics() const {
        return integrator_ ? past_statistics_ + integrator_->statistics() : past_statistics_;
    }
    [[nodiscard]] double water_now() const;  ///< m3, in the pores and ponded, from the pressures
    [[nodiscard]] double initial_water() const { return initial_water_; }
    [[nodiscard]] double least_factor_of_safety() const;  ///< 0: none known
    [[nodiscard]] const std::vector<double>& pore_stress() const {
        return point_pore_stress_;
    }  ///< per point, Pa; empty: rigid or dry
    [[nodiscard]] size_t motion_unknowns() const { return motion_unknowns_; }
    [[nodiscard]] const DynamicGround* dynamic() const { return dynamic_.get(); }  ///< nullptr: quasi-static

private:
    Simulation(const Simulation& moved, Deposit deposit);
    void start_motion(Place place);
    bool advance_dynamically(double until, const Cancelled& cancelled);
    void lie_still(double until);
    [[nodiscard]] double rain_at(double x, double time) const;  ///< m/s, 0 where no zone is

    struct FlowPath {  // of one advance: where it ends, and what was noticed on the way
        FlowState flow;
        FlowWatch watch;
        std::vector<Happening> noticed;
    };
    enum class Exchange { agreed, cancelled, disagreed, flow_stopped, equilibrium_lost, gave_way };

    // initial state (initial.cpp)
    void make_flow();
    void make_motion();
    std::vector<uint8_t> hold_nodes();
    [[nodiscard]] bool holds(const Boundary& boundary, const Facet& facet, size_t axis) const;
    void set_initial_flow();
    void find_steady_flow();
    [[nodiscard]] std::vector<double> steady_guess() const;
    void set_initial_stress();
    EquilibriumOutcome find_initial_stress(const Loads& loads);
    void make_dynamic(int32_t threads);

    // the way back (settle.cpp)
    void take_grains(const Simulation& moved, Deposit& deposit);
    void take_water(const Simulation& moved, const Deposit& deposit);
    void hold_water(double water);
    void take_stress(const Deposit& deposit);

    // the exchange (exchange.cpp)
    struct Settled {  // an exchange that is agreed on
        double first_disagreement = 0;
        bool jointly = false;
    };
    Exchange exchange(double duration, bool is_short, const Cancelled& cancelled);
    Exchange settle_in_turn(double duration, FlowPath& path, bool is_short, const Cancelled& cancelled,
                            Settled& settled);
    [[nodiscard]] static Exchange end_of(const EquilibriumOutcome& outcome);
    AdvanceResult advance_flow(double duration, FlowPath& path, const Cancelled& cancelled);
    [[nodiscard]] bool skeleton_moves() const { return equilibrium_ && !state_.equilibrium_lost; }
    [[nodiscard]] double shorter_exchange(double duration, double whole) const;
    void shorten_exchange(double duration, double whole, const std::string& problem);
    void lose_equilibrium();
    void set_flow_forcing(double duration);
    void hold_skeleton() const;
    void expect_skeleton(double duration);
    void expect_skeleton_at(double duration, std::span<const double> volume, std::span<const double> stress);
    void compare_pore_volumes(const FlowState& flow);
    [[nodiscard]] double agreement_pressures(size_t portion, double pressure, double found, double taken) const;
    void correct_expectation();
    // the two together (joint.cpp)
    class Water;
    [[nodiscard]] bool is_as_expected(double duration) const;
    Exchange creep_jointly(double duration, FlowPath& path, std::span<const double> from, int32_t most_steps,
                           const Cancelled& cancelled);
    Exchange go_on_jointly(double duration, FlowPath& path, const Cancelled& cancelled, Settled& settled);
    Exchange settle_jointly(double duration, FlowPath& path, bool is_short, const Cancelled& cancelled);
    void settle_beside(const FlowState& flow, double duration, int32_t most_creep_steps);
    [[nodiscard]] Loads loads() const {
        return {point_density_, point_pore_stress_, point_strength_, node_force_, prescribed_displacement_};
    }
    void accept(double duration, const FlowState& flow);
    EquilibriumOutcome find_equilibrium(const FlowState& flow, double until,
                                        int32_t most_creep_steps = Equilibrium::usual_creep_steps);
    // what passes between them (loads.cpp)
    void set_loads(const FlowState& flow, double until);
    void soften();
    [[nodiscard]] double porosity(size_t point) const;
    void refresh_geometry();
    void set_projection();
    void update_points();
    [[nodiscard]] std::vector<double> portion_saturation(const FlowState& flow) const;
    [[nodiscard]] static bool is_full(std::span<const double> pressure);
    void notice(double time, std::span<const double> pressure, FlowWatch& watch, std::vector<Happening>& noticed) const;
    [[nodiscard]] Place place_of(int32_t node) const;
    [[nodiscard]] Place place_of_largest_increment() const;

    const Scene& scene_;
    double tolerance_;
    int32_t threads_;
    bool stop_at_motion_;
    Mesh mesh_;
    Mesh reference_mesh_;
    GroundState state_;
    std::unique_ptr<FlowSystem> flow_;            // empty: dry
    std::unique_ptr<FlowIntegrator> integrator_;  // empty: dry
    std::unique_ptr<Equilibrium> equilibrium_;    // empty: rigid, or dynamic
    std::unique_ptr<DynamicGround> dynamic_;      // empty: quasi-static
    double initial_water_ = 0;
    FlowStatistics past_statistics_;  // of the simulation before it settled
    size_t motion_unknowns_ = 0;
    double agreement_pressure_ = 0;  // Pa: pore volumes agree where the difference moves the pressure by less
    struct GivenDisplacement {
        size_t freedom, boundary, component;
    };
    struct GivenTraction {
        size_t facet, boundary;
    };
    void add_traction(const GivenTraction& given, double time);
    void add_pond(const Facet& facet, std::span<const double> pressure);

    std::vector<double> softness_;             // per soil, 1/Pa: the fixed-stress split's
    std::vector<double> projection_softness_;  // per soil, 1/Pa: the pressure projection's
    std::vector<GivenDisplacement> given_displacements_;
    std::vector<GivenTraction> given_tractions_;

    // Of the exchange under way
    std::vector<double> portion_stress_, point_pressure_, point_saturation_;
    std::vector<double> start_stress_;  // per portion, Pa
    std::vector<double> end_stress_;    // per portion, Pa, as the flow found it
    std::vector<double> end_volume_;    // per portion, m3, as the skeleton is expected to have it
    std::vector<double> taken_volume_;  // per portion, m3, as the flow took it
    std::vector<double> found_volume_;  // per portion, m3, as the skeleton found it
    std::vector<double> correction_;    // per portion, Pa: of what is expected of the skeleton
    Anderson acceleration_{0};
    SparseMatrix joint_matrix_, storage_matrix_;             // the flow's
    std::unique_ptr<KluSolver> joint_solver_;                // empty: not needed yet
    std::vector<double> forecast_volume_, forecast_stress_;  // the first of end_volume_ and end_stress_
    double forecast_error_ = 0;  // largest difference of what the skeleton found and that, as that of the disagreement
    double disagreement_ = 0;    // largest difference of the two's pore volumes, over the one that is let stand
    std::vector<double> point_pore_stress_, point_density_, node_force_, prescribed_displacement_;
    std::vector<ShearStrength> point_strength_;
    std::vector<double> initial_volume_;  // per point, m3
    // Per point, where a soil of the regime auto softens: share of what that takes, and what it and the plastic strain were when the ground settled
    std::vector<double> lost_strength_, settled_lost_strength_, settled_plastic_strain_;
    std::vector<double> conductivity_factor_;  // per cell; empty: 1
    EquilibriumOutcome outcome_;
};

}  // namespace talus
