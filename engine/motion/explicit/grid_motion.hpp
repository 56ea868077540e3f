// What the nodes of the Cartesian background hold, and their equation of motion.
#pragma once

#include "motion/explicit/walled_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
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

inline double dot(const NodeVector& a, const NodeVector& b) { return a.x * b.x + a.y * b.y; }

/// Of two fluids, side by side: four numbers are one register.
struct NodePairOfVectors {
    NodeVector liquid, gas;
};

/// A node's fluids: a liquid, or a liquid and a gas that moves.
template <bool has_gas>
using NodeFluids = std::conditional_t<has_gas, NodePairOfVectors, NodeVector>;
inline NodeVector& liquid_of(NodeVector& liquid) { return liquid; }
inline NodeVector& liquid_of(NodePairOfVectors& fluids) { return fluids.liquid; }

/// A momentum's velocity; speeds below any that matters are none: between walls they halve in every step, down to numbers below 2e-308, which processors
/// are slow with.
inline NodeVector velocity_of(double x, double y, double per_mass) {
    constexpr double least = 1e-100;  // m/s
    const double along_x = x * per_mass, along_y = y * per_mass;
    return {std::abs(along_x) < least ? 0 : along_x, std::abs(along_y) < least ? 0 : along_y};
}

/// What friction leaves of a speed that it can take so much off.
inline double slowed(double speed, double by) { return std::copysign(std::max(std::abs(speed) - by, 0.0), speed); }

inline NodeVector mirrored(const NodeVector& vector, const Mirror& mirror) {
    return {mirror.x * vector.x, mirror.y * vector.y};
}
inline NodePairOfVectors mirrored(const NodePairOfVectors& vectors, const Mirror& mirror) {
    return {mirrored(vectors.liquid, mirror), mirrored(vectors.gas, mirror)};
}

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

/// A force beyond a wall comes inside, and what the mirror changes of the weight there: that is mirrored as any force, and the mass it belongs to will be
/// weighed inside, so that where the wall turns it about twice of it is missing.
inline void move_inside(NodeVector& inside, NodeVector& beyond, const Mirror& mirror, double weight) {
    add_mirrored(inside, mirror, beyond);
    inside.y += (1 - mirror.y) * weight;
    beyond = {};
}

/// A bound of the speed that nodes give a point. Nodes that only the rim of a spline reaches have next to no mass and run away, but points see
/// as little of them: a point of mass m sees at most M / m of the velocity of a node of mass M. Where M is below a share of the least m, the
/// velocity counts as that much less; of nine such nodes together a point sees at most nine shares of the largest one counted.
class SpeedBound {
public:
    explicit SpeedBound(double least_mass)  ///< kg, of a point
        : per_mass_(1 / std::max(light_share * least_mass, std::numeric_limits<double>::min())) {}

    void add(double mass, const NodeVector& velocity) {
        const double weight = std::min(mass * per_mass_, 1.0);
        const double x = weight * velocity.x, y = weight * velocity.y, square = x * x + y * y;
        largest_ = std::max(largest_, square);
        sum_ += square;
    }
    void add(const SpeedBound& other) {
        largest_ = std::max(largest_, other.largest_);
        sum_ += other.sum_;
    }
    /// m/s; no number where a velocity is none.
    [[nodiscard]] double value() const {
        return std::isfinite(sum_) ? (1 + 9 * light_share) * std::sqrt(largest_) : sum_;
    }

private:
    static constexpr double light_share = 1.0 / 900;
    double per_mass_, largest_ = 0, sum_ = 0;  // the largest of numbers and NaN may be a number, their sum is none
};

struct GridMotion : WalledGrid {
    double gravity = 0;                  ///< m/s2, downwards
    double least_mass = 0;               ///< kg, of a point
    double speed = 0;                    ///< m/s, a bound of the points' in the step, from its end
    double start_speed = 0;              ///< likewise, from its start
    std::vector<NodeMomentum> momentum;  ///< of the points where they came to lie
    std::vector<NodeVector> velocity;
    std::vector<NodeVector> force;  ///< the weight at first, then the stress's too, N

    /// Velocities from momenta, and the nodes' weight as their first force.
    void begin_step();

    /// Velocities at the end of a step of dt (s). Momenta are zero afterwards.
    void end_step(double dt);

private:
    [[nodiscard]] double bound_of_speed();
    template <class Use>
    void for_each_part(const Use& use);
    void finish(size_t node, SpeedBound& bound);
    void mirror(NodePair nodes, const Mirror& sign);
    void mirror_upright(size_t part);
    void mirror_level();
    void slide(bool with_friction);
    void meet(const Corner& corner, bool with_friction);
    void meet(const Wall& wall, size_t axis, double outwards, NodePair nodes, bool with_friction);

    std::vector<SpeedBound> bounds_;  // one a part of the grid
};

}  // namespace talus
