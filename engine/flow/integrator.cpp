#include "flow/integrator.hpp"

#include "error.hpp"

#include <arkode/arkode_arkstep.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_nonlinearsolver.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace talus {
namespace {

constexpr double stage_share = 1e-4;  // of the tolerance: what Newton's method may leave at a node, of its pore volume
constexpr double loosest_stage = 1e-6;  // and at most this
constexpr double end_tolerance = 1e-9;  // likewise, at the end of an advance, where a host may look
constexpr double balance = 1e-9;        // of the water that crossed the edge of the ground until then,
constexpr double end_share = 1e-9;      // of an advance: round-off in its times
constexpr int most_refusals = 6;  // of last substeps for the balance's sake: a node without water has none to give
constexpr double little = 1e-6;   // or, where less than this of the water stored did, of that: beyond it is rounding

void check(int flag, const char* call) {
    if (flag != 0) throw Error(Status::internal, std::string("SUNDIALS ") + call + " returned " + std::to_string(flag));
}

// Largest weighted entry instead of ARKODE's root mean square: an error at a front must not hide behind the nodes at rest.
double largest_weighted(N_Vector x, N_Vector weight) {
    const double* values = N_VGetArrayPointer(x);
    const double* weights = N_VGetArrayPointer(weight);
    double largest = 0;
    for (sunindextype i = 0; i < N_VGetLength(x); ++i) largest = std::max(largest, std::abs(values[i] * weights[i]));
    return largest;
}

// Alexander (1977): two stages, second order, L-stable, stiffly accurate, so that the last stage's pressures are the step's. Embedded: the
// first order b = (1, 0), damped like the method itself.
ARKodeButcherTable alexander_table() {
    const double gamma = 1.0 - 1.0 / std::sqrt(2.0);
    std::array<double, 2> c{gamma, 1.0};
    std::array<double, 4> a{gamma, 0.0, 1.0 - gamma, gamma};
    std::array<double, 2> b{1.0 - gamma, gamma};
    std::array<double, 2> d{1.0, 0.0};
    return ARKodeButcherTable_Create(2, 2, 1, c.data(), a.data(), b.data(), d.data());
}

}  // namespace

struct FlowIntegrator::Arkode {
    FlowSystem& system;
    StageSolver solver;
    double tolerance;
    double pressure_tolerance;
    SUNContext context = nullptr;
    N_Vector variables = nullptr;  // water gained by every node since the advance began, then the totals
    SUNNonlinearSolver nonlinear_solver = nullptr;
    void* memory = nullptr;
    std::vector<double> initial;   // stored water where the advance began, m3
    std::vector<double> accepted;  // pressures at the last finished substep
    std::vector<double> stage;     // pressures at the last stage solved
    double stage_time = 0;
    double accepted_time = 0;
    double duration = 0;  // s, of the advance
    int refusals = 0;     // of its last substeps
    std::vector<double> target;

    Arkode(FlowSystem& system_in, double tolerance_in, double pressure_tolerance_in);
    ~Arkode();
    Arkode(const Arkode&) = delete;
    Arkode& operator=(const Arkode&) = delete;

    void start(const FlowState& state);
    void make_memory();
    [[nodiscard]] bool is_end(double t) const { return t >= (1.0 - end_share) * duration; }
    [[nodiscard]] StageAccuracy accuracy(double t, double gamma) const;
    int solve_stage(N_Vector correction);

    static Arkode& of(SUNNonlinearSolver solver) { return *static_cast<Arkode*>(solver->content); }
    // ARKODE's callbacks
    static int right_hand_side(realtype t, N_Vector y, N_Vector result, void* user);
    static int weights(N_Vector y, N_Vector weight, void* user);
};

FlowIntegrator::Arkode::Arkode(FlowSystem& system_in, double tolerance_in, double pressure_tolerance_in)
    : system(system_in), solver(system_in), tolerance(tolerance_in), pressure_tolerance(pressure_tolerance_in) {
    const auto nodes = static_cast<size_t>(system.node_count());
    accepted.resize(nodes);
    stage.resize(nodes);
    target.resize(nodes);
    check(SUNContext_Create(nullptr, &context), "SUNContext_Create");
    variables = N_VNew_Serial(static_cast<sunindextype>(nodes + flow_total_count), context);
    variables->ops->nvwrmsnorm = largest_weighted;
    N_VConst(0.0, variables);

    nonlinear_solver = SUNNonlinSolNewEmpty(context);
    nonlinear_solver->content = this;
    nonlinear_solver->ops->gettype = [](SUNNonlinearSolver) { return SUNNONLINEARSOLVER_ROOTFIND; };
    nonlinear_solver->ops->setsysfn = [](SUNNonlinearSolver, SUNNonlinSolSysFn) { return 0; };
    nonlinear_solver->ops->solve = [](SUNNonlinearSolver self, N_Vector, N_Vector correction, N_Vector, realtype,
                                      booleantype, void*) { return of(self).solve_stage(correction); };
}

