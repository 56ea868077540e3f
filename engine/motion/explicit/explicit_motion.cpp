#include "motion/explicit/explicit_motion.hpp"

#include "motion/explicit/transfer.hpp"

#include <tbb/parallel_for.h>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace talus {
namespace {

constexpr int32_t strip_rows = 8;
constexpr int32_t margin =
    2;  // cells that a point may drift from where it was arranged; less than half of a strip's rows less one

}  // namespace

ExplicitMotion::ExplicitMotion(double cell_size, const Walls& walls, double gravity, std::vector<ExplicitSoil> soils,
                               FreePoints points, int32_t threads)
    : soils_(std::move(soils)),
      points_(std::move(points)),
      threads_(threads > 1 ? std::make_unique<tbb::task_arena>(threads) : nullptr) {
    for (const ExplicitSoil& soil : soils_) yields_ = yields_ || soil.yields;
    nodes_.grid.cell_size = cell_size;
    nodes_.walls = walls;
    nodes_.gravity = gravity;
    nodes_.least_mass =
        points_.count > 0 ? *std::min_element(points_[solid_mass], points_[solid_mass] + points_.count) : 0;
    restart();
}

void ExplicitMotion::restart() {
    const Walls& walls = nodes_.walls;
    nodes_.grid.corner = {walls.left.kind != WallKind::none ? walls.left.place : walls.right.place, walls.base.place};
    nodes_.grid.cells = {};
    arrange_points();
    for_each_strip([this](Strip strip) { give(strip); });
    nodes_.begin_step();
}

template <class Handle>
void ExplicitMotion::for_each_strip(const Handle& handle) {
    for (const size_t parity : {size_t{0}, size_t{1}}) {
        const size_t strips = (strips_.size() + 1 - parity) / 2;
        const auto handle_one = [&](size_t s) { handle(strips_[2 * s + parity]); };
        if (!threads_) {
            for (size_t s = 0; s < strips; ++s) handle_one(s);
        } else {
            threads_->execute([&] { tbb::parallel_for(size_t{0}, strips, handle_one); });
        }
    }
}

bool ExplicitMotion::step(double dt, bool is_last) {
    for_each_strip([&](Strip strip) { stress_and_forces(strip, dt); });
    nodes_.end_step(dt);
    const double drift = dt * nodes_.speed / nodes_.grid.cell_size;
    if (!(drift <= margin)) return false;
    if (drift_ + drift > margin) arrange_points();
    drift_ += drift;
    for_each_strip([&](Strip strip) {
        if (is_last) {
            move_and_give<true>(strip, dt);
        } else {
            move_and_give<false>(strip, dt);
        }
    });
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
                             velocity_x, affine_xx, gift, taken);
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

