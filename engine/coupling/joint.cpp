// Flow and skeleton together: where the plain repetition of the two does not settle.
//
// Ground near its limit load hardly resists: under pressures that are held it slips far or not at all, within fractions of a pascal of each
// other, and the pore volumes that it finds in the two have no use for the next pressures. The water is what holds it. So the skeleton
// creeps in pseudo-time (motion/iterations.cpp) with the water beside it: each step is Newton's for both, the flow by one step of its
// integrator as long as the exchange, the skeleton by its viscous tangent, the linear equations by GMRES behind the split's own matrix;
// neither is solved for before the other. Where the two were settled so last, it starts from where that lets expect them, and a balance like
// the expected is where they went on to. Otherwise it starts from where they lie; where that ends in a steady mechanism, the ground fails with its water in
// it. No more is shown than that: there may be a balance farther on, as there was for ground that went on (docs/architecture.md).
#include "coupling/simulation.hpp"
#include "coupling/stopwatch.hpp"
#include "linear/gmres.hpp"
#include "linear/norm.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace talus {

namespace {

constexpr double stage_share = 1.0 - std::numbers::sqrt2 / 2;  // of the integrator's step, in each of its two stages
constexpr int32_t few_steps = 30;                              // few creeps that find a balance take more

std::span<double> span_of(Eigen::VectorXd& values) { return {values.data(), static_cast<size_t>(values.size())}; }

}  // namespace

/// The water of one exchange, beside the skeleton. It is told what pore volume to expect, a portion each, and takes another where the
/// pressures that it finds are not the expected ones; between that and what the skeleton has is the gap.
class Simulation::Water final : public Companion {
public:
    Water(Simulation& simulation, double duration, FlowPath& path, const Cancelled& cancelled)
        : all_(simulation), duration_(duration), path_(path), cancelled_(cancelled) {
        all_.expect_skeleton(duration);
        start_volume_ = all_.end_volume_;
        start_stress_ = all_.end_stress_;
        change_.assign(start_volume_.size(), 0.0);
        gap_ = change_;
    }

    void guide(std::span<double> direction) override;
    std::optional<Loads> follow(double length) override;
    [[nodiscard]] double power() const override;
    [[nodiscard]] bool agrees() const override { return all_.disagreement_ <= 1.0; }
    [[nodiscard]] bool is_cancelled() const { return result_ == AdvanceResult::cancelled; }

private:
    [[nodiscard]] bool linearise();
    void add_water(std::span<const double> volume, double sign, Eigen::VectorXd& sum) const;
    void add_volume(std::span<const double> displacement, std::span<double> sum) const;
    void answer_water(Eigen::VectorXd& water) const;
    void answer_pressures(std::span<const double> change);

    Simulation& all_;
    double duration_;
    FlowPath& path_;
    const Cancelled& cancelled_;
    AdvanceResult result_ = AdvanceResult::done;
    std::vector<double> start_volume_, start_stress_;  // per portion, m3 and Pa, expected where the step starts
    std::vector<double> change_;                       // per portion, m3, of the expected volume over the step
    std::vector<double> gap_;                          // per portion, m3
    std::vector<double> answered_volume_;              // per portion, m3: see answer_pressures()
    std::vector<double> answered_displacement_;        // nodes x dimension, m
    Eigen::VectorXd pressure_;                         // per node, Pa, change over the step
};

// Solves gap + d(found - taken) = 0 for the change of the expected pore volumes, by the water that it takes in at each node.
void Simulation::Water::guide(std::span<double> direction) {
    constexpr double reduction = 1e-3;
    constexpr int most_products = 100;
    start_volume_ = all_.taken_volume_;
    start_stress_ = all_.end_stress_;
    change_ = gap_;
    add_volume(direction, change_);
    pressure_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(path_.flow.pressure.size()));
    if (!linearise()) return;
    Eigen::VectorXd right = pressure_;
    add_water(change_, -1.0, right);
    const auto product = [&](const Eigen::VectorXd& water, Eigen::VectorXd& result) {
        pressure_ = water;
        answer_water(pressure_);
        answer_pressures(span_of(pressure_));
        result = water;
        add_water(answered_volume_, 1.0, result);
    };
    pressure_ = gmres(product, right, reduction, most_products);
    answer_water(pressure_);
    answer_pressures(span_of(pressure_));
    for (size_t i = 0; i < change_.size(); ++i) change_[i] += answered_volume_[i];
    for (size_t i = 0; i < direction.size(); ++i) direction[i] += answered_displacement_[i];
}

