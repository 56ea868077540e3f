#include "ground/quality.hpp"

#include "error.hpp"
#include "ground/edges.hpp"
#include "ground/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace talus {
namespace {

[[noreturn]] void refuse(const std::string& what) { throw Error(Status::invalid_scene, what); }

[[noreturn]] void refuse_cell(size_t cell, const std::string& what) {
    refuse("cell " + std::to_string(cell) + " " + what);
}

// --- places in messages ----------------------------------------------------------------------------------------------

std::string node_text(const Mesh& mesh, int32_t node) {
    const double* place = &mesh.position[static_cast<size_t>(node) * static_cast<size_t>(mesh.dimension)];
    const std::string at = mesh.dimension == 1 ? "y = " + number_text(place[0]) + " m" : place_text(place[0], place[1]);
    return "node " + std::to_string(node) + " at " + at;
}

std::string cell_text(const Mesh& mesh, int32_t cell) {
    const auto first = static_cast<size_t>(mesh.cell_start[static_cast<size_t>(cell)]);
    const auto last = static_cast<size_t>(mesh.cell_start[static_cast<size_t>(cell) + 1]);
    const auto dimension = static_cast<size_t>(mesh.dimension);
    std::array<double, 2> centre{};
    for (size_t i = first; i < last; ++i) {
        for (size_t k = 0; k < dimension; ++k) {
            centre[k] += mesh.position[static_cast<size_t>(mesh.cell_nodes[i]) * dimension + k] /
                         static_cast<double>(last - first);
        }
    }
    const std::string at =
        mesh.dimension == 1 ? "y = " + number_text(centre[0]) + " m" : place_text(centre[0], centre[1]);
    return "cell " + std::to_string(cell) + " at " + at;
}

std::string edge_text(const Mesh& mesh, const Edge& edge) {
    return " the edge from " + node_text(mesh, edge.a) + " to " + node_text(mesh, edge.b);
}

// --- checks, each standing on those before it ------------------------------------------------------------------------

void check_sizes(const Mesh& mesh) {
    constexpr auto most = static_cast<size_t>(std::numeric_limits<int32_t>::max());
    const size_t cells = mesh.cell_soil.size();
    if (cells == 0) refuse("the mesh has no cells");
    if (mesh.position.size() > most || mesh.cell_nodes.size() > most) refuse("the mesh is too large");
    if (mesh.position.size() % static_cast<size_t>(mesh.dimension) != 0) {
        refuse("position has " + std::to_string(mesh.position.size()) + " numbers, not two a node");
    }
    if (mesh.cell_start.size() != cells + 1) {
        refuse("cell_start has " + std::to_string(mesh.cell_start.size()) + " entries, not one more than the " +
               std::to_string(cells) + " cells that cell_soil has");
    }
    if (mesh.cell_start.front() != 0 || mesh.cell_start.back() != static_cast<int32_t>(mesh.cell_nodes.size())) {
        refuse("cell_start must begin with 0 and end with the number of cell_nodes, " +
               std::to_string(mesh.cell_nodes.size()));
    }
}

void check_cell_entries(const Mesh& mesh) {
    const int32_t least = mesh.dimension == 1 ? 2 : 3;
    const int32_t most = mesh.dimension == 1 ? 2 : 4;
    const int32_t node_count = mesh.node_count();
    for (size_t cell = 0; cell < mesh.cell_soil.size(); ++cell) {
        const int64_t count = static_cast<int64_t>(mesh.cell_start[cell + 1]) - mesh.cell_start[cell];
        if (count < least || count > most) {
            refuse_cell(
                cell, "has " + std::to_string(count) + " nodes; cells have " + (mesh.dimension == 1 ? "2" : "3 or 4"));
        }
        if (mesh.cell_start[cell + 1] > static_cast<int32_t>(mesh.cell_nodes.size()))
            refuse_cell(cell, "ends beyond cell_nodes");
        const auto first = mesh.cell_nodes.begin() + mesh.cell_start[cell];
        const auto last = mesh.cell_nodes.begin() + mesh.cell_start[cell + 1];
        for (auto node = first; node != last; ++node) {
            if (*node < 0 || *node >= node_count) {
                refuse_cell(cell,
                            "has node " + std::to_string(*node) + "; nodes are 0 to " + std::to_string(node_count - 1));
            }
            if (std::find(first, node, *node) != node)
                refuse_cell(cell, "has node " + std::to_string(*node) + " twice");
        }
        if (mesh.cell_soil[cell] < 0)
            refuse_cell(cell, "has soil " + std::to_string(mesh.cell_soil[cell]) + "; soils are numbered from 0");
    }
}

void check_nodes(const Mesh& mesh) {
    for (size_t i = 0; i < mesh.position.size(); ++i) {
        if (!std::isfinite(mesh.position[i])) {
            refuse("node " + std::to_string(i / static_cast<size_t>(mesh.dimension)) +
                   " has a place that is not a finite number");
        }
    }
    std::vector<char> used(static_cast<size_t>(mesh.node_count()), 0);
    for (const int32_t node : mesh.cell_nodes) used[static_cast<size_t>(node)] = 1;
    const auto unused = std::find(used.begin(), used.end(), 0);
    if (unused != used.end())
        refuse(node_text(mesh, static_cast<int32_t>(unused - used.begin())) + " belongs to no cell");
}

/// Twice the areas of the triangles at the corners of a plane cell over the square of its longest edge: positive at all
/// of them where the cell is convex and counter-clockwise. For a quad that is the Jacobian at the corners, for a
/// triangle everywhere.
double least_corner(const Mesh& mesh, int32_t cell) {
    const auto first = static_cast<size_t>(mesh.cell_start[static_cast<size_t>(cell)]);
    const size_t count = static_cast<size_t>(mesh.cell_start[static_cast<size_t>(cell) + 1]) - first;
    const auto place = [&](size_t corner) {
        return &mesh.position[2 * static_cast<size_t>(mesh.cell_nodes[first + corner % count])];
    };
    double least = std::numeric_limits<double>::infinity();
    double longest = 0;
    for (size_t corner = 0; corner < count; ++corner) {
        const double* a = place(corner + count - 1);
        const double* b = place(corner);
        const double* c = place(corner + 1);
        least = std::min(least, (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]));
        longest = std::max(longest, std::hypot(c[0] - b[0], c[1] - b[1]));
    }
    return least / (longest * longest);
}

