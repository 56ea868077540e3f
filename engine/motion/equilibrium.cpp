#include "motion/equilibrium.hpp"

#include "linear/norm.hpp"
#include "motion/stability.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace talus {

Equilibrium::Equilibrium(Mesh& mesh, Points& points, std::vector<Solid> solids, std::span<const uint8_t> prescribed,
                         double gravity)
    : mesh_(mesh),
      points_(points),
      gravity_(gravity),
      kinematics_(mesh, points),
      equations_(prescribed),
      skeleton_(kinematics_, points, std::move(solids)),
      stiffness_(kinematics_, equations_, mesh.dimension),
      acceleration_(equations_.freedom.size()) {
    const size_t freedoms = mesh.position.size();
    for (auto* field : {&displacement_, &increment_, &reaction_, &external_, &internal_, &start_, &strength_force_})
        field->assign(freedoms, 0.0);
    for (auto* field : {&residual_, &direction_, &last_direction_}) field->assign(equations_.freedom.size(), 0.0);
    if (equations_.count() == 0) return;  // every displacement is given: nothing to solve for
    for (Factor* factor : {&elastic_, &tangent_}) {
        factor->matrix = stiffness_.matrix();
        factor->solver = std::make_unique<KluSolver>(factor->matrix);
    }
    stiffness_.assemble_elastic(points_, skeleton_, elastic_.matrix);
    undeformed_stiffness_ = elastic_.matrix.value;
    elastic_.solver->factorise(elastic_.matrix);
}

EquilibriumOutcome Equilibrium::solve(const Loads& loads, double wanted, int32_t most_creep_steps) {
    constexpr double worth_predicting = 1e-2;
    constexpr double reduction = 0.1;  // of what a change of the loads unbalances
    constexpr double round_off = 1e-13;
    EquilibriumOutcome outcome;
    start(loads);
    const bool starts_afresh = is_at_start_;
    is_at_start_ = false;
    unbalance();
    const double unbalanced = relative_residual();
    const bool follows =
        !starts_afresh && unbalanced > left_residual_;  // loads that the last ones' answer does not balance
    wanted_ = follows ? std::min(wanted, std::max(reduction * unbalanced, round_off)) : wanted;
    if (unbalanced > wanted_) {
        if (starts_afresh) {
            predict(worth_predicting, outcome);
            unbalance();
        }
        if (!accelerate(outcome)) creep(largest_first_viscosity, most_creep_steps, outcome);
    }
    finish(outcome);
    return outcome;
}

EquilibriumOutcome Equilibrium::solve_with(Companion& companion, std::span<const double> increment, double expected,
                                           int32_t most_creep_steps) {
    EquilibriumOutcome outcome;
    reject();
    std::copy(increment.begin(), increment.end(), increment_.begin());
    is_at_start_ = false;
    wanted_ = tolerance;
    if (!follow(&companion, 0)) return outcome;
    const bool is_balanced = relative_residual() <= wanted_ && companion.agrees();
    if (!is_balanced) creep(viscosity_for(expected, companion, outcome), most_creep_steps, outcome, &companion);
    finish(outcome);
    if (outcome.status == EquilibriumStatus::converged && !companion.agrees())
        outcome.status = EquilibriumStatus::not_converged;
    return outcome;
}

EquilibriumOutcome Equilibrium::solve_elastically(const Loads& loads) {
    EquilibriumOutcome outcome;
    start(loads);
    predict(0, outcome);
    finish(outcome);
    return outcome;
}

void Equilibrium::start(const Loads& loads) {
    skeleton_.revert();
    skeleton_.set_strength(loads.strength);
    std::copy(loads.force.begin(), loads.force.end(), external_.begin());
    add_body_forces(loads, external_);
    for (size_t i = 0; i < increment_.size(); ++i) {
        if (equations_.number[i] < 0) increment_[i] = loads.prescribed[i];
    }
}

void Equilibrium::add_body_forces(const Loads& loads, std::span<double> external) const {
    for_each_block(kinematics_.blocks(), [&](auto shape, const CellBlock& block) {
        using Shape = decltype(shape);
        for (const int32_t c : block.cells) {
            const auto first = static_cast<size_t>(points_.cell_start[static_cast<size_t>(c)]);
            const auto stencil = kinematics_.stencil(c);
            double pore = 0;
            for (size_t i = 0; i < Shape::points; ++i) {
                const double volume = points_.volume[first + i];
                const double weight = loads.density[first + i] * gravity_ * volume;
                const auto value = Shape::values(Shape::point[i]);
                const auto g = kinematics_.gradient<Shape>(c, i);
                pore += loads.pore_stress[first + i] * volume;
                for (size_t a = 0; a < Shape::nodes; ++a) {
                    const size_t up = static_cast<size_t>(stencil[a]) * Shape::dimension + Shape::dimension - 1;
                    external[up] -= value[a] * weight;
                    if constexpr (Shape::dimension == 1)
                        external[up] += loads.pore_stress[first + i] * volume * g[a][0];
                }
            }
            if constexpr (Shape::dimension == 2) {
                const auto b = kinematics_.dilatation(c);
                for (size_t a = 0; a < stencil.size(); ++a) {
                    external[2 * static_cast<size_t>(stencil[a])] += pore * b[2 * a];
                    external[2 * static_cast<size_t>(stencil[a]) + 1] += pore * b[2 * a + 1];
                }
            }
        }
    });
}

