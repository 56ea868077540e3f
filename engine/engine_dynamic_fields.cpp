// The fields of a dynamic ground: those of its material points, in the order of their numbers, which never changes.
#include "engine_state.hpp"
#include "error.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace talus {
namespace {

enum class Needs { nothing, water, gas, exchange };

struct PointEntry {
    const char* name;
    const char* units;
    const char* standard_name;
    int32_t components;
    bool probed;  ///< whether probes record it
    Needs needs;
};

constexpr std::array entries{
    PointEntry{"point_position", "m", "", 2, false, Needs::nothing},
    PointEntry{"point_volume", "m2", "", 1, false, Needs::nothing},
    PointEntry{"point_soil", "1", "", 1, false, Needs::nothing},
    PointEntry{"point_pressure", "Pa", "soil_water__pressure", 1, true, Needs::water},
    PointEntry{"gas_pressure", "Pa", "", 1, true, Needs::gas},
    PointEntry{"relative_humidity", "1", "", 1, true, Needs::exchange},
    PointEntry{"dissolved_air", "kg m-3", "", 1, true, Needs::exchange},
    PointEntry{"saturation", "1", "soil_water__saturated_volume_fraction", 1, true, Needs::water},
    PointEntry{"suction", "Pa", "soil_water__suction", 1, true, Needs::water},
    PointEntry{"porosity", "1", "soil__porosity", 1, true, Needs::water},
    PointEntry{"water_content", "1", "soil_water__volume_fraction", 1, true, Needs::water},
    PointEntry{"darcy_flux", "m s-1", "soil_water__darcy_velocity", 2, true, Needs::water},
    PointEntry{"displacement", "m", "soil__displacement", 2, true, Needs::nothing},
    PointEntry{"velocity", "m s-1", "soil__velocity", 2, true, Needs::nothing},
    PointEntry{"net_stress", "Pa", "soil__net_stress", 4, true, Needs::nothing},
    PointEntry{"total_stress", "Pa", "soil__total_stress", 4, true, Needs::nothing},
    PointEntry{"plastic_strain", "1", "soil__plastic_strain", 1, true, Needs::nothing},
    PointEntry{"mobilised_strength", "1", "soil__mobilized_strength", 1, true, Needs::nothing},
};

bool has(const PointEntry& entry, const DynamicGround& ground) {
    if (entry.needs == Needs::gas) return ground.has_gas();
    if (entry.needs == Needs::exchange) return ground.has_exchange();
    return entry.needs == Needs::nothing || ground.has_water();
}

const char* missing(Needs needs) {
    if (needs == Needs::exchange) return "exchange between water and gas";
    return needs == Needs::gas ? "gas that moves" : "water";
}

const PointEntry& find_entry(std::string_view name, const DynamicGround& ground) {
    const auto found =
        std::find_if(entries.begin(), entries.end(), [&](const PointEntry& entry) { return entry.name == name; });
    if (found == entries.end()) {
        throw Error(Status::unknown_field, "a dynamic ground has no field '" + std::string(name) +
                                               "': it has no mesh, only fields of its points (see describe)");
    }
    if (!has(*found, ground)) {
        throw Error(Status::unknown_field,
                    "field '" + std::string(name) + "' is left out: the scene has no " + missing(found->needs));
    }
    return *found;
}

constexpr double none = std::numeric_limits<double>::quiet_NaN();  // what a point has that was taken out of the ground

/// Values of some fields of the points, side by side, by number.
std::vector<double> by_number(const DynamicGround& ground, std::initializer_list<PointField> names) {
    const FreePoints& points = ground.points();
    std::vector<double> values(ground.numbers() * names.size(), none);
    size_t k = 0;
    for (const PointField name : names) {
        for (size_t p = 0; p < points.count; ++p)
            values[static_cast<size_t>(points.number[p]) * names.size() + k] = points[name][p];
        ++k;
    }
    return values;
}

/// value(point) of every point, by number.
template <class Value>
std::vector<double> each_by_number(const DynamicGround& ground, const Value& value, double of_others = none) {
    const FreePoints& points = ground.points();
    std::vector<double> values(ground.numbers(), of_others);
    for (size_t p = 0; p < points.count; ++p) values[static_cast<size_t>(points.number[p])] = value(p);
    return values;
}

std::vector<double> stresses(const DynamicGround& ground, bool is_total) {
    std::vector<double> values = by_number(ground, {stress_xx, stress_yy, stress_zz, stress_xy});
    if (!ground.has_water()) return values;  // net and total stress are the same
    for (size_t p = 0; p < ground.points().count; ++p) {
        const double pore_stress = ground.pore_stress(p);
        const double larger = std::max(ground.pressure(p), ground.gas_pressure(p));
        const double added = is_total ? -pore_stress : larger - pore_stress;
        for (size_t k = 0; k < 3; ++k) values[4 * static_cast<size_t>(ground.points().number[p]) + k] += added;
    }
    return values;
}

/// Relative to the solid: n S (v_l - v_s).
std::vector<double> darcy_flux(const DynamicGround& ground) {
    const FreePoints& points = ground.points();
    std::vector<double> values(2 * ground.numbers(), none);
    for (size_t p = 0; p < points.count; ++p) {
        const double content = ground.porosity(p) * ground.saturation(p);
        double* flux = &values[2 * static_cast<size_t>(points.number[p])];
        flux[0] = content * (points[liquid_velocity_x][p] - points[velocity_x][p]);
        flux[1] = content * (points[liquid_velocity_y][p] - points[velocity_y][p]);
    }
    return values;
}

std::vector<double> derive_water(std::string_view name, const DynamicGround& ground) {
    if (name == "darcy_flux") return darcy_flux(ground);
    if (name == "porosity") return each_by_number(ground, [&](size_t p) { return ground.porosity(p); });
    if (name == "saturation") return each_by_number(ground, [&](size_t p) { return ground.saturation(p); });
    if (name == "gas_pressure") return each_by_number(ground, [&](size_t p) { return ground.gas_pressure(p); });
    if (name == "relative_humidity")
        return each_by_number(ground, [&](size_t p) { return ground.relative_humidity(p); });
    if (name == "dissolved_air") return each_by_number(ground, [&](size_t p) { return ground.dissolved_air(p); });
    if (name == "suction") {
        return each_by_number(ground,
                              [&](size_t p) { return std::max(ground.gas_pressure(p) - ground.pressure(p), 0.0); });
    }
    if (name == "water_content")
        return each_by_number(ground, [&](size_t p) { return ground.porosity(p) * ground.saturation(p); });
    return each_by_number(ground, [&](size_t p) { return ground.pressure(p); });
}

std::vector<double> derive(std::string_view name, const DynamicGround& ground) {
    const double* volume = ground.points()[point_volume];
    if (name == "point_position") return ground.positions();
    if (name == "point_volume") {
        return each_by_number(
            ground, [&](size_t p) { return volume[p]; }, 0.0);
    }
    if (name == "velocity") return by_number(ground, {velocity_x, velocity_y});
    if (name == "plastic_strain") return by_number(ground, {plastic_shear_strain});
    if (name == "mobilised_strength")
        return each_by_number(ground, [&](size_t p) { return ground.mobilised_strength(p); });
    if (name == "displacement") {
        std::vector<double> values = ground.positions();
        for (size_t i = 0; i < values.size(); ++i) values[i] -= ground.start_position()[i];
        return values;
    }
    if (name == "net_stress" || name == "total_stress") return stresses(ground, name == "total_stress");
    return derive_water(name, ground);
}

}  // namespace

