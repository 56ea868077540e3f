#include "error.hpp"
#include "ground/builders.hpp"
#include "ground/quality.hpp"
#include "ground/sides.hpp"
#include "ground/text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talus {
namespace {

constexpr double most_cells = 20e6;
constexpr int32_t most_rows = 100000;

using Profile = std::vector<Place>;

double elevation(const Profile& profile, double x) {
    const auto right = std::upper_bound(profile.begin() + 1, profile.end() - 1, x,
                                        [](double at, const Place& p) { return at < p[0]; });
    const Place& a = *(right - 1);
    const Place& b = *right;
    if (x <= a[0]) return a[1];
    if (x >= b[0]) return b[1];
    return a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]);
}

// --- grid lines ------------------------------------------------------------------------------------------------------

/// Columns beside a bend of the terrain: `bend` wide there, wider by `slope` times the distance from it, at most `widest`.
struct ColumnWidths {
    double bend, widest, slope;

    /// How many columns there are within a distance of the bend: the integral of 1 / (bend + slope distance).
    [[nodiscard]] double columns(double distance) const {
        const double graded = std::min(distance, graded_distance());
        const double near = slope > 0 ? std::log1p(slope * graded / bend) / slope : graded / bend;
        return near + (distance - graded) / widest;
    }

    /// The distance within which there are so many columns.
    [[nodiscard]] double distance(double count) const {
        const double graded = columns(graded_distance());
        if (count > graded) return graded_distance() + (count - graded) * widest;
        return slope > 0 ? bend * std::expm1(slope * count) / slope : bend * count;
    }

private:
    [[nodiscard]] double graded_distance() const {
        return slope > 0 ? (widest - bend) / slope : std::numeric_limits<double>::infinity();
    }
};

/// A place through which a grid line goes.
struct GridVertex {
    double x;
    bool is_bend;
};

std::vector<GridVertex> grid_vertices(const SectionGround& section, const std::vector<const Profile*>& profiles) {
    const double left = section.terrain.front()[0];
    const double right = section.terrain.back()[0];
    const double near = 1e-9 * (right - left);
    std::vector<GridVertex> vertices = {{left, false}, {right, false}};
    for (const Profile* profile : profiles) {
        for (const Place& place : *profile) {
            if (place[0] > left + near && place[0] < right - near)
                vertices.push_back({place[0], profile == profiles.front()});
        }
    }
    std::stable_sort(vertices.begin(), vertices.end(),
                     [](const GridVertex& a, const GridVertex& b) { return a.x < b.x; });
    std::vector<GridVertex> apart;
    for (const GridVertex& vertex : vertices) {
        if (apart.empty() || vertex.x - apart.back().x > near) {
            apart.push_back(vertex);
        } else {
            apart.back().is_bend |= vertex.is_bend;
        }
    }
    return apart;
}

/// The greatest distance from a bend, m; 0 without bends.
double farthest_from_bends(const std::vector<GridVertex>& vertices) {
    double farthest = 0;
    for (size_t v = 1; v < vertices.size(); ++v) {
        const double length = vertices[v].x - vertices[v - 1].x;
        const int bends = (vertices[v - 1].is_bend ? 1 : 0) + (vertices[v].is_bend ? 1 : 0);
        if (bends > 0) farthest = std::max(farthest, length / bends);
    }
    return farthest;
}

/// x of the vertical grid lines: every vertex of every profile, and columns between them, equal or graded towards bends.
std::vector<double> grid_lines(const SectionGround& section, const std::vector<const Profile*>& profiles) {
    const std::vector<GridVertex> vertices = grid_vertices(section, profiles);
    const double bend = section.bend_column_width > 0 ? section.bend_column_width : section.column_width;
    const double farthest = farthest_from_bends(vertices);
    const double even_slope = farthest > 0 ? (section.column_width - bend) / farthest : 0;
    const double slope = section.growth > 0 ? std::log(section.growth) : even_slope;
    std::vector<double> lines = {vertices.front().x};
    for (size_t v = 1; v < vertices.size(); ++v) {
        const auto [from, bends_from] = vertices[v - 1];
        const auto [to, bends_to] = vertices[v];
        const ColumnWidths widths{bends_from || bends_to ? bend : section.column_width, section.column_width, slope};
        const double length = to - from;
        const bool bends_twice = bends_from && bends_to;
        const double columns = bends_twice ? 2 * widths.columns(length / 2) : widths.columns(length);
        const double count = std::max(1.0, std::ceil(columns - 1e-9));
        if (!(count < most_cells)) {
            const char* const entry = bend < section.column_width ? "bendColumnWidth" : "columnWidth";
            throw Error(Status::invalid_scene, "ground.section." + std::string(entry) + ": " + number_text(bend) +
                                                   " m is too small for a section " +
                                                   number_text(vertices.back().x - vertices.front().x) + " m wide");
        }
        for (double i = 1; i < count; ++i) {
            const double at = columns * i / count;
            const bool from_left = bends_twice ? at <= columns / 2 : !bends_to;
            lines.push_back(from_left ? from + widths.distance(at) : to - widths.distance(columns - at));
        }
        lines.push_back(to);
    }
    return lines;
}

