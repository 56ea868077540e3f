#include "flow/stage_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talus {
namespace {

constexpr int most_iterations = 60;
constexpr int most_steady_iterations = 100;
constexpr int most_halvings = 6;
constexpr double good_contraction = 0.2;  // of the residuals in one iteration, with which the factors at hand are kept
constexpr double like_steps = 0.2;        // relative difference of two time steps that may share factors
constexpr double round_off = 1e-10;  // a whole Newton step that changes no pressure by more has little left to gain,
constexpr double gaining = 0.5;      // and nothing where it leaves more than this of the residuals

double largest_relative_change(std::span<const double> before, std::span<const double> after) {
    double largest = 0;
    for (size_t i = 0; i < before.size(); ++i)
        largest = std::max(largest, std::abs(after[i] - before[i]) / (1.0 + std::abs(before[i])));
    return largest;
}

}  // namespace

StageSolver::StageSolver(FlowSystem& system)
    : system_(system),
      matrix_(system.make_matrix()),
      solver_(matrix_),
      residual_(static_cast<size_t>(system.node_count())),
      change_(residual_.size()),
      trial_(residual_.size()) {}

// Largest residual relative to a node's pores; evaluates the system. Sets merit_ and missing_ too.
double StageSolver::residual(double t, double step, std::span<const double> target, std::span<const double> pressure) {
    system_.evaluate(t, pressure);
    double largest = 0;
    merit_ = missing_ = 0;
    for (size_t i = 0; i < residual_.size(); ++i) {
        residual_[i] = system_.is_held(i) ? 0.0 : system_.stored()[i] - step * system_.inflow()[i] - target[i];
        largest = std::max(largest, std::abs(residual_[i]) / system_.pore_volume()[i]);
        merit_ += std::abs(residual_[i]);
        missing_ += residual_[i];
    }
    return std::isfinite(merit_) ? largest : std::numeric_limits<double>::infinity();
}

bool StageSolver::solve(double t, double step, std::span<const double> target, StageAccuracy accuracy,
                        std::span<double> pressure) {
    const auto& held = system_.boundaries.held;
    for (size_t h = 0; h < held.size(); ++h)
        pressure[static_cast<size_t>(held[h].node)] = system_.forcing.held[h].at(t);
    double error = residual(t, step, target, pressure);
    const auto is_met = [&] { return error <= accuracy.node && std::abs(missing_) <= accuracy.sum; };
    bool is_stale = factorised_step_ <= 0 || std::abs(step / factorised_step_ - 1.0) > like_steps;
    for (int iteration = 0; iteration < most_iterations && !is_met(); ++iteration) {
        if (!std::isfinite(error)) return false;
        ++iterations_;
        const bool is_fresh = is_stale;
        if (is_stale && !factorise(step)) return false;
        std::transform(residual_.begin(), residual_.end(), change_.begin(), [](double r) { return -r; });
        solver_.solve(matrix_, change_);
        // The equations are accretive in the sum of their absolute residuals (what enters a node leaves others), hence that merit.
        const double merit = merit_;
        double length = 1.0;
        double trial_error = 0;
        for (int halving = 0; halving <= (is_fresh ? most_halvings : 0); ++halving, length *= 0.5) {
            for (size_t i = 0; i < trial_.size(); ++i) trial_[i] = system_.moved(i, pressure[i], length * change_[i]);
            trial_error = residual(t, step, target, trial_);
            if (merit_ < merit) break;
        }
        is_stale = !(merit_ < good_contraction * merit);
        if (!is_fresh && !(merit_ < merit)) {  // the old factors lead nowhere: back, and anew
            error = residual(t, step, target, pressure);
            continue;
        }
        if (is_fresh && error <= accuracy.node && !(merit_ < merit)) {  // the rest is round-off
            residual(t, step, target, pressure);
            return true;
        }
        const bool is_settled = is_fresh && length == 1.0 && largest_relative_change(pressure, trial_) < round_off;
        std::copy(trial_.begin(), trial_.end(), pressure.begin());
        error = trial_error;
        if (is_settled && std::isfinite(error) && merit_ > gaining * merit) return true;
    }
    return error <= accuracy.node;
}

bool StageSolver::factorise(double step) {
    system_.assemble(step, matrix_);
    factorised_step_ = solver_.factorise(matrix_) ? step : 0.0;
    return factorised_step_ > 0;
}

bool StageSolver::solve_steady(double tolerance, std::span<double> pressure) {
    const auto& held = system_.boundaries.held;
    for (size_t h = 0; h < held.size(); ++h)
        pressure[static_cast<size_t>(held[h].node)] = system_.forcing.held[h].at(0.0);
    const auto imbalance = [&](std::span<const double> at) {
        system_.evaluate(0.0, at);
        merit_ = 0;
        for (size_t i = 0; i < residual_.size(); ++i) {
            residual_[i] = system_.is_held(i) ? 0.0 : -system_.inflow()[i];
            merit_ += std::abs(residual_[i]);
        }
        return system_.imbalance();
    };
    double error = imbalance(pressure);
    for (int iteration = 0; iteration < most_steady_iterations && error > tolerance; ++iteration) {
        ++iterations_;
        system_.assemble_steady(matrix_);
        if (!solver_.factorise(matrix_)) return false;
        std::transform(residual_.begin(), residual_.end(), change_.begin(), [](double r) { return -r; });
        solver_.solve(matrix_, change_);
        const double merit = merit_;
        double length = 1.0;
        for (int halving = 0; halving <= most_halvings; ++halving, length *= 0.5) {
            for (size_t i = 0; i < trial_.size(); ++i)
                trial_[i] = system_.moved_steadily(i, pressure[i], length * change_[i]);
            error = imbalance(trial_);
            if (merit_ < merit) break;
        }
        std::copy(trial_.begin(), trial_.end(), pressure.begin());
    }
    return error <= tolerance;
}

}  // namespace talus
