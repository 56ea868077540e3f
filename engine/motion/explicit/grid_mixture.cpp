#include "motion/explicit/grid_mixture.hpp"

#include "motion/explicit/ground_edge.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

constexpr double full_share = 0.95;  // of a cell's volume: with less, a node is at the ground's edge

/// Of what Darcy's law lets pass between the halves of a cell. Nodes do not see what one point has too much and its neighbour too little:
/// it would grow by chance from step to step, until the pressure of the fuller one counts (docs/verification.md).
constexpr double evening_share = 0.5;

double dot(const NodeVector& a, const NodeVector& b) { return a.x * b.x + a.y * b.y; }

}  // namespace

void GridMixture::resize() {
    const size_t nodes = grid.nodes();
    momentum.assign(nodes, {});
    liquid_momentum.assign(nodes, {});
    force.assign(nodes, {});
    gradients.assign(nodes, {});
    means.assign(nodes, {});
    returned.resize(nodes);
    capacity.resize(nodes);
    evening.resize(nodes);
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
        if (!(solid.mass > 0)) {  // the last point has left: what came to its node has left with the surface
            seepage += flow_time * returned[i];
            returned[i] = 0;
        }
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
    if (!immersed) cross_surface(dt);
    mirror();
    flow_time = dt;
    speed = largest_speed();
    for_each_node([this](size_t i) {
        momentum[i] = {};
        liquid_momentum[i] = {};
    });
}

void GridMixture::fold_forces() {
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
        mean_in.permeability += mean_out.permeability;
        mean_in.resistance += mean_out.resistance;
        mean_in.volume += mean_out.volume;
        mean_out = {};
    });
}

bool GridMixture::is_at_edge(size_t node) const {
    return means[node].volume > 0 && means[node].volume < full_share * cell_volume();
}

double GridMixture::total_returned() const {
    double sum = 0;
    for_each_node([&](size_t i) { sum += returned[i]; });
    return sum;
}

double GridMixture::facing_up(size_t node) const {
    return is_at_edge(node) ? std::max(gradients[node].edge_y, 0.0) : 0.0;
}

/// Every column's rain falls on its nodes at the edge in proportion to the edge's horizontal width there. What one of them cannot take, or
/// gives back, is offered to the others. What none takes leaves: within the column's own rain it is run-off, the rest seepage.
void GridMixture::cross_surface(double dt) {
    const auto columns = static_cast<size_t>(grid.cells[0]);
    surfaces_.assign(columns, {});
    for_each_node([&](size_t i) { surfaces_[i % columns].width += facing_up(i); });
    const auto falls_on = [&](size_t i) {
        const double up = rain.empty() ? 0.0 : facing_up(i);
        return up > 0 ? rain[i % columns] * grid.cell_size * up / surfaces_[i % columns].width : 0.0;
    };
    const auto takes = [&](size_t i) { return std::min(falls_on(i), capacity[i]); };
    for_each_node([&](size_t i) {
        if (!is_at_edge(i)) return;
        returned[i] += takes(i);
        if (!(facing_up(i) > 0)) {
            seepage -= dt * takes(i);
            return;
        }
        OpenSurface& surface = surfaces_[i % columns];
        surface.fallen += falls_on(i);
        surface.left += falls_on(i) - takes(i);
        surface.room += capacity[i] - takes(i);
    });
    for_each_node([&](size_t i) {
        const OpenSurface& surface = surfaces_[i % columns];
        if (facing_up(i) > 0 && surface.left > 0 && surface.room > 0)
            returned[i] += (capacity[i] - takes(i)) * std::min(surface.left / surface.room, 1.0);
    });
    for (const OpenSurface& surface : surfaces_) {
        const double leaves = std::max(surface.left - surface.room, 0.0), runs_off = std::min(leaves, surface.fallen);
        rained += dt * surface.fallen;
        run_off += dt * runs_off;
        seepage += dt * (leaves - runs_off);
    }
}

void GridMixture::solve(size_t node, double dt) {
    const double mass = momentum[node].mass, liquid_mass = liquid_momentum[node].mass;
    const NodeGradients& sums = gradients[node];
    const NodeMeans& mean = means[node];
    flux[node] = {};
    returned[node] = 0;
    capacity[node] = 0;
    evening[node] = {};
    if (!(mass > 0) || !(mean.volume > 0)) return;
    const double push = mean.push / mass;
    const double liquid_content = liquid_mass / (liquid_density * mean.volume);
    const double full_drag = dt * liquid_content * mean.resistance / (mass * liquid_density);
    const double drag = full_drag * mass / mean.permeability;
    const double conductance = dt * liquid_content / (1 + drag),
                 full_conductance = dt * liquid_content / (1 + full_drag);
    const double spread = evening_share * conductance * mean.volume / (cell_volume() * mass);
    evening[node] = {spread, spread * push};
    const double response = dt / (liquid_density * mean.volume);
    const double moved = liquid_mass / (1 + drag), coupled = mass + moved * drag;
    NodeVector &solid = velocity[node], &liquid = liquid_velocity[node];
    const auto move = [&](double NodeVector::*c, double pushed, double normal) {
        const double start = solid.*c, liquid_start = liquid.*c;
        const double alone = liquid_start + response * pushed;
        const double whole = mass * start + liquid_mass * liquid_start + dt * (force[node].*c - edge_pressure * normal);
        solid.*c = (whole - moved * alone) / coupled;
        liquid.*c = (alone + drag * solid.*c) / (1 + drag);
        flux[node].*c = liquid_mass / mean.volume * (liquid.*c - solid.*c);
    };
    const NodeVector outwards{sums.edge_x, sums.edge_y};
    const auto flow = [&](const NodeVector& pushed) {
        move(&NodeVector::x, pushed.x, outwards.x);
        move(&NodeVector::y, pushed.y, outwards.y);
    };
    const NodeVector inner{sums.push_x - push * outwards.x, sums.push_y - push * outwards.y};
    if (!is_at_edge(node)) {
        flow(inner);
        returned[node] = dot(flux[node], outwards);
        return;
    }
    const GroundEdge edge(outwards, mean.volume / cell_volume(), grid.cell_size);
    const double edge_head = gravity * liquid_density * (height_of(node) + edge.height);
    if (immersed) {
        flow({sums.push_x - edge_head * outwards.x, sums.push_y - edge_head * outwards.y});
        seepage += dt * dot(flux[node], outwards);
        return;
    }
    const NodeVector pushed = edge.stretched(inner);
    flow(pushed);
    flux[node] = edge.stretched(flux[node]);
    returned[node] = dot(flux[node], outwards);
    if (!(edge.distance > 0)) return;
    const double carried = returned[node] - conductance / mean.volume * dot(edge.stretched(pushed), outwards);
    const double drawn = full_conductance * edge.length * (edge_head - push) / edge.distance;
    capacity[node] = drawn - carried;
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
        evening[nodes.beyond] = evening[nodes.inside];
    });
}

}  // namespace talus