std::optional<Loads> Simulation::Water::follow(double length) {
    for (size_t i = 0; i < change_.size(); ++i) all_.end_volume_[i] = start_volume_[i] + length * change_[i];
    if (*std::min_element(all_.end_volume_.begin(), all_.end_volume_.end()) <= 0) return {};  // no pores left
    all_.end_stress_ = start_stress_;
    all_.expect_skeleton_at(duration_, all_.end_volume_, all_.end_stress_);
    ++all_.counts.exchange_iterations;
    result_ = all_.advance_flow(duration_, path_, cancelled_);
    if (result_ != AdvanceResult::done) return {};
    all_.compare_pore_volumes(path_.flow);
    for (size_t i = 0; i < gap_.size(); ++i) gap_[i] = all_.found_volume_[i] - all_.taken_volume_[i];
    all_.set_loads(path_.flow, all_.state_.time + duration_);
    return all_.loads();
}

double Simulation::Water::power() const {
    double sum = 0;
    for (size_t i = 0; i < gap_.size(); ++i) sum -= gap_[i] * pressure_[all_.flow_->network.portions[i].node];
    return sum;
}

// At the end of the exchange, where the flow was evaluated last.
bool Simulation::Water::linearise() {
    if (!all_.joint_solver_) {
        all_.storage_matrix_ = all_.joint_matrix_ = all_.flow_->make_matrix();
        all_.joint_solver_ = std::make_unique<KluSolver>(all_.joint_matrix_);
    }
    all_.flow_->assemble(0.0, all_.storage_matrix_);
    all_.flow_->assemble(stage_share * duration_, all_.joint_matrix_);
    return all_.joint_solver_->factorise(all_.joint_matrix_);
}

void Simulation::Water::add_water(std::span<const double> volume, double sign, Eigen::VectorXd& sum) const {
    const auto& portions = all_.flow_->network.portions;
    for (size_t i = 0; i < portions.size(); ++i) {
        const auto node = static_cast<size_t>(portions[i].node);
        if (all_.flow_->is_held(node)) continue;
        const double density = std::exp(path_.flow.pressure[node] / all_.scene_.water.bulk_modulus);
        sum[portions[i].node] += sign * all_.flow_->state()[i].saturation * density * volume[i];
    }
}

// Pore volume that the skeleton gains by a displacement.
void Simulation::Water::add_volume(std::span<const double> displacement, std::span<double> sum) const {
    const Mesh& mesh = all_.mesh_;
    const Network& network = all_.flow_->network;
    for (size_t c = 0; c < mesh.cell_soil.size(); ++c) {
        const double strain = all_.equilibrium_->volumetric_strain(static_cast<int32_t>(c), displacement);
        for (auto corner = static_cast<size_t>(mesh.cell_start[c]);
             corner < static_cast<size_t>(mesh.cell_start[c + 1]); ++corner) {
            sum[static_cast<size_t>(network.corner_portion[corner])] += strain * network.corner_volume[corner];
        }
    }
}

// From water that is added evenly over the exchange (m3 a node) to what it changes the pressures at its end by: one step of the integrator's.
void Simulation::Water::answer_water(Eigen::VectorXd& water) const {
    const SparseMatrix& storage = all_.storage_matrix_;
    Eigen::VectorXd stage = stage_share * water;
    all_.joint_solver_->solve(all_.joint_matrix_, span_of(stage));
    water *= stage_share;
    for (int32_t column = 0; column < storage.size(); ++column) {
        const auto first = static_cast<size_t>(storage.column_start[static_cast<size_t>(column)]);
        const auto last = static_cast<size_t>(storage.column_start[static_cast<size_t>(column) + 1]);
        for (size_t k = first; k < last; ++k)
            water[storage.row[k]] += (1 / stage_share - 1) * storage.value[k] * stage[column];
    }
    all_.joint_solver_->solve(all_.joint_matrix_, span_of(water));
}

