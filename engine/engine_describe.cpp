// What the engine is made of and what it left out, as JSON.
#include "engine_state.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace talus {
namespace {

using nlohmann::ordered_json;

ordered_json number_or_null(double value) { return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr); }

const char* flow_name(const Boundary& boundary) {
    if (!boundary.has_flow) return nullptr;
    switch (boundary.flow) {
        case FlowCondition::impermeable: return "impermeable";
        case FlowCondition::pressure: return "pressure";
        case FlowCondition::hydrostatic: return "hydrostatic";
        case FlowCondition::flux: return "flux";
        case FlowCondition::surface: return "surface";
    }
    return nullptr;
}

const char* motion_name(const Boundary& boundary) {
    if (!boundary.has_motion) return nullptr;
    switch (boundary.motion) {
        case MotionCondition::free: return "free";
        case MotionCondition::roller: return "roller";
        case MotionCondition::fixed: return "fixed";
        case MotionCondition::displacement: return "displacement";
        case MotionCondition::traction: return "traction";
        case MotionCondition::friction: return "friction";
    }
    return nullptr;
}

ordered_json text_or_null(const char* text) { return text != nullptr ? ordered_json(text) : ordered_json(nullptr); }

ordered_json left_out(const Scene& scene) {
    ordered_json list = ordered_json::array();
    if (!scene.physics.gas) list.push_back("gas flow: gas pressure is that of the atmosphere");
    if (scene.physics.gas && !scene.physics.exchange)
        list.push_back("exchange between the fluids: no vapour, no dissolved air");
    const bool is_dynamic = scene.physics.regime != MotionRegime::quasi_static;
    if (!is_dynamic) list.push_back("inertia: equilibrium is quasi-static");
    if (is_dynamic && scene.physics.water)
        list.push_back("flow through sides: in motion all but the surface is closed");
    if (!scene.physics.water) list.push_back("water: no pore pressure is held, no flow is solved");
    if (!scene.physics.deforming) list.push_back("deformation: no stress is held, no equilibrium is solved");
    if (scene.ground.kind == GroundKind::column) list.push_back("the horizontal dimension");
    return list;
}

}  // namespace

int64_t bytes_held(const Simulation& simulation) {
    const GroundState& ground = simulation.state();
    const Points& points = ground.points;
    size_t values = simulation.mesh().position.size();
    for (const auto* field :
         {&ground.node_position,      &ground.displacement,      &ground.velocity,         &ground.flow.pressure,
          &ground.flow.stored,        &ground.pore_volume,       &ground.flow_pore_volume, &ground.pore_volume_rate,
          &ground.pore_stress_rate,   &ground.displacement_rate, &points.position,         &points.volume,
          &points.displacement,       &points.skeleton_stress,   &points.strain,           &points.plastic_strain,
          &points.mobilised_strength, &points.pressure,          &points.saturation,       &points.porosity,
          &points.darcy_flux})
        values += field->size();
    size_t bytes = values * sizeof(double);
    if (simulation.dynamic() != nullptr) {
        const FreePoints& moving = simulation.dynamic()->points();
        bytes += moving.count * moving.bytes_a_point();
    }
    return static_cast<int64_t>(bytes);
}

std::string Engine::State::describe() const {
    const Scene& s = *scene;
    const Mesh& mesh = simulation->mesh();
    const DynamicGround* dynamic = simulation->dynamic();
    ordered_json json;
    json["name"] = s.name;
    json["title"] = s.title;
    json["dimension"] = mesh.dimension;
    json["physics"] = {{"water", s.physics.water},
                       {"gas", s.physics.gas},
                       {"exchange", s.physics.exchange},
                       {"deforming", s.physics.deforming},
                       {"stress", s.physics.stress == StressMeasure::net ? "net" : "bishop"},
                       {"regime", dynamic != nullptr ? "dynamic" : "quasi_static"}};
    json["left_out"] = left_out(s);
    json["nodes"] = dynamic == nullptr ? mesh.node_count() : 0;
    json["cells"] = dynamic == nullptr ? mesh.cell_count() : 0;
    json["points"] = dynamic == nullptr ? static_cast<size_t>(simulation->state().points.count) : dynamic->numbers();
    if (dynamic != nullptr) {
        json["cell_size"] = dynamic->cell_size();
        json["bytes_a_point"] = dynamic->points().bytes_a_point();
    }
    json["unknowns"] = {{"flow", simulation->flow() != nullptr ? mesh.node_count() : 0},
                        {"motion", simulation->motion_unknowns()}};
    json["bytes"] = bytes_held(*simulation);
    json["schedule"] = {{"duration", number_or_null(s.schedule.duration)},
                        {"step", number_or_null(s.schedule.step)},
                        {"motion_step", number_or_null(s.schedule.motion_step)},
                        {"outputs", s.schedule.outputs}};
    json["zones"] = ordered_json::array();
    for (const RainZone& zone : s.surface.zones)
        json["zones"].push_back(
            {{"name", zone.name}, {"x_from", number_or_null(zone.x_from)}, {"x_to", number_or_null(zone.x_to)}});
    json["boundaries"] = ordered_json::array();
    for (const Boundary& boundary : s.boundaries)
        json["boundaries"].push_back({{"name", boundary.name},
                                      {"side", boundary.side},
                                      {"flow", text_or_null(flow_name(boundary))},
                                      {"motion", text_or_null(motion_name(boundary))}});
    json["probes"] = ordered_json::array();
    for (const ProbeTrack& probe : probes)
        json["probes"].push_back({{"name", probe.name}, {"x", probe.place[0]}, {"y", probe.place[1]}});
    json["probe_quantities"] = quantities;
    json["fields"] = ordered_json::array();
    constexpr std::array locations{"node", "point", "cell", "mesh"};
    for (const std::string& name : field_names()) {
        const FieldView field = view(name);
        json["fields"].push_back({{"name", name},
                                  {"location", locations[static_cast<size_t>(field.location)]},
                                  {"type", field.type == DataType::float64 ? "float64" : "int32"},
                                  {"components", field.components},
                                  {"units", field.units},
                                  {"standard_name", field.standard_name}});
    }
    return json.dump();
}

}  // namespace talus
