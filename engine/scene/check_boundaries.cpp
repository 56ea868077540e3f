#include "scene/check.hpp"
#include "scene/outline.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

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

/// In a dynamic ground only whole sides that are straight and along an axis are held, as walls.
void check_wall(const Check& check, const Boundary& boundary, const Ground& ground) {
    if (!boundary.has_motion || boundary.motion == MotionCondition::free) return;
    const Check motion = check.at("motion");
    const std::string dynamic = " is not supported yet in a dynamic ground";
    if (boundary.motion == MotionCondition::displacement || boundary.motion == MotionCondition::traction)
        return motion.say("= " + name(boundary.motion) + ":" + dynamic + "; must be free, roller, fixed or friction");
    if (boundary.side != "base" && boundary.side != "left" && boundary.side != "right")
        return motion.say("= " + name(boundary.motion) + ": on the side '" + boundary.side + "'" + dynamic +
                          "; must be on base, left or right");
    const bool whole = std::isinf(boundary.x_from) && std::isinf(boundary.x_to) && std::isinf(boundary.y_from) &&
                       std::isinf(boundary.y_to);
    motion.require(whole, "= " + name(boundary.motion) + ": on a part of a side" + dynamic +
                              "; leave xFrom, xTo, yFrom and yTo out");
    if (boundary.side != "base" || ground.kind != GroundKind::section || ground.section.base.empty()) return;
    const std::vector<Place>& base = ground.section.base;
    const bool level =
        std::all_of(base.begin(), base.end(), [&](const Place& place) { return place[1] == base.front()[1]; });
    motion.require(level, "= " + name(boundary.motion) + ": on a base that is not level" + dynamic +
                              "; make the rock below a layer of its own, on a level base");
}

