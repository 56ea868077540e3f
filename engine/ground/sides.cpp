#include "ground/sides.hpp"

#include "ground/edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace talus {
namespace {

using Loop = std::vector<Facet>;

/// Boundary facets by their first node, -1 where a node has none; a checked mesh has at most one a node.
std::vector<Facet> boundary_by_node(const Mesh& mesh) {
    std::vector<Facet> facet(static_cast<size_t>(mesh.node_count()), Facet{-1, -1, -1, -1});
    const std::vector<Edge> edges = sorted_edges(mesh);
    for (size_t i = 0; i < edges.size(); ++i) {
        const bool shared = (i > 0 && edges[i].joins_same_nodes(edges[i - 1])) ||
                            (i + 1 < edges.size() && edges[i].joins_same_nodes(edges[i + 1]));
        if (!shared) facet[static_cast<size_t>(edges[i].a)] = {edges[i].a, edges[i].b, edges[i].cell, -1};
    }
    return facet;
}

std::vector<Loop> boundary_loops(const Mesh& mesh) {
    std::vector<Facet> next = boundary_by_node(mesh);
    std::vector<Loop> loops;
    for (size_t node = 0; node < next.size(); ++node) {
        if (next[node].node_a < 0) continue;
        Loop& loop = loops.emplace_back();
        for (size_t at = node; next[at].node_a >= 0;) {
            loop.push_back(next[at]);
            next[at].node_a = -1;
            at = static_cast<size_t>(loop.back().node_b);
        }
    }
    return loops;
}

class Boundary2D {
public:
    explicit Boundary2D(const Mesh& mesh) : position_(mesh.position) {
        left_ = right_ = position_[0];
        for (size_t i = 0; i < position_.size(); i += 2) {
            left_ = std::min(left_, position_[i]);
            right_ = std::max(right_, position_[i]);
        }
    }

    /// Twice the area that a loop goes around, positive counter-clockwise.
    [[nodiscard]] double area(const Loop& loop) const {
        double sum = 0;
        for (const Facet& facet : loop) {
            sum += (x(facet.node_a) - left_) * y(facet.node_b) - (x(facet.node_b) - left_) * y(facet.node_a);
        }
        return sum;
    }

    /// Turns the outer loop to start at the base's first node and sets the side of each facet.
    void cut_at_corners(Loop& loop) const {
        const size_t start = corner(loop, left_, -1);
        std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(start), loop.end());
        const std::array<size_t, 3> cut = {corner(loop, right_, -1), corner(loop, right_, 1), corner(loop, left_, 1)};
        for (size_t i = 0; i < loop.size(); ++i) {
            loop[i].side = i < cut[0]                  ? side_base
                           : i < cut[1]                ? side_right
                           : i < cut[2] || cut[2] == 0 ? side_surface
                                                       : side_left;
        }
    }

private:
    /// The facet that starts at the lowest (direction -1) or highest (1) node on the vertical line at `line`.
    [[nodiscard]] size_t corner(const Loop& loop, double line, double direction) const {
        const double near = 1e-9 * (right_ - left_);
        size_t best = loop.size();
        for (size_t i = 0; i < loop.size(); ++i) {
            if (std::abs(x(loop[i].node_a) - line) > near) continue;
            if (best == loop.size() || direction * (y(loop[i].node_a) - y(loop[best].node_a)) > 0) best = i;
        }
        return best;
    }
    [[nodiscard]] double x(int32_t node) const { return position_[2 * static_cast<size_t>(node)]; }
    [[nodiscard]] double y(int32_t node) const { return position_[2 * static_cast<size_t>(node) + 1]; }

    const std::vector<double>& position_;
    double left_ = 0;
    double right_ = 0;
};

void set_plane_sides(Mesh& mesh) {
    const Boundary2D boundary(mesh);
    std::vector<Loop> loops = boundary_loops(mesh);
    // A checked mesh is one piece: one loop goes around it, counter-clockwise, and the others around its holes.
    const auto outer = std::max_element(loops.begin(), loops.end(), [&](const Loop& one, const Loop& other) {
        return boundary.area(one) < boundary.area(other);
    });
    std::rotate(loops.begin(), outer, outer + 1);
    boundary.cut_at_corners(loops.front());
    if (loops.size() > 1) mesh.sides.push_back("hole");
    for (const Loop& loop : loops) {
        for (Facet facet : loop) {
            if (facet.side < 0) facet.side = side_surface + 1;
            mesh.facets.push_back(facet);
        }
    }
}

}  // namespace

void set_sides(Mesh& mesh) {
    mesh.sides = {"base", "left", "right", "surface"};
    mesh.facets.clear();
    if (mesh.dimension == 1) {
        mesh.facets = {{mesh.cell_nodes.front(), -1, 0, side_base},
                       {mesh.cell_nodes.back(), -1, mesh.cell_count() - 1, side_surface}};
    } else {
        set_plane_sides(mesh);
    }
}

}  // namespace talus