void Engine::State::number_point_soils() {
    const FreePoints& points = simulation->dynamic()->points();
    point_soil.resize(points.count);
    for (size_t p = 0; p < points.count; ++p) point_soil[static_cast<size_t>(points.number[p])] = points.soil[p];
}

void Engine::State::follow_points() {
    number_point_soils();
    // By where they lay at the start: within the step they may have moved already.
    const NearestPlace start(simulation->dynamic()->start_position(), simulation->dynamic()->cell_size());
    for (ProbeTrack& probe : probes) probe.point = start.find(probe.start[0], probe.start[1]);
    description = describe();
}

bool Engine::State::has_point_field(std::string_view name) const {
    const std::vector<std::string> names = point_field_names();
    return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<std::string> Engine::State::point_field_names() const {
    std::vector<std::string> names;
    for (const PointEntry& entry : entries)
        if (has(entry, *simulation->dynamic())) names.emplace_back(entry.name);
    return names;
}

std::vector<std::string> Engine::State::point_quantities() const {
    constexpr std::array plane{".x", ".y"};
    constexpr std::array tensor{".xx", ".yy", ".zz", ".xy"};
    std::vector<std::string> names;
    for (const PointEntry& entry : entries) {
        if (!entry.probed || !has(entry, *simulation->dynamic())) continue;
        const bool is_pressure = std::string_view(entry.name) == "point_pressure";  // probes of a mesh have the nodes'
        if (entry.components == 1) names.emplace_back(is_pressure ? "pressure" : entry.name);
        for (size_t k = 0; k < static_cast<size_t>(entry.components) && entry.components > 1; ++k)
            names.push_back(std::string(entry.name) + (entry.components == 2 ? plane[k] : tensor[k]));
    }
    return names;
}

FieldView Engine::State::view_points(std::string_view field) const {
    const PointEntry& entry = find_entry(field, *simulation->dynamic());
    FieldView view;
    view.name = entry.name;
    view.units = entry.units;
    view.standard_name = entry.standard_name;
    view.location = Location::point;
    view.components = entry.components;
    view.count = static_cast<int64_t>(simulation->dynamic()->numbers());
    if (field == "point_soil") {
        view.type = DataType::int32;
        view.data = point_soil.data();
        return view;
    }
    auto found = derived.find(field);
    if (found == derived.end()) found = derived.emplace(field, derive(field, *simulation->dynamic())).first;
    view.data = found->second.data();
    return view;
}

int32_t Engine::State::nearest_point(double x, double y) const {
    if (!nearest) {
        nearest =
            std::make_unique<NearestPlace>(simulation->dynamic()->positions(), simulation->dynamic()->cell_size());
    }
    return nearest->find(x, y);
}

void Engine::State::copy_row(const FieldView& field, int32_t point, std::span<double> values) {
    const auto* rows = static_cast<const double*>(field.data);
    std::copy_n(rows + static_cast<size_t>(point) * values.size(), values.size(), values.begin());
}

void Engine::State::report_motion() {
    const MotionReport motion = simulation->dynamic()->report();
    report.regime = simulation->state().rests ? Regime::at_rest : Regime::dynamic;
    report.motion = motion;
    report.largest_displacement = motion.largest_displacement;
    report.largest_velocity = motion.largest_velocity;
}

}  // namespace talus
