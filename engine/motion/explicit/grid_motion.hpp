// What the nodes of the Cartesian background hold, and their equation of motion.
#pragma once

#include "background/grid.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace talus {

/// roller: no motion across the wall, nothing held along it; fixed: no motion; friction: the ground may slide, held by Coulomb's
/// friction, and leave the wall.
enum class WallKind { none, roller, fixed, friction };

/// A plane that holds the ground, along an axis of the grid and as long as the grid.
struct Wall {
    WallKind kind = WallKind::none;
    double place = 0;     ///< x of a left or right wall, y of the base, m
    double friction = 0;  ///< tangent of the friction angle
};

struct Walls {
    Wall left, right, base;
};

/// The columns of a row that points may reach; none where first = last.
struct Span {
    int32_t first = 0;
    int32_t last = 0;
};

struct NodeMomentum {
    double x = 0, y = 0;  ///< kg m/s
    double mass = 0;      ///< kg
    double unused = 0;    ///< four numbers are one register
};

struct NodeVector {
    double x = 0, y = 0;
};

struct GridMotion {
    Grid grid;
    Walls walls;
    double gravity = 0;                  ///< m/s2, downwards
    double least_mass = 0;               ///< kg, of a point
    double speed = 0;                    ///< m/s, largest_speed() at the end of the step
    std::vector<Span> spans;             ///< one a row: outside them all is zero
    std::vector<NodeMomentum> momentum;  ///< of the points where they came to lie
    std::vector<NodeVector> velocity;
    std::vector<NodeVector> force;  ///< the weight at first, then the stress's too, N

    /// Velocities from momenta, and the nodes' weight as their first force.
    void begin_step();

    /// Velocities at the end of a step of dt (s). Momenta are zero afterwards.
    void end_step(double dt);

    /// A bound of the speed that the nodes give a point, m/s; no number where a velocity is none. Nodes that only the rim of a spline reaches
    /// have next to no mass and run away, but points see as little of them.
    [[nodiscard]] double largest_speed() const;

private:
    /// Two nodes on either side of a wall.
    struct Pair {
        size_t inside, beyond;
    };
    template <class Use>
    void for_each_node(const Use& use);
    template <class Use>
    void for_each_pair(const Wall& wall, size_t axis, int32_t inwards, const Use& use);
    template <class Use>
    void for_each_wall(const Use& use);
    template <class Fold>
    void fold(const Fold& fold);
    void mirror();
    void slide(bool with_friction);
    void meet(const Wall& wall, size_t axis, double outwards, Pair nodes, bool with_friction);
};

}  // namespace talus