// Anew for every advance: ARKODE's step control remembers, and a step that was undone must leave nothing behind.
void FlowIntegrator::Arkode::make_memory() {
    if (memory != nullptr) ARKStepFree(&memory);
    memory = ARKStepCreate(nullptr, right_hand_side, 0.0, variables, context);
    if (memory == nullptr) throw Error(Status::out_of_memory, "SUNDIALS could not set up the flow's time integration");
    check(ARKStepSetUserData(memory, this), "ARKStepSetUserData");
    const ARKodeButcherTable table = alexander_table();
    const int flag = ARKStepSetTables(memory, 2, 1, table, nullptr);
    ARKodeButcherTable_Free(table);
    check(flag, "ARKStepSetTables");
    check(ARKStepWFtolerances(memory, weights), "ARKStepWFtolerances");
    check(ARKStepSetNonlinearSolver(memory, nonlinear_solver), "ARKStepSetNonlinearSolver");
    check(ARKStepSetDeduceImplicitRhs(memory, SUNTRUE), "ARKStepSetDeduceImplicitRhs");
    check(ARKStepSetInterpolantType(memory, ARK_INTERP_LAGRANGE), "ARKStepSetInterpolantType");
    check(ARKStepSetMaxNumSteps(memory, -1), "ARKStepSetMaxNumSteps");
    check(ARKStepSetMaxConvFails(memory, 60), "ARKStepSetMaxConvFails");
    check(ARKStepSetMaxErrTestFails(memory, 30), "ARKStepSetMaxErrTestFails");
    check(ARKStepSetErrFile(memory, nullptr), "ARKStepSetErrFile");
}

FlowIntegrator::Arkode::~Arkode() {
    if (memory != nullptr) ARKStepFree(&memory);
    if (nonlinear_solver != nullptr) SUNNonlinSolFreeEmpty(nonlinear_solver);
    if (variables != nullptr) N_VDestroy(variables);
    if (context != nullptr) SUNContext_Free(&context);
}

void FlowIntegrator::Arkode::start(const FlowState& state) {
    double* y = N_VGetArrayPointer(variables);
    initial = state.stored;
    std::fill(y, y + initial.size(), 0.0);
    std::copy(state.totals.begin(), state.totals.end(), y + initial.size());
    accepted = state.pressure;
    solver.forget();
    system.evaluate(0.0, accepted);  // for the error weights
    stage_time = accepted_time = 0.0;
    make_memory();
}

// ARKODE asks for it where a step begins, and for that state alone are its values used.
int FlowIntegrator::Arkode::right_hand_side(realtype t, N_Vector, N_Vector result, void* user) {
    Arkode& self = *static_cast<Arkode*>(user);
    self.system.evaluate(t, self.accepted);
    double* rates = N_VGetArrayPointer(result);
    std::copy(self.system.inflow().begin(), self.system.inflow().end(), rates);
    std::copy(self.system.total_rates().begin(), self.system.total_rates().end(), rates + self.accepted.size());
    return 0;
}

// A held node's water follows what holds it, which may jump where the ground under a water table has moved: no error of a substep.
int FlowIntegrator::Arkode::weights(N_Vector, N_Vector weight, void* user) {
    const Arkode& self = *static_cast<Arkode*>(user);
    double* w = N_VGetArrayPointer(weight);
    constexpr double none = std::numeric_limits<double>::min();
    const std::span<const double> pores = self.system.pore_volume();
    for (size_t i = 0; i < pores.size(); ++i) w[i] = self.system.is_held(i) ? none : 1.0 / (self.tolerance * pores[i]);
    std::fill(w + pores.size(), w + pores.size() + flow_total_count, none);
    return 0;
}

// A host reads the water in the ground from the pressures, so Newton's remainder is what its balance misses, at the end of an advance.
StageAccuracy FlowIntegrator::Arkode::accuracy(double t, double gamma) const {
    constexpr double any = std::numeric_limits<double>::infinity();
    if (!is_end(t)) return {std::min(stage_share * tolerance, loosest_stage), any};
    if (refusals >= most_refusals) return {end_tolerance, any};
    const double* totals = N_VGetArrayPointer(variables) + target.size();
    double moved = 0;
    for (const size_t k : {rain_total, seepage_total, inflow_total, drained_total})
        moved += totals[k] + gamma * system.total_rates()[k];
    const double stored = std::accumulate(target.begin(), target.end(), 0.0);
    return {end_tolerance, balance * std::max(moved, little * stored), pressure_tolerance};
}

