#include "motion/explicit/explicit_motion.hpp"

#include "motion/explicit/transfer.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

ExplicitMotion::ExplicitMotion(double cell_size, const Walls& walls, double gravity, std::vector<ExplicitSoil> soils,
                               FreePoints points, int32_t threads, double rest_speed)
    : soils_(std::move(soils)), points_(std::move(points)), arrangement_(Threads(threads), rest_speed) {
    for (const ExplicitSoil& soil : soils_) {
        yields_ = yields_ || soil.yields;
        is_inertial_ = is_inertial_ || soil.friction_rise > 0;
    }
    nodes_.threads = arrangement_.threads();
    nodes_.grid.cell_size = cell_size;
    nodes_.walls = walls;
    nodes_.gravity = gravity;
    nodes_.least_mass = points_.least(solid_mass);
    restart();
}

void ExplicitMotion::restart() {
    nodes_.start_grid();
    arrange_points();
    hold_points();
    arrangement_.for_each_strip([this](Strip strip) { give(strip); });
    nodes_.begin_step();
}

void ExplicitMotion::keep(const std::vector<int32_t>& staying) {
    points_.arrange(staying);
    if (points_.count > 0) restart();
}

bool ExplicitMotion::step(double dt, bool is_last) {
    arrangement_.for_each_strip([&](Strip strip) { stress_and_forces(strip, dt); });
    nodes_.end_step(dt);
    const double drift = dt * nodes_.speed / nodes_.grid.cell_size;
    if (!arrangement_.bears(drift)) return false;
    if (arrangement_.is_outgrown(drift)) arrange_points();
    arrangement_.count_substep(drift);
    arrangement_.for_each_strip([&](Strip strip) {
        if (is_last) {
            move_and_give<true>(strip, dt);
        } else {
            move_and_give<false>(strip, dt);
        }
    });
    if (is_last && arrangement_.look_for_rest(points_)) {
        hold_points();
        nodes_.momentum.assign(nodes_.grid.nodes(), {});
        arrangement_.for_each_strip([this](Strip strip) { give(strip); });
    }
    nodes_.begin_step();
    return true;
}

void ExplicitMotion::stress_and_forces(Strip strip, double dt) {
    SplineBlock spline;
    GradientBlock gradient;
    MaterialBlock material;
    for (size_t first = strip.first; first < strip.last; first += block_size) {
        const size_t count = std::min(block_size, strip.last - first);
        spline.find(nodes_.grid, points_[position_x] + first, points_[position_y] + first, count);
        gather_gradient(nodes_.grid, nodes_.velocity, count, spline, gradient);
        set_elasticity(soils_, points_, first, count, material);
        strain_elastically(points_, first, count, dt, gradient, material);
        if (yields_) {
            set_strength(soils_, points_, first, count, nodes_.grid.cell_size, material);
            if (is_inertial_) add_inertial_friction(soils_, points_, first, count, gradient, material);
            return_stresses(points_, first, count, material);
        }
        scatter_force(nodes_.grid, count, spline, points_[point_volume] + first, points_[stress_xx] + first,
                      points_[stress_yy] + first, points_[stress_xy] + first, nodes_.force);
    }
}

template <bool keeps>
void ExplicitMotion::move_and_give(Strip strip, double dt) {
    SplineBlock spline;
    VelocityBlock taken;
    GiftBlock gift;
    for (size_t first = strip.first; first < strip.last; first += block_size) {
        const size_t count = std::min(block_size, strip.last - first);
        double* x = points_[position_x] + first;
        double* y = points_[position_y] + first;
        spline.find(nodes_.grid, x, y, count);
        take_velocity<keeps>(nodes_.grid, nodes_.velocity, points_, first, count, spline, points_[solid_mass] + first,
                             {velocity_x, affine_xx}, gift, taken);
        for (size_t k = 0; k < count; ++k) {
            x[k] += dt * taken.x[k];
            y[k] += dt * taken.y[k];
        }
        spline.find(nodes_.grid, x, y, count);
        give_momentum(nodes_.grid, count, spline, gift, nodes_.momentum);
    }
}

/// The momenta of points that have a velocity of their own.
void ExplicitMotion::give(Strip strip) {
    SplineBlock spline;
    GiftBlock gift;
    const double size = nodes_.grid.cell_size;
    for (size_t first = strip.first; first < strip.last; first += block_size) {
        const size_t count = std::min(block_size, strip.last - first);
        spline.find(nodes_.grid, points_[position_x] + first, points_[position_y] + first, count);
        for (size_t k = 0; k < count; ++k) {
            const size_t p = first + k;
            gift[k].set(points_[solid_mass][p], {points_[velocity_x][p], points_[velocity_y][p]},
                        {size * points_[affine_xx][p], size * points_[affine_yx][p]},
                        {size * points_[affine_xy][p], size * points_[affine_yy][p]});
        }
        give_momentum(nodes_.grid, count, spline, gift, nodes_.momentum);
    }
}

/// Arranges the points anew, with what the nodes hold.
void ExplicitMotion::arrange_points() {
    const Grid old = nodes_.grid;
    if (arrangement_.arrange(points_, nodes_.grid)) {
        move_nodes(nodes_.velocity, old, nodes_.grid);
        nodes_.momentum.assign(nodes_.grid.nodes(), {});
        nodes_.force.assign(nodes_.grid.nodes(), {});
    }
    arrangement_.tell(points_, nodes_);
    find_wave_speed();
}

void ExplicitMotion::hold_points() {
    arrangement_.hold(points_);
    arrangement_.tell(points_, nodes_);
}

/// Of the points as they are: ground that dilates becomes lighter, and its waves faster.
void ExplicitMotion::find_wave_speed() {
    wave_speed_ = 0;
    for (size_t p = 0; p < points_.count; ++p) {
        const Elasticity& elastic = soils_[static_cast<size_t>(points_.soil[p])].elastic;
        const double density = points_[solid_mass][p] / points_[point_volume][p];
        wave_speed_ = std::max(wave_speed_, std::sqrt((elastic.lame + 2 * elastic.shear) / density));
    }
}

MohrCoulomb ExplicitMotion::strength(size_t point) const {
    MaterialBlock material;
    set_strength(soils_, points_, point, 1, nodes_.grid.cell_size, material);
    return material.at(0);
}

double ExplicitMotion::critical_step() const {
    constexpr double share =
        0.5;  // energy is kept within 1 % over a period of 200 cells' length (docs/verification.md)
    return share * nodes_.grid.cell_size / (wave_speed_ + nodes_.start_speed);
}

Energies energies_of(const FreePoints& points, const std::vector<ExplicitSoil>& soils, double gravity) {
    Energies sum;
    for (size_t p = 0; p < points.count; ++p) {
        const double mass = points[solid_mass][p];
        sum.kinetic += 0.5 * mass *
                       (points[velocity_x][p] * points[velocity_x][p] + points[velocity_y][p] * points[velocity_y][p]);
        sum.potential += mass * gravity * points[position_y][p];
        const Elasticity& elastic = soils[static_cast<size_t>(points.soil[p])].elastic;
        const double xx = points[stress_xx][p], yy = points[stress_yy][p], zz = points[stress_zz][p],
                     xy = points[stress_xy][p];
        const double trace = xx + yy + zz;
        const double squares = xx * xx + yy * yy + zz * zz + 2 * xy * xy;
        const double spread = elastic.lame / (3 * elastic.lame + 2 * elastic.shear);
        sum.elastic += points[point_volume][p] * (squares - spread * trace * trace) / (4 * elastic.shear);
    }
    return sum;
}

}  // namespace talus
