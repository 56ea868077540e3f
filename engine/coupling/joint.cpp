// Newton's method for flow and skeleton together: where the plain repetition of the two does not settle.
//
// At the end of the exchange both answer a change of what the flow expects of the skeleton: the flow by the pressures after one step of
// its integrator as long as the exchange, the skeleton by its consistent tangent. What it makes of changed pressures is had from a small
// change of all its loads (pore stress, strength, weight, ponds), so that it holds for every form of them. Where the ground turns from
// elastic to yielding within a step, its answer has a kink and the step may lead far beyond it: it is then cut back to where the
// disagreement does no more work on the change of the pressures than half of that at its start.
#include "coupling/simulation.hpp"
#include "linear/gmres.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace talus {

namespace {

constexpr double stage_share = 1.0 - std::numbers::sqrt2 / 2;  // of the integrator's step, in each of its two stages
constexpr double most_work_left = 0.5;                         // of a step's at its start
constexpr int most_cuts = 8;                                   // of a step

std::span<double> span_of(Eigen::VectorXd& values) { return {values.data(), static_cast<size_t>(values.size())}; }

}  // namespace

// The next expectation of Newton's method, from what the present one led to. False where there is no tangent.
bool Simulation::correct_jointly(const FlowState& flow, double duration) {
    JointStep& step = joint_step_;
    for (size_t i = 0; i < gap_.size(); ++i) gap_[i] = found_volume_[i] - taken_volume_[i];
    if (!linearise_jointly(flow, duration)) return false;
    if (step.length == 0 || is_far_enough(gap_)) {
        if (!start_joint_step(flow, duration)) return false;
    } else {
        cut_joint_step(flow, duration);
    }
    end_stress_ = step.stress;
    for (size_t i = 0; i < end_volume_.size(); ++i)
        end_volume_[i] = step.taken_volume[i] + step.length * step.change[i];
    return true;
}

// Half of the step, where the skeleton bears the pressures of the whole one no more: they are not those of the two together. False: enough.
bool Simulation::halve_joint_step() {
    JointStep& step = joint_step_;
    if (step.length == 0 || ++step.cuts > most_cuts) return false;
    step.longest = step.length;
    step.length = (step.shortest + step.longest) / 2;
    for (size_t i = 0; i < end_volume_.size(); ++i)
        end_volume_[i] = step.taken_volume[i] + step.length * step.change[i];
    end_stress_ = step.stress;
    equilibrium_->reject();
    return true;
}

bool Simulation::linearise_jointly(const FlowState& flow, double duration) {
    if (!joint_solver_) {
        storage_matrix_ = joint_matrix_ = flow_->make_matrix();
        joint_solver_ = std::make_unique<KluSolver>(joint_matrix_);
    }
    set_loads(flow, state_.time + duration);
    if (!equilibrium_->linearise(loads())) return false;
    flow_->assemble(0.0, storage_matrix_);
    flow_->assemble(stage_share * duration, joint_matrix_);
    return joint_solver_->factorise(joint_matrix_);
}

// Solves gap + d(found - taken) = 0 for the change of the expected pore volumes, by the water that it takes in at each node.
bool Simulation::start_joint_step(const FlowState& flow, double duration) {
    constexpr double reduction = 1e-3;
    constexpr int most_products = 100;
    JointStep& step = joint_step_;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(flow.pressure.size()));
    add_water(flow, gap_, -1.0, right);
    Eigen::VectorXd pressure;
    const auto product = [&](const Eigen::VectorXd& water, Eigen::VectorXd& result) {
        pressure = water;
        answer_water(pressure);
        answer_pressures(flow, duration, span_of(pressure), step.change);
        result = water;
        add_water(flow, step.change, 1.0, result);
    };
    pressure = gmres(product, right, reduction, most_products);
    answer_water(pressure);
    answer_pressures(flow, duration, span_of(pressure), step.change);
    for (size_t i = 0; i < gap_.size(); ++i) step.change[i] += gap_[i];
    step.pressure.assign(pressure.begin(), pressure.end());
    step.taken_volume = taken_volume_;
    step.stress = end_stress_;
    step.length = 1;
    step.shortest = 0;
    step.longest = 1;
    step.cuts = 0;
    step.disagreement = disagreement_;
    step.work = work(gap_);
    return std::isfinite(step.work);
}

double Simulation::work(std::span<const double> volume) const {
    double sum = 0;
    for (size_t i = 0; i < volume.size(); ++i)
        sum += volume[i] * joint_step_.pressure[static_cast<size_t>(flow_->network.portions[i].node)];
    return sum;
}

