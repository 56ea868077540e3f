// How the equilibrium is found: an elastic predictor; then iterations with the elastic stiffness, accelerated, which suffice while
// the yielding ground is held by ground that does not yield; then creep in pseudo-time with the consistent tangent, which ends in
// Newton's method where there is a balance, and otherwise proves that there is none.
//
// Plain Newton with a search on the norm of the unbalanced force is left out: near a factor of one it stops in local minima, cycles
// between the planes of the yield surface, and where dilation differs from friction (equilibria need not be unique then) it may jump
// to another equilibrium than the one that the ground comes to.
#include "linear/norm.hpp"
#include "motion/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talus {

namespace {

/// A part of a step and what is left there of the work that it began with.
struct Reached {
    double length, left;
};

double between(const Reached& near, const Reached& far) {
    const double share = far.left > 0 ? 0.5 : std::clamp(near.left / (near.left - far.left), 0.1, 0.7);
    return near.length + share * (far.length - near.length);
}

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
    for (size_t i = 0; i < internal_.size(); ++i)
        reaction_[i] = equations_.number[i] < 0 ? internal_[i] - external_[i] : 0.0;
    const double unbalanced = norm(residual_);
    return unbalanced == 0 ? 0 : unbalanced / std::max(norm(external_), norm(reaction_));
}

