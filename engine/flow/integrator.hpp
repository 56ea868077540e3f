// Time integration of the flow by ARKODE of SUNDIALS: a singly diagonally implicit Runge-Kutta pair, its step adapted to a tolerance.
//
// ARKODE's variable is the water that each node gained since the advance began (and the running totals of what crossed the ground's edge),
// so every step, stage and error test conserves water by construction, and what many substeps round off is small beside what moved, not
// beside what is stored. The pressures behind the stored water are found by StageSolver, which ARKODE sees as its nonlinear solver; the
// stage derivative is deduced from the stage value, never evaluated anew.
#pragma once

#include "flow/stage_solver.hpp"
#include "flow/system.hpp"

#include <functional>
#include <limits>
#include <memory>
#include <vector>

namespace talus {

struct FlowStatistics {
    int64_t substeps = 0;
    int64_t failures = 0;
    int64_t iterations = 0;

    friend FlowStatistics operator+(const FlowStatistics& a, const FlowStatistics& b) {
        return {a.substeps + b.substeps, a.failures + b.failures, a.iterations + b.iterations};
    }
};

/// The flow's state between advances.
struct FlowState {
    std::vector<double> pressure;  ///< Pa, one a node
    std::vector<double> stored;    ///< m3, one a node
    FlowTotals totals{};           ///< m3 since the start
    double substep = 0;            ///< s, what the integrator would try next; 0: unknown
};

using AfterSubstep = std::function<bool(double t, std::span<const double> pressure)>;

enum class AdvanceResult { done, cancelled, failed };

class FlowIntegrator {
public:
    /// tolerance: error allowed in a substep in saturation, per unit of the pore volume.
    /// pressure_tolerance: Pa, how closely Newton's method finds the pressures at the end of an advance.
    FlowIntegrator(FlowSystem& system, double tolerance,
                   double pressure_tolerance = std::numeric_limits<double>::infinity());
    ~FlowIntegrator();
    FlowIntegrator(const FlowIntegrator&) = delete;
    FlowIntegrator& operator=(const FlowIntegrator&) = delete;

    /// Carries `state` over `duration` seconds under the system's forcing. `after_substep(t, pressure)`, t in s since the advance began and
    /// the system evaluated there, may return true to cancel.
    /// After cancelled or failed, `state` is at the last finished substep; the caller keeps its own copy to undo.
    AdvanceResult advance(FlowState& state, double duration, const AfterSubstep& after_substep);

    /// Brings `state` to the steady state of the system's forcing: by Newton's method, or else by ever longer implicit Euler steps. False:
    /// none found.
    bool find_steady(FlowState& state);

    [[nodiscard]] const FlowStatistics& statistics() const { return statistics_; }  ///< since the start

private:
    struct Arkode;
    std::unique_ptr<Arkode> arkode_;
    FlowStatistics statistics_;
};

}  // namespace talus
