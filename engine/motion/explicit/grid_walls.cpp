// Nodes on either side of a wall come together as the mirrored ground has it; on a wall with friction while the ground is there.
#include "motion/explicit/grid_mixture.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace talus {
namespace {

size_t from(size_t node, std::ptrdiff_t step) { return static_cast<size_t>(static_cast<std::ptrdiff_t>(node) + step); }

void add_mirrored(NodeGradients& inside, const Mirror& mirror, const NodeGradients& beyond) {
    inside.push_x += mirror.x * beyond.push_x;
    inside.push_y += mirror.y * beyond.push_y;
    inside.edge_x += mirror.x * beyond.edge_x;
    inside.edge_y += mirror.y * beyond.edge_y;
}

void add_mirrored(NodeMoments& inside, const Mirror& mirror, const NodeMoments& beyond) {
    inside.xx += beyond.xx;
    inside.yy += beyond.yy;
    inside.yx += mirror.x * mirror.y * beyond.yx;
    inside.xy += mirror.x * mirror.y * beyond.xy;
}

/// The mirror turns the bedding's dip about.
void add_mirrored_bedding(NodeVector& inside, const Mirror& mirror, const NodeVector& beyond) {
    inside.x += beyond.x;
    inside.y += mirror.x * mirror.y * beyond.y;
}

void add(NodeMeans& inside, const NodeMeans& beyond) {
    inside.push += beyond.push;
    inside.permeability += beyond.permeability;
    inside.volume += beyond.volume;
    inside.resistance += beyond.resistance;
}

void add(NodeMeansBesideGas& inside, const NodeMeansBesideGas& beyond) {
    inside.push += beyond.push;
    inside.mobility += beyond.mobility;
    inside.volume += beyond.volume;
    inside.edge_mobility += beyond.edge_mobility;
}

}  // namespace

/// From a node along a wall across an axis to the next one along it where the first is beyond another wall; 0 where it is not.
template <bool has_gas, bool exchanges>
std::ptrdiff_t GridMixture<has_gas, exchanges>::to_inner(size_t node, size_t axis) const {
    const std::ptrdiff_t stride = grid.cells[0];
    const auto row = static_cast<int32_t>(node / static_cast<size_t>(stride));
    const auto column = static_cast<int32_t>(node % static_cast<size_t>(stride));
    const auto is_beyond = [&](const Wall& wall, int32_t inwards, int32_t place) {
        return wall.kind != WallKind::none && place == line_at(wall, 1 - axis, inwards) - inwards;
    };
    if (axis == 0) return is_beyond(walls.base, 1, row) ? stride : is_beyond(walls.top, -1, row) ? -stride : 0;
    return is_beyond(walls.left, 1, column) ? 1 : is_beyond(walls.right, -1, column) ? -1 : 0;
}

template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::forget_contacts() {
    contacts_.clear();
    contact_at_.assign(grid.nodes(), -1);
    for (auto& contact : contact_beyond_) contact.assign(grid.nodes(), -1);
}

/// Of stress and weight on two nodes, less what the inner one has got in advance, N.
template <bool has_gas, bool exchanges>
double GridMixture<has_gas, exchanges>::force_across(NodePair nodes, size_t axis, double weight) const {
    const auto [inside, beyond] = nodes;
    if (axis == 0) return force[inside].x + force[beyond].x;
    double mass =
        momentum[inside].mass + momentum[beyond].mass + liquid_momentum[inside].mass + liquid_momentum[beyond].mass;
    if constexpr (has_gas) mass += gas.momentum[inside].mass + gas.momentum[beyond].mass;
    return force[inside].y + force[beyond].y - weight - gravity * mass;
}

