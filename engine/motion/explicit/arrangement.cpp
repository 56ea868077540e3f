#include "motion/explicit/arrangement.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace talus {
namespace {

constexpr size_t strip_rows = 8, region_columns = strip_rows;
constexpr int32_t margin =
    2;  // cells that a point may drift from where it was arranged; less than half of a strip's rows less one
constexpr int32_t quiet_substeps = 1000;  // a wave has crossed some 500 cells

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
            regions_.push_back({start[(s * columns + column) * strip_rows], start[(s * columns + next) * strip_rows]});
        }
    }
    std::vector<int32_t> order(points.count);
    for (size_t p = 0; p < points.count; ++p) order[start[key[p]]++] = static_cast<int32_t>(p);
    points.arrange(order);
    if (held_.size() != points.count) held_.clear();  // of other points: hold() is to follow
    if (!held_.empty()) {
        std::vector<uint8_t> held(held_.size());
        for (size_t k = 0; k < held.size(); ++k) held[k] = held_[static_cast<size_t>(order[k])];
        held_ = std::move(held);
    }
    find_runs();
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

bool Arrangement::look_for_rest(FreePoints& points) {
    if (!(rest_speed_ > 0)) return false;
    count_slow(points);
    substeps_ = 0;
    return find_held(points) != held_;
}

void Arrangement::count_slow(FreePoints& points) const {
    const bool is_wet = !points.field[liquid_velocity_x].empty();
    const auto is_slow = [&](PointField along_x, PointField along_y, size_t p) {
        const double x = points[along_x][p], y = points[along_y][p];
        return x * x + y * y < rest_speed_ * rest_speed_;
    };
    for_each_strip([&](Strip strip) {
        for (size_t p = strip.first; p < strip.last; ++p) {
            const bool is_quiet =
                is_slow(velocity_x, velocity_y, p) && (!is_wet || is_slow(liquid_velocity_x, liquid_velocity_y, p));
            points.quiet[p] = is_quiet ? std::min(points.quiet[p] + substeps_, quiet_substeps) : 0;
        }
    });
}

void Arrangement::hold(FreePoints& points) {
    if (!(rest_speed_ > 0)) return;
    points.quiet.resize(points.count);
    substeps_ = 0;
    held_ = find_held(points);
    find_runs();
    const auto stop = [&](PointField first, PointField last) {
        if (points.field[first].empty()) return;
        for (size_t name = first; name <= last; ++name) {
            for (size_t p = 0; p < held_.size(); ++p)
                if (held_[p] != 0) points.field[name][p] = 0;
        }
    };
    stop(velocity_x, affine_yy);
    stop(liquid_velocity_x, liquid_affine_yy);
}

/// Those of a region that is quiet and whose neighbours are.
std::vector<uint8_t> Arrangement::find_held(const FreePoints& points) const {
    const std::vector<bool> quiet = find_quiet_regions(points);
    std::vector<uint8_t> held(points.count, 0);
    bool holds_any = false;
    for (size_t strip = 0; strip < strips_; ++strip) {
        for (size_t place = 0; place < regions_a_strip_; ++place) {
            bool holds = true;
            for (size_t s = std::max(strip, size_t{1}) - 1; s < std::min(strip + 2, strips_); ++s) {
                for (size_t r = std::max(place, size_t{1}) - 1; r < std::min(place + 2, regions_a_strip_); ++r)
                    holds = holds && quiet[s * regions_a_strip_ + r];
            }
            const Strip& region = regions_[strip * regions_a_strip_ + place];
            if (!holds || region.first == region.last) continue;
            holds_any = true;
            std::fill(held.begin() + static_cast<std::ptrdiff_t>(region.first),
                      held.begin() + static_cast<std::ptrdiff_t>(region.last), uint8_t{1});
        }
    }
    return holds_any ? held : std::vector<uint8_t>{};
}

/// Whether all points of each region have been quiet.
std::vector<bool> Arrangement::find_quiet_regions(const FreePoints& points) const {
    std::vector<bool> quiet;
    for (const Strip& region : regions_) {
        const auto first = points.quiet.begin() + static_cast<std::ptrdiff_t>(region.first);
        const auto last = points.quiet.begin() + static_cast<std::ptrdiff_t>(region.last);
        quiet.push_back(std::all_of(first, last, [](int32_t count) { return count >= quiet_substeps; }));
    }
    return quiet;
}

void Arrangement::tell(const FreePoints& points, WalledGrid& nodes) const {
    const Grid& grid = nodes.grid;
    nodes.spans = find_spans(points, grid);
    nodes.still.clear();
    if (held_.empty()) return;
    nodes.still.assign(grid.nodes(), 0);
    const auto columns = static_cast<size_t>(grid.cells[0]);
    for (size_t p = 0; p < held_.size(); ++p) {
        if (held_[p] == 0) continue;
        const auto row = static_cast<size_t>(grid.cell_of(points[position_y][p], 1));
        const auto column = static_cast<size_t>(grid.cell_of(points[position_x][p], 0));
        for (size_t near = row - 1; near <= row + 1; ++near)
            std::fill_n(nodes.still.begin() + static_cast<std::ptrdiff_t>(near * columns + column - 1), 3, uint8_t{1});
    }
}

void Arrangement::find_runs() {
    const auto is_held = [this](size_t p) { return !held_.empty() && held_[p] != 0; };
    runs_.clear();
    run_start_.assign(1, 0);
    for (size_t strip = 0; strip < strips_; ++strip) {
        const size_t last = regions_[(strip + 1) * regions_a_strip_ - 1].last;
        for (size_t p = regions_[strip * regions_a_strip_].first; p < last; ++p) {
            if (is_held(p)) continue;
            const size_t first = p;
            while (p < last && !is_held(p)) ++p;
            runs_.push_back({first, p});
        }
        run_start_.push_back(runs_.size());
    }
}

std::vector<Span> Arrangement::find_spans(const FreePoints& points, const Grid& grid) const {
    std::vector<Span> reached(static_cast<size_t>(grid.cells[1]), {grid.cells[0], 0});
    const auto widen = [&](Strip strip) {
        for (size_t p = strip.first; p < strip.last; ++p) {
            const int32_t column = grid.cell_of(points[position_x][p], 0);
            Span& span = reached[static_cast<size_t>(grid.cell_of(points[position_y][p], 1))];
            span.first = std::min(span.first, column);
            span.last = std::max(span.last, column + 1);
        }
    };
    for (const Strip& run : runs_) widen(run);
    constexpr int32_t reach = margin + 1;
    std::vector<Span> spans(reached.size());
    for (int32_t row = 0; row < grid.cells[1]; ++row) {
        Span span{grid.cells[0], 0};
        for (int32_t near = std::max(0, row - reach); near <= std::min(grid.cells[1] - 1, row + reach); ++near) {
            span.first = std::min(span.first, reached[static_cast<size_t>(near)].first);
            span.last = std::max(span.last, reached[static_cast<size_t>(near)].last);
        }
        if (span.first >= span.last) continue;
        spans[static_cast<size_t>(row)] = {std::max(0, span.first - reach), std::min(grid.cells[0], span.last + reach)};
    }
    return spans;
}

}  // namespace talus
