#include "scene/validate.hpp"

#include "scene/check.hpp"
#include "scene/message.hpp"

#include <capnp/message.h>
#include <algorithm>

namespace talus {
namespace {

/// The ends of a dynamic ground's background, each on a side without a wall.
void check_ends(const Check& check, const Scene& scene) {
    const Dynamics& dynamics = scene.dynamics;
    const bool moves = scene.physics.regime != MotionRegime::quasi_static;
    const auto is_wall = [&](const std::string& side) {
        return std::any_of(scene.boundaries.begin(), scene.boundaries.end(), [&](const Boundary& boundary) {
            return boundary.side == side && boundary.has_motion && boundary.motion != MotionCondition::free;
        });
    };
    bool has_end = false;
    const auto check_end = [&](const std::string& name, double end, const std::string& side) {
        has_end = has_end || std::isfinite(end);
        check.at(name).unused(!moves && std::isfinite(end), "a ground whose regime is not dynamic");
        check.at(name).unused(std::isfinite(end) && is_wall(side), "a ground whose side '" + side + "' is a wall");
    };
    check_end("xFrom", dynamics.x_from, "left");
    check_end("xTo", dynamics.x_to, "right");
    check_end("yFrom", dynamics.y_from, "base");
    check_end("yTo", dynamics.y_to, "surface");
    const std::string policy = name_of<schema::EndPolicy>(dynamics.at_ends);
    check.at("atEnds").require(dynamics.at_ends == EndPolicy::extend || has_end,
                               "= " + policy + ": has no effect: the background has no end (xFrom, xTo, yFrom, yTo)");
}

/// What a dynamic ground cannot do yet.
void check_regime(const Check& check, const Scene& scene) {
    const Check cell_size = check.at("dynamics").at("cellSize"), rest_speed = check.at("dynamics").at("restSpeed");
    const bool rests = given_positive(scene.dynamics.rest_speed);
    if (scene.physics.regime == MotionRegime::quasi_static) {
        cell_size.unused(given_positive(scene.dynamics.cell_size), "a ground whose regime is not dynamic");
        rest_speed.unused(rests, "a ground whose regime is not dynamic");
        return;
    }
    rest_speed.require(!(rests && scene.physics.gas), "= " + value_text(scene.dynamics.rest_speed) +
                                                          " m/s: is not supported yet where gas moves (physics.gas)");
    cell_size.needed(given_positive(scene.dynamics.cell_size), "a dynamic ground");
    const Check physics = check.at("physics");
    physics.at("deforming").require(scene.physics.deforming, "= false: must be true where the regime is dynamic");
    physics.at("regime").require(scene.ground.kind != GroundKind::column,
                                 "= dynamic: must be quasiStatic in a column; a dynamic ground is a section or a mesh");
    check.at("surface")
        .at("pondingDepth")
        .require(!(scene.physics.water && scene.surface.ponding_depth != 0),
                 "= " + value_text(scene.surface.ponding_depth) +
                     " m: is not supported yet where the regime is dynamic; must be 0");
}

/// What of the gas only its exchange with the water needs.
void check_exchange(const Check& check, const Scene& scene) {
    const Gas &gas = scene.gas, plain;
    constexpr double least_atmosphere = 2e4;  // Pa: under less of it water of 50 degrees comes near to boil
    check.at("atmosphere")
        .require(!(scene.physics.exchange && gas.atmosphere < least_atmosphere),
                 "= " + value_text(gas.atmosphere) + " Pa: must be at least " + value_text(least_atmosphere) +
                     " Pa where it exchanges water and air (physics.exchange)");
    if (scene.physics.exchange || !scene.physics.gas) return;
    const std::string who = "a gas that exchanges nothing with the water (physics.exchange)";
    check.at("temperature").unused(gas.temperature != plain.temperature, who);
    check.at("henryConstant").unused(gas.henry_constant != plain.henry_constant, who);
    check.at("vapourDiffusivity").unused(gas.vapour_diffusivity != plain.vapour_diffusivity, who);
    check.at("airDiffusivity").unused(gas.air_diffusivity != plain.air_diffusivity, who);
    check.at("humidity").unused(gas.humidity != plain.humidity, who);
}

void check_physics(const Check& check, const Scene& scene) {
    const Physics& physics = scene.physics;
    check.at("physics").require(physics.water || physics.deforming,
                                "neither water nor deforming: there is nothing to simulate");
    check.at("physics").at("stress").unused(
        physics.stress == StressMeasure::bishop && !(physics.water && physics.deforming),
        "a ground that is dry or rigid");
    check.at("gravity").require(
        !(physics.water && scene.gravity == 0),
        "= 0 m/s2: must be above 0 where there is water, whose weight defines the conductivity");
    check_regime(check, scene);
    check_ends(check.at("dynamics"), scene);
    const bool may_move = physics.water && physics.regime != MotionRegime::quasi_static;
    check.at("physics").at("gas").require(!physics.gas || may_move,
                                          "= true: needs water and a regime that is not quasiStatic");
    check.at("gas").unused(!physics.gas && !(scene.gas == Gas{}), "a ground whose gas does not move (physics.gas)");
    check.at("physics")
        .at("exchange")
        .require(!physics.exchange || physics.gas, "= true: needs physics.gas, a gas that moves");
    check_exchange(check.at("gas"), scene);
    check.at("name").require(scene.name.find_first_of("/\\") == std::string::npos,
                             "'" + scene.name + "': must have no slash; files are named after it");
}

// --- initial state ---------------------------------------------------------------------------------------------------

/// A uniform saturation needs a suction in every soil.
void check_saturation(const Check& check, double saturation, const std::vector<Soil>& soils) {
    for (const Soil& soil : soils) {
        const Retention& retention = soil.hydraulics.retention;
        const bool table = retention.model == RetentionModel::tabulated && !retention.saturation.empty();
        const double least = table ? retention.saturation.back() : retention.residual_saturation;
        const double most = table ? retention.saturation.front() : retention.maximum_saturation;
        const bool above = table ? saturation >= least : saturation > least;
        check.require(!given(saturation) || (above && saturation <= most),
                      "= " + value_text(saturation) + ": must be above the residual saturation, " + value_text(least) +
                          ", and at most the maximum, " + value_text(most) + ", of the soil '" + soil.name + "'");
    }
}

void check_initial_flow(const Check& check, const Scene& scene) {
    using enum InitialFlow;
    const Initial& initial = scene.initial;
    const std::string flow = name_of<schema::InitialFlow>(initial.flow);
    const bool held = given(initial.surface_pressure);
    const bool rained = given(initial.surface_rain);
    check.at("suction").used(initial.flow == InitialFlow::suction, given(initial.suction), flow);
    check.at("saturation").used(initial.flow == InitialFlow::saturation, given(initial.saturation), flow);
    check.at("waterTable").used(initial.flow == hydrostatic, given(initial.water_table), flow);
    if (initial.flow == InitialFlow::saturation)
        check_saturation(check.at("saturation"), initial.saturation, scene.soils);
    if (initial.flow == steady) {
        check.at("surfacePressure").needed(held || rained, "steady (or surfaceRain)");
        check.at("surfaceRain").require(!(held && rained), "is given with surfacePressure; must be one of them");
    } else {
        check.at("surfacePressure").unused(held, flow);
        check.at("surfaceRain").unused(rained, flow);
    }
}

void check_dry(const Check& check, const Initial& initial) {
    check.at("suction").unused(given(initial.suction), "a dry ground");
    check.at("saturation").unused(given(initial.saturation), "a dry ground");
    check.at("waterTable").unused(given(initial.water_table), "a dry ground");
    check.at("surfacePressure").unused(given(initial.surface_pressure), "a dry ground");
    check.at("surfaceRain").unused(given(initial.surface_rain), "a dry ground");
}

void check_initial_stress(const Check& check, const Scene& scene) {
    const Initial& initial = scene.initial;
    if (!scene.physics.deforming) {
        check.at("stress").unused(initial.stress != InitialStress::gravity, "a rigid ground");
        check.at("k0").unused(given(initial.k0), "a rigid ground");
        return;
    }
    check.at("stress").require(
        initial.stress != InitialStress::elastic || scene.physics.regime == MotionRegime::dynamic,
        "= elastic: must be gravity, k0 or zero where the regime is not dynamic");
    check.at("k0").used(initial.stress == InitialStress::k0, given(initial.k0),
                        "the initial stress " + name_of<schema::InitialStress>(initial.stress));
}

}  // namespace

void check_increasing(const Check& list, const std::vector<double>& values) {
    for (size_t i = 1; i < values.size(); ++i) {
        if (values[i] > values[i - 1]) continue;
        list.item(i).say("= " + value_text(values[i]) + ": must be above the one before it, " +
                         value_text(values[i - 1]));
        return;
    }
}

void check_length(const Check& list, size_t length, size_t expected, const std::string& other) {
    list.require(length == expected, "has " + std::to_string(length) + " entries; must have " +
                                         std::to_string(expected) + ", as many as " + other);
}

void check_initial(const Check& scene_check, const Scene& scene) {
    const Check check = scene_check.at("initial");
    scene.physics.water ? check_initial_flow(check, scene) : check_dry(check, scene.initial);
    check_initial_stress(check, scene);
}

void check_schedule(const Check& scene_check, const Scene& scene) {
    const Check check = scene_check.at("schedule");
    const Schedule& schedule = scene.schedule;
    check.at("step").needed(given(schedule.step) || !given(schedule.duration), "a duration");
    check.at("duration")
        .needed(given(schedule.duration) ||
                    (!given(schedule.step) && !given(schedule.motion_step) && schedule.outputs.empty()),
                "a step or an output");
    check.at("step").require(
        !(schedule.step > schedule.duration),
        "= " + value_text(schedule.step) + " s: must be at most the duration, " + value_text(schedule.duration) + " s");
    check.at("motionStep")
        .unused(given(schedule.motion_step) && scene.physics.regime != MotionRegime::automatic,
                "a ground whose regime is not auto");
    check_increasing(check.at("outputs"), schedule.outputs);
    const auto late = std::find_if(schedule.outputs.begin(), schedule.outputs.end(),
                                   [&](double time) { return time > schedule.duration; });
    if (late == schedule.outputs.end()) return;
    check.at("outputs", static_cast<size_t>(late - schedule.outputs.begin()))
        .say("= " + value_text(*late) + " s: must be at most the duration, " + value_text(schedule.duration) + " s");
}

std::vector<std::string> problems(const Scene& scene) {
    Problems found;
    guarded("scene: ", [&] {
        capnp::MallocMessageBuilder message;
        const auto root = message.initRoot<schema::Scene>();
        to_message(scene, root);
        check_entries(root.asReader(), found);
    });

    const Check check(found, "");
    check_physics(check, scene);
    check_soils(check, scene);
    check_ground(check, scene);
    check_boundaries(check, scene);
    check_surface(check, scene);
    check_initial(check, scene);
    check_schedule(check, scene);
    check_probes(check, scene);
    return found.list();
}

void validate(const Scene& scene) {
    const std::vector<std::string> found = problems(scene);
    if (!found.empty()) throw Error(Status::invalid_scene, joined(found, "\n"));
}

}  // namespace talus
