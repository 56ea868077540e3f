#include "scene/outline.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

Box around(const std::vector<Place>& places) {
    const double infinite = std::numeric_limits<double>::infinity();
    Box box{infinite, -infinite, infinite, -infinite};
    for (const auto [x, y] : places) {
        box = {std::min(box.x_from, x), std::max(box.x_to, x), std::min(box.y_from, y), std::max(box.y_to, y)};
    }
    return box;
}

Box widened(const Box& box) {
    const double margin = 1e-9 * std::max(box.x_to - box.x_from, box.y_to - box.y_from);
    return {box.x_from - margin, box.x_to + margin, box.y_from - margin, box.y_to + margin};
}

/// Keeps the part [from, to] of a segment, as fractions of it, where start + t * step lies between low and high.
void clip(double start, double step, double low, double high, double& from, double& to) {
    if (step == 0) {
        if (start < low || start > high) to = from;
        return;
    }
    const double at_low = (low - start) / step;
    const double at_high = (high - start) / step;
    from = std::max(from, std::min(at_low, at_high));
    to = std::min(to, std::max(at_low, at_high));
}

bool segment_passes(Place a, Place b, const Box& box) {
    double from = 0;
    double to = 1;
    clip(a[0], b[0] - a[0], box.x_from, box.x_to, from, to);
    clip(a[1], b[1] - a[1], box.y_from, box.y_to, from, to);
    return to - from > 1e-9;
}

bool contains(const Box& box, Place place) {
    return place[0] >= box.x_from && place[0] <= box.x_to && place[1] >= box.y_from && place[1] <= box.y_to;
}

/// More than a point of the line, or the one place that it has.
bool passes(const std::vector<Place>& line, const Box& box) {
    if (line.size() == 1) return contains(box, line[0]);
    for (size_t i = 0; i + 1 < line.size(); ++i) {
        if (segment_passes(line[i], line[i + 1], box)) return true;
    }
    return false;
}

std::vector<Place> vertical(const std::vector<Place>& base, const std::vector<Place>& terrain, bool right) {
    if (base.empty() || terrain.empty()) return {};
    return right ? std::vector{base.back(), terrain.back()} : std::vector{base.front(), terrain.front()};
}

std::vector<Place> nodes(const MeshGround& mesh) {
    std::vector<Place> places;
    for (size_t i = 0; i + 1 < mesh.position.size(); i += 2) places.push_back({mesh.position[i], mesh.position[i + 1]});
    return places;
}

std::vector<Place> side_line(const Ground& ground, const std::string& side) {
    const SectionGround& section = ground.section;
    if (ground.kind == GroundKind::column) return {{0, side == "base" ? 0 : ground.column.height}};
    if (side == "base") return section.base;
    if (side == "surface") return section.terrain;
    return vertical(section.base, section.terrain, side == "right");
}

std::optional<Box> bounds_of(const Ground& ground) {
    switch (ground.kind) {
        case GroundKind::column: return Box{0, 0, 0, ground.column.height};
        case GroundKind::section: break;
        case GroundKind::mesh:
            return ground.mesh.file.empty() ? std::optional(around(nodes(ground.mesh))) : std::nullopt;
    }
    std::vector<Place> places = ground.section.terrain;
    places.insert(places.end(), ground.section.base.begin(), ground.section.base.end());
    return around(places);
}

}  // namespace

Box intersection(const Box& a, const Box& b) {
    return {std::max(a.x_from, b.x_from), std::min(a.x_to, b.x_to), std::max(a.y_from, b.y_from),
            std::min(a.y_to, b.y_to)};
}

bool is_empty(const Box& box) { return !(box.x_from <= box.x_to && box.y_from <= box.y_to); }

double height_at(const std::vector<Place>& profile, double x) {
    const auto right =
        std::lower_bound(profile.begin(), profile.end(), x, [](Place place, double at) { return place[0] < at; });
    if (right == profile.begin()) return profile.front()[1];
    if (right == profile.end()) return profile.back()[1];
    const auto [x0, y0] = right[-1];
    const auto [x1, y1] = *right;
    return x == x1 ? y1 : y0 + (y1 - y0) * (x - x0) / (x1 - x0);
}

Outline::Outline(const Ground& ground_) : ground(ground_), bounds(bounds_of(ground_)) {}

std::vector<std::string> Outline::side_names() const {
    switch (ground.kind) {
        case GroundKind::column: return {"base", "surface"};
        case GroundKind::section: return {"base", "left", "right", "surface"};
        case GroundKind::mesh: break;
    }
    if (!ground.mesh.file.empty()) return {};
    return {"base", "left", "right", "surface", "hole"};
}

bool Outline::reaches(const std::string& side, const Box& box) const {
    if (is_empty(box)) return false;
    if (ground.kind == GroundKind::mesh) return !bounds || !is_empty(intersection(*bounds, box));
    return passes(side_line(ground, side), box);
}

bool Outline::inside(Place place) const {
    if (!bounds) return true;
    const Box wide = widened(*bounds);
    if (!contains(wide, place)) return false;
    const std::vector<Place>& base = ground.section.base;
    const std::vector<Place>& terrain = ground.section.terrain;
    if (ground.kind != GroundKind::section || base.empty() || terrain.empty()) return true;
    const double margin = bounds->y_from - wide.y_from;
    return place[1] >= height_at(base, place[0]) - margin && place[1] <= height_at(terrain, place[0]) + margin;
}

}  // namespace talus
