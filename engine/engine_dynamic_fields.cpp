// The fields of a dynamic ground: those of its material points, in the order of their numbers, which never changes.
#include "engine_state.hpp"
#include "error.hpp"

#include <algorithm>
#include <array>

namespace talus {
namespace {

struct PointEntry {
    const char* name;
    const char* units;
    const char* standard_name;
    int32_t components;
    bool probed;  ///< whether probes record it
};

constexpr std::array entries{
    PointEntry{"point_position", "m", "", 2, false},
    PointEntry{"point_volume", "m2", "", 1, false},
    PointEntry{"point_soil", "1", "", 1, false},
    PointEntry{"displacement", "m", "soil__displacement", 2, true},
    PointEntry{"velocity", "m s-1", "soil__velocity", 2, true},
    PointEntry{"net_stress", "Pa", "soil__net_stress", 4, true},
    PointEntry{"total_stress", "Pa", "soil__total_stress", 4, true},
    PointEntry{"plastic_strain", "1", "soil__plastic_strain", 1, true},
    PointEntry{"mobilised_strength", "1", "soil__mobilized_strength", 1, true},
};

const PointEntry& find_entry(std::string_view name) {
    const auto found =
        std::find_if(entries.begin(), entries.end(), [&](const PointEntry& entry) { return entry.name == name; });
    if (found != entries.end()) return *found;
    throw Error(Status::unknown_field, "a dynamic ground has no field '" + std::string(name) +
                                           "': it has no mesh and no water, only fields of its points (see describe)");
}

/// Values of some fields of the points, side by side, by number.
std::vector<double> by_number(const FreePoints& points, std::initializer_list<PointField> names) {
    std::vector<double> values(points.count * names.size());
    size_t k = 0;
    for (const PointField name : names) {
        for (size_t p = 0; p < points.count; ++p)
            values[static_cast<size_t>(points.number[p]) * names.size() + k] = points[name][p];
        ++k;
    }
    return values;
}

std::vector<double> derive(std::string_view name, const DynamicGround& ground) {
    const FreePoints& points = ground.points();
    if (name == "point_position") return by_number(points, {position_x, position_y});
    if (name == "point_volume") return by_number(points, {point_volume});
    if (name == "velocity") return by_number(points, {velocity_x, velocity_y});
    if (name == "plastic_strain") return by_number(points, {plastic_shear_strain});
    if (name == "mobilised_strength") return ground.mobilised_strength();
    if (name == "displacement") {
        std::vector<double> values = by_number(points, {position_x, position_y});
        for (size_t i = 0; i < values.size(); ++i) values[i] -= ground.start_position()[i];
        return values;
    }
    return by_number(points, {stress_xx, stress_yy, stress_zz, stress_xy});  // dry: net and total stress are the same
}

}  // namespace

void Engine::State::number_point_soils() {
    const FreePoints& points = simulation.dynamic()->points();
    point_soil.resize(points.count);
    for (size_t p = 0; p < points.count; ++p) point_soil[static_cast<size_t>(points.number[p])] = points.soil[p];
}

std::vector<std::string> Engine::State::point_field_names() const {
    std::vector<std::string> names;
    for (const PointEntry& entry : entries) names.emplace_back(entry.name);
    return names;
}

std::vector<std::string> Engine::State::point_quantities() const {
    constexpr std::array plane{".x", ".y"};
    constexpr std::array tensor{".xx", ".yy", ".zz", ".xy"};
    std::vector<std::string> names;
    for (const PointEntry& entry : entries) {
        if (!entry.probed) continue;
        if (entry.components == 1) names.emplace_back(entry.name);
        for (size_t k = 0; k < static_cast<size_t>(entry.components) && entry.components > 1; ++k)
            names.push_back(std::string(entry.name) + (entry.components == 2 ? plane[k] : tensor[k]));
    }
    return names;
}

FieldView Engine::State::view_points(std::string_view field) const {
    const PointEntry& entry = find_entry(field);
    FieldView view;
    view.name = entry.name;
    view.units = entry.units;
    view.standard_name = entry.standard_name;
    view.location = Location::point;
    view.components = entry.components;
    view.count = static_cast<int64_t>(simulation.dynamic()->points().count);
    if (field == "point_soil") {
        view.type = DataType::int32;
        view.data = point_soil.data();
        return view;
    }
    auto found = derived.find(field);
    if (found == derived.end()) found = derived.emplace(field, derive(field, *simulation.dynamic())).first;
    view.data = found->second.data();
    return view;
}

int32_t Engine::State::nearest_point(double x, double y) const {
    if (!nearest) {
        const FieldView position = view_points("point_position");
        nearest = std::make_unique<NearestPlace>(
            std::span(static_cast<const double*>(position.data), static_cast<size_t>(2 * position.count)),
            simulation.dynamic()->cell_size());
    }
    return nearest->find(x, y);
}

void Engine::State::copy_row(const FieldView& field, int32_t point, std::span<double> values) {
    const auto* rows = static_cast<const double*>(field.data);
    std::copy_n(rows + static_cast<size_t>(point) * values.size(), values.size(), values.begin());
}

void Engine::State::report_motion() {
    const MotionReport motion = simulation.dynamic()->report();
    report.regime = Regime::dynamic;
    report.motion = motion;
    report.largest_displacement = motion.largest_displacement;
    report.largest_velocity = motion.largest_velocity;
}

}  // namespace talus
