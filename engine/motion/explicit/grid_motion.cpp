#include "motion/explicit/grid_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace talus {

/// use(part, bound of its speeds), for the parts of the grid at the same time.
template <class Use>
void GridMotion::for_each_part(const Use& use) {
    bounds_.assign(parts(), SpeedBound(least_mass));
    threads.for_each(parts(), [&](size_t part) {
        SpeedBound bound(least_mass);
        use(part, bound);
        bounds_[part] = bound;
    });
}

void GridMotion::finish(size_t node, SpeedBound& bound) {
    bound.add(momentum[node].mass, velocity[node]);
    momentum[node] = {};
    force[node] = {};
}

double GridMotion::bound_of_speed() {
    SpeedBound bound(least_mass);
    for (const SpeedBound& part : bounds_) bound.add(part);
    return bound.value();
}

/// Beyond a wall the nodes move as the mirrored ground would, so that what is interpolated on the wall is zero across it, and along it
/// where it is fixed.
void GridMotion::mirror(NodePair nodes, const Mirror& sign) {
    velocity[nodes.beyond] = mirrored(velocity[nodes.inside], sign);
}

void GridMotion::mirror_upright(size_t part) {
    for_each_upright_mirror_of(part,
                               [this](NodePair nodes, const Mirror& sign, const Mirror&) { mirror(nodes, sign); });
}

void GridMotion::mirror_level() {
    for_each_level_mirror([this](NodePair nodes, const Mirror& sign, const Mirror&) { mirror(nodes, sign); });
}

void GridMotion::begin_step() {
    const bool rubs = rubs_along_walls();
    const auto come_inside = [this](NodePair nodes, const Mirror& sign, const Mirror&) {
        move_inside(force[nodes.inside], force[nodes.beyond], sign, gravity * momentum[nodes.beyond].mass);
        move_inside(momentum[nodes.inside], momentum[nodes.beyond], sign);
    };
    for_each_level_mirror(come_inside);
    for_each_part([&](size_t part, SpeedBound& bound) {
        for_each_upright_mirror_of(part, come_inside);
        for_each_node_of(part, [&](size_t node) {
            force[node].y -= gravity * momentum[node].mass;
            const double inverse = momentum[node].mass > 0 && !is_still(node) ? 1 / momentum[node].mass : 0;
            velocity[node] = velocity_of(momentum[node].x, momentum[node].y, inverse);
            bound.add(momentum[node].mass, velocity[node]);
        });
        if (!rubs) mirror_upright(part);
    });
    start_speed = bound_of_speed();  // walls make no node faster
    if (rubs) {
        slide(false);
        for (size_t part = 0; part < parts(); ++part) mirror_upright(part);
    }
    mirror_level();
}

void GridMotion::end_step(double dt) {
    const bool rubs = rubs_along_walls();
    const auto come_inside = [this](NodePair nodes, const Mirror& sign, const Mirror&) {
        add_mirrored(force[nodes.inside], sign, force[nodes.beyond]);
    };
    for_each_level_mirror(come_inside);
    for_each_part([&](size_t part, SpeedBound& bound) {
        for_each_upright_mirror_of(part, come_inside);
        for_each_node_of(part, [&](size_t node) {
            const double response = momentum[node].mass > 0 && !is_still(node) ? dt / momentum[node].mass : 0;
            velocity[node].x += response * force[node].x;
            velocity[node].y += response * force[node].y;
            if (!rubs) finish(node, bound);
        });
        if (!rubs) mirror_upright(part);
    });
    if (rubs) {  // by the nodes' masses
        slide(true);
        for_each_part([this](size_t part, SpeedBound& bound) {
            for_each_node_of(part, [&](size_t node) { finish(node, bound); });
        });
        for (size_t part = 0; part < parts(); ++part) mirror_upright(part);
    }
    mirror_level();
    speed = bound_of_speed();
}

void GridMotion::slide(bool with_friction) {
    for_each_corner([&](const Corner& corner) { meet(corner, with_friction); });
    for_each_wall([&](const Wall& wall, size_t axis, int32_t inwards) {
        if (wall.kind != WallKind::friction) return;
        for_each_pair(wall, axis, inwards, [&](NodePair nodes) { meet(wall, axis, -inwards, nodes, with_friction); });
    });
}

/// Ground that runs into both walls of a corner: wall after wall, what the one leaves would run into the other. Its four nodes get the velocity and
/// its mirror images that the mirrored ground would have, less what the friction of either wall takes off along it; the walls leave that alone.
void GridMotion::meet(const Corner& corner, bool with_friction) {
    constexpr std::array<Mirror, 4> mirrors{{{1, 1}, {-1, 1}, {1, -1}, {-1, -1}}};
    if (is_still(corner.nodes[0])) {
        for (const size_t node : corner.nodes) velocity[node] = {};
        return;
    }
    double mass = 0;
    NodeVector sum, mirrored, inside;  // of momentum; of its mirror images inside; of mass times the mirror
    for (size_t k = 0; k < 4; ++k) {
        const double own = momentum[corner.nodes[k]].mass;
        const NodeVector& v = velocity[corner.nodes[k]];
        mass += own;
        sum = {sum.x + own * v.x, sum.y + own * v.y};
        mirrored = {mirrored.x + own * mirrors[k].x * v.x, mirrored.y + own * mirrors[k].y * v.y};
        inside = {inside.x + own * mirrors[k].x, inside.y + own * mirrors[k].y};
    }
    if (!(mass > 0) || corner.inwards_x * sum.x >= 0 || corner.inwards_y * sum.y >= 0) return;  // it leaves a wall
    NodeVector common{mirrored.x / mass, mirrored.y / mass};
    const double impulse_x = std::abs(inside.x * common.x - sum.x), impulse_y = std::abs(inside.y * common.y - sum.y);
    if (with_friction) {
        common.x = slowed(common.x, corner.level->friction * impulse_y / mass);
        common.y = slowed(common.y, corner.side->friction * impulse_x / mass);
    }
    for (size_t k = 0; k < 4; ++k) velocity[corner.nodes[k]] = {mirrors[k].x * common.x, mirrors[k].y * common.y};
}

/// Ground that runs into a wall: the two nodes get the one velocity that the mirrored ground would have, and along the wall the momentum
/// that friction leaves of theirs.
void GridMotion::meet(const Wall& wall, size_t axis, double outwards, NodePair nodes, bool with_friction) {
    if (is_still(nodes.inside)) {
        velocity[nodes.beyond] = {};
        return;
    }
    const double mass_inside = momentum[nodes.inside].mass, mass_beyond = momentum[nodes.beyond].mass;
    const double mass = mass_inside + mass_beyond;
    if (!(mass > 0)) return;
    const auto across = axis == 0 ? &NodeVector::x : &NodeVector::y;
    const auto along = axis == 0 ? &NodeVector::y : &NodeVector::x;
    NodeVector &in = velocity[nodes.inside], &out = velocity[nodes.beyond];
    const double pushed = mass_inside * in.*across + mass_beyond * out.*across;
    if (outwards * pushed <= 0) return;  // it leaves the wall
    const double speed = (mass_inside * in.*across - mass_beyond * out.*across) / mass;
    const double impulse = std::abs((mass_inside - mass_beyond) * speed - pushed);
    double sliding = (mass_inside * in.*along + mass_beyond * out.*along) / mass;
    if (with_friction) sliding = slowed(sliding, wall.friction * impulse / mass);
    in.*across = speed;
    out.*across = -speed;
    in.*along = out.*along = sliding;
}

}  // namespace talus
