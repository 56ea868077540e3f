// Quasi-static equilibrium of the skeleton on the fitted mesh: integral of B^T (skeleton stress - pore stress) = weight + forces.
// Updated Lagrangian: an increment is solved on the last accepted geometry, and accept() moves nodes and points by it.
#pragma once

#include "ground/mesh.hpp"
#include "motion/anderson.hpp"
#include "motion/cell_kinematics.hpp"
#include "motion/collapse.hpp"
#include "motion/companion.hpp"
#include "motion/loads.hpp"
#include "motion/skeleton.hpp"
#include "motion/stiffness.hpp"
#include "points/points.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace talus {

enum class EquilibriumStatus {
    converged,
    no_equilibrium,  ///< proved: the loads move the ground in a steady mechanism that they keep driving
    not_converged,   ///< the solver stopped; says nothing on the ground
};

struct EquilibriumOutcome {
    EquilibriumStatus status = EquilibriumStatus::not_converged;
    int32_t iterations = 0;        ///< linear solves
    int32_t factorisations = 0;    ///< of tangents
    int32_t pseudo_steps = 0;      ///< of these iterations, steps in pseudo-time
    int32_t yielding = 0;          ///< points on the yield surface
    double residual = 0;           ///< norm of the unbalanced force over the norm of the loads, -
    double largest_increment = 0;  ///< m
    CollapseEvidence collapse;     ///< of no_equilibrium; of not_converged what was seen last
};

class Equilibrium {
public:
    /// The unbalanced force that is let stand, over the norm of the loads: the larger of the external forces (weight, pore
    /// stress, boundary forces) and the reactions; more only within what displacements are rounded by.
    static constexpr double tolerance = 1e-7;
    static constexpr int32_t usual_creep_steps = 200;        ///< after which it is given up
    static constexpr double largest_first_viscosity = 0.01;  ///< of creep, over the elastic stiffness

    /// `solids`: one a soil. `prescribed`: nodes x dimension, non-zero where the displacement is given. `gravity` in m/s2,
    /// downwards. Mesh and points are the caller's; their present state is the accepted one, without displacement.
    /// Throws Error(invalid_scene) where a triangle has too many neighbours.
    Equilibrium(Mesh& mesh, Points& points, std::vector<Solid> solids, std::span<const uint8_t> prescribed,
                double gravity);

    /// Finds the displacement increment from the accepted state that balances the loads. The points' stress, strain, plastic
    /// strain and mobilised strength are a trial state until accept() or reject(). Starts from the increment of the last solve
    /// where that was neither accepted nor rejected: loads that hardly differ are then soon balanced, and as far as they differ, so that
    /// the answer follows them however little that is. `wanted`: the unbalanced force aimed at, where round-off lets it be had. After so
    /// many steps of creep it is given up.
    EquilibriumOutcome solve(const Loads& loads, double wanted = tolerance,
                             int32_t most_creep_steps = usual_creep_steps);

    /// Creeps from an increment (nodes x dimension, m) to where the skeleton is in equilibrium with what loads it and that agrees.
    /// `expected`: how far some node may go in all, m, for the first step's length; 0: unknown.
    EquilibriumOutcome solve_with(Companion& companion, std::span<const double> increment, double expected,
                                  int32_t most_creep_steps);

    /// As solve() for a skeleton that does not yield: gravity turned on elastically.
    EquilibriumOutcome solve_elastically(const Loads& loads);

    /// Moves nodes and points by the increment, turns the stresses with it, updates the volumes.
    void accept();

    /// Keeps the stress, and forgets the increment, its strain and plastic strain: the ground takes its stress where it lies.
    void accept_stress();

    /// Back to the last accepted state, bit for bit.
    void reject();

    /// After mesh and points were put back to a state that had been accepted with this displacement (nodes x dimension, m): the
    /// next solve goes as it went from there.
    void restore(std::span<const double> displacement);

    /// Nodes x dimension. `increment` is that of the last solve; `reaction` (N per m) is zero where not prescribed.
    [[nodiscard]] std::span<const double> displacement() const { return displacement_; }
    [[nodiscard]] std::span<const double> increment() const { return increment_; }
    [[nodiscard]] std::span<const double> reaction() const { return reaction_; }

    /// Volumetric strain increment of a cell since the accepted state, the mean one that its stress follows, -.
    [[nodiscard]] double volumetric_increment(int32_t cell) const { return volumetric_strain(cell, increment_); }
    /// The same under any displacement (nodes x dimension, m).
    [[nodiscard]] double volumetric_strain(int32_t cell, std::span<const double> displacement) const;

    /// Within Companion::guide(): the change of the displacement (nodes x dimension, m) under loads that hardly differ, to first order.
    std::span<const double> answer(const Loads& loads);

    /// Whether the ground, without yield, comes back from a nudge: it does not where its stress outweighs its stiffness.
    [[nodiscard]] bool is_stable(const Loads& loads) const;

    [[nodiscard]] double least_factor_of_safety() const { return skeleton_.least_factor_of_safety(); }

private:
    struct Factor {
        SparseMatrix matrix;
        std::unique_ptr<KluSolver> solver;
    };

    // equilibrium.cpp
    void start(const Loads& loads);
    void add_body_forces(const Loads& loads, std::span<double> external) const;
    void update_geometry();
    void forget_increment();
    [[nodiscard]] double largest_displacement_gradient() const;
    void finish(EquilibriumOutcome& outcome);

    // iterations.cpp
    double unbalance();
    double unbalance_elastically();
    void set_residual();
    double relative_residual();
    [[nodiscard]] bool is_within_rounding() const;
    void predict(double wanted, EquilibriumOutcome& outcome);
    bool accelerate(EquilibriumOutcome& outcome);
    bool creep(double viscosity, int32_t most_steps, EquilibriumOutcome& outcome, Companion* companion = nullptr);
    double viscosity_for(double expected, Companion& companion, EquilibriumOutcome& outcome);
    std::optional<double> follow_direction(Companion* companion);
    void guide(Companion& companion);
    bool follow(Companion* companion, double length);
    void find_mechanism(CollapseEvidence& evidence);
    double elastic_displacement(EquilibriumOutcome& outcome);
    bool watch(CollapseWatch& watch, std::span<const double> last_direction) const;
    bool factorise_tangent(double viscosity, EquilibriumOutcome& outcome);
    void solve_for_direction(Factor& factor, EquilibriumOutcome& outcome);
    void step_along(double length);

    Mesh& mesh_;
    Points& points_;
    double gravity_;
    CellKinematics kinematics_;
    Equations equations_;
    Skeleton skeleton_;
    Stiffness stiffness_;
    Factor elastic_, tangent_;
    std::vector<double> undeformed_stiffness_;  // values of the elastic matrix
    bool was_deformed_ = false;                 // at the last update: elastic_ is not the undeformed one
    bool is_at_start_ = true;                   // no increment to start from

    std::vector<double> displacement_, increment_, reaction_;    // nodes x dimension
    std::vector<double> external_, internal_, start_;            // nodes x dimension
    std::vector<double> residual_, direction_, last_direction_;  // equations
    Anderson acceleration_;
    double wanted_ = tolerance;                    // relative residual that the present solve aims at
    double left_residual_ = 0;                     // that the last solve left
    std::vector<double> answer_, strength_force_;  // nodes x dimension
    int32_t yielding_ = 0;
};

}  // namespace talus
