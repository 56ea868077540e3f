#include "motion/explicit/arrangement.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace talus {
namespace {

constexpr size_t strip_rows = 8, region_columns = strip_rows;
constexpr int32_t margin =
    2;  // cells that a point may drift from where it was arranged; less than half of a strip's rows less one

}  // namespace

bool Arrangement::bears(double cells) { return cells <= margin; }

bool Arrangement::is_outgrown(double cells) const { return drift_ + cells > margin; }

/// Points by strips of rows, in a strip by columns, in a column by cells; points of one cell keep their order.
bool Arrangement::arrange(FreePoints& points, Grid& grid) {
    const bool grew = fit(points, grid);
    const auto columns = static_cast<size_t>(grid.cells[0]);
    const size_t strips = (static_cast<size_t>(grid.cells[1]) + strip_rows - 1) / strip_rows;
    std::vector<size_t> key(points.count), start(strips * columns * strip_rows + 1, 0);
    for (size_t p = 0; p < points.count; ++p) {
        const auto row = static_cast<size_t>(grid.cell_of(points[position_y][p], 1));
        const auto column = static_cast<size_t>(grid.cell_of(points[position_x][p], 0));
        key[p] = (row / strip_rows * columns + column) * strip_rows + row % strip_rows;
        ++start[key[p] + 1];
    }
    std::partial_sum(start.begin(), start.end(), start.begin());
    strips_ = strips;
    regions_a_strip_ = (columns + region_columns - 1) / region_columns;
    regions_.clear();
    for (size_t s = 0; s < strips; ++s) {
        for (size_t column = 0; column < columns; column += region_columns) {
            const size_t next = std::min(column + region_columns, columns);
            regions_.push_back(
                {{start[(s * columns + column) * strip_rows], start[(s * columns + next) * strip_rows]}, false});
        }
    }
    std::vector<int32_t> order(points.count);
    for (size_t p = 0; p < points.count; ++p) order[start[key[p]]++] = static_cast<int32_t>(p);
    points.arrange(order);
    find_spans(points, grid);
    drift_ = 0;
    return grew;
}

bool Arrangement::fit(const FreePoints& points, Grid& grid) const {
    constexpr int32_t room = 8 * (margin + 2);
    std::array<int32_t, 2> before{}, after{};
    bool fits = grid.cells[0] > 0;
    for (size_t axis = 0; axis < 2; ++axis) {
        const double* place = points[axis == 0 ? position_x : position_y];
        const auto [low, high] = std::minmax_element(place, place + points.count);
        const auto lowest = static_cast<int32_t>(std::floor((*low - grid.corner[axis]) / grid.cell_size));
        const auto highest = static_cast<int32_t>(std::floor((*high - grid.corner[axis]) / grid.cell_size));
        fits = fits && lowest >= margin + 2 && highest < grid.cells[axis] - margin - 2;
        before[axis] = std::max(0, room - lowest);
        after[axis] = std::max(grid.cells[axis], highest + 1 + room);
    }
    if (fits) return false;
    for (size_t axis = 0; axis < 2; ++axis) {
        grid.corner[axis] -= before[axis] * grid.cell_size;
        grid.cells[axis] = after[axis] + before[axis];
    }
    return true;
}

bool Arrangement::hold(const FreePoints& points, const Grid& grid, int32_t substeps) {
    const std::vector<bool> quiet = find_quiet(points, substeps);
    const auto is_quiet = [&](size_t strip, size_t place) { return quiet[strip * regions_a_strip_ + place]; };
    bool changed = false;
    for (size_t strip = 0; strip < strips_; ++strip) {
        for (size_t place = 0; place < regions_a_strip_; ++place) {
            bool holds = true;
            for (size_t s = std::max(strip, size_t{1}) - 1; s < std::min(strip + 2, strips_); ++s) {
                for (size_t r = std::max(place, size_t{1}) - 1; r < std::min(place + 2, regions_a_strip_); ++r)
                    holds = holds && is_quiet(s, r);
            }
            Region& region = regions_[strip * regions_a_strip_ + place];
            holds = holds && region.points.first < region.points.last;
            changed = changed || holds != region.is_held;
            region.is_held = holds;
        }
    }
    if (changed) find_spans(points, grid);
    return changed;
}

/// Whether all points of each region have been quiet.
std::vector<bool> Arrangement::find_quiet(const FreePoints& points, int32_t substeps) const {
    std::vector<bool> quiet;
    for (const Region& region : regions_) {
        const auto first = points.quiet.begin() + static_cast<std::ptrdiff_t>(region.points.first);
        const auto last = points.quiet.begin() + static_cast<std::ptrdiff_t>(region.points.last);
        quiet.push_back(std::all_of(first, last, [substeps](int32_t count) { return count >= substeps; }));
    }
    return quiet;
}

void Arrangement::find_spans(const FreePoints& points, const Grid& grid) {
    std::vector<Span> held(static_cast<size_t>(grid.cells[1]), {grid.cells[0], 0});
    const auto widen = [&](Strip strip) {
        for (size_t p = strip.first; p < strip.last; ++p) {
            const int32_t column = grid.cell_of(points[position_x][p], 0);
            Span& span = held[static_cast<size_t>(grid.cell_of(points[position_y][p], 1))];
            span.first = std::min(span.first, column);
            span.last = std::max(span.last, column + 1);
        }
    };
    for (const Region& region : regions_)
        if (!region.is_held) widen(region.points);
    constexpr int32_t reach = margin + 1;
    spans_.assign(held.size(), {});
    for (int32_t row = 0; row < grid.cells[1]; ++row) {
        Span span{grid.cells[0], 0};
        for (int32_t near = std::max(0, row - reach); near <= std::min(grid.cells[1] - 1, row + reach); ++near) {
            span.first = std::min(span.first, held[static_cast<size_t>(near)].first);
            span.last = std::max(span.last, held[static_cast<size_t>(near)].last);
        }
        if (span.first >= span.last) continue;
        spans_[static_cast<size_t>(row)] = {std::max(0, span.first - reach),
                                            std::min(grid.cells[0], span.last + reach)};
    }
}

}  // namespace talus