[[noreturn]] void refuse_crossing(size_t k, bool is_base, double x, double y, double above) {
    const std::string entry = is_base ? "ground.section.base" : "ground.section.layers[" + std::to_string(k) + "].top";
    const std::string upper = k == 1 ? "the terrain" : "the top of layers[" + std::to_string(k - 1) + "]";
    throw Error(Status::invalid_scene, entry + ": at x = " + number_text(x) + " m it lies at " + number_text(y) +
                                           " m, above " + upper + " (" + number_text(above) +
                                           " m); layers may touch but not cross");
}

/// Elevations of the layer boundaries on one grid line: terrain, layer tops, base. Where a layer is pinched out, two
/// are equal.
std::vector<double> interfaces_at(const std::vector<const Profile*>& profiles, double x, double height) {
    const double near = 1e-9 * height;
    std::vector<double> interface = {elevation(*profiles.front(), x)};
    for (size_t k = 1; k < profiles.size(); ++k) {
        const double y = elevation(*profiles[k], x);
        const double above = interface.back();
        if (y > above + near) refuse_crossing(k, k + 1 == profiles.size(), x, y, above);
        interface.push_back(y > above - near ? above : y);
    }
    if (!(interface.front() - interface.back() > near)) {
        throw Error(Status::invalid_scene, "ground.section.base: at x = " + number_text(x) +
                                               " m it meets the terrain; the ground needs a thickness everywhere");
    }
    return interface;
}

// --- grading ---------------------------------------------------------------------------------------------------------

/// Height of a cell whose top is at this depth. Below the graded depth cells grow by the ratio `growth`: with z the
/// depth below it, h (growth + growth^2 + ... ) = z makes the next one growth h + (growth - 1) z.
double cell_height(const SectionGround& section, double growth, double depth) {
    const double surface_height = section.surface_cell_height;
    const double below = depth - section.graded_depth;
    if (below < -1e-9 * surface_height) return surface_height;
    return std::min(section.largest_cell_height, growth * surface_height + (growth - 1) * std::max(0., below));
}

/// The growth with which heights are linear in the depth, and the largest at the greatest depth: a height is then the same function of the
/// depth on every mesh, but for a factor.
double even_growth(const SectionGround& section, double greatest_depth) {
    const double gain = section.largest_cell_height - section.surface_cell_height;
    const double growing = greatest_depth - section.graded_depth;
    return 1 + gain / std::max(growing, section.largest_cell_height);
}

double depth_after(const SectionGround& section, double growth, double depth, int32_t rows) {
    for (int32_t i = 0; i < rows; ++i) depth += cell_height(section, growth, depth);
    return depth;
}

/// Rows that a layer needs between two depths for no cell to be higher than the grading says.
int32_t rows_needed(const SectionGround& section, double top, double bottom, double x) {
    const double near = 1e-6 * section.surface_cell_height;
    int32_t rows = 0;
    for (double depth = top; depth < bottom - near; ++rows) {
        depth += cell_height(section, section.growth, depth);
        if (rows < most_rows) continue;
        throw Error(Status::invalid_scene, "ground.section.surfaceCellHeight: the column at x = " + number_text(x) +
                                               " m would have more than " + std::to_string(most_rows) +
                                               " cells with cells of " + number_text(section.surface_cell_height) +
                                               " m at the surface");
    }
    return rows;
}

/// The growth with which `rows` cells fill a layer, between 1 and the section's; the depth they reach increases with
/// it.
double fitting_growth(const SectionGround& section, double top, double bottom, int32_t rows) {
    double low = 1;
    double high = section.growth;
    for (int32_t i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (depth_after(section, middle, top, rows) < bottom ? low : high) = middle;
    }
    return high;
}

/// Depths of the row boundaries of one layer on one grid line, its top not included.
void add_row_depths(const SectionGround& section, double top, double bottom, int32_t rows,
                    std::vector<double>& depths) {
    const double growth = fitting_growth(section, top, bottom, rows);
    const double stretch =
        (bottom - top) / (depth_after(section, growth, top, rows) - top);  // below 1 where even cells are too many
    double depth = top;
    for (int32_t i = 1; i < rows; ++i) {
        depth += cell_height(section, growth, depth);
        depths.push_back(top + stretch * (depth - top));
    }
    depths.push_back(bottom);
}

