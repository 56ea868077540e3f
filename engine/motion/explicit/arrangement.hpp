// How points are arranged for the loops, and which nodes they reach.
//
// Points lie in the order of strips of rows of cells. Strips that are not neighbours share no node: even ones are handled at once, then
// odd ones, and every node receives its shares in the same order for any number of threads.
//
// A region is as wide as a strip is high. Where all points of a region and of its neighbours have been slower than the rest speed for a while, its
// points are held: they lie still, with their stress and their water, and are not handled.
#pragma once

#include "background/grid.hpp"
#include "motion/explicit/threads.hpp"
#include "motion/explicit/walled_grid.hpp"
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
    /// With a rest speed (m/s) above 0, points of dry ground, and of moist ground whose gas is at rest, may be held.
    explicit Arrangement(Threads threads, double rest_speed = 0)
        : threads_(std::move(threads)), rest_speed_(rest_speed) {}
    [[nodiscard]] const Threads& threads() const { return threads_; }

    /// Arranges points, and gives the grid room about them, by whole cells; it only grows. True: it grew, and what nodes hold must move.
    bool arrange(FreePoints& points, Grid& grid);

    /// Whether arranging anew would do for points that move by `cells` in one step; not where that is no number.
    [[nodiscard]] static bool bears(double cells);

    /// Whether points that may move by `cells` more would leave the room they were arranged with.
    [[nodiscard]] bool is_outgrown(double cells) const;
    /// All points have moved, by so many cells at most, in one substep.
    void count_substep(double cells) {
        drift_ += cells;
        ++substeps_;
    }

    /// Counts for how many substeps points have been slow, whose velocities must be their own. True: others are to be held than are, and what nodes
    /// have of the points is to be made anew.
    bool look_for_rest(FreePoints& points);

    /// Finds which points are held, from their counts alone; they have no velocity from then on.
    void hold(FreePoints& points);

    /// Tells the nodes which of them points reach that are not held, and which held ones do.
    void tell(const FreePoints& points, WalledGrid& nodes) const;

    /// handle(points), for all of a strip that are not held, in as many threads as there are.
    template <class Handle>
    void for_each_strip(const Handle& handle) const;

private:
    bool fit(const FreePoints& points, Grid& grid) const;
    void count_slow(FreePoints& points) const;
    [[nodiscard]] std::vector<bool> find_quiet_regions(const FreePoints& points) const;
    [[nodiscard]] std::vector<uint8_t> find_held(const FreePoints& points) const;
    void find_runs();
    [[nodiscard]] std::vector<Span> find_spans(const FreePoints& points, const Grid& grid) const;

    Threads threads_;
    double rest_speed_;  // m/s
    size_t strips_ = 0, regions_a_strip_ = 0;
    std::vector<Strip> regions_;
    std::vector<uint8_t> held_;      // one a point; empty: none is
    std::vector<Strip> runs_;        // of points that are not held, strip by strip
    std::vector<size_t> run_start_;  // strips + 1
    double drift_ = 0;               // cells that a point may have moved since it was arranged
    int32_t substeps_ = 0;           // since rest was looked for
};

template <class Handle>
void Arrangement::for_each_strip(const Handle& handle) const {
    for (const size_t parity : {size_t{0}, size_t{1}}) {
        const size_t strips = (strips_ + 1 - parity) / 2;
        threads_.for_each(strips, [&](size_t s) {
            const size_t strip = 2 * s + parity;
            for (size_t run = run_start_[strip]; run < run_start_[strip + 1]; ++run) handle(runs_[run]);
        });
    }
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
