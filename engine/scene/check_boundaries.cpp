#include "scene/check.hpp"
#include "scene/outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace talus {
namespace {

std::string name(FlowCondition condition) { return name_of<schema::FlowCondition>(condition, 1); }
std::string name(MotionCondition condition) { return name_of<schema::MotionCondition>(condition, 1); }

/// What a boundary's value may be at most, either way.
struct Quantity {
    const char* unit;
    double most;
    const char* slip;
};

constexpr Quantity pressure{"Pa", 1e9, ""};
constexpr Quantity elevation{"m", 1e6, " (is it a pressure?)"};
constexpr Quantity inflow{"m/s", 1e-2, " (did you mean mm/h?)"};
constexpr Quantity length{"m", 1e3, " (did you mean mm?)"};
constexpr Quantity traction{"Pa", 1e10, ""};

void check_series(const Check& check, const Series& series, const Quantity& quantity) {
    check_length(check.at("time"), series.time.size(), series.value.size(), "value");
    check_increasing(check.at("time"), series.time);
    for (size_t i = 0; i < series.value.size(); ++i) {
        if (!(std::abs(series.value[i]) > quantity.most)) continue;
        check.at("value", i)
            .say("= " + with_unit(series.value[i], quantity.unit) + ": must be between " + value_text(-quantity.most) +
                 " and " + with_unit(quantity.most, quantity.unit) + quantity.slip);
    }
}

bool is_given(const Series& series) { return !series.time.empty() || !series.value.empty(); }

void check_flow(const Check& check, const Boundary& boundary, const Physics& physics) {
    check.at("flow").unused(boundary.has_flow && !physics.water, "a dry ground");
    const Check value = check.at("flowValue");
    if (!boundary.has_flow) return value.unused(is_given(boundary.flow_value), "a boundary without flow");
    const bool valued = boundary.flow == FlowCondition::pressure || boundary.flow == FlowCondition::hydrostatic ||
                        boundary.flow == FlowCondition::flux;
    value.used(valued, is_given(boundary.flow_value), name(boundary.flow));
    if (!valued) return;
    const Quantity& quantity = boundary.flow == FlowCondition::pressure      ? pressure
                               : boundary.flow == FlowCondition::hydrostatic ? elevation
                                                                             : inflow;
    check_series(value, boundary.flow_value, quantity);
}

void check_motion(const Check& check, const Boundary& boundary, const Scene& scene) {
    const bool column = scene.ground.kind == GroundKind::column;
    const bool x_given = is_given(boundary.motion_x);
    const bool y_given = is_given(boundary.motion_y);
    check.at("motion").unused(boundary.has_motion && !scene.physics.deforming, "a rigid ground");
    check.at("motionX").unused(column && x_given, "a column");
    const bool valued = boundary.has_motion && (boundary.motion == MotionCondition::displacement ||
                                                boundary.motion == MotionCondition::traction);
    if (!valued) {
        const std::string who = boundary.has_motion ? name(boundary.motion) : "a boundary without motion";
        check.at("motionX").unused(x_given, who);
        check.at("motionY").unused(y_given, who);
        return;
    }
    check.at("motionY").needed(x_given || y_given, name(boundary.motion) + (column ? "" : " (or motionX)"));
    const Quantity& quantity = boundary.motion == MotionCondition::displacement ? length : traction;
    check_series(check.at("motionX"), boundary.motion_x, quantity);
    check_series(check.at("motionY"), boundary.motion_y, quantity);
}

Box box_of(const Boundary& boundary) { return {boundary.x_from, boundary.x_to, boundary.y_from, boundary.y_to}; }

/// Whether any part of the side lies in the box, as far as that is known before there is a mesh.
bool reaches(const Ground& ground, const std::string& side, const Box& box) {
    if (box.x_from > box.x_to || box.y_from > box.y_to) return false;
    const std::vector<Place> line = side_line(ground, side);
    if (!line.empty()) return passes(line, box);
    const std::optional<Box> all = bounds(ground);
    if (!all) return true;
    const Box part = intersection(*all, box);
    return part.x_from <= part.x_to && part.y_from <= part.y_to;
}

void check_place(const Check& check, const Boundary& boundary, const Ground& ground) {
    const std::vector<std::string> sides = side_names(ground);
    if (boundary.side.empty())
        return check.at("side").say("is missing" + (sides.empty() ? "" : "; must be one of " + joined(sides)));
    if (!sides.empty() && std::find(sides.begin(), sides.end(), boundary.side) == sides.end()) {
        return check.at("side").say("'" + boundary.side + "' is no side of this ground; must be one of " +
                                    joined(sides));
    }
    const auto check_order = [&](const char* first, const char* second, double from, double to) {
        check.at(second).require(
            !(from > to), "= " + value_text(to) + " m: must not be below " + first + ", " + value_text(from) + " m");
        return !(from > to);
    };
    const bool ordered_x = check_order("xFrom", "xTo", boundary.x_from, boundary.x_to);
    const bool ordered_y = check_order("yFrom", "yTo", boundary.y_from, boundary.y_to);
    if (ordered_x && ordered_y && !reaches(ground, boundary.side, box_of(boundary))) {
        check.say("has no effect: no part of the side '" + boundary.side +
                  "' lies between its xFrom, xTo, yFrom and yTo");
    }
}

/// Two boundaries may not say something on the same part of a side. A mesh's sides are not known yet: its own checks follow.
void check_overlaps(const Check& scene_check, const Scene& scene) {
    const std::vector<Boundary>& all = scene.boundaries;
    for (size_t i = 1; i < all.size(); ++i) {
        for (size_t k = 0; k < i; ++k) {
            const bool flow = all[i].has_flow && all[k].has_flow;
            const bool motion = all[i].has_motion && all[k].has_motion;
            if (all[i].side != all[k].side || !(flow || motion)) continue;
            const std::vector<Place> line = side_line(scene.ground, all[i].side);
            const bool unbounded = scene.ground.kind == GroundKind::mesh;
            const Box both = intersection(box_of(all[i]), box_of(all[k]));
            const bool overlap = unbounded ? both.x_from < both.x_to && both.y_from < both.y_to
                                           : !line.empty() && reaches(scene.ground, all[i].side, both);
            scene_check.at("boundaries", i)
                .require(!overlap, std::string("says something on the ") + (flow ? "flow" : "motion") +
                                       " of a part of the side '" + all[i].side + "' where " +
                                       item_path("boundaries", k) + " does");
        }
    }
}

/// Without a held part the ground would fall, or slide.
void check_held(const Check& check, const Scene& scene) {
    bool x_held = scene.ground.kind == GroundKind::column;
    bool y_held = false;
    for (const Boundary& boundary : scene.boundaries) {
        if (!boundary.has_motion) continue;
        const bool fixed = boundary.motion == MotionCondition::fixed;
        const bool roller = boundary.motion == MotionCondition::roller;
        const bool moved = boundary.motion == MotionCondition::displacement;
        const bool upright = boundary.side == "left" || boundary.side == "right";
        x_held |= fixed || (roller && boundary.side != "base") || (moved && is_given(boundary.motion_x));
        y_held |= fixed || (roller && !upright) || (moved && is_given(boundary.motion_y));
    }
    check.require(
        x_held,
        "hold the ground nowhere along x: a ground that deforms needs a boundary that is fixed, a roller or a displacement");
    check.require(
        y_held,
        "hold the ground nowhere along y: a ground that deforms needs a boundary that is fixed, a roller or a displacement");
}

// --- rain ------------------------------------------------------------------------------------------------------------

/// Whether boundaries hold the flow on all of a zone's surface, so that its rain falls on nothing.
bool is_covered(const RainZone& zone, const Scene& scene) {
    const auto covers = [&](const Boundary& boundary) {
        return boundary.side == "surface" && boundary.has_flow && boundary.flow != FlowCondition::surface &&
               boundary.x_from <= zone.x_from && boundary.x_to >= zone.x_to && std::isinf(boundary.y_from) &&
               std::isinf(boundary.y_to);
    };
    return std::any_of(scene.boundaries.begin(), scene.boundaries.end(), covers);
}

void check_zone(const Check& check, const RainZone& zone, const Scene& scene) {
    check_length(check.at("rate"), zone.rate.size(), zone.time.size(), "time");
    check_increasing(check.at("time"), zone.time);
    if (given(zone.rain_end)) {
        const double last = zone.time.empty() ? std::numeric_limits<double>::infinity() : zone.time.back();
        check.at("rainEnd").require(
            zone.rain_end > last,
            zone.time.empty()
                ? "has no effect: there are no times before it"
                : "= " + value_text(zone.rain_end) + " s: must be after the last time, " + value_text(last) + " s");
    }
    if (zone.x_from >= zone.x_to) {
        return check.at("xTo").say("= " + value_text(zone.x_to) + " m: must be above xFrom, " +
                                   value_text(zone.x_from) + " m");
    }
    check.require(reaches(scene.ground, "surface", {.x_from = zone.x_from, .x_to = zone.x_to}),
                  "has no effect: it is outside the ground");
    check.require(!is_covered(zone, scene), "has no effect: a boundary holds the flow on all of its surface");
}

void check_zone_overlaps(const Check& check, const std::vector<RainZone>& zones) {
    for (size_t i = 1; i < zones.size(); ++i) {
        for (size_t k = 0; k < i; ++k) {
            const double from = std::max(zones[i].x_from, zones[k].x_from);
            const double to = std::min(zones[i].x_to, zones[k].x_to);
            check.at("zones", i)
                .require(!(from < to), "overlaps " + item_path("surface.zones", k) + " from x = " + value_text(from) +
                                           " to " + value_text(to) + " m");
        }
    }
}

}  // namespace

