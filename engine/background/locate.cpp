#include "background/locate.hpp"

#include "background/shape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace talus {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
using Vector = std::array<double, 2>;

double cross(const Vector& a, const Vector& b) { return a[0] * b[1] - a[1] * b[0]; }

Vector natural_coordinates(Line2, const NodePlaces<Line2>& node, const Vector& at) {
    return {2 * (at[1] - node[0][0]) / (node[1][0] - node[0][0]) - 1, 0};
}

Vector natural_coordinates(Tri3, const NodePlaces<Tri3>& node, const Vector& at) {
    const Vector e = {node[1][0] - node[0][0], node[1][1] - node[0][1]};
    const Vector f = {node[2][0] - node[0][0], node[2][1] - node[0][1]};
    const Vector h = {at[0] - node[0][0], at[1] - node[0][1]};
    return {cross(h, f) / cross(e, f), cross(e, h) / cross(e, f)};
}

/// With h = x - centre, the bilinear map is h = xi e + eta f + xi eta g. Taking the cross product with e + eta g leaves
/// a quadratic in eta alone; its root in the cell is the one whose slope, the Jacobian, is positive, and the form of
/// the root taken here divides by twice the Jacobian at (xi, 0), so it holds for parallelograms too.
Vector natural_coordinates(Quad4, const NodePlaces<Quad4>& node, const Vector& at) {
    Vector e{}, f{}, g{}, h{};
    for (size_t k = 0; k < 2; ++k) {
        const double a = node[0][k], b = node[1][k], c = node[2][k], d = node[3][k];
        e[k] = (b + c - a - d) / 4;
        f[k] = (c + d - a - b) / 4;
        g[k] = (a + c - b - d) / 4;
        h[k] = at[k] - (a + b + c + d) / 4;
    }
    const double quadratic = cross(g, f);
    const double linear = cross(e, f) + cross(h, g);
    const double constant = cross(h, e);
    const double root = std::sqrt(std::max(0., linear * linear - 4 * quadratic * constant));
    const double eta = -2 * constant / (linear + root);
    const Vector direction = {e[0] + eta * g[0], e[1] + eta * g[1]};
    const Vector rest = {h[0] - eta * f[0], h[1] - eta * f[1]};
    const double xi =
        (rest[0] * direction[0] + rest[1] * direction[1]) / (direction[0] * direction[0] + direction[1] * direction[1]);
    return {xi, eta};
}

/// How far the place is beyond the farthest of the lines through a convex cell's edges, 0 inside, m.
template <class Shape>
double distance_outside(Shape, const NodePlaces<Shape>& node, const Vector& at) {
    double distance = 0;
    for (size_t i = 0; i < Shape::nodes; ++i) {
        const auto& a = node[i];
        const auto& b = node[(i + 1) % Shape::nodes];
        const Vector edge = {b[0] - a[0], b[1] - a[1]};
        const double outside = cross({at[0] - a[0], at[1] - a[1]}, edge);
        if (outside > 0) distance = std::max(distance, outside / std::hypot(edge[0], edge[1]));
    }
    return distance;
}

double distance_outside(Line2, const NodePlaces<Line2>& node, const Vector& at) {
    return std::max({0., node[0][0] - at[1], at[1] - node[1][0]});
}

/// Calls `use` with the cell's shape and the places of its nodes.
template <class Use>
auto with_cell(const Mesh& mesh, int32_t cell, Use use) {
    const auto c = static_cast<size_t>(cell);
    const int32_t first = mesh.cell_start[c];
    return with_shape(mesh.cell_start[c + 1] - first, [&](auto shape) {
        using Shape = decltype(shape);
        return use(shape, gather_places<Shape>(mesh.position.data(), &mesh.cell_nodes[static_cast<size_t>(first)]));
    });
}

}  // namespace