void check_motion(const Check& check, const Boundary& boundary, const Scene& scene) {
    const bool column = scene.ground.kind == GroundKind::column;
    const bool x_given = is_given(boundary.motion_x);
    const bool y_given = is_given(boundary.motion_y);
    const bool rubs = boundary.has_motion && boundary.motion == MotionCondition::friction;
    check.at("frictionAngle")
        .used(rubs, given(boundary.friction_angle),
              boundary.has_motion ? name(boundary.motion) : "a boundary without motion");
    if (scene.physics.regime != MotionRegime::quasi_static) {
        check_wall(check, boundary, scene.ground);
    } else {
        check.at("motion").require(!rubs, "= friction: needs a dynamic regime");
    }
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

void check_place(const Check& check, const Boundary& boundary, const Outline& outline) {
    const std::vector<std::string> sides = outline.side_names();
    if (boundary.side.empty())
        return check.at("side").say("is missing" + (sides.empty() ? "" : "; must be one of " + joined(sides)));
    if (!sides.empty() && std::find(sides.begin(), sides.end(), boundary.side) == sides.end()) {
        return check.at("side").say("'" + boundary.side + "' is no side of this ground; must be one of " +
                                    joined(sides));
    }
    const auto check_order = [&](const char* first, const char* second, double from, double to) {
        check.at(second).require(
            !(from > to), "= " + value_text(to) + " m: must not be below " + first + ", " + value_text(from) + " m");
        return from <= to;  // false where one is not a number
    };
    const bool ordered_x = check_order("xFrom", "xTo", boundary.x_from, boundary.x_to);
    const bool ordered_y = check_order("yFrom", "yTo", boundary.y_from, boundary.y_to);
    if (ordered_x && ordered_y && !outline.reaches(boundary.side, box_of(boundary))) {
        check.say("has no effect: no part of the side '" + boundary.side +
                  "' lies between its xFrom, xTo, yFrom and yTo");
    }
}

/// What both boundaries say something on, where their boxes overlap; nothing otherwise.
std::string said_by_both(const Boundary& a, const Boundary& b, const Outline& outline, bool sides_known) {
    const bool flow = a.has_flow && b.has_flow;
    const bool motion = a.has_motion && b.has_motion;
    const Box both = intersection(box_of(a), box_of(b));
    if (a.side != b.side || !(flow || motion) || is_empty(both)) return "";
    if (!sides_known && !(both.x_from < both.x_to && both.y_from < both.y_to)) return "";
    return outline.reaches(a.side, both) ? (flow ? "flow" : "motion") : "";
}

/// Two boundaries may not say something on the same part of a side.
void check_overlaps(const Check& scene_check, const Scene& scene, const Outline& outline) {
    const std::vector<Boundary>& all = scene.boundaries;
    const bool sides_known = scene.ground.kind != GroundKind::mesh;
    for (size_t i = 1; i < all.size(); ++i) {
        for (size_t k = 0; k < i; ++k) {
            const std::string what = said_by_both(all[i], all[k], outline, sides_known);
            if (what.empty()) continue;
            scene_check.at("boundaries", i)
                .say("says something on the " + what + " of a part of the side '" + all[i].side + "' where " +
                     item_path("boundaries", k) + " does");
            break;
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
        const bool rubs = boundary.motion == MotionCondition::friction;
        x_held |= fixed || rubs || (roller && boundary.side != "base") || (moved && is_given(boundary.motion_x));
        y_held |= fixed || (rubs && !upright) || (roller && !upright) || (moved && is_given(boundary.motion_y));
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

void check_zone(const Check& check, const RainZone& zone, const Scene& scene, const Outline& outline) {
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
    check.require(outline.reaches("surface", {.x_from = zone.x_from, .x_to = zone.x_to}),
                  "has no effect: it is outside the ground");
    check.require(!is_covered(zone, scene), "has no effect: a boundary holds the flow on all of its surface");
}

void check_zone_overlaps(const Check& check, const std::vector<RainZone>& zones) {
    std::vector<size_t> order(zones.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return zones[a].x_from < zones[b].x_from; });
    for (size_t i = 1; i < order.size(); ++i) {  // neighbours: where any two overlap, two neighbours do
        const auto [first, second] = std::minmax(order[i - 1], order[i]);
        const double from = std::max(zones[first].x_from, zones[second].x_from);
        const double to = std::min(zones[first].x_to, zones[second].x_to);
        if (!(from < to)) continue;
        check.at("zones", second)
            .say("overlaps " + check.at("zones", first).path() + " from x = " + value_text(from) + " to " +
                 value_text(to) + " m");
    }
}

}  // namespace

void check_boundaries(const Check& scene_check, const Scene& scene) {
    check_names(scene_check, "boundaries", scene.boundaries, false);
    const Outline outline(scene.ground);
    for (size_t i = 0; i < scene.boundaries.size(); ++i) {
        const Check check = scene_check.at("boundaries", i);
        const Boundary& boundary = scene.boundaries[i];
        check.require(boundary.has_flow || boundary.has_motion, "has no effect: says nothing on flow or motion");
        check_place(check, boundary, outline);
        check_flow(check, boundary, scene.physics);
        check_motion(check, boundary, scene);
    }
    check_overlaps(scene_check, scene, outline);
    const bool from_equilibrium = scene.physics.regime != MotionRegime::dynamic ||
                                  scene.initial.stress == InitialStress::gravity ||
                                  scene.initial.stress == InitialStress::elastic;
    if (scene.physics.deforming && from_equilibrium) check_held(scene_check.at("boundaries"), scene);
}

void check_surface(const Check& scene_check, const Scene& scene) {
    const Check check = scene_check.at("surface");
    if (!scene.physics.water) {
        check.at("zones").unused(!scene.surface.zones.empty(), "a dry ground");
        check.at("pondingDepth").unused(scene.surface.ponding_depth != 0, "a dry ground");
        return;
    }
    check_names(check, "zones", scene.surface.zones, false);
    const Outline outline(scene.ground);
    for (size_t i = 0; i < scene.surface.zones.size(); ++i) {
        check_zone(check.at("zones", i), scene.surface.zones[i], scene, outline);
    }
    check_zone_overlaps(check, scene.surface.zones);
}

}  // namespace talus
