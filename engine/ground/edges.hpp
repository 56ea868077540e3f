// The edges of a plane mesh, found by sorting: the same order on every machine.
#pragma once

#include "ground/mesh.hpp"

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

namespace talus {

/// One cell's edge from node a to node b, the cell on its left.
struct Edge {
    int32_t a;
    int32_t b;
    int32_t cell;
    [[nodiscard]] int32_t low() const { return std::min(a, b); }
    [[nodiscard]] int32_t high() const { return std::max(a, b); }
    [[nodiscard]] bool joins_same_nodes(const Edge& other) const {
        return low() == other.low() && high() == other.high();
    }
};

/// Every cell's edges, those between the same two nodes side by side.
[[nodiscard]] inline std::vector<Edge> sorted_edges(const Mesh& mesh) {
    std::vector<Edge> edges;
    edges.reserve(mesh.cell_nodes.size());
    for (int32_t cell = 0; cell < mesh.cell_count(); ++cell) {
        const auto c = static_cast<size_t>(cell);
        const int32_t first = mesh.cell_start[c];
        const int32_t last = mesh.cell_start[c + 1] - 1;
        for (int32_t i = first; i <= last; ++i) {
            const int32_t next = i == last ? first : i + 1;
            edges.push_back(
                {mesh.cell_nodes[static_cast<size_t>(i)], mesh.cell_nodes[static_cast<size_t>(next)], cell});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& left, const Edge& right) {
        return std::tuple(left.low(), left.high(), left.cell) < std::tuple(right.low(), right.high(), right.cell);
    });
    return edges;
}

}  // namespace talus
