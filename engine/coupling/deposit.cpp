#include "coupling/deposit.hpp"

#include "background/nearest.hpp"
#include "ground/build.hpp"
#include "materials/hydraulic/hydraulic_table.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace talus {
namespace {

// --- the surface -----------------------------------------------------------------------------------------------------

/// The sides between which the ground lies: walls that it has not left, or as far as it has come, m.
std::array<double, 2> find_sides(const DynamicGround& ground) {
    const FreePoints& points = ground.points();
    std::array<double, 2> sides{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (size_t p = 0; p < points.count; ++p) {
        const double half = std::sqrt(points[point_volume][p]) / 2;
        sides[0] = std::min(sides[0], points[position_x][p] - half);
        sides[1] = std::max(sides[1], points[position_x][p] + half);
    }
    const auto lies_at = [&](const Wall& wall, double side) {
        return wall.mirrors() || (wall.kind == WallKind::friction && std::abs(side - wall.place) < ground.cell_size());
    };
    if (lies_at(ground.walls().left, sides[0])) sides[0] = ground.walls().left.place;
    if (lies_at(ground.walls().right, sides[1])) sides[1] = ground.walls().right.place;
    return sides;
}

/// Evens out what the points' arrangement makes rough; the volume below stays as it is.
void smooth(std::vector<double>& height) {
    std::vector<double> gain(height.size(), 0.0);
    for (size_t k = 0; k + 1 < height.size(); ++k) {
        const double flow = 0.25 * (height[k + 1] - height[k]);
        gain[k] += flow;
        gain[k + 1] -= flow;
    }
    gain.front() *= 2;  // the outer ones stand for half a column
    gain.back() *= 2;
    for (size_t k = 0; k < height.size(); ++k) height[k] += gain[k];
}

/// The profile under which each column has the volume of the points in it, its vertices a cell of the grid apart.
std::vector<Place> find_terrain(const DynamicGround& ground, std::array<double, 2> sides) {
    const double width = sides[1] - sides[0];
    const auto columns = static_cast<size_t>(std::max(2.0, std::ceil(width / ground.cell_size() * (1 - 1e-9))));
    const double column = width / static_cast<double>(columns);
    std::vector<double> height(columns + 1, 0.0);
    const FreePoints& points = ground.points();
    for (size_t p = 0; p < points.count; ++p) {
        const double volume = points[point_volume][p], extent = std::sqrt(volume);
        constexpr int parts = 8;  // of a square as large as the point
        for (int i = 0; i < parts; ++i) {
            const double x = points[position_x][p] + extent * ((i + 0.5) / parts - 0.5);
            const double at = std::clamp((x - sides[0]) / column, 0.0, static_cast<double>(columns));
            const size_t left = std::min(static_cast<size_t>(at), columns - 1);
            const double share = at - static_cast<double>(left);
            height[left] += (1 - share) * volume / (parts * column);
            height[left + 1] += share * volume / (parts * column);
        }
    }
    height.front() *= 2;
    height.back() *= 2;
    smooth(height);
    std::vector<Place> terrain;
    for (size_t k = 0; k <= columns; ++k) {
        terrain.push_back({k < columns ? sides[0] + static_cast<double>(k) * column : sides[1],
                           ground.walls().base.place + height[k]});
    }
    return terrain;
}

// --- the mesh --------------------------------------------------------------------------------------------------------

/// Of the first soil all through.
Mesh build_under(const Scene& scene, const DynamicGround& ground, const std::vector<Place>& terrain) {
    Scene lying;
    lying.soils = scene.soils;
    lying.ground.kind = GroundKind::section;
    SectionGround& section = lying.ground.section;
    const double size = ground.cell_size();
    if (scene.ground.kind == GroundKind::section) {
        section = scene.ground.section;
    } else {
        section.surface_cell_height = section.largest_cell_height = size;
        section.growth = 1;
    }
    section.column_width = size;
    section.bend_column_width = 0;
    section.terrain = terrain;
    const double base = ground.walls().base.place;
    section.base = {{terrain.front()[0], base}, {terrain.back()[0], base}};
    section.layers = {{scene.soils.front().name, {}}};
    return build_mesh(lying);
}

// --- the state -------------------------------------------------------------------------------------------------------

enum Quantity : size_t {
    displacement_x,
    displacement_y,
    stress,
    plastic_strain = stress + 4,
    lost_strength,
    porosity,
    pressure,
    saturation,
    soil_shares,  // one a soil from here on
};

std::vector<double> values_of(const DynamicGround& ground, size_t p, size_t soils) {
    const FreePoints& points = ground.points();
    const auto number = static_cast<size_t>(points.number[p]);
    std::vector<double> value(soil_shares + soils, 0.0);
    value[displacement_x] = points[position_x][p] - ground.start_position()[2 * number];
    value[displacement_y] = points[position_y][p] - ground.start_position()[2 * number + 1];
    for (size_t k = 0; k < 4; ++k) value[stress + k] = points.field[stress_xx + k][p];
    value[plastic_strain] = points[plastic_shear_strain][p];
    value[lost_strength] = ground.lost_strength(p);
    value[porosity] = ground.porosity(p);
    if (ground.has_water()) {
        value[pressure] = ground.pressure(p);
        value[saturation] = ground.saturation(p);
    }
    value[soil_shares + static_cast<size_t>(points.soil[p])] = 1;
    return value;
}

/// Values at a place by the plane that fits best to those of the points within a cell's size of it: beyond their range by half of it at most, which is how far the
/// edge lies beyond two rows of points. False: there is none.
bool fit(const FreePoints& points, const NearestPlace& places, const std::vector<double>& point_values,
         const Place& place, double size, std::span<double> values) {
    constexpr double beyond = 0.5;              // of the range of what has no bounds of its own
    constexpr double least_determinant = 1e-4;  // of the places' moments: on a line they make no plane
    const size_t quantities = values.size();
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    std::vector<Eigen::Vector3d> sums(quantities, Eigen::Vector3d::Zero());
    std::vector<double> low(quantities, std::numeric_limits<double>::infinity()), high(quantities, -low[0]);
    places.visit_around(place[0], place[1], [&](int32_t number, double at_x, double at_y) {
        const auto p = static_cast<size_t>(number);
        const double x = (at_x - place[0]) / size, y = (at_y - place[1]) / size;
        if (std::abs(x) >= 1 || std::abs(y) >= 1) return;
        const double weight = points[point_volume][p] * (1 - std::abs(x)) * (1 - std::abs(y));
        const Eigen::Vector3d plane{1.0, x, y};
        moments += weight * plane * plane.transpose();
        for (size_t q = 0; q < quantities; ++q) {
            const double value = point_values[p * quantities + q];
            sums[q] += weight * value * plane;
            low[q] = std::min(low[q], value);
            high[q] = std::max(high[q], value);
        }
    });
    const double weight = moments(0, 0);
    if (!(weight > 0)) return false;
    moments /= weight;
    const bool is_plane = moments.determinant() > least_determinant;
    const Eigen::RowVector3d row = is_plane ? moments.inverse().row(0).eval() : Eigen::RowVector3d(1, 0, 0);
    for (size_t q = 0; q < quantities; ++q) {
        const bool is_bounded = q >= plastic_strain && q != pressure;
        const double margin = is_bounded ? 0 : beyond * (high[q] - low[q]);
        values[q] = std::clamp(row.dot(sums[q]) / weight, low[q] - margin, high[q] + margin);
    }
    return true;
}

/// To the nodes next to known ones, the mean of these; whether there were any.
bool spread(const Mesh& mesh, size_t quantities, std::vector<uint8_t>& known, std::vector<double>& values) {
    std::vector<double> sum(values.size(), 0.0);
    std::vector<int32_t> count(known.size(), 0);
    for (size_t c = 0; c < mesh.cell_soil.size(); ++c) {
        const std::span nodes(mesh.cell_nodes.begin() + mesh.cell_start[c],
                              mesh.cell_nodes.begin() + mesh.cell_start[c + 1]);
        for (const int32_t from : nodes) {
            for (const int32_t to : nodes) {
                if (known[static_cast<size_t>(from)] == 0 || known[static_cast<size_t>(to)] != 0) continue;
                ++count[static_cast<size_t>(to)];
                for (size_t q = 0; q < quantities; ++q)
                    sum[static_cast<size_t>(to) * quantities + q] += values[static_cast<size_t>(from) * quantities + q];
            }
        }
    }
    bool found = false;
    for (size_t node = 0; node < count.size(); ++node) {
        if (count[node] == 0) continue;
        found = true;
        known[node] = 1;
        for (size_t q = 0; q < quantities; ++q)
            values[node * quantities + q] = sum[node * quantities + q] / count[node];
    }
    return found;
}

/// Nodes x quantities. What no point is near to takes after the nodes around it.
std::vector<double> find_node_values(const DynamicGround& ground, const Mesh& mesh, size_t soils) {
    const FreePoints& points = ground.points();
    const size_t quantities = soil_shares + soils;
    std::vector<double> point_values, positions;
    point_values.reserve(points.count * quantities);
    for (size_t p = 0; p < points.count; ++p) {
        positions.insert(positions.end(), {points[position_x][p], points[position_y][p]});
        const std::vector<double> value = values_of(ground, p, soils);
        point_values.insert(point_values.end(), value.begin(), value.end());
    }
    const double size = ground.cell_size();
    const NearestPlace places(positions, size);
    const auto nodes = static_cast<size_t>(mesh.node_count());
    std::vector<double> values(nodes * quantities);
    std::vector<uint8_t> known(nodes);
    for (size_t node = 0; node < nodes; ++node) {
        known[node] = fit(points, places, point_values, {mesh.position[2 * node], mesh.position[2 * node + 1]}, size,
                          std::span(values).subspan(node * quantities, quantities));
    }
    while (spread(mesh, quantities, known, values)) {
    }
    return values;
}

/// Where the soil is full its pressure, elsewhere that with the saturation, which is what the water is.
double node_pressure(const HydraulicTable& table, const Retention& retention, double p, double s) {
    constexpr double least = 1e-6;  // of the range of saturation, next to its ends
    if (p >= 0) return p;
    const double range = retention.maximum_saturation - retention.residual_saturation;
    return table.pressure_of_saturation(
        std::clamp(s, retention.residual_saturation + least * range, retention.maximum_saturation - least * range));
}

}  // namespace

std::optional<Deposit> find_deposit(const Scene& scene, const DynamicGround& ground) {
    if (ground.points().count == 0) return {};
    const std::array<double, 2> sides = find_sides(ground);
    const std::vector<Place> terrain = find_terrain(ground, sides);
    const double base = ground.walls().base.place;
    const auto is_thin = [&](const Place& place) { return !(place[1] - base >= ground.cell_size()); };
    if (ground.walls().base.kind == WallKind::none || std::any_of(terrain.begin(), terrain.end(), is_thin)) return {};

    Deposit deposit;
    deposit.mesh = build_under(scene, ground, terrain);
    const std::vector<double> values = find_node_values(ground, deposit.mesh, scene.soils.size());
    const size_t quantities = soil_shares + scene.soils.size();
    const auto nodes = static_cast<size_t>(deposit.mesh.node_count());
    for (size_t c = 0; c < deposit.mesh.cell_soil.size(); ++c) {
        std::vector<double> share(scene.soils.size(), 0.0);
        for (auto k = static_cast<size_t>(deposit.mesh.cell_start[c]);
             k < static_cast<size_t>(deposit.mesh.cell_start[c + 1]); ++k) {
            const size_t row = static_cast<size_t>(deposit.mesh.cell_nodes[k]) * quantities;
            for (size_t s = 0; s < share.size(); ++s) share[s] += values[row + soil_shares + s];
        }
        deposit.mesh.cell_soil[c] = static_cast<int32_t>(std::max_element(share.begin(), share.end()) - share.begin());
    }
    std::vector<HydraulicTable> tables;
    if (ground.has_water())
        for (const Soil& soil : scene.soils) tables.emplace_back(soil.hydraulics);
    for (size_t node = 0; node < nodes; ++node) {
        const double* value = &values[node * quantities];
        deposit.displacement.insert(deposit.displacement.end(), {value[displacement_x], value[displacement_y]});
        deposit.stress.insert(deposit.stress.end(), value + stress, value + stress + 4);
        deposit.plastic_strain.push_back(value[plastic_strain]);
        deposit.lost_strength.push_back(value[lost_strength]);
        deposit.porosity.push_back(value[porosity]);
        if (!ground.has_water()) continue;
        const auto soil =
            static_cast<size_t>(std::max_element(value + soil_shares, value + quantities) - (value + soil_shares));
        deposit.pressure.push_back(
            node_pressure(tables[soil], scene.soils[soil].hydraulics.retention, value[pressure], value[saturation]));
    }
    return deposit;
}

}  // namespace talus
