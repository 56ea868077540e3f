// Explicit motion of material points through the Cartesian background: stress first (USF), affine transfers.
//
// A step: velocities of the nodes from the points' momenta; strain and stress of the points; the nodes' equation of motion; the
// points' new velocity and place, from where they give their momenta to the nodes again. Points are handled by two passes, so that
// each is loaded twice a step.
#pragma once

#include "motion/explicit/arrangement.hpp"
#include "motion/explicit/grid_motion.hpp"
#include "motion/explicit/stress.hpp"
#include "points/free_points.hpp"

#include <cstdint>
#include <vector>

namespace talus {

/// Of the points, J per metre of thickness.
struct Energies {
    double kinetic = 0;    ///< of the points' own velocity
    double elastic = 0;    ///< of their stress
    double potential = 0;  ///< of their weight above y = 0
};

/// Of the solid.
Energies energies_of(const FreePoints& points, const std::vector<ExplicitSoil>& soils, double gravity);

class ExplicitMotion {
public:
    /// The points' fields must be sized. Walls must lie a whole number of cells apart. Points that have been slower than the rest speed
    /// (m/s) for 1000 substeps, with all others up to 8 cells away, are held: they have no velocity and keep their stress. 0: none.
    ExplicitMotion(double cell_size, const Walls& walls, double gravity, std::vector<ExplicitSoil> soils,
                   FreePoints points, int32_t threads, double rest_speed = 0);

    /// Carries the points dt (s) on; dt is at most critical_step(). Where this is not the last of several steps, the points' velocity
    /// is left to the nodes. False: a velocity is no number, or carries a point across several cells, and the points were not moved.
    bool step(double dt, bool is_last);

    /// Makes all that the nodes hold from the points alone, whose velocity must be their own. What follows depends on nothing else, to
    /// the last bit: points put back move as those that they are a copy of.
    void restart();

    /// Goes on with these points alone, whose velocity must be their own.
    void keep(const std::vector<int32_t>& staying);

    /// The time in which a wave crosses a cell that moves with the fastest node, times what the method bears of it, s.
    [[nodiscard]] double critical_step() const;

    [[nodiscard]] Energies energies() const { return energies_of(points_, soils_, nodes_.gravity); }

    /// What a point's stress may come to, at its slip.
    [[nodiscard]] MohrCoulomb strength(size_t point) const;

    [[nodiscard]] const FreePoints& points() const { return points_; }
    [[nodiscard]] FreePoints& points() { return points_; }
    [[nodiscard]] const Grid& grid() const { return nodes_.grid; }
    [[nodiscard]] const Walls& walls() const { return nodes_.walls; }

private:
    void arrange_points();
    void hold_points();
    void find_wave_speed();
    void stress_and_forces(Strip strip, double dt);
    template <bool keeps>
    void move_and_give(Strip strip, double dt);
    void give(Strip strip);

    std::vector<ExplicitSoil> soils_;
    FreePoints points_;
    GridMotion nodes_;
    Arrangement arrangement_;
    bool yields_ = false;       // any soil
    bool is_inertial_ = false;  // likewise: whether its friction grows with the rate of shear
    double wave_speed_ = 0;     // m/s, the fastest when the points were arranged
};

}  // namespace talus