// One stage z = known + gamma rate(z), where known = predicted + sdata. What the nodes hold after it is defined by the flows, not by the
// retention curve: Newton's remainder stays in the stored water and enters the next stage's equation, so no water is ever lost to it.
int FlowIntegrator::Arkode::solve_stage(N_Vector correction) {
    realtype t = 0;
    realtype gamma = 0;
    N_Vector predicted = nullptr;
    N_Vector value = nullptr;
    N_Vector rate = nullptr;
    N_Vector known = nullptr;
    void* user = nullptr;
    if (ARKStepGetNonlinearSystemData(memory, &t, &predicted, &value, &rate, &gamma, &known, &user) != 0) return -1;
    const double* before = N_VGetArrayPointer(predicted);
    const double* change = N_VGetArrayPointer(known);
    for (size_t i = 0; i < target.size(); ++i) target[i] = initial[i] + (before[i] + change[i]);
    if (stage_time <= accepted_time || stage_time >= t) stage = accepted;
    if (!solver.solve(t, gamma, target, accuracy(t, gamma), stage)) {
        if (is_end(t)) ++refusals;
        stage_time = accepted_time;
        return SUN_NLS_CONV_RECVR;
    }
    stage_time = t;

    double* z = N_VGetArrayPointer(correction);
    FlowTotals rates = system.total_rates();
    for (size_t i = 0; i < target.size(); ++i) {
        if (!system.is_held(i)) {
            z[i] = change[i] + gamma * system.inflow()[i];
            continue;
        }
        const double through_boundary = (system.stored()[i] - target[i]) / gamma - system.inflow()[i];
        rates[through_boundary > 0 ? inflow_total : drained_total] += std::abs(through_boundary);
        z[i] = system.stored()[i] - initial[i] - before[i];
    }
    for (size_t k = 0; k < flow_total_count; ++k) z[target.size() + k] = change[target.size() + k] + gamma * rates[k];
    return SUN_NLS_SUCCESS;
}

FlowIntegrator::FlowIntegrator(FlowSystem& system, double tolerance, double pressure_tolerance)
    : arkode_(std::make_unique<Arkode>(system, tolerance, pressure_tolerance)) {}

FlowIntegrator::~FlowIntegrator() = default;

AdvanceResult FlowIntegrator::advance(FlowState& state, double duration, const AfterSubstep& after_substep) {
    Arkode& ark = *arkode_;
    ark.start(state);
    ark.duration = duration;
    ark.refusals = 0;
    ARKStepSetStopTime(ark.memory, duration);
    if (state.substep > 0) ARKStepSetInitStep(ark.memory, std::min(state.substep, duration));
    const int64_t iterations_before = ark.solver.iterations();
    AdvanceResult result = AdvanceResult::done;
    for (double t = 0; t < duration && result == AdvanceResult::done;) {
        if (ARKStepEvolve(ark.memory, duration, ark.variables, &t, ARK_ONE_STEP) < 0) {
            result = AdvanceResult::failed;
            break;
        }
        ark.accepted = ark.stage;
        ark.accepted_time = t;
        if (t < duration || state.substep <= 0) ARKStepGetCurrentStep(ark.memory, &state.substep);
        if (after_substep(t, ark.accepted)) result = AdvanceResult::cancelled;
    }
    long steps = 0, attempts = 0;
    ARKStepGetNumSteps(ark.memory, &steps);
    ARKStepGetNumStepAttempts(ark.memory, &attempts);
    statistics_.substeps += steps;
    statistics_.failures += attempts - steps;
    statistics_.iterations += ark.solver.iterations() - iterations_before;

    const double* y = N_VGetArrayPointer(ark.variables);
    for (size_t i = 0; i < state.stored.size(); ++i) state.stored[i] += y[i];
    std::copy(y + state.stored.size(), y + state.stored.size() + flow_total_count, state.totals.begin());
    state.pressure = ark.accepted;
    return result;
}

bool FlowIntegrator::find_steady(FlowState& state) {
    constexpr double steady = 1e-7;       // imbalance
    constexpr double nearly = 1e-6;       // imbalance, where longer steps find nothing better
    constexpr double first_step = 100.0;  // s
    constexpr double long_step = 1e4;     // s: beyond it round-off in the flows grows with the step
    constexpr int most_attempts = 200;
    FlowSystem& system = arkode_->system;
    double step = first_step;
    std::vector<double> trial = state.pressure;
    if (arkode_->solver.solve_steady(steady, trial)) {
        state.pressure = trial;
        return true;
    }
    for (int attempt = 0; attempt < most_attempts; ++attempt) {
        system.evaluate(0.0, state.pressure);
        arkode_->target.assign(system.stored().begin(), system.stored().end());
        trial = state.pressure;
        const double tolerance = end_tolerance * std::max(1.0, step / long_step);
        const StageAccuracy accuracy{tolerance, std::numeric_limits<double>::infinity()};
        const bool solved = arkode_->solver.solve(0.0, step, arkode_->target, accuracy, trial);
        const double imbalance = system.imbalance();
        if (solved) state.pressure = trial;
        if (solved && imbalance < steady) return true;
        if (!solved && attempt > most_attempts / 2) break;
        step *= solved ? 8.0 : 0.1;
    }
    system.evaluate(0.0, state.pressure);
    return system.imbalance() < nearly;
}

}  // namespace talus