void check_shapes(const Mesh& mesh) {
    constexpr double flat = 1e-10;
    for (int32_t cell = 0; cell < mesh.cell_count(); ++cell) {
        if (mesh.dimension == 1) {
            const size_t bottom = 2 * static_cast<size_t>(cell);
            const double y = mesh.position[static_cast<size_t>(mesh.cell_nodes[bottom])];
            if (!(mesh.position[static_cast<size_t>(mesh.cell_nodes[bottom + 1])] > y))
                refuse(cell_text(mesh, cell) + " has no height or goes downwards");
            continue;
        }
        const double least = least_corner(mesh, cell);
        if (least > flat) continue;
        refuse(cell_text(mesh, cell) +
               (least < -flat ? " is inverted, folded or not convex; nodes go counter-clockwise around convex cells"
                              : " is flat: a corner has no area"));
    }
}

/// Looks through the nodes in bins of width `near` in x, shifted by `offset`, each bin ordered by y: two nodes of a bin
/// within `near` in y are neighbours. With the shifts 0 and 1/2 every two nodes within near/2 share a bin once.
void check_bin_duplicates(const Mesh& mesh, double near, double offset) {
    struct Entry {
        double bin;
        double y;
        int32_t node;
    };
    std::vector<Entry> entries;
    const auto dimension = static_cast<size_t>(mesh.dimension);
    for (size_t i = 0; i < mesh.position.size(); i += dimension) {
        const double x = dimension == 1 ? 0 : mesh.position[i];
        entries.push_back(
            {std::floor(x / near + offset), mesh.position[i + dimension - 1], static_cast<int32_t>(i / dimension)});
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& left, const Entry& right) {
        return std::tuple(left.bin, left.y, left.node) < std::tuple(right.bin, right.y, right.node);
    });
    for (size_t i = 1; i < entries.size(); ++i) {
        const Entry& one = entries[i - 1];
        const Entry& other = entries[i];
        if (one.bin != other.bin || other.y - one.y > near) continue;
        refuse(node_text(mesh, other.node) + " is at the same place as node " + std::to_string(one.node) +
               "; the cells that meet there must share one node");
    }
}

