#include "coupling/background.hpp"

#include "error.hpp"
#include "ground/sides.hpp"
#include "materials/solid/strength.hpp"
#include "scene/problems.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace talus {
namespace {

/// The least and the largest coordinate of the ground along an axis, m.
std::array<double, 2> reach(const Mesh& mesh, size_t axis) {
    std::array<double, 2> ends{mesh.position[axis], mesh.position[axis]};
    for (size_t i = axis; i < mesh.position.size(); i += 2) {
        ends[0] = std::min(ends[0], mesh.position[i]);
        ends[1] = std::max(ends[1], mesh.position[i]);
    }
    return ends;
}

/// Where a side is a straight line across an axis; throws where it is none.
double place_of_side(const Mesh& mesh, int32_t side, size_t axis, const std::string& path) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Facet& facet : mesh.facets) {
        if (facet.side != side) continue;
        for (const int32_t node : {facet.node_a, facet.node_b}) {
            low = std::min(low, mesh.position[2 * static_cast<size_t>(node) + axis]);
            high = std::max(high, mesh.position[2 * static_cast<size_t>(node) + axis]);
        }
    }
    const double rounding = 1e-9 * (std::abs(low) + std::abs(high));
    if (high - low <= rounding) return low;
    throw Error(Status::invalid_scene, path + ": the side is not a straight line along an axis, from " +
                                           value_text(low) + " to " + value_text(high) +
                                           " m; that is not supported yet in a dynamic ground");
}

WallKind wall_kind(MotionCondition motion) {
    switch (motion) {
        case MotionCondition::roller: return WallKind::roller;
        case MotionCondition::fixed: return WallKind::fixed;
        case MotionCondition::friction: return WallKind::friction;
        default: return WallKind::none;
    }
}

Wall wall_at_side(const Scene& scene, const Mesh& mesh, SideNumber side) {
    const size_t axis = side == side_base ? 1 : 0;
    Wall wall{WallKind::none, reach(mesh, axis)[0], 0};
    for (size_t b = 0; b < scene.boundaries.size(); ++b) {
        const Boundary& boundary = scene.boundaries[b];
        if (!boundary.has_motion || boundary.side != mesh.sides[side]) continue;
        wall.kind = wall_kind(boundary.motion);
        if (wall.kind == WallKind::none) continue;
        wall.place = place_of_side(mesh, side, axis, item_path("boundaries", b) + ".motion");
        if (wall.kind == WallKind::friction) wall.friction = tan_degrees(boundary.friction_angle);
    }
    return wall;
}

double fit_cell_size(double wanted, const Walls& walls) {
    if (walls.left.kind == WallKind::none || walls.right.kind == WallKind::none) return wanted;
    const double width = walls.right.place - walls.left.place;
    return width / std::max(1.0, std::ceil(width / wanted * (1 - 1e-12)));
}

}  // namespace

Background make_background(const Scene& scene, const Mesh& mesh) {
    const Dynamics& dynamics = scene.dynamics;
    Background background;
    Walls& walls = background.walls;
    walls = {wall_at_side(scene, mesh, side_left), wall_at_side(scene, mesh, side_right),
             wall_at_side(scene, mesh, side_base)};
    const auto [left, right] = reach(mesh, 0);
    const auto [low, high] = reach(mesh, 1);
    const bool stops = dynamics.at_ends == EndPolicy::stop;
    // By smooth walls, and not within ground that has moved since it lay between the ends.
    if (stops) {
        if (std::isfinite(dynamics.x_from)) walls.left = {WallKind::friction, std::min(dynamics.x_from, left), 0};
        if (std::isfinite(dynamics.x_to)) walls.right = {WallKind::friction, std::max(dynamics.x_to, right), 0};
        if (std::isfinite(dynamics.y_from)) walls.base = {WallKind::friction, std::min(dynamics.y_from, low), 0};
    }
    background.cell_size = fit_cell_size(dynamics.cell_size, walls);
    if (stops && std::isfinite(dynamics.y_to)) {
        const double cells = (std::max(dynamics.y_to, high) - walls.base.place) / background.cell_size;
        walls.top = {WallKind::friction, walls.base.place + background.cell_size * std::ceil(cells * (1 - 1e-12)), 0};
    }
    return background;
}

void check_between_ends(const Dynamics& dynamics, const Mesh& mesh) {
    const auto [left, right] = reach(mesh, 0);
    const auto [low, high] = reach(mesh, 1);
    const auto check = [](const char* name, double end, double ground, bool holds) {
        if (holds) return;
        throw Error(Status::invalid_scene, std::string("dynamics.") + name + " = " + value_text(end) +
                                               " m: the ground reaches to " + value_text(ground) +
                                               " m; must lie between the ends of the background");
    };
    check("xFrom", dynamics.x_from, left, dynamics.x_from <= left);
    check("xTo", dynamics.x_to, right, right <= dynamics.x_to);
    check("yFrom", dynamics.y_from, low, dynamics.y_from <= low);
    check("yTo", dynamics.y_to, high, high <= dynamics.y_to);
}

std::vector<int32_t> points_at_ends(const Dynamics& dynamics, const FreePoints& points, double cell_size) {
    std::vector<int32_t> found;
    const std::array ends{dynamics.x_from, dynamics.x_to, dynamics.y_from, dynamics.y_to};
    if (std::none_of(ends.begin(), ends.end(), [](double end) { return std::isfinite(end); })) return found;
    const double near = dynamics.at_ends == EndPolicy::stop ? cell_size : 0.0;
    const double* x = points[position_x];
    const double* y = points[position_y];
    for (size_t p = 0; p < points.count; ++p) {
        const bool is_at_end = x[p] - near < dynamics.x_from || x[p] + near > dynamics.x_to ||
                               y[p] - near < dynamics.y_from || y[p] + near > dynamics.y_to;
        if (is_at_end) found.push_back(static_cast<int32_t>(p));
    }
    return found;
}

}  // namespace talus