/// Whether the loads are balanced as well as displacements can: asked last, when nothing brings them nearer. Stiff ground on soft ground moves far and strains little: there the last digit of
/// the displacement may be more of a force than the tolerance lets stand, at most eps |K| |u| (Oettli & Prager, Numer. Math. 6, 1964).
bool Equilibrium::is_within_rounding() const {
    const SparseMatrix& matrix = elastic_.matrix;
    std::vector<double> force(residual_.size(), 0.0);
    for (size_t j = 0; j < force.size(); ++j) {
        const double displacement = std::abs(increment_[static_cast<size_t>(equations_.freedom[j])]);
        for (auto k = static_cast<size_t>(matrix.column_start[j]); k < static_cast<size_t>(matrix.column_start[j + 1]);
             ++k)
            force[static_cast<size_t>(matrix.row[k])] += std::abs(matrix.value[k]) * displacement;
    }
    return norm(residual_) <= std::numeric_limits<double>::epsilon() * norm(force);
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

/// Iterates with the elastic stiffness. False, and back at the start, where the unbalanced force has not halved for a while.
bool Equilibrium::accelerate(EquilibriumOutcome& outcome) {
    constexpr int32_t patience = 10;
    double milestone = norm(residual_);
    start_ = increment_;
    acceleration_.restart();
    for (int32_t since = 0; since < patience; ++since) {
        if (relative_residual() <= wanted_) return true;
        solve_for_direction(elastic_, outcome);
        acceleration_.accelerate(direction_);
        step_along(1);
        const double unbalanced = unbalance();
        if (unbalanced < milestone / 2) {
            milestone = unbalanced;
            since = 0;
        }
    }
    if (relative_residual() <= tolerance) return true;
    increment_ = start_;
    unbalance();
    return false;
}

/// Implicit steps of a skeleton with viscosity, viscosity * elastic stiffness * velocity: each solves
/// (tangent + viscosity * elastic stiffness) step = unbalanced force. The viscosity falls with the unbalanced force, which ends in
/// Newton's method where a balance exists (pseudo-transient continuation; Kelley & Keyes, SIAM J. Numer. Anal. 35, 1998), and in
/// the steady motion of a mechanism where there is none. With a companion it is both that creep. True: arrived.
bool Equilibrium::creep(double viscosity, int32_t most_steps, EquilibriumOutcome& outcome, Companion* companion) {
    const auto agrees = [companion] { return companion == nullptr || companion->agrees(); };
    constexpr double largest_viscosity =
        1e6;  // water that softens ground by its pressure may be 1e5 times as stiff as it
    constexpr double smallest_ratio = 0.1, steady_ratio = 0.8;
    CollapseWatch collapse(elastic_displacement(outcome));
    double unbalanced = norm(residual_);
    std::fill(last_direction_.begin(), last_direction_.end(), 0.0);
    for (int32_t k = 0; k < most_steps && viscosity < largest_viscosity; ++k) {
        if (relative_residual() <= wanted_ && agrees()) return true;
        std::optional<double> length = 0.0;
        if (factorise_tangent(viscosity, outcome)) {
            solve_for_direction(tangent_, outcome);
            ++outcome.pseudo_steps;
            if (companion != nullptr) guide(*companion);
            length = follow_direction(companion);
        }
        if (!length) return false;
        if (*length == 0) {
            viscosity *= 4;
            continue;
        }
        const bool gains = norm(residual_) < unbalanced / 2;
        if (!gains && relative_residual() <= tolerance && agrees()) return true;
        const double ratio = std::clamp(norm(residual_) / unbalanced, smallest_ratio, 1.0);
        unbalanced = norm(residual_);
        viscosity *= *length < 1 ? 2 : steady_ratio * ratio;
        const bool is_proved = watch(collapse, last_direction_) && agrees();
        outcome.collapse = collapse.evidence();
        if (is_proved) {
            outcome.status = EquilibriumStatus::no_equilibrium;
            find_mechanism(outcome.collapse);
            return false;
        }
        last_direction_ = direction_;
    }
    return (relative_residual() <= tolerance || is_within_rounding()) && agrees();
}

/// With which the first step goes half as far as is expected. With the largest, ground that keeps slipping spends most of its steps on
/// getting under way.
double Equilibrium::viscosity_for(double expected, Companion& companion, EquilibriumOutcome& outcome) {
    constexpr double least = 1e-4, share = 0.5;
    if (expected <= 0 || !factorise_tangent(largest_first_viscosity, outcome)) return largest_first_viscosity;
    solve_for_direction(tangent_, outcome);
    guide(companion);
    return largest_first_viscosity * std::clamp(largest(direction_) / (share * expected), least, 1.0);
}

/// Goes along the direction, which is cut to the part gone, until the unbalanced force does hardly less work on it than at the start
/// with the sign turned, or more: farther, the linear step would leave the path of the creeping ground. Where that lies beyond a kink
/// (ground that comes into contact again resists up to 1e4 times as much as before), a cut that stops well before the kink does next to no
/// work and leaves the next step the same kink. Returns the part gone; 0, and back at the start, where the direction is none that the
/// unbalanced force drives; nothing where the companion's answer is rougher than what is left to be gained.
std::optional<double> Equilibrium::follow_direction(Companion* companion) {
    constexpr double most_overshoot = 0.5, most_growth = 1.1;
    constexpr double most_left = 0.9;  // after a cut
    constexpr int32_t most_cuts = 6;
    constexpr double next_to_none = 0.01, smooth = 0.5;
    const auto work = [&] { return dot(residual_, direction_) + (companion != nullptr ? companion->power() : 0.0); };
    const auto go = [&](double length) {
        increment_ = start_;
        step_along(length);
        return follow(companion, length);
    };
    const double power = work();
    if (!(power > 0)) return 0.0;
    start_ = increment_;
    Reached near{0, 1}, far{};
    double length = 1;
    for (int32_t k = 0;; ++k) {
        const bool follows = go(length);
        const double left = follows ? work() / power : -1.0;  // as beyond the balance: nearer
        const bool is_on_path = left >= -most_overshoot && left <= most_growth;
        if (is_on_path && (k == 0 || k == most_cuts || left <= most_left)) break;
        if (k == most_cuts) {
            if (companion != nullptr && follows && length < next_to_none && std::abs(left - 1) > smooth) return {};
            if (follows && near.length == 0) break;
            length = near.length;
            go(length);
            break;
        }
        (is_on_path ? near : far) = {length, left};
        length = between(near, far);
    }
    for (double& d : direction_) d *= length;
    return length;
}

/// Unbalanced forces where the companion has gone too. False where it cannot.
bool Equilibrium::follow(Companion* companion, double length) {
    if (companion != nullptr) {
        const std::optional<Loads> loads = companion->follow(length);
        if (!loads) return false;
        start(*loads);
    }
    unbalance();
    return true;
}

void Equilibrium::guide(Companion& companion) {
    skeleton_.linearise_strength(increment_);
    std::fill(start_.begin(), start_.end(), 0.0);
    for (size_t i = 0; i < direction_.size(); ++i) start_[static_cast<size_t>(equations_.freedom[i])] = direction_[i];
    companion.guide(start_);
    for (size_t i = 0; i < direction_.size(); ++i) direction_[i] = start_[static_cast<size_t>(equations_.freedom[i])];
}

void Equilibrium::find_mechanism(CollapseEvidence& evidence) {
    std::fill(start_.begin(), start_.end(), 0.0);
    for (size_t i = 0; i < direction_.size(); ++i) start_[static_cast<size_t>(equations_.freedom[i])] = direction_[i];
    locate_mechanism(kinematics_, points_, start_, evidence);
}

/// Largest displacement that the whole loads would give the skeleton if it did not yield, m; times the contrast of its moduli, since
/// the stiff ground, where it yields, may leave the loads to the soft.
double Equilibrium::elastic_displacement(EquilibriumOutcome& outcome) {
    for (size_t i = 0; i < direction_.size(); ++i)
        direction_[i] = external_[static_cast<size_t>(equations_.freedom[i])];
    elastic_.solver->solve(elastic_.matrix, direction_);
    ++outcome.iterations;
    return largest(direction_) * skeleton_.stiffness_contrast();
}

bool Equilibrium::watch(CollapseWatch& watch, std::span<const double> last_direction) const {
    double loads = 0, surplus = dot(residual_, direction_), displacement = 0;
    for (size_t i = 0; i < direction_.size(); ++i) {
        const auto freedom = static_cast<size_t>(equations_.freedom[i]);
        loads += external_[freedom] * direction_[i];
        displacement = std::max(displacement, std::abs(increment_[freedom]));
    }
    const double lengths = norm(direction_) * norm(last_direction);
    return watch.add(displacement, loads > 0 ? surplus / loads : 0,
                     lengths > 0 ? dot(direction_, last_direction) / lengths : 1);
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
    for (size_t i = 0; i < direction_.size(); ++i)
        increment_[static_cast<size_t>(equations_.freedom[i])] += length * direction_[i];
}

}  // namespace talus
