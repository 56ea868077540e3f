// How points are arranged for the loops, and which nodes they reach.
//
// Points lie in the order of strips of rows of cells. Strips that are not neighbours share no node: even ones are handled at once, then
// odd ones, and every node receives its shares in the same order for any number of threads.
//
// A region is as wide as a strip is high. Where all points of a region and of its neighbours have been quiet, its points are held: they are
// not handled.
#pragma once

#include "background/grid.hpp"
#include "motion/explicit/grid_motion.hpp"
#include "motion/explicit/threads.hpp"
#include "points/free_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace talus {

/// Points first to last - 1.
struct Strip {
    size_t first, last;
};

class Arrangement {
public:
    explicit Arrangement(Threads threads) : threads_(std::move(threads)) {}
    [[nodiscard]] const Threads& threads() const { return threads_; }

    /// Arranges points, and gives the grid room about them, by whole cells; it only grows. True: it grew, and what nodes hold must move.
    bool arrange(FreePoints& points, Grid& grid);

    /// Whether arranging anew would do for points that move by `cells` in one step; not where that is no number.
    [[nodiscard]] static bool bears(double cells);

    /// Whether points that may move by `cells` more would leave the room they were arranged with.
    [[nodiscard]] bool is_outgrown(double cells) const;
    void drift(double cells) { drift_ += cells; }

    /// Finds which points are held, those whose surroundings have been quiet for so many substeps, and the spans of the others. True: not
    /// the same as before.
    bool hold(const FreePoints& points, const Grid& grid, int32_t substeps);

    /// Of nodes that points reach which are not held.
    [[nodiscard]] const std::vector<Span>& spans() const { return spans_; }

    /// handle(points), for all of a strip that are not held, in as many threads as there are.
    template <class Handle>
    void for_each_strip(const Handle& handle) const;

    /// handle(points) for all that are held.
    template <class Handle>
    void for_each_held(const Handle& handle) const;

private:
    struct Region {
        Strip points;
        bool is_held;
    };
    bool fit(const FreePoints& points, Grid& grid) const;
    [[nodiscard]] std::vector<bool> find_quiet(const FreePoints& points, int32_t substeps) const;
    void find_spans(const FreePoints& points, const Grid& grid);

    Threads threads_;
    size_t strips_ = 0, regions_a_strip_ = 0;
    std::vector<Region> regions_;
    std::vector<Span> spans_;
    double drift_ = 0;  // cells that a point may have moved since it was arranged
};

template <class Handle>
void Arrangement::for_each_strip(const Handle& handle) const {
    const auto handle_runs = [&](size_t strip) {
        const size_t last = (strip + 1) * regions_a_strip_;
        for (size_t r = strip * regions_a_strip_; r < last; ++r) {
            if (regions_[r].is_held) continue;
            const size_t first = regions_[r].points.first;
            while (r + 1 < last && !regions_[r + 1].is_held) ++r;
            handle(Strip{first, regions_[r].points.last});
        }
    };
    for (const size_t parity : {size_t{0}, size_t{1}}) {
        const size_t strips = (strips_ + 1 - parity) / 2;
        threads_.for_each(strips, [&](size_t s) { handle_runs(2 * s + parity); });
    }
}

template <class Handle>
void Arrangement::for_each_held(const Handle& handle) const {
    for (const Region& region : regions_)
        if (region.is_held) handle(region.points);
}

/// What nodes of `old` hold, where they are in `grid`, which grew from it.
template <class Value>
void move_nodes(std::vector<Value>& values, const Grid& old, const Grid& grid) {
    const auto shift = [&](size_t axis) {
        return static_cast<size_t>(std::lround((old.corner[axis] - grid.corner[axis]) / grid.cell_size));
    };
    const auto columns = static_cast<size_t>(grid.cells[0]), old_columns = static_cast<size_t>(old.cells[0]);
    std::vector<Value> moved(grid.nodes());
    for (size_t row = 0; row < static_cast<size_t>(old.cells[1]); ++row) {
        const auto from = values.begin() + static_cast<std::ptrdiff_t>(row * old_columns);
        std::copy(from, from + static_cast<std::ptrdiff_t>(old_columns),
                  moved.begin() + static_cast<std::ptrdiff_t>((row + shift(1)) * columns + shift(0)));
    }
    values = std::move(moved);
}

}  // namespace talus