void Equilibrium::finish(EquilibriumOutcome& outcome) {
    skeleton_.complete(increment_);
    outcome.yielding = yielding_;
    outcome.residual = left_residual_ = relative_residual();
    if (outcome.residual <= tolerance || is_within_rounding()) outcome.status = EquilibriumStatus::converged;
    outcome.largest_increment = largest(increment_);
}

void Equilibrium::accept() {
    skeleton_.keep_moved(increment_);
    for_each_block(kinematics_.blocks(), [&](auto shape, const CellBlock& block) {
        using Shape = decltype(shape);
        constexpr size_t dimension = Shape::dimension;
        for (const int32_t c : block.cells) {
            const auto first = static_cast<size_t>(points_.cell_start[static_cast<size_t>(c)]);
            const auto u = gather_increment<Shape>(kinematics_.stencil(c), increment_.data());
            for (size_t i = 0; i < Shape::points; ++i) {
                const size_t p = first + i;
                const auto gradient = displacement_gradient<Shape>(kinematics_.gradient<Shape>(c, i), u);
                const auto value = Shape::values(Shape::point[i]);
                points_.volume[p] *= (Eigen::Matrix2d::Identity() + gradient).determinant();
                for (size_t k = 0; k < dimension; ++k) {
                    double moved = 0;
                    for (size_t a = 0; a < Shape::nodes; ++a) moved += value[a] * u[a][k];
                    points_.position[p * dimension + k] += moved;
                    points_.displacement[p * dimension + k] += moved;
                }
            }
        }
    });
    for (size_t i = 0; i < increment_.size(); ++i) {
        mesh_.position[i] += increment_[i];
        displacement_[i] += increment_[i];
    }
    forget_increment();
    update_geometry();
}

/// The elastic stiffness serves as predictor and preconditioner. It is that of the undeformed ground until the ground is much
/// deformed: a rule on the state alone, so that a restored run goes on with the same bits.
void Equilibrium::update_geometry() {
    constexpr double much = 0.05;
    kinematics_.update(mesh_, points_);
    const bool is_deformed = largest_displacement_gradient() > much;
    if (equations_.count() == 0 || (!is_deformed && !was_deformed_)) return;
    if (is_deformed) {
        stiffness_.assemble_elastic(points_, skeleton_, elastic_.matrix);
    } else {
        elastic_.matrix.value = undeformed_stiffness_;
    }
    elastic_.solver->factorise(elastic_.matrix);
    was_deformed_ = is_deformed;
}

double Equilibrium::largest_displacement_gradient() const {
    double largest = 0;
    for_each_block(kinematics_.blocks(), [&](auto shape, const CellBlock& block) {
        using Shape = decltype(shape);
        for (const int32_t c : block.cells) {
            const auto u = gather_increment<Shape>(kinematics_.stencil(c), displacement_.data());
            for (size_t i = 0; i < Shape::points; ++i) {
                const auto gradient = displacement_gradient<Shape>(kinematics_.gradient<Shape>(c, i), u);
                largest = std::max(largest, gradient.cwiseAbs().maxCoeff());
            }
        }
    });
    return largest;
}

void Equilibrium::accept_stress() {
    std::fill(points_.strain.begin(), points_.strain.end(), 0.0);
    std::fill(points_.plastic_strain.begin(), points_.plastic_strain.end(), 0.0);
    skeleton_.keep();
    forget_increment();
}

void Equilibrium::reject() {
    skeleton_.revert();
    forget_increment();
}

void Equilibrium::restore(std::span<const double> displacement) {
    skeleton_.keep();
    forget_increment();
    displacement_.assign(displacement.begin(), displacement.end());
    update_geometry();
}

void Equilibrium::forget_increment() {
    std::fill(increment_.begin(), increment_.end(), 0.0);
    is_at_start_ = true;
}

double Equilibrium::volumetric_strain(int32_t cell, std::span<const double> displacement) const {
    if (mesh_.dimension == 2) return mean_dilatation<Quad4>(kinematics_, cell, displacement.data());
    const auto u = gather_increment<Line2>(kinematics_.stencil(cell), displacement.data());
    return displacement_gradient<Line2>(kinematics_.gradient<Line2>(cell, 0), u)(1, 1);
}

bool Equilibrium::is_stable(const Loads& loads) const {
    if (mesh_.dimension == 1 || equations_.count() == 0) return true;
    return talus::is_stable(kinematics_, points_, loads.pore_stress, equations_.number, elastic_.matrix);
}

std::span<const double> Equilibrium::answer(const Loads& loads) {
    std::fill(strength_force_.begin(), strength_force_.end(), 0.0);
    skeleton_.add_strength_force(loads.strength, strength_force_);
    answer_.assign(loads.force.begin(), loads.force.end());
    add_body_forces(loads, answer_);
    for (size_t i = 0; i < direction_.size(); ++i) {
        const auto freedom = static_cast<size_t>(equations_.freedom[i]);
        direction_[i] = answer_[freedom] - external_[freedom] - strength_force_[freedom];
    }
    tangent_.solver->solve(tangent_.matrix, direction_);
    std::fill(answer_.begin(), answer_.end(), 0.0);
    for (size_t i = 0; i < direction_.size(); ++i) answer_[static_cast<size_t>(equations_.freedom[i])] = direction_[i];
    return answer_;
}

}  // namespace talus
