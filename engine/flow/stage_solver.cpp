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

// What a whole step to the surface's kink may cost of the residuals, and how often.
constexpr double most_growth = 1.1;
constexpr int most_fillings = 10;

// Whether a node fills up to the surface's kink, on whose other side its slopes are others.
bool fills(std::span<const double> pressure, std::span<const double> reached) {
    for (size_t i = 0; i < pressure.size(); ++i)
        if (pressure[i] <= 0 && reached[i] > 0) return true;
    return false;
}

// Infinite where a node came to the surface's kink.
double largest_relative_change(std::span<const double> pressure, std::span<const double> change,
                               std::span<const double> reached) {
    double largest = 0;
    for (size_t i = 0; i < pressure.size(); ++i) {
        if ((pressure[i] > 0) != (reached[i] > 0)) return std::numeric_limits<double>::infinity();
        largest = std::max(largest, std::abs(change[i]) / (1.0 + std::abs(pressure[i])));
    }
    return largest;
}

}  // namespace

StageSolver::StageSolver(FlowSystem& system)
    : system_(system),
      matrix_(system.make_matrix()),
      solver_(matrix_),
      residual_(static_cast<size_t>(system.node_count())),
      change_(residual_.size()),
      trial_(residual_.size()),
      beyond_(residual_.size()),
      trial_beyond_(residual_.size()) {}

// Largest residual relative to a node's pores; evaluates the system. Sets merit_ and missing_ too.
double StageSolver::residual(double t, double step, std::span<const double> target, std::span<const double> pressure,
                             std::span<const double> beyond) {
    system_.evaluate(t, pressure, beyond);
    double largest = 0;
    merit_ = missing_ = astray_ = 0;
    for (size_t i = 0; i < residual_.size(); ++i) {
        residual_[i] = system_.is_held(i) ? 0.0 : system_.stored()[i] - step * system_.inflow()[i] - target[i];
        largest = std::max(largest, std::abs(residual_[i]) / system_.pore_volume()[i]);
        astray_ = std::max(astray_, std::abs(residual_[i]) / system_.storage()[i]);
        merit_ += std::abs(residual_[i]);
        missing_ += residual_[i];
    }
    return std::isfinite(merit_) ? largest : std::numeric_limits<double>::infinity();
}

// The trial: `length` of the Newton change from `pressure`. Where the change is added, what the sum rounds off is kept.
void StageSolver::move(std::span<const double> pressure, double length) {
    for (size_t i = 0; i < trial_.size(); ++i) {
        const double change = length * change_[i];
        const double sum = pressure[i] + change;
        trial_[i] = system_.moved(i, pressure[i], change);
        const bool is_added = trial_[i] == sum && std::abs(change) < std::abs(pressure[i]);
        trial_beyond_[i] = is_added ? beyond_[i] + (change - (sum - pressure[i])) : 0.0;
    }
}

bool StageSolver::solve(double t, double step, std::span<const double> target, StageAccuracy accuracy,
                        std::span<double> pressure) {
    const auto& held = system_.boundaries.held;
    for (size_t h = 0; h < held.size(); ++h)
        pressure[static_cast<size_t>(held[h].node)] = system_.forcing.held[h].at(t);
    std::fill(beyond_.begin(), beyond_.end(), 0.0);
    double error = residual(t, step, target, pressure, beyond_);
    const auto is_met = [&] { return error <= accuracy.node && std::abs(missing_) <= accuracy.sum; };
    const auto is_wished = [&] { return is_met() && astray_ <= accuracy.pressure; };
    int fillings = 0;
    bool is_stale = factorised_step_ <= 0 || std::abs(step / factorised_step_ - 1.0) > like_steps;
    for (int iteration = 0; iteration < most_iterations && !is_wished(); ++iteration) {
        if (!std::isfinite(error)) return false;
        ++iterations_;
        const bool is_fresh = is_stale;
        if (is_stale && !factorise(step)) return false;
        std::transform(residual_.begin(), residual_.end(), change_.begin(), [](double r) { return -r; });
        solver_.solve(matrix_, change_);
        // The equations are accretive in the sum of their absolute residuals (what enters a node leaves others), hence that merit.
        const double merit = merit_;
        const bool was_met = is_met();
        double length = 1.0;
        double trial_error = 0;
        for (int halving = 0; halving <= (is_fresh ? most_halvings : 0); ++halving, length *= 0.5) {
            move(pressure, length);
            trial_error = residual(t, step, target, trial_, trial_beyond_);
            if (merit_ < merit) break;
            // A filling surface node stops where the pond begins. It gains nothing on the way there, as it holds all its water already.
            const bool may_fill = is_fresh && halving == 0 && !was_met && fillings < most_fillings;
            if (may_fill && merit_ < most_growth * merit && fills(pressure, trial_)) {
                ++fillings;
                break;
            }
        }
        is_stale = !(merit_ < good_contraction * merit);
        const bool is_round_off = is_fresh && largest_relative_change(pressure, change_, trial_) < round_off;
        if (!(merit_ < merit) &&
            (is_round_off || !is_fresh || was_met)) {  // back, and anew where the old factors led nowhere
            error = residual(t, step, target, pressure, beyond_);
            if (is_round_off || (is_fresh && is_met())) return std::isfinite(error);
            continue;
        }
        std::copy(trial_.begin(), trial_.end(), pressure.begin());
        std::swap(beyond_, trial_beyond_);
        error = trial_error;
        if (is_round_off && length == 1.0 && merit_ > gaining * merit) return std::isfinite(error);
    }
    return is_met();
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
