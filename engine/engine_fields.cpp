// The fields that hosts see: what the physics of the scene has, nothing else.
#include "engine_state.hpp"
#include "error.hpp"
#include "points/quadrature.hpp"
#include "scene/problems.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace talus {
namespace {

enum class Needs { nothing, water, skeleton };

/// Where a field's values come from.
enum class Source { held, derived, connectivity };

struct FieldEntry {
    const char* name;
    const char* units;
    const char* standard_name;
    Location location;
    int32_t components;  ///< 0: the dimension
    Needs needs;
    Source source;
};

constexpr std::array fields{
    FieldEntry{"cell_start", "1", "", Location::mesh, 1, Needs::nothing, Source::connectivity},
    FieldEntry{"cell_nodes", "1", "", Location::mesh, 1, Needs::nothing, Source::connectivity},
    FieldEntry{"cell_soil", "1", "", Location::cell, 1, Needs::nothing, Source::connectivity},
    FieldEntry{"node_position", "m", "", Location::node, 0, Needs::nothing, Source::held},
    FieldEntry{"pressure", "Pa", "soil_water__pressure", Location::node, 1, Needs::water, Source::held},
    FieldEntry{"displacement", "m", "soil__displacement", Location::node, 0, Needs::skeleton, Source::held},
    FieldEntry{"velocity", "m s-1", "soil__velocity", Location::node, 0, Needs::skeleton, Source::held},
    FieldEntry{"point_position", "m", "", Location::point, 0, Needs::nothing, Source::held},
    FieldEntry{"point_volume", "m2", "", Location::point, 1, Needs::nothing, Source::held},
    FieldEntry{"point_pressure", "Pa", "soil_water__pressure", Location::point, 1, Needs::water, Source::held},
    FieldEntry{"saturation", "1", "soil_water__saturated_volume_fraction", Location::point, 1, Needs::water,
               Source::held},
    FieldEntry{"suction", "Pa", "soil_water__suction", Location::point, 1, Needs::water, Source::derived},
    FieldEntry{"porosity", "1", "soil__porosity", Location::point, 1, Needs::water, Source::held},
    FieldEntry{"water_content", "1", "soil_water__volume_fraction", Location::point, 1, Needs::water, Source::derived},
    FieldEntry{"darcy_flux", "m s-1", "soil_water__darcy_velocity", Location::point, 0, Needs::water, Source::held},
    FieldEntry{"net_stress", "Pa", "soil__net_stress", Location::point, 4, Needs::skeleton, Source::derived},
    FieldEntry{"total_stress", "Pa", "soil__total_stress", Location::point, 4, Needs::skeleton, Source::derived},
    FieldEntry{"strain", "1", "soil__strain", Location::point, 4, Needs::skeleton, Source::held},
    FieldEntry{"plastic_strain", "1", "soil__plastic_strain", Location::point, 1, Needs::skeleton, Source::held},
    FieldEntry{"mobilised_strength", "1", "soil__mobilized_strength", Location::point, 1, Needs::skeleton,
               Source::held},
};

bool has(const FieldEntry& entry, const Scene& scene) {
    if (entry.needs == Needs::water) return scene.physics.water;
    return entry.needs != Needs::skeleton || scene.physics.deforming;
}

const FieldEntry& find_entry(std::string_view name, const Scene& scene) {
    const auto found =
        std::find_if(fields.begin(), fields.end(), [&](const FieldEntry& entry) { return entry.name == name; });
    if (found == fields.end()) throw Error(Status::unknown_field, "no field is named '" + std::string(name) + "'");
    if (!has(*found, scene)) {
        throw Error(Status::unknown_field, "field '" + std::string(name) + "' is left out: the scene has no " +
                                               (found->needs == Needs::water ? "water" : "deforming skeleton"));
    }
    return *found;
}

const std::vector<double>& held_values(std::string_view name, const GroundState& ground) {
    if (name == "node_position") return ground.node_position;
    if (name == "pressure") return ground.flow.pressure;
    if (name == "displacement") return ground.displacement;
    if (name == "velocity") return ground.velocity;
    if (name == "point_position") return ground.points.position;
    if (name == "point_volume") return ground.points.volume;
    if (name == "point_pressure") return ground.points.pressure;
    if (name == "saturation") return ground.points.saturation;
    if (name == "porosity") return ground.points.porosity;
    if (name == "darcy_flux") return ground.points.darcy_flux;
    if (name == "strain") return ground.points.strain;
    if (name == "plastic_strain") return ground.points.plastic_strain;
    return ground.points.mobilised_strength;
}

// Stresses differ by their spherical part only: total = skeleton stress - pore stress, net = total + max(p_g, p_l) (physics.md).
std::vector<double> stress_with(const Points& points, const std::vector<double>& added) {
    std::vector<double> stress = points.skeleton_stress;
    for (size_t p = 0; p < added.size(); ++p)
        for (size_t k = 0; k < 3; ++k) stress[4 * p + k] += added[p];
    return stress;
}

std::vector<double> derive(std::string_view name, const Simulation& simulation, const Scene& scene) {
    const Points& points = simulation.state().points;
    std::vector<double> values(points.pressure.size());
    if (name == "suction") {
        std::transform(points.pressure.begin(), points.pressure.end(), values.begin(),
                       [](double p) { return std::max(0.0, -p); });
        return values;
    }
    if (name == "water_content") {
        std::transform(points.saturation.begin(), points.saturation.end(), points.porosity.begin(), values.begin(),
                       std::multiplies<>());
        return values;
    }
    std::vector<double> added(simulation.pore_stress().size());
    for (size_t p = 0; p < added.size(); ++p) {
        const bool is_net = name == "net_stress";
        if (is_net && scene.physics.stress == StressMeasure::net) continue;
        added[p] =
            -simulation.pore_stress()[p] + (is_net && scene.physics.water ? std::max(0.0, points.pressure[p]) : 0.0);
    }
    return stress_with(points, added);
}

constexpr std::array plane_axes{"x", "y"};
constexpr std::array tensor_axes{"xx", "yy", "zz", "xy"};

std::string component_name(const FieldEntry& entry, int64_t components, size_t k) {
    if (components == 1 && entry.components == 1) return entry.name;
    if (entry.components == 4) return std::string(entry.name) + "." + tensor_axes[k];
    return std::string(entry.name) + "." + plane_axes[components == 1 ? 1 : k];
}

}  // namespace

