// The axes along which the ground at a node conducts water and gas, each on its own: along the bedding and across it.
//
// With the anisotropy a = |K_along - K_across| / (K_along + K_across), which is the same for all fluids, the resistance to flow, 1 / K, is its mean over
// all directions times 1 - a where it is least and times 1 + a where it is greatest. a times cosine and sine of twice the dip turns as the tensor
// does, and is averaged as the tensor is.
#pragma once

#include "materials/hydraulic/parameters.hpp"
#include "motion/explicit/grid_motion.hpp"
#include "motion/explicit/ground_edge.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace talus {

inline double size_of(const NodeVector& v) { return std::hypot(v.x, v.y); }

inline double anisotropy_size(const Conductivity& conductivity) {
    constexpr double most =
        1 - 1e-12;  // more is lost by rounding: the better direction then conducts 2e12 times as well
    const double difference = std::abs(conductivity.along - conductivity.across);
    return std::min(difference / (conductivity.along + conductivity.across), most);
}

/// That of the mean resistance over all directions, m/s.
inline double mean_conductivity(const Conductivity& conductivity) {
    return std::min(conductivity.along, conductivity.across) * (1 + anisotropy_size(conductivity));
}

/// a times cosine and sine of twice the dip of the direction that conducts best.
inline NodeVector anisotropy_of(const Conductivity& conductivity) {
    const double size = std::copysign(anisotropy_size(conductivity), conductivity.along - conductivity.across);
    const double twice_dip = 2 * conductivity.dip * std::numbers::pi / 180;
    return {size * std::cos(twice_dip), size * std::sin(twice_dip)};
}

/// Of ground that conducts alike in all directions: x and y, one value for both.
struct AnyAxes {
    static constexpr size_t count = 1;
    using Values = std::array<double, count>;

    template <class Find>
    [[nodiscard]] static auto each(const Find& find) {
        return std::array{find(0.0)};
    }
    [[nodiscard]] static NodeVector turned(const NodeVector& v) { return v; }
    [[nodiscard]] static NodeVector turned_back(const NodeVector& v) { return v; }
    [[nodiscard]] static NodeVector product(const Values& conductance, const NodeVector& v) {
        return {conductance[0] * v.x, conductance[0] * v.y};
    }
    [[nodiscard]] static double along(const Values& conductance, const NodeVector&) { return conductance[0]; }
    [[nodiscard]] static double driven_out(const Values& conductance, const GroundEdge& edge, const NodeVector& pushed,
                                           const NodeVector& outwards) {
        return conductance[0] * dot(edge.stretched(pushed), outwards);
    }
};

/// Where the ground conducts best, along the bedding as a rule, and across that.
class BeddingAxes {
public:
    static constexpr size_t count = 2;
    using Values = std::array<double, count>;

    /// `anisotropy`: times cosine and sine of twice the dip; not none.
    explicit BeddingAxes(const NodeVector& anisotropy) : anisotropy_(size_of(anisotropy)) {
        const NodeVector half = anisotropy.x > 0 ? NodeVector{anisotropy_ + anisotropy.x, anisotropy.y}
                                                 : NodeVector{anisotropy.y, anisotropy_ - anisotropy.x};
        const double length = size_of(half);
        bedding_ = {half.x / length, half.y / length};
    }

    /// find(anisotropy) for both.
    template <class Find>
    [[nodiscard]] auto each(const Find& find) const {
        return std::array{find(anisotropy_), find(-anisotropy_)};
    }
    [[nodiscard]] NodeVector turned(const NodeVector& v) const {
        return {bedding_.x * v.x + bedding_.y * v.y, bedding_.x * v.y - bedding_.y * v.x};
    }
    [[nodiscard]] NodeVector turned_back(const NodeVector& v) const {
        return {bedding_.x * v.x - bedding_.y * v.y, bedding_.y * v.x + bedding_.x * v.y};
    }
    /// Of the tensor with these values and a vector.
    [[nodiscard]] NodeVector product(const Values& conductance, const NodeVector& v) const {
        const NodeVector own = turned(v);
        return turned_back({conductance[0] * own.x, conductance[1] * own.y});
    }
    [[nodiscard]] double along(const Values& conductance, const NodeVector& normal) const {
        return dot(normal, product(conductance, normal));
    }
    /// What the push along an edge's normal drives through it. What the push along the edge drives through it goes on beyond.
    [[nodiscard]] double driven_out(const Values& conductance, const GroundEdge& edge, const NodeVector& pushed,
                                    const NodeVector& outwards) const {
        const double across = dot(edge.normal, pushed);
        const NodeVector along_edge{pushed.x - across * edge.normal.x, pushed.y - across * edge.normal.y};
        return dot(edge.stretched(product(conductance, pushed)), outwards) -
               dot(product(conductance, along_edge), outwards);
    }

private:
    double anisotropy_;
    NodeVector bedding_;  // its direction
};

}  // namespace talus
