#include "points/seeding.hpp"

#include "error.hpp"
#include "scene/problems.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace talus {
namespace {

constexpr double most_points = 5e6;
constexpr double least_share = 0.1;  // of a quarter of a grid cell

/// In units of a quarter's width from the grid's corner, so that quarters meet on whole numbers, exactly.
using Vertex = std::array<double, 2>;

/// A convex polygon: a cell has four corners at most, and each of four cuts adds one.
struct Polygon {
    std::array<Vertex, 8> vertex{};
    size_t count = 0;

    void add(const Vertex& v) { vertex[count++] = v; }
};

struct Range {
    double low, high;
};

Range extent(const Polygon& polygon, size_t axis) {
    Range range{polygon.vertex[0][axis], polygon.vertex[0][axis]};
    for (size_t k = 1; k < polygon.count; ++k) {
        range.low = std::min(range.low, polygon.vertex[k][axis]);
        range.high = std::max(range.high, polygon.vertex[k][axis]);
    }
    return range;
}

/// The part on one side of a line along an axis: where sign * (coordinate - place) >= 0 (Sutherland & Hodgman 1974).
Polygon cut(const Polygon& polygon, size_t axis, double place, double sign) {
    Polygon kept;
    for (size_t k = 0; k < polygon.count; ++k) {
        const Vertex &a = polygon.vertex[k], &b = polygon.vertex[k + 1 < polygon.count ? k + 1 : 0];
        const double from = sign * (a[axis] - place), to = sign * (b[axis] - place);
        if (from >= 0) kept.add(a);
        if ((from > 0 && to < 0) || (from < 0 && to > 0)) {
            const double share = from / (from - to);
            Vertex crossing{a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])};
            crossing[axis] = place;
            kept.add(crossing);
        }
    }
    return kept;
}

Polygon between(const Polygon& polygon, size_t axis, int32_t first) {
    return cut(cut(polygon, axis, first, 1), axis, first + 1.0, -1);
}

/// The ground of one soil in a quarter of a grid cell.
struct Piece {
    int32_t row, column, soil;
    int32_t cell;                       ///< of the mesh, of its largest part
    double area = 0;                    ///< in quarters
    double moment_x = 0, moment_y = 0;  ///< area times the centroid's place from the quarter's corner
    double largest = 0;                 ///< area of its largest part

    [[nodiscard]] auto key() const { return std::tie(row, column, soil); }
    void add(const Piece& other) {
        const double shift_x = other.column - column, shift_y = other.row - row;
        area += other.area;
        moment_x += other.moment_x + shift_x * other.area;
        moment_y += other.moment_y + shift_y * other.area;
        if (other.largest > largest) {
            largest = other.largest;
            cell = other.cell;
        }
    }
};

bool is_before(const Piece& a, const Piece& b) { return a.key() < b.key(); }

Piece piece_of(const Polygon& polygon, int32_t row, int32_t column, int32_t soil, int32_t cell) {
    Piece piece{row, column, soil, cell};
    for (size_t k = 0; k < polygon.count; ++k) {
        const Vertex &a = polygon.vertex[k], &b = polygon.vertex[k + 1 < polygon.count ? k + 1 : 0];
        const double ax = a[0] - column, ay = a[1] - row, bx = b[0] - column, by = b[1] - row;
        const double twice = ax * by - bx * ay;
        piece.area += twice / 2;
        piece.moment_x += twice * (ax + bx) / 6;
        piece.moment_y += twice * (ay + by) / 6;
    }
    piece.largest = piece.area;
    return piece;
}

void cut_cell(const Polygon& polygon, int32_t soil, int32_t cell, std::vector<Piece>& pieces) {
    const Range columns = extent(polygon, 0);
    for (auto column = static_cast<int32_t>(std::floor(columns.low)); column < columns.high; ++column) {
        const Polygon strip = between(polygon, 0, column);
        if (strip.count < 3) continue;
        const Range rows = extent(strip, 1);
        for (auto row = static_cast<int32_t>(std::floor(rows.low)); row < rows.high; ++row) {
            const Piece piece = piece_of(between(strip, 1, row), row, column, soil, cell);
            if (piece.area > 0) pieces.push_back(piece);
        }
    }
}

