#include "error.hpp"
#include "ground/builders.hpp"
#include "ground/gmsh_file.hpp"
#include "ground/quality.hpp"
#include "ground/sides.hpp"
#include "ground/text.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <tuple>

namespace talus {
namespace {

constexpr double farthest_off_plane = 1e-6;  // m: what rounding leaves of a zero

[[noreturn]] void fail(const GmshFile& file, int32_t line, const std::string& what) {
    throw Error(Status::invalid_scene, gmsh_place(file.name, line) + what);
}

GmshFile read_gmsh(const std::string& name) {
    std::ifstream stream(name, std::ios::binary);
    std::ostringstream text;
    if (stream.peek() != std::ifstream::traits_type::eof()) text << stream.rdbuf();
    if (!stream.is_open() || stream.bad() || !text)
        throw Error(Status::io, "ground.mesh.file: cannot read '" + name + "'");
    return parse_gmsh(text.view(), name);
}

/// Tag of the physical group that an element belongs to, 0 for none.
int64_t physical_group(const GmshFile& file, const GmshElement& element) {
    if (!file.has_entities) return element.owner;
    const auto entity = file.entity_group.find({element.dimension(), element.owner});
    if (entity == file.entity_group.end()) {
        fail(file, element.line,
             "the element belongs to entity " + std::to_string(element.owner) + ", which $Entities does not list");
    }
    return std::abs(entity->second);  // negative where the entity is reversed in its group
}

/// Number of a node in file.nodes.
size_t find_node(const GmshFile& file, const GmshElement& element, int64_t tag) {
    const auto node = std::lower_bound(file.nodes.begin(), file.nodes.end(), tag,
                                       [](const GmshNode& a, int64_t b) { return a.tag < b; });
    if (node == file.nodes.end() || node->tag != tag)
        fail(file, element.line, "the element has node " + std::to_string(tag) + ", which $Nodes does not list");
    return static_cast<size_t>(node - file.nodes.begin());
}

// --- cells -----------------------------------------------------------------------------------------------------------

/// Number of the soil that each physical surface names.
std::map<int64_t, int32_t> surface_soils(const Scene& scene, const GmshFile& file) {
    std::map<int64_t, int32_t> soils;
    for (const auto& [key, name] : file.physical_names) {
        if (key.first == 2)
            soils[key.second] = find_soil(scene, name.text, gmsh_place(file.name, name.line) + "physical surface");
    }
    return soils;
}

int32_t cell_soil(const GmshFile& file, const GmshElement& element, const std::map<int64_t, int32_t>& soils) {
    const int64_t group = physical_group(file, element);
    const auto soil = soils.find(group);
    if (soil != soils.end()) return soil->second;
    fail(file, element.line,
         group == 0
             ? "the cell belongs to no physical surface; every cell must, and the surface's name must be a soil's"
             : "physical surface " + std::to_string(group) + " has no name; name it after a soil");
}

/// Adds the node to the mesh when a cell first uses it: a file also holds nodes that no cell uses, such as centres of
/// arcs.
int32_t use_node(const GmshFile& file, size_t number, std::vector<int32_t>& mesh_node, Mesh& mesh) {
    if (mesh_node[number] < 0) {
        mesh_node[number] = mesh.node_count();
        mesh.position.insert(mesh.position.end(), {file.nodes[number].x, file.nodes[number].y});
    }
    return mesh_node[number];
}

/// Surfaces may be meshed clockwise: which way says nothing about the ground.
void turn_counter_clockwise(const std::vector<double>& position, int32_t* nodes, int32_t size) {
    const auto place = [&](int32_t corner) { return &position[2 * static_cast<size_t>(nodes[corner % size])]; };
    double area = 0;
    for (int32_t i = 1; i + 1 < size; ++i) {
        const double* a = place(0);
        const double* b = place(i);
        const double* c = place(i + 1);
        area += (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    }
    if (area < 0) std::reverse(nodes + 1, nodes + size);
}

/// Adds the cells; gives the mesh's node of each of the file's, -1 where no cell uses it.
std::vector<int32_t> add_cells(const Scene& scene, const GmshFile& file, Mesh& mesh) {
    const std::map<int64_t, int32_t> soils = surface_soils(scene, file);
    std::vector<int32_t> mesh_node(file.nodes.size(), -1);
    mesh.cell_start = {0};
    for (const GmshElement& element : file.elements) {
        if (element.dimension() != 2) continue;
        mesh.cell_soil.push_back(cell_soil(file, element, soils));
        for (int32_t i = 0; i < element.size; ++i) {
            const size_t number = find_node(file, element, element.nodes[static_cast<size_t>(i)]);
            if (std::abs(file.nodes[number].z) > farthest_off_plane) {
                fail(file, element.line,
                     "the cell has node " + std::to_string(file.nodes[number].tag) + " with z = " +
                         number_text(file.nodes[number].z) + "; a section lies in the plane z = 0, y being up");
            }
            mesh.cell_nodes.push_back(use_node(file, number, mesh_node, mesh));
        }
        mesh.cell_start.push_back(static_cast<int32_t>(mesh.cell_nodes.size()));
        turn_counter_clockwise(
            mesh.position, &mesh.cell_nodes[mesh.cell_nodes.size() - static_cast<size_t>(element.size)], element.size);
    }
    return mesh_node;
}

// --- sides -----------------------------------------------------------------------------------------------------------

/// The mesh's side called `name`, added where it has none.
int32_t side_number(const std::string& name, Mesh& mesh) {
    const auto side = std::find(mesh.sides.begin(), mesh.sides.end(), name);
    if (side == mesh.sides.end()) mesh.sides.push_back(name);
    return static_cast<int32_t>(std::find(mesh.sides.begin(), mesh.sides.end(), name) - mesh.sides.begin());
}

/// Facets on named physical lines get the side of that name; lines inside the ground name no side.
void name_sides(const GmshFile& file, const std::vector<int32_t>& mesh_node, Mesh& mesh) {
    std::map<int64_t, int32_t> sides;
    for (const auto& [key, name] : file.physical_names) {
        if (key.first == 1) sides[key.second] = side_number(name.text, mesh);
    }
    std::map<std::pair<int32_t, int32_t>, Facet*> facets;
    for (Facet& facet : mesh.facets) facets[std::minmax(facet.node_a, facet.node_b)] = &facet;
    std::map<const Facet*, int32_t> named;
    for (const GmshElement& element : file.elements) {
        if (element.dimension() != 1) continue;
        const auto side = sides.find(physical_group(file, element));
        const int32_t a = mesh_node[find_node(file, element, element.nodes[0])];
        const int32_t b = mesh_node[find_node(file, element, element.nodes[1])];
        const auto facet = facets.find(std::minmax(a, b));
        if (side == sides.end() || facet == facets.end()) continue;
        if (!named.emplace(facet->second, side->second).second && facet->second->side != side->second) {
            fail(file, element.line,
                 "the line belongs to the sides " + mesh.sides[static_cast<size_t>(facet->second->side)] + " and " +
                     mesh.sides[static_cast<size_t>(side->second)] + "; one is allowed");
        }
        facet->second->side = side->second;
    }
}

}  // namespace

Mesh build_gmsh(const Scene& scene) {
    const GmshFile file = read_gmsh(scene.ground.mesh.file);
    Mesh mesh;
    const std::vector<int32_t> mesh_node = add_cells(scene, file, mesh);
    check_mesh(mesh, "ground.mesh.file: " + file.name);
    set_sides(mesh);
    name_sides(file, mesh_node, mesh);
    return mesh;
}

}  // namespace talus
