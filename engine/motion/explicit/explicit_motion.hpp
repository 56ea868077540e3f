// Explicit motion of material points through the Cartesian background: stress first (USF), affine transfers.
//
// A step: velocities of the nodes from the points' momenta; strain and stress of the points; the nodes' equation of motion; the
// points' new velocity and place, from where they give their momenta to the nodes again. Points are handled by two passes, so that
// each is loaded twice a step.
//
// Points lie in the order of strips of rows of cells. Strips that are not neighbours share no node: even ones are handled at once, then
// odd ones, and every node receives its shares in the same order for any number of threads.
#pragma once

#include "motion/explicit/grid_motion.hpp"
#include "motion/explicit/stress.hpp"
#include "points/free_points.hpp"

#include <tbb/task_arena.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace talus {

/// Of the points, J per metre of thickness.
struct Energies {
    double kinetic = 0;    ///< of the points' own velocity
    double elastic = 0;    ///< of their stress
    double potential = 0;  ///< of their weight above y = 0
};

class ExplicitMotion {
public:
    /// The points' fields must be sized. Walls must lie a whole number of cells apart.
    ExplicitMotion(double cell_size, const Walls& walls, double gravity, std::vector<ExplicitSoil> soils,
                   FreePoints points, int32_t threads);

    /// Carries the points dt (s) on; dt is at most critical_step(). Where this is not the last of several steps, the points' velocity
    /// is left to the nodes. False: a velocity is no number, or carries a point across several cells, and the points were not moved.
    bool step(double dt, bool is_last);

    /// Makes all that the nodes hold from the points alone, whose velocity must be their own. What follows depends on nothing else, to
    /// the last bit: points put back move as those that they are a copy of.
    void restart();

    /// The time in which a wave crosses a cell that moves with the fastest node, times what the method bears of it, s.
    [[nodiscard]] double critical_step() const;

    [[nodiscard]] Energies energies() const;

    [[nodiscard]] const FreePoints& points() const { return points_; }
    [[nodiscard]] FreePoints& points() { return points_; }
    [[nodiscard]] const Grid& grid() const { return nodes_.grid; }

private:
    struct Strip {
        size_t first, last;  // points
    };

    void arrange_points();
    void fit_grid();
    void find_spans();
    void find_wave_speed();
    template <class Handle>
    void for_each_strip(const Handle& handle);
    void stress_and_forces(Strip strip, double dt);
    template <bool keeps>
    void move_and_give(Strip strip, double dt);
    void give(Strip strip);

    std::vector<ExplicitSoil> soils_;
    FreePoints points_;
    GridMotion nodes_;
    std::vector<Strip> strips_;
    std::unique_ptr<tbb::task_arena> threads_;  // empty: this one alone
    bool yields_ = false;                       // any soil
    double wave_speed_ = 0;                     // m/s, the fastest when the points were arranged
    double drift_ = 0;                          // cells that a point may have moved since it was arranged
};

}  // namespace talus