std::vector<Piece> cut_mesh(const Mesh& mesh, double width, std::array<double, 2> corner) {
    std::vector<Piece> pieces;
    for (size_t c = 0; c < mesh.cell_soil.size(); ++c) {
        Polygon polygon;
        for (auto k = static_cast<size_t>(mesh.cell_start[c]); k < static_cast<size_t>(mesh.cell_start[c + 1]); ++k) {
            const auto node = 2 * static_cast<size_t>(mesh.cell_nodes[k]);
            polygon.add({(mesh.position[node] - corner[0]) / width, (mesh.position[node + 1] - corner[1]) / width});
        }
        cut_cell(polygon, mesh.cell_soil[c], static_cast<int32_t>(c), pieces);
    }
    return pieces;
}

/// One piece a quarter and soil.
void join_parts(std::vector<Piece>& pieces) {
    std::stable_sort(pieces.begin(), pieces.end(), is_before);
    size_t kept = 0;
    for (size_t k = 1; k < pieces.size(); ++k) {
        if (pieces[k].key() == pieces[kept].key()) {
            pieces[kept].add(pieces[k]);
        } else {
            pieces[++kept] = pieces[k];
        }
    }
    if (!pieces.empty()) pieces.resize(kept + 1);
}

/// The largest piece of the same soil beside one; none: nullptr.
Piece* neighbour(std::vector<Piece>& pieces, const Piece& piece) {
    Piece* best = nullptr;
    for (const auto& [across, up] : {std::array{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        const Piece beside{piece.row + up, piece.column + across, piece.soil, -1};
        const auto found = std::lower_bound(pieces.begin(), pieces.end(), beside, is_before);
        if (found == pieces.end() || found->key() != beside.key()) continue;
        if (found->area > (best != nullptr ? best->area : 0)) best = &*found;
    }
    return best;
}

void join_slivers(std::vector<Piece>& pieces) {
    for (Piece& piece : pieces) {
        if (piece.area >= least_share) continue;
        Piece* const best = neighbour(pieces, piece);
        if (best == nullptr) continue;
        best->add(piece);
        piece.area = 0;
    }
    std::erase_if(pieces, [](const Piece& piece) { return piece.area <= 0; });
}

void check_count(const Mesh& mesh, double cell_size, double width) {
    const auto range = [&](size_t axis) {
        double low = mesh.position[axis], high = low;
        for (size_t i = axis; i < mesh.position.size(); i += 2) {
            low = std::min(low, mesh.position[i]);
            high = std::max(high, mesh.position[i]);
        }
        return high - low;
    };
    const double count = range(0) * range(1) / (width * width);
    if (count <= most_points) return;
    throw Error(Status::invalid_scene, "dynamics.cellSize = " + value_text(cell_size) + " m: makes some " +
                                           value_text(std::round(count)) + " points; at most " +
                                           value_text(most_points) + " are allowed");
}

}  // namespace

SeededPoints seed_points(const Mesh& mesh, double cell_size, std::array<double, 2> corner,
                         std::span<const double> density) {
    const double width = cell_size / 2;
    check_count(mesh, cell_size, width);
    std::vector<Piece> pieces = cut_mesh(mesh, width, corner);
    join_parts(pieces);
    join_slivers(pieces);

    SeededPoints seeded;
    FreePoints& points = seeded.points;
    points.assign(pieces.size(), dry_fields);
    for (size_t p = 0; p < points.count; ++p) {
        const Piece& piece = pieces[p];
        points[position_x][p] = corner[0] + width * (piece.column + piece.moment_x / piece.area);
        points[position_y][p] = corner[1] + width * (piece.row + piece.moment_y / piece.area);
        points[point_volume][p] = width * width * piece.area;
        points[solid_mass][p] = density[static_cast<size_t>(piece.soil)] * points[point_volume][p];
        points.soil[p] = piece.soil;
        seeded.cell.push_back(piece.cell);
    }
    return seeded;
}

}  // namespace talus