Locator::Locator(const Mesh& mesh) : mesh_(&mesh) {
    bounds_ = {{infinity, infinity}, {-infinity, -infinity}};
    Vector cell_sizes{};
    for (int32_t cell = 0; cell < mesh.cell_count(); ++cell) {
        const Box box = cell_box(cell);
        for (size_t k = 0; k < 2; ++k) {
            bounds_.low[k] = std::min(bounds_.low[k], box.low[k]);
            bounds_.high[k] = std::max(bounds_.high[k], box.high[k]);
            cell_sizes[k] += box.high[k] - box.low[k];
        }
    }
    const Vector extent = {bounds_.high[0] - bounds_.low[0], bounds_.high[1] - bounds_.low[1]};
    tolerance_ = 1e-9 * std::max(extent[0], extent[1]);
    // Bins of the cells' mean size, but fewer than that where most of the box around the mesh lies outside it.
    Vector count = {1, 1};
    for (size_t k = 0; k < 2; ++k) {
        if (extent[k] > 0) count[k] = std::max(1., extent[k] * mesh.cell_count() / cell_sizes[k]);
    }
    const double fewer = std::min(1., std::sqrt(4. * mesh.cell_count() / (count[0] * count[1])));
    for (size_t k = 0; k < 2; ++k) {
        bins_[k] = std::max(1, static_cast<int32_t>(count[k] * fewer));
        bins_per_metre_[k] = extent[k] > 0 ? bins_[k] / extent[k] : 0;
    }
    fill_bins();
}

Locator::Box Locator::cell_box(int32_t cell) const {
    return with_cell(*mesh_, cell, [](auto shape, const auto& node) {
        Box box = {{infinity, infinity}, {-infinity, -infinity}};
        for (const auto& place : node) {
            const Vector at = shape.dimension == 1 ? Vector{0, place[0]} : Vector{place[0], place.back()};
            for (size_t k = 0; k < 2; ++k) {
                box.low[k] = std::min(box.low[k], at[k]);
                box.high[k] = std::max(box.high[k], at[k]);
            }
        }
        return box;
    });
}

int32_t Locator::bin_index(double at, size_t axis) const {
    const double bin = (at - bounds_.low[axis]) * bins_per_metre_[axis];
    return static_cast<int32_t>(std::clamp(bin, 0., bins_[axis] - 1.));
}

/// Calls `visit` with the number of every bin that the box touches, give or take the tolerance.
template <class Visit>
void Locator::visit_bins(const Box& box, Visit visit) const {
    const int32_t last_x = bin_index(box.high[0] + tolerance_, 0);
    const int32_t last_y = bin_index(box.high[1] + tolerance_, 1);
    for (int32_t y = bin_index(box.low[1] - tolerance_, 1); y <= last_y; ++y) {
        for (int32_t x = bin_index(box.low[0] - tolerance_, 0); x <= last_x; ++x) {
            visit(static_cast<size_t>(y) * static_cast<size_t>(bins_[0]) + static_cast<size_t>(x));
        }
    }
}

/// Counts each bin's cells, and then puts them in, so that a bin's cells are by number.
void Locator::fill_bins() {
    bin_start_.assign(static_cast<size_t>(bins_[0]) * static_cast<size_t>(bins_[1]) + 1, 0);
    for (int32_t cell = 0; cell < mesh_->cell_count(); ++cell) {
        visit_bins(cell_box(cell), [&](size_t bin) { ++bin_start_[bin + 1]; });
    }
    std::partial_sum(bin_start_.begin(), bin_start_.end(), bin_start_.begin());
    bin_cells_.resize(static_cast<size_t>(bin_start_.back()));
    std::vector<int32_t> next(bin_start_.begin(), bin_start_.end() - 1);
    for (int32_t cell = 0; cell < mesh_->cell_count(); ++cell) {
        visit_bins(cell_box(cell), [&](size_t bin) { bin_cells_[static_cast<size_t>(next[bin]++)] = cell; });
    }
}

CellPlace Locator::locate(double x, double y) const {
    const Vector at = {mesh_->dimension == 1 ? 0 : x, y};
    for (size_t k = 0; k < 2; ++k) {
        if (!(at[k] >= bounds_.low[k] - tolerance_ && at[k] <= bounds_.high[k] + tolerance_)) return {};
    }
    const auto bin = static_cast<size_t>(bin_index(at[1], 1)) * static_cast<size_t>(bins_[0]) +
                     static_cast<size_t>(bin_index(at[0], 0));
    int32_t nearest = -1;
    double least = std::nextafter(tolerance_, infinity);
    for (int32_t i = bin_start_[bin]; i < bin_start_[bin + 1] && least > 0; ++i) {
        const int32_t cell = bin_cells_[static_cast<size_t>(i)];
        const double distance =
            with_cell(*mesh_, cell, [&](auto shape, const auto& node) { return distance_outside(shape, node, at); });
        if (distance >= least) continue;
        least = distance;
        nearest = cell;
    }
    if (nearest < 0) return {};
    return {nearest, with_cell(*mesh_, nearest,
                               [&](auto shape, const auto& node) { return natural_coordinates(shape, node, at); })};
}

}  // namespace talus