/// Whether the ground at a wall with friction runs into it, within dt by the forces on it: then it is a contact. In a corner the nodes beyond one wall do by
/// the other as those inside it.
template <bool has_gas, bool exchanges>
bool GridMixture<has_gas, exchanges>::touch(const Wall& wall, size_t axis, int32_t inwards, NodePair nodes, double dt) {
    const size_t inside = nodes.inside, beyond = nodes.beyond;
    Contact contact{&wall, axis, inwards};
    const auto add = [&](const std::vector<NodeMomentum>& phase, double& difference) {
        difference = phase[inside].mass - phase[beyond].mass;
        contact.pushed += axis == 0 ? phase[inside].x + phase[beyond].x : phase[inside].y + phase[beyond].y;
    };
    add(momentum, contact.solid);
    add(liquid_momentum, contact.liquid);
    if constexpr (has_gas) add(gas.momentum, contact.gas);
    const std::ptrdiff_t inner = to_inner(inside, axis);
    if (inner != 0) {
        if (contact_beyond_[axis][from(beyond, inner)] < 0) return false;
    } else {
        const double force_by_then = dt > 0 ? force_across(nodes, axis, 0) : 0;
        if (inwards * (contact.pushed + dt * force_by_then) >= 0) return false;  // it leaves the wall
    }
    const auto number = static_cast<int32_t>(contacts_.size());
    int32_t& first = contact_at_[is_held_below(inside, axis, inner) ? from(inside, inner) : inside];
    contact.other = std::exchange(first, number);
    contact_beyond_[axis][beyond] = number;
    contacts_.push_back(contact);
    return true;
}

/// Whether a node along an upright wall is beyond a level one, too, that holds the ground there by now: its sums come to the one inside that.
template <bool has_gas, bool exchanges>
bool GridMixture<has_gas, exchanges>::is_held_below(size_t node, size_t axis, std::ptrdiff_t inner) const {
    if (axis == 1 || inner == 0) return false;
    const Wall& level = inner > 0 ? walls.base : walls.top;
    return level.kind != WallKind::friction || contact_beyond_[1][node] >= 0;
}

/// What rubs on one wall beyond another does so inside it, too.
template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::join_contacts(NodePair nodes) {
    int32_t* last = &contact_at_[nodes.inside];
    while (*last >= 0) last = &contacts_[static_cast<size_t>(*last)].other;
    *last = contact_at_[nodes.beyond];
}

template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::fold_momenta(NodePair nodes, const Mirror& mirror, const Mirror& even) {
    const auto [inside, beyond] = nodes;
    double mass = momentum[beyond].mass + liquid_momentum[beyond].mass;
    if constexpr (has_gas) mass += gas.momentum[beyond].mass;
    move_inside(force[inside], force[beyond], mirror, gravity * mass);
    move_inside(momentum[inside], momentum[beyond], mirror);
    move_inside(liquid_momentum[inside], liquid_momentum[beyond], even);
    returned[inside] += returned[beyond];
    returned[beyond] = 0;
    if (rubs_) join_contacts(nodes);
    if constexpr (has_gas) {
        move_inside(gas.momentum[inside], gas.momentum[beyond], even);
        gas.weight[inside] += gas.weight[beyond];  // what is left beyond nobody reads
        gas.returned[inside] += gas.returned[beyond];
        gas.returned[beyond] = 0;
    }
}

/// Where a wall rubs: pair by pair, as one may bring another into touch.
template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::meet_contacts() {
    forget_contacts();
    for_each_wall_pair([this](const Wall& wall, size_t axis, int32_t inwards, NodePair nodes) {
        const bool rubs = wall.kind == WallKind::friction;
        if (rubs && !touch(wall, axis, inwards, nodes, 0)) return;
        const double before = force[nodes.inside].y;
        fold_momenta(nodes, mirror_of(wall, axis), even_mirror(axis));
        if (rubs && axis == 1) contacts_.back().weight = force[nodes.inside].y - before;
    });
}

template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::fold_momenta() {
    rubs_ = rubs_along_walls();
    if (rubs_) meet_contacts();
    for_each_meeting([this](NodePair nodes, const Mirror& mirror, const Mirror& even) {
        if (!rubs_) fold_momenta(nodes, mirror, even);
        if constexpr (exchanges) fold_solutes(nodes);
    });
}