std::vector<std::string> Engine::State::field_names() const {
    if (simulation->dynamic() != nullptr) return point_field_names();
    std::vector<std::string> names;
    for (const FieldEntry& entry : fields)
        if (has(entry, *scene)) names.emplace_back(entry.name);
    return names;
}

FieldView Engine::State::view(std::string_view field) const {
    if (simulation->dynamic() != nullptr) return view_points(field);
    const FieldEntry& entry = find_entry(field, *scene);
    const Mesh& mesh = simulation->mesh();
    FieldView view;
    view.name = entry.name;
    view.units = entry.units;
    view.standard_name = entry.standard_name;
    view.location = entry.location;
    view.components = entry.components == 0 ? mesh.dimension : entry.components;
    if (entry.source == Source::connectivity) {
        const std::vector<int32_t>& numbers = field == "cell_start"   ? mesh.cell_start
                                              : field == "cell_nodes" ? mesh.cell_nodes
                                                                      : mesh.cell_soil;
        view.type = DataType::int32;
        view.data = numbers.data();
        view.count = static_cast<int64_t>(numbers.size());
        return view;
    }
    const std::vector<double>* values = nullptr;
    if (entry.source == Source::held) {
        values = &held_values(field, simulation->state());
    } else {
        auto found = derived.find(field);
        if (found == derived.end()) found = derived.emplace(field, derive(field, *simulation, *scene)).first;
        values = &found->second;
    }
    view.data = values->data();
    view.count = static_cast<int64_t>(values->size()) / view.components;
    return view;
}

bool Engine::State::sample(const FieldView& field, double x, double y, std::span<double> values) const {
    if (simulation->dynamic() != nullptr) {
        const int32_t point = nearest_point(x, y);
        if (point >= 0) copy_row(field, point, values);
        return point >= 0;
    }
    const CellPlace place = locator.locate(x, y);
    if (place.cell >= 0) sample_cell(field, place, values);
    return place.cell >= 0;
}

void Engine::State::sample_cell(const FieldView& field, const CellPlace& place, std::span<double> values) const {
    const Mesh& mesh = simulation->mesh();
    const auto cell = static_cast<size_t>(place.cell);
    const auto* rows = static_cast<const double*>(field.data);
    const int32_t first = mesh.cell_start[cell];
    with_shape(mesh.cell_start[cell + 1] - first, [&](auto shape) {
        using Shape = decltype(shape);
        typename Shape::Natural at{};
        std::copy_n(place.natural.begin(), Shape::dimension, at.begin());
        const auto components = static_cast<size_t>(field.components);
        const auto share = Shape::values(at);
        const auto from_nodes = [&](const double* node_rows, size_t width, size_t k) {
            double value = 0;
            for (size_t a = 0; a < Shape::nodes; ++a) {
                value += share[a] *
                         node_rows[static_cast<size_t>(mesh.cell_nodes[static_cast<size_t>(first) + a]) * width + k];
            }
            return value;
        };
        if (field.location == Location::node) {
            for (size_t k = 0; k < components; ++k) values[k] = from_nodes(rows, components, k);
            return;
        }
        const std::string_view name = field.name;
        // On one curve: between nodes on either side of a water table the saturation is far from linear.
        if (name == "saturation" || name == "suction" || name == "point_pressure") {
            const double pressure = from_nodes(simulation->state().flow.pressure.data(), 1, 0);
            const HydraulicTable& table = simulation->flow()->table(static_cast<size_t>(mesh.cell_soil[cell]));
            values[0] = name == "saturation" ? table.at(pressure).saturation
                        : name == "suction"  ? std::max(0.0, -pressure)
                                             : pressure;
            return;
        }
        const auto row = static_cast<size_t>(simulation->state().points.cell_start[cell]);
        sample_points<Shape>(rows + row * components, field.components, at, values);
    });
}