void check_duplicates(const Mesh& mesh) {
    const auto dimension = static_cast<size_t>(mesh.dimension);
    double extent = 0;
    for (size_t k = 0; k < dimension; ++k) {
        double least = mesh.position[k];
        double greatest = mesh.position[k];
        for (size_t i = k; i < mesh.position.size(); i += dimension) {
            least = std::min(least, mesh.position[i]);
            greatest = std::max(greatest, mesh.position[i]);
        }
        extent = std::max(extent, greatest - least);
    }
    check_bin_duplicates(mesh, 1e-9 * extent, 0);
    check_bin_duplicates(mesh, 1e-9 * extent, 0.5);
}

class Pieces {
public:
    explicit Pieces(int32_t count) : parent_(static_cast<size_t>(count)) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }
    void join(int32_t a, int32_t b) { parent_[static_cast<size_t>(root(a))] = root(b); }
    int32_t root(int32_t a) {
        while (parent_[static_cast<size_t>(a)] != a) {
            int32_t& parent = parent_[static_cast<size_t>(a)];
            parent = parent_[static_cast<size_t>(parent)];
            a = parent;
        }
        return a;
    }

private:
    std::vector<int32_t> parent_;
};

void check_one_piece(const Mesh& mesh, Pieces& pieces) {
    for (int32_t cell = 1; cell < mesh.cell_count(); ++cell) {
        if (pieces.root(cell) == pieces.root(0)) continue;
        refuse("the mesh is in several pieces: " + cell_text(mesh, cell) + " is not connected by edges to " +
               cell_text(mesh, 0));
    }
}

void check_plane_topology(const Mesh& mesh) {
    const std::vector<Edge> edges = sorted_edges(mesh);
    std::vector<char> boundary_starts(static_cast<size_t>(mesh.node_count()), 0);
    Pieces pieces(mesh.cell_count());
    for (size_t i = 0; i < edges.size();) {
        size_t next = i + 1;
        while (next < edges.size() && edges[next].joins_same_nodes(edges[i])) ++next;
        if (next - i > 2) refuse(std::to_string(next - i) + " cells share" + edge_text(mesh, edges[i]));
        if (next - i == 2 && edges[i].a == edges[i + 1].a) {
            refuse(cell_text(mesh, edges[i].cell) + " and " + cell_text(mesh, edges[i + 1].cell) +
                   " lie on the same side of" + edge_text(mesh, edges[i]));
        }
        if (next - i == 2) pieces.join(edges[i].cell, edges[i + 1].cell);
        if (next - i == 1 && ++boundary_starts[static_cast<size_t>(edges[i].a)] > 1) {
            refuse("two parts of the boundary touch in " + node_text(mesh, edges[i].a));
        }
        i = next;
    }
    check_one_piece(mesh, pieces);
}

/// Every inner node of a column is the top of the cell below and the bottom of the one above.
void check_column_topology(const Mesh& mesh) {
    for (size_t i = 0; i < mesh.cell_nodes.size(); ++i) {
        const auto expected = static_cast<int32_t>((i + 1) / 2);
        if (mesh.cell_nodes[i] != expected)
            refuse(cell_text(mesh, static_cast<int32_t>(i / 2)) + " does not stand on the cell below it");
    }
}

}  // namespace

void check_mesh(const Mesh& mesh, const std::string& path) try {
    check_sizes(mesh);
    check_cell_entries(mesh);
    check_nodes(mesh);
    check_shapes(mesh);
    check_duplicates(mesh);
    mesh.dimension == 1 ? check_column_topology(mesh) : check_plane_topology(mesh);
} catch (const Error& error) {
    throw Error(error.status, path + ": " + error.what());
}

}  // namespace talus