// --- mesh ------------------------------------------------------------------------------------------------------------

/// Rows of each layer: as many as the place that needs most.
std::vector<int32_t> layer_rows(const SectionGround& section, const std::vector<double>& lines,
                                const std::vector<std::vector<double>>& interfaces) {
    std::vector<int32_t> rows(section.layers.size(), 1);
    double total = 0;
    for (size_t k = 0; k < rows.size(); ++k) {
        for (size_t i = 0; i < lines.size(); ++i) {
            const double surface = interfaces[i].front();
            rows[k] = std::max(
                rows[k], rows_needed(section, surface - interfaces[i][k], surface - interfaces[i][k + 1], lines[i]));
        }
        total += rows[k];
    }
    if (total * static_cast<double>(lines.size()) > most_cells) {
        throw Error(Status::invalid_scene, "ground.section: would have " +
                                               number_text(total * static_cast<double>(lines.size())) +
                                               " cells, more than " + number_text(most_cells) +
                                               "; give the column widths or the cell heights larger values");
    }
    return rows;
}

/// Adds the nodes of one grid line from the base up; returns the node of each row boundary from the surface down.
/// Boundaries that coincide, where a layer is pinched out, share a node.
std::vector<int32_t> add_line(const SectionGround& section, double x, const std::vector<double>& interface,
                              const std::vector<int32_t>& rows, Mesh& mesh) {
    const double surface = interface.front();
    std::vector<double> depths = {0};
    for (size_t k = 0; k < rows.size(); ++k) {
        const double top = surface - interface[k];
        const double bottom = surface - interface[k + 1];
        if (bottom > top) {
            add_row_depths(section, top, bottom, rows[k], depths);
        } else {
            depths.insert(depths.end(), static_cast<size_t>(rows[k]), top);
        }
    }
    std::vector<int32_t> nodes(depths.size());
    for (size_t row = depths.size(); row-- > 0;) {
        const bool same_as_below = row + 1 < depths.size() && depths[row + 1] <= depths[row];
        if (!same_as_below) {
            mesh.position.push_back(x);
            mesh.position.push_back(surface - depths[row]);
        }
        nodes[row] = mesh.node_count() - 1;
    }
    return nodes;
}

/// A quad between two grid lines, a triangle where one side has no height, nothing where both have none.
void add_cell(int32_t bottom_left, int32_t bottom_right, int32_t top_right, int32_t top_left, int32_t soil,
              Mesh& mesh) {
    if (bottom_left == top_left && bottom_right == top_right) return;
    std::vector<int32_t>& nodes = mesh.cell_nodes;
    nodes.insert(nodes.end(), {bottom_left, bottom_right});
    if (top_right != bottom_right) nodes.push_back(top_right);
    if (top_left != bottom_left) nodes.push_back(top_left);
    mesh.cell_start.push_back(static_cast<int32_t>(nodes.size()));
    mesh.cell_soil.push_back(soil);
}

}  // namespace

Mesh build_section(const Scene& scene) {
    SectionGround section = scene.ground.section;
    std::vector<const Profile*> profiles = {&section.terrain};
    for (size_t k = 1; k < section.layers.size(); ++k) profiles.push_back(&section.layers[k].top);
    profiles.push_back(&section.base);
    std::vector<int32_t> soils;
    for (size_t k = 0; k < section.layers.size(); ++k) {
        soils.push_back(
            find_soil(scene, section.layers[k].soil, "ground.section.layers[" + std::to_string(k) + "].soil"));
    }

    const std::vector<double> lines = grid_lines(section, profiles);
    double height = 0;
    for (const Place& place : section.terrain) height = std::max(height, place[1] - elevation(section.base, place[0]));
    if (!(section.growth > 0)) section.growth = even_growth(section, height);
    std::vector<std::vector<double>> interfaces;
    interfaces.reserve(lines.size());
    for (const double x : lines) interfaces.push_back(interfaces_at(profiles, x, height));
    const std::vector<int32_t> rows = layer_rows(section, lines, interfaces);

    Mesh mesh;
    mesh.cell_start = {0};
    std::vector<int32_t> left;
    for (size_t i = 0; i < lines.size(); ++i) {
        const std::vector<int32_t> right = add_line(section, lines[i], interfaces[i], rows, mesh);
        size_t row = right.size() - 1;
        for (size_t k = rows.size(); i > 0 && k-- > 0;) {
            for (int32_t r = 0; r < rows[k]; ++r, --row)
                add_cell(left[row], right[row], right[row - 1], left[row - 1], soils[k], mesh);
        }
        left = right;
    }
    check_mesh(mesh, "ground.section");
    set_sides(mesh);
    return mesh;
}

}  // namespace talus