// How the skeleton goes under a change of the nodes' pressures, and its pore volumes with it, less what the split takes for it. It is had
// from a small change of all its loads (pore stress, strength, weight, ponds), so that it holds for every form of them.
void Simulation::Water::answer_pressures(std::span<const double> change) {
    constexpr double small = 1e-6;
    const double most = largest(change);
    double scale = all_.agreement_pressure_;
    for (const double pressure : path_.flow.pressure) scale = std::max(scale, std::abs(pressure));
    answered_volume_.assign(gap_.size(), 0.0);
    answered_displacement_.assign(all_.mesh_.position.size(), 0.0);
    if (!(most > 0)) return;
    const double length = small * scale / most;
    FlowState moved = path_.flow;
    for (size_t i = 0; i < change.size(); ++i) moved.pressure[i] += length * change[i];
    all_.set_loads(moved, all_.state_.time + duration_);
    const std::span<const double> answer = all_.equilibrium_->answer(all_.loads());
    for (size_t i = 0; i < answer.size(); ++i) answered_displacement_[i] = answer[i] / length;
    add_volume(answered_displacement_, answered_volume_);
    const auto& portions = all_.flow_->network.portions;
    for (size_t i = 0; i < portions.size(); ++i) {
        const double pressure = moved.pressure[static_cast<size_t>(portions[i].node)];
        const double stress = all_.flow_->pore_stress(static_cast<size_t>(portions[i].soil), pressure);
        answered_volume_[i] -= all_.flow_->skeleton.softness[i] * (stress - start_stress_[i]) / length;
    }
}

Simulation::Exchange Simulation::creep_jointly(double duration, FlowPath& path, std::span<const double> from,
                                               int32_t most_steps, const Cancelled& cancelled) {
    const double flow_before = counts.seconds_flow;
    {
        const Stopwatch stopwatch(counts.seconds_motion);
        Water water(*this, duration, path, cancelled);
        outcome_ = equilibrium_->solve_with(water, from, largest(state_.displacement_rate) * duration, most_steps);
        if (water.is_cancelled()) return Exchange::cancelled;
    }
    counts.seconds_motion -= counts.seconds_flow - flow_before;
    counts.motion_iterations += outcome_.iterations;
    return end_of(outcome_);
}

bool Simulation::is_as_expected(double duration) const {
    constexpr double alike = 0.5;
    const std::vector<double>& rate = state_.displacement_rate;
    double surprise = 0;
    for (size_t i = 0; i < rate.size(); ++i)
        surprise = std::max(surprise, std::abs(equilibrium_->increment()[i] - rate[i] * duration));
    return surprise <= alike * (largest(rate) * duration);
}

// From where the last exchange lets expect the two to be. A balance near that is where they went on to.
Simulation::Exchange Simulation::go_on_jointly(double duration, FlowPath& path, const Cancelled& cancelled,
                                               Settled& settled) {
    std::vector<double> expected = state_.displacement_rate;
    for (double& u : expected) u *= duration;
    const Exchange result = creep_jointly(duration, path, expected, few_steps, cancelled);
    if (result == Exchange::cancelled) return result;
    if (result == Exchange::agreed && is_as_expected(duration)) {
        settled = {forecast_error_, true};
        return result;
    }
    equilibrium_->reject();
    return Exchange::disagreed;
}

// It is dear where the exchange is long: first a shorter one is tried, in which the skeleton alone may find its equilibrium, and where it did
// not, the two found theirs.
Simulation::Exchange Simulation::settle_jointly(double duration, FlowPath& path, bool is_short,
                                                const Cancelled& cancelled) {
    constexpr int32_t most_steps = 1000;
    const EquilibriumOutcome alone = outcome_;
    const bool is_lost_alone = alone.status == EquilibriumStatus::no_equilibrium;
    if (creep_jointly(duration, path, {}, is_short && !is_lost_alone ? most_steps : few_steps, cancelled) ==
        Exchange::cancelled)
        return Exchange::cancelled;
    if (outcome_.status == EquilibriumStatus::not_converged && disagreement_ <= 1.0)
        settle_beside(path.flow, duration, is_short ? Equilibrium::usual_creep_steps : few_steps);
    if (outcome_.status == EquilibriumStatus::not_converged && is_lost_alone) outcome_ = alone;
    return end_of(outcome_);
}

// The skeleton beside water that has come to agree with it: what unbalanced force is left may be less than the flow's own error.
void Simulation::settle_beside(const FlowState& flow, double duration, int32_t most_creep_steps) {
    outcome_ = find_equilibrium(flow, state_.time + duration, most_creep_steps);
    if (outcome_.status != EquilibriumStatus::converged) return;
    compare_pore_volumes(flow);
    if (disagreement_ > 1.0) outcome_.status = EquilibriumStatus::not_converged;
}

}  // namespace talus