template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::fold_momenta_of(size_t part) {
    for_each_meeting_of(part, [this](NodePair nodes, const Mirror& mirror, const Mirror& even) {
        fold_momenta(nodes, mirror, even);
        if constexpr (exchanges) fold_solutes(nodes);
    });
}

/// Whether the ground is on a wall with friction at the end of the step, and how it presses on that; where only the step's forces bring it there, its
/// momenta come together now.
template <bool has_gas, bool exchanges>
bool GridMixture<has_gas, exchanges>::presses(const Wall& wall, size_t axis, int32_t inwards, NodePair nodes,
                                              double dt) {
    const bool is_new = contact_beyond_[axis][nodes.beyond] < 0;
    if (is_new && !touch(wall, axis, inwards, nodes, dt)) return false;
    Contact& contact = contacts_[static_cast<size_t>(contact_beyond_[axis][nodes.beyond])];
    const NodeGradients &inside = gradients[nodes.inside], &beyond = gradients[nodes.beyond];
    const double edge = axis == 0 ? inside.edge_x + beyond.edge_x : inside.edge_y + beyond.edge_y;
    contact.area = std::max(-inwards * edge, 0.0);
    contact.force = force_across(nodes, axis, contact.weight);
    if (!is_new) return true;
    fold_momenta(nodes, even_mirror(axis), even_mirror(axis));
    find_velocities(nodes.inside);
    return true;
}

template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::fold_forces(NodePair nodes, const Mirror& mirror, const Mirror& even) {
    const auto [inside, beyond] = nodes;
    add_mirrored(force[inside], mirror, force[beyond]);
    add_mirrored(gradients[inside], even, gradients[beyond]);
    gradients[beyond] = {};
    add(means[inside], means[beyond]);
    means[beyond] = {};
    if (!anisotropy.empty()) {
        add_mirrored_bedding(anisotropy[inside], even, anisotropy[beyond]);
        anisotropy[beyond] = {};
    }
    if (!moments.empty()) {
        add_mirrored(moments[inside], even, moments[beyond]);
        add_mirrored(places[inside], even, places[beyond]);
        moments[beyond] = {};
        places[beyond] = {};
    }
    if constexpr (has_gas) {  // what is left beyond the wall nobody reads
        add_mirrored(gas.gradients[inside], even, gas.gradients[beyond]);
        GasMeans& gas_in = gas.means[inside];
        const GasMeans& gas_out = gas.means[beyond];
        gas_in.push += gas_out.push;
        gas_in.mobility += gas_out.mobility;
        gas_in.volume += gas_out.volume;
        gas_in.mass += gas_out.mass;
    }
}

template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::fold_forces(double dt) {
    if (rubs_) {
        for_each_wall_pair([&](const Wall& wall, size_t axis, int32_t inwards, NodePair nodes) {
            if (wall.kind != WallKind::friction || presses(wall, axis, inwards, nodes, dt))
                fold_forces(nodes, mirror_of(wall, axis), even_mirror(axis));
        });
    }
    for_each_meeting([this](NodePair nodes, const Mirror& mirror, const Mirror& even) {
        if (!rubs_) fold_forces(nodes, mirror, even);
        if constexpr (exchanges) fold_solute_means(nodes, even);
    });
}

template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::fold_forces_of(size_t part) {
    for_each_meeting_of(part, [this](NodePair nodes, const Mirror& mirror, const Mirror& even) {
        fold_forces(nodes, mirror, even);
        if constexpr (exchanges) fold_solute_means(nodes, even);
    });
}