void check_boundaries(const Check& scene_check, const Scene& scene) {
    check_names(scene_check, "boundaries", scene.boundaries, false);
    for (size_t i = 0; i < scene.boundaries.size(); ++i) {
        const Check check = scene_check.at("boundaries", i);
        const Boundary& boundary = scene.boundaries[i];
        check.require(boundary.has_flow || boundary.has_motion, "has no effect: says nothing on flow or motion");
        check_place(check, boundary, scene.ground);
        check_flow(check, boundary, scene.physics);
        check_motion(check, boundary, scene);
    }
    check_overlaps(scene_check, scene);
    if (scene.physics.deforming) check_held(scene_check.at("boundaries"), scene);
}

void check_surface(const Check& scene_check, const Scene& scene) {
    const Check check = scene_check.at("surface");
    if (!scene.physics.water) {
        check.at("zones").unused(!scene.surface.zones.empty(), "a dry ground");
        check.at("pondingDepth").unused(scene.surface.ponding_depth != 0, "a dry ground");
        return;
    }
    check_names(check, "zones", scene.surface.zones, false);
    for (size_t i = 0; i < scene.surface.zones.size(); ++i)
        check_zone(check.at("zones", i), scene.surface.zones[i], scene);
    check_zone_overlaps(check, scene.surface.zones);
}

}  // namespace talus