std::vector<std::string> Engine::State::probe_quantities() const {
    if (simulation->dynamic() != nullptr) return point_quantities();
    std::vector<std::string> names;
    for (const FieldEntry& entry : fields) {
        const bool is_place = std::string_view(entry.name).find("position") != std::string_view::npos;
        if (!has(entry, *scene) || entry.source == Source::connectivity || is_place) continue;
        if (std::string_view(entry.name).starts_with("point_")) continue;
        const int64_t components = entry.components == 0 ? simulation->mesh().dimension : entry.components;
        for (size_t k = 0; k < static_cast<size_t>(components); ++k)
            names.push_back(component_name(entry, components, k));
    }
    return names;
}

ProbeTrack Engine::State::make_probe(const std::string& name, Place place) const {
    ProbeTrack probe{name, place, place, {}, -1, std::vector<std::vector<double>>(quantities.size())};
    std::array<double, 2> moved{};
    if (scene->physics.regime == MotionRegime::automatic && sample(view("displacement"), place[0], place[1], moved))
        probe.start = {place[0] - moved[0], place[1] - moved[1]};
    if (simulation->dynamic() != nullptr) {
        probe.point = nearest_point(place[0], place[1]);
    } else {
        probe.cell_place = locator.locate(place[0], place[1]);
    }
    return probe;
}

void Engine::State::follow_mesh() {
    locator = Locator(simulation->reference_mesh());
    point_soil.clear();
    if (simulation->dynamic() != nullptr) return;  // it moves again
    const Points& points = simulation->state().points;
    std::vector<double> start(points.position);
    for (size_t i = 0; i < start.size(); ++i) start[i] -= points.displacement[i];
    const double largest = *std::max_element(points.volume.begin(), points.volume.end());
    const NearestPlace nearest_start(start, scene->dynamics.cell_size + 2 * std::sqrt(largest));
    for (ProbeTrack& probe : probes) {
        probe.cell_place = {};
        probe.point = -1;
        const int32_t nearest_one = nearest_start.find(probe.start[0], probe.start[1]);
        if (nearest_one < 0) continue;
        const double* displacement = &points.displacement[2 * static_cast<size_t>(nearest_one)];
        probe.cell_place = locator.locate(probe.start[0] + displacement[0], probe.start[1] + displacement[1]);
        if (probe.cell_place.cell >= 0) continue;
        const double* position = &points.position[2 * static_cast<size_t>(nearest_one)];
        probe.cell_place = locator.locate(position[0], position[1]);
    }
    description = describe();
}

void Engine::State::record(ProbeTrack& probe) const {
    size_t quantity = 0;
    std::array<double, 4> values{};
    const auto name_of = [this](size_t k) {
        return std::string_view(quantities[k]).substr(0, quantities[k].find('.'));
    };
    while (quantity < quantities.size()) {
        const std::string_view name = name_of(quantity);
        size_t next = quantity + 1;
        while (next < quantities.size() && name_of(next) == name) ++next;
        const std::span<double> row = std::span(values).first(next - quantity);
        record_row(probe, name, row);
        for (const double value : row) probe.history[quantity++].push_back(value);
    }
}

/// The values of a field at a probe; no number where the ground that the probe is in has come to lack the field.
void Engine::State::record_row(const ProbeTrack& probe, std::string_view name, std::span<double> row) const {
    if (simulation->dynamic() == nullptr && probe.cell_place.cell >= 0)
        return sample_cell(view(name), probe.cell_place, row);
    const std::string_view at_points = name == "pressure" ? "point_pressure" : name;
    if (probe.point >= 0 && has_point_field(at_points)) return copy_row(view(at_points), probe.point, row);
    std::fill(row.begin(), row.end(), std::numeric_limits<double>::quiet_NaN());
}

void Engine::State::record_probes() {
    probe_times.push_back(simulation->state().time);
    for (ProbeTrack& probe : probes) record(probe);
}

}  // namespace talus
