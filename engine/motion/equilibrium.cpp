#include "motion/equilibrium.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace talus {

namespace {

double norm(std::span<const double> v) {
    double sum = 0;
    for (const double x : v) sum += x * x;
    return std::sqrt(sum);
}

}  // namespace

Equilibrium::Equilibrium(Mesh& mesh, Points& points, std::vector<Solid> solids, std::span<const uint8_t> prescribed, double gravity)
    : mesh_(mesh),
      points_(points),
      gravity_(gravity),
      kinematics_(mesh, points),
      equations_(prescribed),
      skeleton_(kinematics_, points, std::move(solids)),
      stiffness_(kinematics_, equations_, mesh.dimension) {
    const size_t freedoms = mesh.position.size();
    for (auto* field : {&displacement_, &increment_, &reaction_, &external_, &internal_, &search_start_}) field->assign(freedoms, 0.0);
    for (auto* field : {&residual_, &direction_}) field->assign(equations_.freedom.size(), 0.0);
    for (Factor* factor : {&elastic_, &tangent_}) {
        factor->matrix = stiffness_.matrix();
        factor->solver = std::make_unique<KluSolver>(factor->matrix);
    }
}

EquilibriumOutcome Equilibrium::solve(const Loads& loads) {
    EquilibriumOutcome outcome;
    start(loads);
    unbalance();
    if (residual_norm() > tolerance) {
        predict(outcome);
        newton(outcome);
    }
    outcome.residual = residual_norm();
    if (outcome.residual <= tolerance) outcome.status = EquilibriumStatus::converged;
    finish(outcome);
    return outcome;
}

EquilibriumOutcome Equilibrium::solve_elastically(const Loads& loads) {
    EquilibriumOutcome outcome;
    start(loads);
    predict(outcome);
    unbalance_elastic();
    outcome.residual = residual_norm();
    if (outcome.residual <= tolerance) outcome.status = EquilibriumStatus::converged;
    finish(outcome);
    return outcome;
}

void Equilibrium::start(const Loads& loads) {
    skeleton_.revert();
    skeleton_.set_strength(loads.strength);
    set_external_force(loads);
    std::copy(loads.prescribed.begin(), loads.prescribed.end(), increment_.begin());
    for (const int32_t freedom : equations_.freedom) increment_[static_cast<size_t>(freedom)] = 0;
}

void Equilibrium::set_external_force(const Loads& loads) {
    std::copy(loads.force.begin(), loads.force.end(), external_.begin());
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
                    external_[up] -= value[a] * weight;
                    if constexpr (Shape::dimension == 1) external_[up] += loads.pore_stress[first + i] * volume * g[a][0];
                }
            }
            if constexpr (Shape::dimension == 2) {
                const auto b = kinematics_.dilatation(c);
                for (size_t a = 0; a < stencil.size(); ++a) {
                    external_[2 * static_cast<size_t>(stencil[a])] += pore * b[2 * a];
                    external_[2 * static_cast<size_t>(stencil[a]) + 1] += pore * b[2 * a + 1];
                }
            }
        }
    });
}

/// Stresses of the present increment, and the unbalanced forces; returns their norm.
double Equilibrium::unbalance() {
    std::fill(internal_.begin(), internal_.end(), 0.0);
    yielding_ = skeleton_.respond(increment_, internal_);
    for (size_t i = 0; i < residual_.size(); ++i) {
        const auto freedom = static_cast<size_t>(equations_.freedom[i]);
        residual_[i] = external_[freedom] - internal_[freedom];
    }
    return norm(residual_);
}

double Equilibrium::unbalance_elastic() {
    std::fill(internal_.begin(), internal_.end(), 0.0);
    skeleton_.respond_elastically(increment_, internal_);
    for (size_t i = 0; i < residual_.size(); ++i) {
        const auto freedom = static_cast<size_t>(equations_.freedom[i]);
        residual_[i] = external_[freedom] - internal_[freedom];
    }
    return norm(residual_);
}

double Equilibrium::residual_norm() {
    double reactions = 0;
    for (size_t i = 0; i < internal_.size(); ++i) {
        reaction_[i] = equations_.number[i] < 0 ? internal_[i] - external_[i] : 0.0;
        reactions += reaction_[i] * reaction_[i];
    }
    const double loads = std::max(norm(external_), std::sqrt(reactions));
    const double unbalanced = norm(residual_);
    return unbalanced == 0 ? 0 : unbalanced / loads;
}

/// The increment of a skeleton that does not yield. One solve with the kept factorisation while the geometry has hardly changed.
void Equilibrium::predict(EquilibriumOutcome& outcome) {
    constexpr double worth_keeping = 0.1;
    constexpr int32_t most_solves = 20;
    if (!elastic_is_factorised_ && !factorise_elastic(outcome)) return;
    double before = unbalance_elastic();
    for (int32_t k = 0; k < most_solves && residual_norm() > 0.1 * tolerance; ++k) {
        solve_for_direction(elastic_, outcome);
        step_along(1);
        const double after = unbalance_elastic();
        if (after > worth_keeping * before && residual_norm() > 0.1 * tolerance && !elastic_is_fresh_) factorise_elastic(outcome);
        before = after;
    }
}

bool Equilibrium::newton(EquilibriumOutcome& outcome) {
    constexpr int32_t most_iterations = 40;
    double unbalanced = unbalance();
    for (int32_t k = 0; k < most_iterations; ++k) {
        if (residual_norm() <= tolerance) return true;
        if (!factorise_tangent(0, outcome)) return false;
        solve_for_direction(tangent_, outcome);
        if (!line_search(unbalanced)) return false;
    }
    return residual_norm() <= tolerance;
}

/// Goes along the direction as far as the unbalanced force falls enough; false, and back at the start, where it does not.
bool Equilibrium::line_search(double& unbalanced) {
    constexpr double shortest = 1.0 / 64;
    search_start_ = increment_;
    const double before = unbalanced;
    for (double length = 1; length >= shortest; length /= 2) {
        increment_ = search_start_;
        step_along(length);
        unbalanced = unbalance();
        if (unbalanced < (1 - 0.01 * length) * before) return true;
    }
    increment_ = search_start_;
    unbalanced = unbalance();
    return false;
}

bool Equilibrium::factorise_elastic(EquilibriumOutcome& outcome) {
    stiffness_.assemble_elastic(points_, skeleton_, elastic_.matrix);
    ++outcome.factorisations;
    elastic_is_factorised_ = elastic_is_fresh_ = elastic_.solver->factorise(elastic_.matrix);
    return elastic_is_factorised_;
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

void Equilibrium::finish(EquilibriumOutcome& outcome) {
    skeleton_.complete(increment_);
    outcome.yielding = yielding_;
    for (const double u : increment_) outcome.largest_increment = std::max(outcome.largest_increment, std::abs(u));
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
        increment_[i] = 0;
    }
    kinematics_.update(mesh_, points_);
    elastic_is_fresh_ = false;
}

void Equilibrium::accept_stress() {
    std::fill(points_.strain.begin(), points_.strain.end(), 0.0);
    std::fill(points_.plastic_strain.begin(), points_.plastic_strain.end(), 0.0);
    std::fill(increment_.begin(), increment_.end(), 0.0);
    skeleton_.keep();
}

void Equilibrium::reject() {
    skeleton_.revert();
    std::fill(increment_.begin(), increment_.end(), 0.0);
}

double Equilibrium::volumetric_increment(int32_t cell) const {
    return mesh_.dimension == 1 ? 0 : mean_dilatation<Quad4>(kinematics_, cell, increment_.data());
}

}  // namespace talus
