#include "motion/explicit/grid_mixture.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

constexpr double full_share = 0.95;  // of a cell's volume: with less, a node is at the ground's edge

}  // namespace

void GridMixture::resize() {
    const size_t nodes = grid.nodes();
    momentum.assign(nodes, {});
    liquid_momentum.assign(nodes, {});
    force.assign(nodes, {});
    gradients.assign(nodes, {});
    means.assign(nodes, {});
    edge_height.assign(nodes, {});
    returned.resize(nodes);
    velocity.resize(nodes);
    liquid_velocity.resize(nodes);
    flux.resize(nodes);
    rates.resize(nodes);
}

void GridMixture::begin_step() {
    for_each_node([this](size_t i) {
        force[i] = {0, -gravity * (momentum[i].mass + liquid_momentum[i].mass)};
        gradients[i] = {};
        means[i] = {};
        edge_height[i] = {};
    });
    for_each_mirror([this](NodePair nodes, const Mirror& mirror) {
        move_inside(momentum[nodes.inside], momentum[nodes.beyond], mirror);
        add_mirrored(force[nodes.inside], mirror, force[nodes.beyond]);
        force[nodes.beyond] = {};
    });
    for_each_even_mirror([this](NodePair nodes, const Mirror& mirror) {
        move_inside(liquid_momentum[nodes.inside], liquid_momentum[nodes.beyond], mirror);
    });
    for_each_node([this](size_t i) {
        const NodeMomentum &solid = momentum[i], &liquid = liquid_momentum[i];
        const double inverse = solid.mass > 0 ? 1 / solid.mass : 0;
        velocity[i] = {solid.x * inverse, solid.y * inverse};
        liquid_velocity[i] = velocity[i];
        if (liquid.mass > 0) liquid_velocity[i] = {liquid.x / liquid.mass, liquid.y / liquid.mass};
        rates[i] = {solid.more * inverse, (liquid.more + returned[i]) * inverse};
    });
    mirror();
}

void GridMixture::end_step(double dt) {
    fold_forces();
    for_each_node([this, dt](size_t i) { solve(i, dt); });
    if (!rain.empty()) rain_on(dt);
    mirror();
    flow_time = dt;
    speed = largest_speed();
    for_each_node([this](size_t i) {
        momentum[i] = {};
        liquid_momentum[i] = {};
    });
}

void GridMixture::fold_forces() {
    for_each_node([this](size_t i) { edge_height[i].y += means[i].volume; });
    for_each_mirror([this](NodePair nodes, const Mirror& mirror) {
        add_mirrored(force[nodes.inside], mirror, force[nodes.beyond]);
    });
    for_each_even_mirror([this](NodePair nodes, const Mirror& mirror) {
        NodeGradients &in = gradients[nodes.inside], &out = gradients[nodes.beyond];
        in.push_x += mirror.x * out.push_x;
        in.push_y += mirror.y * out.push_y;
        in.edge_x += mirror.x * out.edge_x;
        in.edge_y += mirror.y * out.edge_y;
        out = {};
        NodeMeans &mean_in = means[nodes.inside], &mean_out = means[nodes.beyond];
        mean_in.push += mean_out.push;
        mean_in.height += mean_out.height;
        mean_in.mobility += mean_out.mobility;
        mean_in.volume += mean_out.volume;
        mean_out = {};
        add_mirrored(edge_height[nodes.inside], mirror, edge_height[nodes.beyond]);
        edge_height[nodes.beyond] = {};
    });
}

bool GridMixture::is_at_edge(size_t node) const {
    return means[node].volume > 0 && means[node].volume < full_share * cell_volume();
}

/// Every column's rain goes to its nodes at the edge, in proportion to the edge's horizontal width there.
void GridMixture::rain_on(double dt) {
    const auto columns = static_cast<size_t>(grid.cells[0]);
    std::vector<double>& width = column_width_;
    width.assign(columns, 0.0);
    const auto facing_up = [this](size_t i) { return is_at_edge(i) ? std::max(gradients[i].edge_y, 0.0) : 0.0; };
    for_each_node([&](size_t i) { width[i % columns] += facing_up(i); });
    for_each_node([&](size_t i) {
        const size_t column = i % columns;
        const double up = facing_up(i);
        if (!(up > 0)) return;
        const double rate = rain[column] * grid.cell_size * up / width[column];
        returned[i] += rate;
        rained += dt * rate;
    });
}

void GridMixture::solve(size_t node, double dt) {
    const double mass = momentum[node].mass, liquid_mass = liquid_momentum[node].mass;
    const NodeGradients& sums = gradients[node];
    const NodeMeans& mean = means[node];
    flux[node] = {};
    returned[node] = 0;
    if (!(mass > 0) || !(mean.volume > 0)) return;
    const double unit_weight = gravity * liquid_density;
    const double push = mean.push / mass, pressure = push - unit_weight * mean.height / mass;
    const double liquid_content = liquid_mass / (liquid_density * mean.volume);
    const double drag = dt * liquid_content * mass / (mean.mobility * liquid_density);
    const double response = dt / (liquid_density * mean.volume);
    const double moved = liquid_mass / (1 + drag), coupled = mass + moved * drag;
    NodeVector &solid = velocity[node], &liquid = liquid_velocity[node];
    const NodeVector start = solid, liquid_start = liquid;
    const auto move = [&](double NodeVector::*c, double pushed, double normal) {
        const double alone = liquid_start.*c + response * pushed;
        const double whole =
            mass * start.*c + liquid_mass * liquid_start.*c + dt * (force[node].*c - edge_pressure * normal);
        solid.*c = (whole - moved * alone) / coupled;
        liquid.*c = (alone + drag * solid.*c) / (1 + drag);
        flux[node].*c = liquid_mass / mean.volume * (liquid.*c - solid.*c);
    };
    const auto leaving = [&](const NodeVector& held) {
        move(&NodeVector::x, sums.push_x - held.x, sums.edge_x);
        move(&NodeVector::y, sums.push_y - held.y, sums.edge_y);
        return flux[node].x * sums.edge_x + flux[node].y * sums.edge_y;
    };
    if ((immersed || pressure > 0) && is_at_edge(node)) {
        const double rate = leaving({unit_weight * edge_height[node].x, unit_weight * edge_height[node].y});
        if (immersed || rate >= 0) {
            seepage += dt * rate;
            return;
        }
    }
    returned[node] = leaving({push * sums.edge_x, push * sums.edge_y});
}

/// Beyond a wall the nodes move as the mirrored ground would; water slides along every wall.
void GridMixture::mirror() {
    for_each_mirror([this](NodePair nodes, const Mirror& mirror) {
        velocity[nodes.beyond] = {mirror.x * velocity[nodes.inside].x, mirror.y * velocity[nodes.inside].y};
    });
    for_each_even_mirror([this](NodePair nodes, const Mirror& mirror) {
        for (auto* field : {&liquid_velocity, &flux})
            (*field)[nodes.beyond] = {mirror.x * (*field)[nodes.inside].x, mirror.y * (*field)[nodes.inside].y};
        rates[nodes.beyond] = rates[nodes.inside];
    });
}

}  // namespace talus