/// Points by strips of rows, in a strip by columns, in a column by cells; points of one cell keep their order.
void ExplicitMotion::arrange_points() {
    fit_grid();
    const Grid& grid = nodes_.grid;
    const auto columns = static_cast<size_t>(grid.cells[0]);
    const auto strips = static_cast<size_t>((grid.cells[1] + strip_rows - 1) / strip_rows);
    std::vector<size_t> key(points_.count), start(strips * columns * strip_rows + 1, 0);
    for (size_t p = 0; p < points_.count; ++p) {
        const auto row = static_cast<size_t>(grid.cell_of(points_[position_y][p], 1));
        const auto column = static_cast<size_t>(grid.cell_of(points_[position_x][p], 0));
        key[p] = (row / strip_rows * columns + column) * strip_rows + row % strip_rows;
        ++start[key[p] + 1];
    }
    std::partial_sum(start.begin(), start.end(), start.begin());
    strips_.resize(strips);
    for (size_t s = 0; s < strips; ++s)
        strips_[s] = {start[s * columns * strip_rows], start[(s + 1) * columns * strip_rows]};
    std::vector<int32_t> order(points_.count);
    for (size_t p = 0; p < points_.count; ++p) order[start[key[p]]++] = static_cast<int32_t>(p);
    points_.arrange(order);
    find_spans();
    find_wave_speed();
    drift_ = 0;
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

/// The grid about the points, with room for them to drift; only ever larger.
void ExplicitMotion::fit_grid() {
    constexpr int32_t room = 8 * (margin + 2);
    Grid& grid = nodes_.grid;
    std::array<int32_t, 2> before{}, after{};
    bool fits = grid.cells[0] > 0;
    for (size_t axis = 0; axis < 2; ++axis) {
        const double* place = points_[axis == 0 ? position_x : position_y];
        const auto [low, high] = std::minmax_element(place, place + points_.count);
        const auto lowest = static_cast<int32_t>(std::floor((*low - grid.corner[axis]) / grid.cell_size));
        const auto highest = static_cast<int32_t>(std::floor((*high - grid.corner[axis]) / grid.cell_size));
        fits = fits && lowest >= margin + 2 && highest < grid.cells[axis] - margin - 2;
        before[axis] = std::max(0, room - lowest);
        after[axis] = std::max(grid.cells[axis], highest + 1 + room);
    }
    if (fits) return;
    const Grid old = grid;
    const std::vector<NodeVector> velocity = nodes_.velocity;
    for (size_t axis = 0; axis < 2; ++axis) {
        grid.corner[axis] -= before[axis] * grid.cell_size;
        grid.cells[axis] = after[axis] + before[axis];
    }
    nodes_.momentum.assign(grid.nodes(), {});
    nodes_.velocity.assign(grid.nodes(), {});
    nodes_.force.assign(grid.nodes(), {});
    for (int32_t row = 0; row < old.cells[1]; ++row) {
        const auto from = velocity.begin() + static_cast<int64_t>(row) * old.cells[0];
        std::copy(from, from + old.cells[0],
                  nodes_.velocity.begin() + static_cast<int64_t>(row + before[1]) * grid.cells[0] + before[0]);
    }
}

void ExplicitMotion::find_spans() {
    const Grid& grid = nodes_.grid;
    std::vector<Span> held(static_cast<size_t>(grid.cells[1]), {grid.cells[0], 0});
    for (size_t p = 0; p < points_.count; ++p) {
        const int32_t column = grid.cell_of(points_[position_x][p], 0);
        Span& span = held[static_cast<size_t>(grid.cell_of(points_[position_y][p], 1))];
        span.first = std::min(span.first, column);
        span.last = std::max(span.last, column + 1);
    }
    constexpr int32_t reach = margin + 1;
    nodes_.spans.assign(held.size(), {grid.cells[0], 0});
    for (int32_t row = 0; row < grid.cells[1]; ++row) {
        Span& span = nodes_.spans[static_cast<size_t>(row)];
        for (int32_t near = std::max(0, row - reach); near <= std::min(grid.cells[1] - 1, row + reach); ++near) {
            span.first = std::min(span.first, held[static_cast<size_t>(near)].first);
            span.last = std::max(span.last, held[static_cast<size_t>(near)].last);
        }
        if (span.first >= span.last) {
            span = {};
            continue;
        }
        span = {std::max(0, span.first - reach), std::min(grid.cells[0], span.last + reach)};
    }
}

double ExplicitMotion::critical_step() const {
    constexpr double share =
        0.5;  // energy is kept within 1 % over a period of 200 cells' length (docs/verification.md)
    return share * nodes_.grid.cell_size / (wave_speed_ + nodes_.largest_speed());
}

Energies ExplicitMotion::energies() const {
    Energies sum;
    for (size_t p = 0; p < points_.count; ++p) {
        const double mass = points_[solid_mass][p];
        sum.kinetic +=
            0.5 * mass *
            (points_[velocity_x][p] * points_[velocity_x][p] + points_[velocity_y][p] * points_[velocity_y][p]);
        sum.potential += mass * nodes_.gravity * points_[position_y][p];
        const Elasticity& elastic = soils_[static_cast<size_t>(points_.soil[p])].elastic;
        const double xx = points_[stress_xx][p], yy = points_[stress_yy][p], zz = points_[stress_zz][p],
                     xy = points_[stress_xy][p];
        const double trace = xx + yy + zz;
        const double squares = xx * xx + yy * yy + zz * zz + 2 * xy * xy;
        const double spread = elastic.lame / (3 * elastic.lame + 2 * elastic.shear);
        sum.elastic += points_[point_volume][p] * (squares - spread * trace * trace) / (4 * elastic.shear);
    }
    return sum;
}

}  // namespace talus
