// Newton's method for one implicit stage of the flow: stored(p) - step inflow(p) = target at every node.
#pragma once

#include "flow/system.hpp"

#include <limits>
#include <vector>

namespace talus {

/// What may remain of a stage's equations.
struct StageAccuracy {
    double node = 0;  ///< at any node, of its pore volume
    double sum = 0;   ///< over all nodes, m3: what the balance of the whole ground would miss
    double pressure =
        std::numeric_limits<double>::infinity();  ///< Pa, at any node that stored the rest: as far as round-off allows
};

class StageSolver {
public:
    explicit StageSolver(FlowSystem& system);

    /// Finds the pressures at t seconds into the advance, starting from those in `pressure`. Every free node's equation is met to
    /// `accuracy.node` of its pore volume, their sum to `accuracy.sum`, or both as well as round-off allows. On failure returns false and
    /// leaves `pressure` as the last iterate.
    bool solve(double t, double step, std::span<const double> target, StageAccuracy accuracy,
               std::span<double> pressure);

    /// Finds the steady state, inflow = 0, from `pressure`, until the system's imbalance is below `tolerance`.
    bool solve_steady(double tolerance, std::span<double> pressure);

    /// The next solve depends on its input alone, not on what was solved before.
    void forget() { factorised_step_ = 0; }

    [[nodiscard]] int64_t iterations() const { return iterations_; }  ///< since the start

private:
    bool factorise(double step);
    double residual(double t, double step, std::span<const double> target, std::span<const double> pressure,
                    std::span<const double> beyond);
    void move(std::span<const double> pressure, double length);

    FlowSystem& system_;
    SparseMatrix matrix_;
    KluSolver solver_;
    std::vector<double> residual_, change_, trial_;
    std::vector<double> beyond_, trial_beyond_;  // digits of the pressures beyond those of a double, Pa
    double merit_ = 0;                           // sum of the absolute residuals, m3
    double missing_ = 0;                         // sum of the residuals, m3
    double astray_ = 0;                          // largest residual as a pressure that would store it, Pa
    double factorised_step_ = 0;                 // s, of the factors at hand; 0: none
    int64_t iterations_ = 0;
};

}  // namespace talus
