// What the nodes of the Cartesian background hold, and their equation of motion.
#pragma once

#include "motion/explicit/walled_grid.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace talus {

struct NodeMomentum {
    double x = 0, y = 0;  ///< kg m/s
    double mass = 0;      ///< kg
    double more = 0;      ///< a sum that a mixture needs; four numbers are one register
};

struct NodeVector {
    double x = 0, y = 0;
};

/// What a wall mirrors adds to a vector inside.
template <class Vector>
void add_mirrored(Vector& inside, const Mirror& mirror, const Vector& beyond) {
    inside.x += mirror.x * beyond.x;
    inside.y += mirror.y * beyond.y;
}

/// Momentum and mass beyond a wall come inside.
inline void move_inside(NodeMomentum& inside, NodeMomentum& beyond, const Mirror& mirror) {
    add_mirrored(inside, mirror, beyond);
    inside.mass += beyond.mass;
    inside.more += beyond.more;
    beyond = {};
}

/// A bound of the speed that the nodes give a point, m/s; no number where a velocity is none. Nodes that only the rim of a spline reaches
/// have next to no mass and run away, but points see as little of them. `least_mass`: kg, of a point.
double speed_bound(const WalledGrid& grid, const std::vector<NodeMomentum>& momentum,
                   const std::vector<NodeVector>& velocity, double least_mass);

struct GridMotion : WalledGrid {
    double gravity = 0;                  ///< m/s2, downwards
    double least_mass = 0;               ///< kg, of a point
    double speed = 0;                    ///< m/s, largest_speed() at the end of the step
    std::vector<NodeMomentum> momentum;  ///< of the points where they came to lie
    std::vector<NodeVector> velocity;
    std::vector<NodeVector> force;  ///< the weight at first, then the stress's too, N
    std::vector<NodeMomentum>
        held;  ///< of points that are held: the mass, and x, y, force of their stress and weight, N; empty: none

    /// Velocities from momenta, and the nodes' weight as their first force.
    void begin_step();

    /// Velocities at the end of a step of dt (s). Momenta are zero afterwards.
    void end_step(double dt);

    [[nodiscard]] double largest_speed() const { return speed_bound(*this, momentum, velocity, least_mass); }

private:
    void mirror();
    void slide(bool with_friction);
    void meet(const Wall& wall, size_t axis, double outwards, NodePair nodes, bool with_friction);
};

}  // namespace talus