/// Friction along walls takes at most its coefficient times the impulse that presses the skeleton on them: the whole ground's, less what the pores' fluid
/// bears there; suction presses nothing.
template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::rub(size_t node, double dt, const ImpulseAnswers& answers) {
    NodeVector &solid = velocity[node], &liquid = liquid_of(fluid_velocity[node]), &through = liquid_of(flux[node]);
    const auto for_each_contact = [&](const auto& use) {
        for (int32_t number = contact_at_[node]; number >= 0; number = contacts_[static_cast<size_t>(number)].other)
            use(contacts_[static_cast<size_t>(number)]);
    };
    for_each_contact([&](Contact& contact) {
        const auto across = contact.axis == 0 ? &NodeVector::x : &NodeVector::y;
        const double height = contact.axis == 0 ? height_of(node) : contact.wall->place;
        double momentum_left = contact.solid * solid.*across + contact.liquid * liquid.*across;
        double pore_pressure = std::max(answers.head - liquid_density * gravity * height, 0.0);
        if constexpr (has_gas) {
            momentum_left += contact.gas * fluid_velocity[node].gas.*across;
            if (answers.gas_density > 0) pore_pressure = gas.pressure(answers.gas_potential - gravity * height);
        }
        const double impulse = contact.inwards * (momentum_left - contact.pushed - dt * contact.force);
        contact.pressing = std::max(impulse - dt * pore_pressure * contact.area, 0.0);
    });
    for_each_contact([&](const Contact& contact) {
        const auto along = contact.axis == 0 ? &NodeVector::y : &NodeVector::x;
        const ImpulseAnswer& answer = contact.axis == 0 ? answers.y : answers.x;
        const double change =
            slowed(solid.*along, contact.wall->friction * contact.pressing / answer.mass) - solid.*along;
        NodeVector own;
        own.*along = 1;
        const auto follow = [&](NodeVector& fluid, NodeVector& flux, const NodeVector& follows, double density) {
            fluid = {fluid.x + follows.x * change, fluid.y + follows.y * change};
            flux = {flux.x + density * (follows.x - own.x) * change, flux.y + density * (follows.y - own.y) * change};
        };
        solid.*along += change;
        follow(liquid, through, answer.liquid, answers.liquid_density);
        if constexpr (has_gas) follow(fluid_velocity[node].gas, flux[node].gas, answer.gas, answers.gas_density);
    });
}

/// Beyond a wall the nodes move as the mirrored ground would; water slides along every wall.
template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::mirror(NodePair nodes, const Mirror& mirror, const Mirror& even) {
    const auto [inside, beyond] = nodes;
    velocity[beyond] = mirrored(velocity[inside], mirror);
    fluid_velocity[beyond] = mirrored(fluid_velocity[inside], even);
    flux[beyond] = mirrored(flux[inside], even);
    rates[beyond] = rates[inside];
    evening[beyond] = evening[inside];
    if constexpr (exchanges) mirror_solutes(nodes, even);
}

template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::mirror() {
    for_each_meeting([this](NodePair nodes, const Mirror& sign, const Mirror& even) { mirror(nodes, sign, even); });
}

template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::mirror_part(size_t part) {
    for_each_meeting_of(part,
                        [this](NodePair nodes, const Mirror& sign, const Mirror& even) { mirror(nodes, sign, even); });
}

template void GridMixture<false>::fold_momenta();
template void GridMixture<false>::fold_momenta_of(size_t part);
template void GridMixture<false>::fold_forces(double dt);
template void GridMixture<false>::fold_forces_of(size_t part);
template void GridMixture<false>::rub(size_t node, double dt, const ImpulseAnswers& answers);
template void GridMixture<false>::mirror();
template void GridMixture<false>::mirror_part(size_t part);
template void GridMixture<true>::fold_momenta();
template void GridMixture<true>::fold_momenta_of(size_t part);
template void GridMixture<true>::fold_forces(double dt);
template void GridMixture<true>::fold_forces_of(size_t part);
template void GridMixture<true>::rub(size_t node, double dt, const ImpulseAnswers& answers);
template void GridMixture<true>::mirror();
template void GridMixture<true>::mirror_part(size_t part);
template void GridMixture<true, true>::fold_momenta();
template void GridMixture<true, true>::fold_momenta_of(size_t part);
template void GridMixture<true, true>::fold_forces(double dt);
template void GridMixture<true, true>::fold_forces_of(size_t part);
template void GridMixture<true, true>::rub(size_t node, double dt, const ImpulseAnswers& answers);
template void GridMixture<true, true>::mirror();
template void GridMixture<true, true>::mirror_part(size_t part);

}  // namespace talus
