// Grounds that several tests of meshes use.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "error.hpp"
#include "ground/build.hpp"

namespace talus {

inline Scene scene_with_soils(const std::vector<std::string>& names) {
    Scene scene;
    for (const std::string& name : names) scene.soils.emplace_back().name = name;
    return scene;
}

/// The slope of 45 degrees, one layer.
inline Scene slope_scene() {
    Scene scene = scene_with_soils({"sand", "clay"});
    scene.ground.kind = GroundKind::section;
    SectionGround& section = scene.ground.section;
    section.terrain = {{0, 30}, {20, 30}, {40, 10}, {60, 10}};
    section.base = {{0, 0}, {60, 0}};
    section.layers = {{"sand", {}}};
    section.column_width = 1;
    section.surface_cell_height = 0.15;
    section.graded_depth = 6;
    section.growth = 1.3;
    section.largest_cell_height = 1.5;
    return scene;
}

inline std::vector<int32_t> cell_nodes(const Mesh& mesh, int32_t cell) {
    const auto c = static_cast<size_t>(cell);
    return {mesh.cell_nodes.begin() + mesh.cell_start[c], mesh.cell_nodes.begin() + mesh.cell_start[c + 1]};
}

inline Place node_place(const Mesh& mesh, int32_t node) {
    const auto n = static_cast<size_t>(node);
    return {mesh.position[2 * n], mesh.position[2 * n + 1]};
}

inline double cell_area(const Mesh& mesh, int32_t cell) {
    const std::vector<int32_t> nodes = cell_nodes(mesh, cell);
    double twice = 0;
    for (size_t i = 0; i < nodes.size(); ++i) {
        const Place a = node_place(mesh, nodes[i]);
        const Place b = node_place(mesh, nodes[(i + 1) % nodes.size()]);
        twice += a[0] * b[1] - b[0] * a[1];
    }
    return twice / 2;
}

/// Area of the cells of one soil, or of all with -1.
inline double soil_area(const Mesh& mesh, int32_t soil) {
    double sum = 0;
    for (int32_t cell = 0; cell < mesh.cell_count(); ++cell) {
        if (soil < 0 || mesh.cell_soil[static_cast<size_t>(cell)] == soil) sum += cell_area(mesh, cell);
    }
    return sum;
}

/// Length of the facets of a side.
inline double side_length(const Mesh& mesh, const std::string& name) {
    double length = 0;
    for (const Facet& facet : mesh.facets) {
        if (mesh.sides[static_cast<size_t>(facet.side)] != name) continue;
        const Place a = node_place(mesh, facet.node_a);
        const Place b = node_place(mesh, facet.node_b);
        length += std::hypot(b[0] - a[0], b[1] - a[1]);
    }
    return length;
}

/// Elevations of the nodes on the vertical line at x, from the surface down.
inline std::vector<double> elevations_at(const Mesh& mesh, double x) {
    std::vector<double> elevations;
    for (int32_t node = 0; node < mesh.node_count(); ++node) {
        const Place place = node_place(mesh, node);
        if (std::abs(place[0] - x) < 1e-9) elevations.push_back(place[1]);
    }
    std::sort(elevations.rbegin(), elevations.rend());
    return elevations;
}

/// The message with which building the scene's ground fails, empty where it does not.
inline std::string build_failure(const Scene& scene) {
    try {
        (void)build_mesh(scene);
    } catch (const Error& error) {
        CHECK((error.status == Status::invalid_scene || error.status == Status::io));
        return error.what();
    }
    return {};
}

inline bool mentions(const std::string& message, const std::string& part) {
    return message.find(part) != std::string::npos;
}

}  // namespace talus
