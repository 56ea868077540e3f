// The edge of the ground in the surroundings of a node, found from the sums of V N and of V grad N over points.
//
// For a linear field p, integral of (p - mean p) grad N is less there than -V grad p, with V = integral of N, because the surroundings are
// ground on one side alone: a quarter of it where only the tip of N lies in the ground. Force and flow are both stretched along the edge's
// normal by the square root of what is missing: they stay each other's adjoint, and a linear pressure drives the flow that it should.
#pragma once

#include "motion/explicit/grid_motion.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

/// Ground that fills a share of a node's surroundings up to a level edge.
struct LevelEdge {
    double above = 0;  ///< of the edge, from the node, in cells
    double sidedness =
        1;  ///< V over integral of -(y - mean y) dN/dy: 1 in full surroundings, 4 in all that hold less than a sixth
    double variance = 0;  ///< of y in V, in squares of a cell
    explicit LevelEdge(double share);
};

inline LevelEdge::LevelEdge(double share) {
    double spline = 0, moment = 0, second = 0;  // N at the edge; integrals of y N and y^2 N up to it
    if (share <= 1.0 / 6) {
        const double reach = std::cbrt(6 * share);
        above = reach - 1.5;
        sidedness = 4;
        variance = 3.0 / 80 * reach * reach;
        return;
    }
    if (share < 5.0 / 6) {
        for (int i = 0; i < 8; ++i) above = (share - 0.5 + above * above * above / 3) / 0.75;
        spline = 0.75 - above * above;
        moment = -13.0 / 64 + above * above * (0.375 - 0.25 * above * above);
        second = 0.125 + above * above * above * (0.25 - 0.2 * above * above);
    } else {
        const double rest = std::cbrt(6 * std::max(1 - share, 0.0));
        above = 1.5 - rest;
        spline = 0.5 * rest * rest;
        moment = -rest * rest * rest * (0.25 - 0.125 * rest);
        second = 0.25 - rest * rest * rest * (0.375 - rest * (0.375 - 0.1 * rest));
    }
    const double mean = moment / share;
    sidedness = share / (share - (above - mean) * spline);
    variance = second / share - mean * mean;
}

/// Sums over points, r being their place from the node: of V x dN/dx, V y dN/dy, V y dN/dx, V x dN/dy, m2.
struct NodeMoments {
    double xx = 0, yy = 0, yx = 0, xy = 0;
};

struct GroundEdge {
    NodeVector normal;      ///< outwards; none where the sum of V grad N is none
    double length = 0;      ///< that sum's, m
    double above = 0;       ///< of the edge, from the node along the normal, m
    double height = 0;      ///< of the edge above the node, m
    double distance = 0;    ///< from the middle of the ground to the edge, m; 0: no edge
    double more = 0;        ///< what a stretch adds along the normal, per unit
    double reach = 0;       ///< depth of the ground in the surroundings, m
    double spread = 0;      ///< variance of that depth times the square of 1 + more, m2
    bool is_blind = false;  ///< to a gradient along the normal: its points lie hardly apart

    /// `sum`: of V grad N, m; `share`: of the node's surroundings that is ground.
    GroundEdge(const NodeVector& sum, double share, double cell_size) {
        length = std::hypot(sum.x, sum.y);
        if (!(length > 0)) return;
        const LevelEdge level(share);
        normal = {sum.x / length, sum.y / length};
        above = level.above * cell_size;
        height = above * normal.y;
        distance = share * cell_size * cell_size * (1 - 1 / level.sidedness) / length;
        more = std::sqrt(level.sidedness) - 1;
        reach = (level.above + 1.5) * cell_size;
        spread = level.sidedness * level.variance * cell_size * cell_size;
    }

    /// Takes from the points themselves what the share tells of ground that is evenly filled: then a linear field drives the very flow that it should,
    /// however few the points are. `volume`, `sum`: of V N and of V grad N; `middle`: of N m r over that of N m, m.
    void fit(double volume, const NodeVector& sum, const NodeVector& middle, const NodeMoments& moments) {
        if (!(length > 0)) return;
        constexpr double most_sided = 8;  // twice what the tip of a spline is
        const double xx = moments.xx - middle.x * sum.x, yy = moments.yy - middle.y * sum.y;
        const double yx = moments.yx - middle.y * sum.x, xy = moments.xy - middle.x * sum.y;
        const double facing = -(normal.x * normal.x * xx + normal.x * normal.y * (xy + yx) + normal.y * normal.y * yy);
        is_blind = most_sided * facing < volume;
        more = std::sqrt(is_blind ? most_sided : std::max(volume / facing, 1.0)) - 1;
        distance = std::max(above - (normal.x * middle.x + normal.y * middle.y), 0.5 * distance);
    }

    /// From the edge to the middle of what fills a share of the ground that is linear in depth, m. `volume`, `sum`: of its V N and V grad N; `ground`:
    /// the ground's own. The middle is deeper by the variance times the share's slope over its mean, which needs the stretch that a pressure's needs.
    [[nodiscard]] double distance_to(double volume, const NodeVector& sum, double ground) const {
        const double slope = (normal.x * sum.x + normal.y * sum.y) / volume - length / ground;
        return std::max(std::min(distance + spread * slope, reach), 0.5 * distance);
    }

    [[nodiscard]] NodeVector stretched(const NodeVector& v) const {
        const double along = more * (normal.x * v.x + normal.y * v.y);
        return {v.x + along * normal.x, v.y + along * normal.y};
    }
};

}  // namespace talus