bool Simulation::is_far_enough(std::span<const double> gap) const {
    if (joint_step_.cuts >= most_cuts) return true;
    if (disagreement_ > joint_step_.disagreement) return false;
    const double left = work(gap) / joint_step_.work;
    return std::abs(left) <= most_work_left || (left > 0 && joint_step_.cuts == 0);
}

// Cuts the step, or makes it longer again. Beyond a kink the work is steep: the tangent there leads back to it.
void Simulation::cut_joint_step(const FlowState& flow, double duration) {
    constexpr double margin = 0.02;
    JointStep& step = joint_step_;
    ++step.cuts;
    const double left = work(gap_) / step.work;
    const bool is_short = left > most_work_left && step.length < step.longest;
    (is_short ? step.shortest : step.longest) = step.length;
    double target = (step.shortest + step.longest) / 2;
    if (left < -most_work_left) {
        const double slope = work_slope(flow, duration) / step.work;
        target = slope < 0 ? step.length - left / slope : step.shortest;
    }
    const double range = margin * (step.longest - step.shortest);
    step.length = std::clamp(target, step.shortest + range, step.longest - range);
}

// How the work changes with the length of the step, by the tangent at its end.
double Simulation::work_slope(const FlowState& flow, double duration) {
    Eigen::VectorXd pressure = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(flow.pressure.size()));
    add_water(flow, joint_step_.change, -1.0, pressure);
    answer_water(pressure);
    answer_pressures(flow, duration, span_of(pressure), gap_);
    for (size_t i = 0; i < gap_.size(); ++i) gap_[i] -= joint_step_.change[i];
    return work(gap_);
}

void Simulation::add_water(const FlowState& flow, std::span<const double> volume, double sign,
                           Eigen::VectorXd& sum) const {
    const auto& portions = flow_->network.portions;
    for (size_t i = 0; i < portions.size(); ++i) {
        const auto node = static_cast<size_t>(portions[i].node);
        const double density = std::exp(flow.pressure[node] / scene_.water.bulk_modulus);
        if (!flow_->is_held(node)) sum[portions[i].node] += sign * flow_->state()[i].saturation * density * volume[i];
    }
}

// From water that is added evenly over the exchange (m3 a node) to what it changes the pressures at its end by: one step of the integrator's.
void Simulation::answer_water(Eigen::VectorXd& water) {
    Eigen::VectorXd stage = stage_share * water;
    joint_solver_->solve(joint_matrix_, span_of(stage));
    water *= stage_share;
    for (int32_t column = 0; column < storage_matrix_.size(); ++column) {
        const auto first = static_cast<size_t>(storage_matrix_.column_start[static_cast<size_t>(column)]);
        const auto last = static_cast<size_t>(storage_matrix_.column_start[static_cast<size_t>(column) + 1]);
        for (size_t k = first; k < last; ++k)
            water[storage_matrix_.row[k]] += (1 / stage_share - 1) * storage_matrix_.value[k] * stage[column];
    }
    joint_solver_->solve(joint_matrix_, span_of(water));
}

// How the pore volumes that the skeleton finds change with the nodes' pressures, less what the split takes for it.
void Simulation::answer_pressures(const FlowState& flow, double duration, std::span<const double> change,
                                  std::span<double> answer) {
    constexpr double small = 1e-6;
    double largest = 0;
    double scale = agreement_pressure_;
    for (size_t i = 0; i < change.size(); ++i) {
        largest = std::max(largest, std::abs(change[i]));
        scale = std::max(scale, std::abs(flow.pressure[i]));
    }
    std::fill(answer.begin(), answer.end(), 0.0);
    if (!(largest > 0)) return;
    const double length = small * scale / largest;
    FlowState moved = flow;
    for (size_t i = 0; i < change.size(); ++i) moved.pressure[i] += length * change[i];
    set_loads(moved, state_.time + duration);
    const std::span<const double> displacement = equilibrium_->answer(loads());
    for (size_t c = 0; c < mesh_.cell_soil.size(); ++c) {
        const double strain = equilibrium_->volumetric_strain(static_cast<int32_t>(c), displacement) / length;
        for (auto corner = static_cast<size_t>(mesh_.cell_start[c]);
             corner < static_cast<size_t>(mesh_.cell_start[c + 1]); ++corner) {
            answer[static_cast<size_t>(flow_->network.corner_portion[corner])] +=
                strain * flow_->network.corner_volume[corner];
        }
    }
    const auto& portions = flow_->network.portions;
    for (size_t i = 0; i < portions.size(); ++i) {
        const double pressure = moved.pressure[static_cast<size_t>(portions[i].node)];
        const double stress = flow_->pore_stress(static_cast<size_t>(portions[i].soil), pressure);
        answer[i] -= flow_->skeleton.softness[i] * (stress - end_stress_[i]) / length;
    }
}

}  // namespace talus
