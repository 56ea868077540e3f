// The fitted mesh: what every ground becomes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace talus {

/// A boundary facet: an edge of a plane mesh, or an end node of a column.
struct Facet {
    int32_t node_a;  ///< the ground lies to the left of a -> b, so the outward normal is (dy, -dx)
    int32_t node_b;  ///< -1 in a column
    int32_t cell;
    int32_t side;  ///< index into Mesh::sides
};

/// Lines (2 nodes, a column), triangles (3) and quads (4), counter-clockwise, each of one soil.
struct Mesh {
    int32_t dimension = 2;            ///< 1: position is y alone; 2: x, y
    std::vector<double> position;     ///< nodes x dimension, m
    std::vector<int32_t> cell_start;  ///< cells + 1 offsets into cell_nodes
    std::vector<int32_t> cell_nodes;
    std::vector<int32_t> cell_soil;  ///< index into Scene::soils, one a cell
    std::vector<Facet> facets;
    std::vector<std::string> sides;  ///< base, left, right, surface, then the names of a mesh file's own lines

    [[nodiscard]] int32_t node_count() const { return static_cast<int32_t>(position.size()) / dimension; }
    [[nodiscard]] int32_t cell_count() const { return static_cast<int32_t>(cell_soil.size()); }
};

}  // namespace talus
