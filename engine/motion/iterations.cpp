// How the equilibrium is found: an elastic predictor, then the elastic stiffness as a fixed preconditioner with acceleration, then
// Newton with the consistent tangent and a line search, then creep in pseudo-time, which either arrives or proves that there is
// nowhere to arrive. Each is only tried when the one before it did not settle the matter.
#include "motion/equilibrium.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

namespace {

double dot(std::span<const double> a, std::span<const double> b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

double norm(std::span<const double> a) { return std::sqrt(dot(a, a)); }

}  // namespace

/// Stresses of the present increment, and the unbalanced forces; returns their norm.
double Equilibrium::unbalance() {
    std::fill(internal_.begin(), internal_.end(), 0.0);
    yielding_ = skeleton_.respond(increment_, internal_);
    set_residual();
    return norm(residual_);
}

double Equilibrium::unbalance_elastically() {
    std::fill(internal_.begin(), internal_.end(), 0.0);
    skeleton_.respond_elastically(increment_, internal_);
    yielding_ = 0;
    set_residual();
    return norm(residual_);
}

void Equilibrium::set_residual() {
    for (size_t i = 0; i < residual_.size(); ++i) {
        const auto freedom = static_cast<size_t>(equations_.freedom[i]);
        residual_[i] = external_[freedom] - internal_[freedom];
    }
}

double Equilibrium::relative_residual() {
    for (size_t i = 0; i < internal_.size(); ++i) reaction_[i] = equations_.number[i] < 0 ? internal_[i] - external_[i] : 0.0;
    const double unbalanced = norm(residual_);
    return unbalanced == 0 ? 0 : unbalanced / std::max(norm(external_), norm(reaction_));
}

/// Solves for a skeleton that does not yield, until the unbalanced force has fallen by the factor wanted, or below the tolerance.
void Equilibrium::predict(double wanted, EquilibriumOutcome& outcome) {
    constexpr int32_t most_solves = 20;
    const double start = unbalance_elastically();
    double unbalanced = start;
    for (int32_t k = 0; k < most_solves && unbalanced > wanted * start && relative_residual() > tolerance / 10; ++k) {
        solve_for_direction(elastic_, outcome);
        step_along(1);
        unbalanced = unbalance_elastically();
    }
}

/// Iterates with the elastic stiffness. Leaves the best iterate, and gives up, when it has not improved enough for a while.
bool Equilibrium::accelerate(EquilibriumOutcome& outcome) {
    constexpr int32_t patience = 10;
    constexpr double improvement = 0.5;
    double unbalanced = norm(residual_), least = unbalanced, milestone = unbalanced;
    best_ = increment_;
    acceleration_.restart();
    for (int32_t k = 0, since = 0; since < patience; ++k, ++since) {
        if (relative_residual() <= tolerance) return true;
        solve_for_direction(elastic_, outcome);
        acceleration_.accelerate(direction_);
        step_along(1);
        unbalanced = unbalance();
        if (unbalanced < least) {
            least = unbalanced;
            best_ = increment_;
        }
        if (unbalanced < improvement * milestone) {
            milestone = unbalanced;
            since = 0;
        }
    }
    increment_ = best_;
    unbalance();
    return relative_residual() <= tolerance;
}

bool Equilibrium::newton(EquilibriumOutcome& outcome) {
    constexpr int32_t most_iterations = 20;
    double unbalanced = norm(residual_);
    for (int32_t k = 0; k < most_iterations; ++k) {
        if (relative_residual() <= tolerance) return true;
        if (!factorise_tangent(0, outcome)) return false;
        solve_for_direction(tangent_, outcome);
        if (!line_search(unbalanced)) return false;
    }
    return relative_residual() <= tolerance;
}

/// Goes along the direction as far as the unbalanced force falls enough; false, and back at the start, where it does not.
bool Equilibrium::line_search(double& unbalanced) {
    constexpr double shortest = 1.0 / 8;
    constexpr double enough = 0.1;
    best_ = increment_;
    const double before = unbalanced;
    for (double length = 1; length >= shortest; length /= 2) {
        increment_ = best_;
        step_along(length);
        unbalanced = unbalance();
        if (unbalanced < (1 - enough * length) * before) return true;
    }
    increment_ = best_;
    unbalanced = unbalance();
    return false;
}

/// Implicit steps of a skeleton with viscosity, viscosity * elastic stiffness * velocity: each solves
/// (tangent + viscosity * elastic stiffness) step = unbalanced force. The viscosity falls with the unbalanced force, which ends in
/// Newton's method where a balance exists (pseudo-transient continuation; Kelley & Keyes, SIAM J. Numer. Anal. 35, 1998), and
/// ends in the steady motion of a mechanism where there is none.
bool Equilibrium::creep(EquilibriumOutcome& outcome) {
    constexpr int32_t most_steps = 200;
    constexpr double first_viscosity = 0.1, largest_viscosity = 1e3;
    constexpr double most_growth = 2;  // of the unbalanced force over a step that counts
    CollapseWatch collapse(elastic_displacement(outcome));
    double unbalanced = unbalance();
    double viscosity = first_viscosity;
    std::fill(last_direction_.begin(), last_direction_.end(), 0.0);
    for (int32_t k = 0; k < most_steps && viscosity < largest_viscosity; ++k) {
        if (relative_residual() <= tolerance) return true;
        if (!factorise_tangent(viscosity, outcome)) {
            viscosity *= 4;
            continue;
        }
        best_ = increment_;
        solve_for_direction(tangent_, outcome);
        ++outcome.pseudo_steps;
        step_along(1);
        const double after = unbalance();
        if (!(after <= most_growth * unbalanced)) {
            increment_ = best_;
            unbalance();
            viscosity *= 4;
            continue;
        }
        const bool proved = watch(collapse, last_direction_);
        outcome.collapse = collapse.evidence();
        if (proved) {
            outcome.status = EquilibriumStatus::no_equilibrium;
            std::fill(best_.begin(), best_.end(), 0.0);
            for (size_t i = 0; i < direction_.size(); ++i) best_[static_cast<size_t>(equations_.freedom[i])] = direction_[i];
            locate_mechanism(kinematics_, points_, best_, outcome.collapse);
            return false;
        }
        viscosity *= 0.8 * std::clamp(after / unbalanced, 0.1, 1.0);
        unbalanced = after;
        last_direction_ = direction_;
    }
    return relative_residual() <= tolerance;
}

/// Largest displacement that the whole loads would give the skeleton if it did not yield, m.
double Equilibrium::elastic_displacement(EquilibriumOutcome& outcome) {
    for (size_t i = 0; i < direction_.size(); ++i) direction_[i] = external_[static_cast<size_t>(equations_.freedom[i])];
    elastic_.solver->solve(elastic_.matrix, direction_);
    ++outcome.iterations;
    double largest = 0;
    for (const double u : direction_) largest = std::max(largest, std::abs(u));
    return largest;
}

bool Equilibrium::watch(CollapseWatch& watch, std::span<const double> last_direction) const {
    double loads = 0, surplus = dot(residual_, direction_), displacement = 0;
    for (size_t i = 0; i < direction_.size(); ++i) {
        const auto freedom = static_cast<size_t>(equations_.freedom[i]);
        loads += external_[freedom] * direction_[i];
        displacement = std::max(displacement, std::abs(increment_[freedom]));
    }
    const double lengths = norm(direction_) * norm(last_direction);
    return watch.add(displacement, loads > 0 ? surplus / loads : 0, lengths > 0 ? dot(direction_, last_direction) / lengths : 1);
}

bool Equilibrium::factorise_tangent(double viscosity, EquilibriumOutcome& outcome) {
    stiffness_.assemble_tangent(points_, skeleton_, viscosity, tangent_.matrix);
    ++outcome.factorisations;
    return tangent_.solver->factorise(tangent_.matrix);
}

void Equilibrium::solve_for_direction(Factor& factor, EquilibriumOutcome& outcome) {
    direction_ = residual_;
    factor.solver->solve(factor.matrix, direction_);
    ++outcome.iterations;
}

void Equilibrium::step_along(double length) {
    for (size_t i = 0; i < direction_.size(); ++i) increment_[static_cast<size_t>(equations_.freedom[i])] += length * direction_[i];
}

}  // namespace talus
