// Explicit motion of blocks of material points on the Cartesian background.
#pragma once

#include "materials/hydraulic/saturation_table.hpp"
#include "motion/explicit/explicit_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace talus::test {

inline constexpr double block_density = 2000;  // kg/m3

/// A soil that conducts 1e-4 m/s; alpha in 1/Pa.
inline Hydraulics van_genuchten(double alpha, double n) {
    Hydraulics soil;
    soil.retention.alpha = alpha;
    soil.retention.n = n;
    soil.conductivity.along = soil.conductivity.across = 1e-4;
    return soil;
}

/// A rectangle of points at rest, two a cell and direction, with its lower left corner at (x, y).
inline FreePoints block_of_points(double cell_size, double x, double y, size_t columns, size_t rows,
                                  size_t fields = dry_fields) {
    FreePoints points;
    points.assign(4 * columns * rows, fields);
    const double spacing = cell_size / 2;
    for (size_t p = 0; p < points.count; ++p) {
        const size_t row = p / (2 * columns), column = p % (2 * columns);
        points[position_x][p] = x + (static_cast<double>(column) + 0.5) * spacing;
        points[position_y][p] = y + (static_cast<double>(row) + 0.5) * spacing;
        points[point_volume][p] = spacing * spacing;
        points[solid_mass][p] = block_density * spacing * spacing;
    }
    return points;
}

struct BarErrors {
    double energy;  ///< largest change of the mean energy over a period, relative
    double period;  ///< of the mean of all periods, relative
};

/// The first longitudinal vibration of a bar, fixed at its lower end and free at its upper one, between rollers; undamped.
inline BarErrors vibrate_bar(size_t cells, double courant, double periods) {
    constexpr double pi = std::numbers::pi;
    const Elasticity elastic = elasticity(1e7, 0.3);
    const double stiffness = elastic.lame + 2 * elastic.shear;
    const double wave = std::sqrt(stiffness / block_density);
    const double cell_size = 1.0 / static_cast<double>(cells), period = 4 / wave;
    FreePoints points = block_of_points(cell_size, 0, 0, 1, cells);
    for (size_t p = 0; p < points.count; ++p) {
        const double place = pi / 2 * points[position_y][p];
        points[velocity_y][p] = 1e-4 * wave * std::sin(place);
        points[affine_yy][p] = 1e-4 * wave * pi / 2 * std::cos(place);
    }
    const Walls walls{{WallKind::roller, 0, 0}, {WallKind::roller, cell_size, 0}, {WallKind::roller, 0, 0}};
    ExplicitMotion bar(cell_size, walls, 0, {{elastic}}, std::move(points), 1);
    const auto steps_a_period = static_cast<int64_t>(std::ceil(period * wave / (courant * cell_size)));
    const double dt = period / static_cast<double>(steps_a_period);
    const auto momentum = [&bar] {
        double sum = 0;
        for (size_t p = 0; p < bar.points().count; ++p)
            sum += bar.points()[solid_mass][p] * bar.points()[velocity_y][p];
        return sum;
    };
    double first_energy = 0, energy = 0, last_momentum = momentum(), first_crossing = -1, last_crossing = -1;
    int64_t crossings = -1;
    BarErrors errors{0, 0};
    const auto steps = static_cast<int64_t>(periods) * steps_a_period;
    for (int64_t step = 1; step <= steps; ++step) {
        bar.step(dt, true);
        const Energies now = bar.energies();
        energy += (now.kinetic + now.elastic) / static_cast<double>(steps_a_period);
        if (step % steps_a_period == 0) {
            if (first_energy == 0) first_energy = energy;
            errors.energy = std::max(errors.energy, std::abs(energy / first_energy - 1));
            energy = 0;
        }
        const double present = momentum();
        if (last_momentum <= 0 && present > 0) {
            last_crossing = (static_cast<double>(step) - present / (present - last_momentum)) * dt;
            if (crossings < 0) first_crossing = last_crossing;
            ++crossings;
        }
        last_momentum = present;
    }
    errors.period = std::abs((last_crossing - first_crossing) / static_cast<double>(crossings) / period - 1);
    return errors;
}

struct Momentum {
    double x = 0, y = 0;  ///< kg m/s
    double angular = 0;   ///< about the origin, the affine parts' too, kg m2/s
};

inline Momentum momentum_of(const FreePoints& points, double cell_size) {
    Momentum sum;
    const double second_moment = cell_size * cell_size / 4;  // of the quadratic splines
    for (size_t p = 0; p < points.count; ++p) {
        const double mass = points[solid_mass][p];
        sum.x += mass * points[velocity_x][p];
        sum.y += mass * points[velocity_y][p];
        sum.angular +=
            mass * (points[position_x][p] * points[velocity_y][p] - points[position_y][p] * points[velocity_x][p] +
                    second_moment * (points[affine_yx][p] - points[affine_xy][p]));
    }
    return sum;
}

struct FlightErrors {
    double linear, angular;  ///< largest change in a step beside the weight's, over the momentum
    double volume;           ///< change in the whole flight, over the volume
};

inline double volume_of(const FreePoints& points) {
    double sum = 0;
    for (size_t p = 0; p < points.count; ++p) sum += points[point_volume][p];
    return sum;
}

/// A block that spins about its centre and flies, without weight (its angular momentum is then the same about any place).
inline FlightErrors fly_block(int64_t steps) {
    constexpr double cell_size = 0.1, spin = 5, speed_x = 3, speed_y = 2;
    FreePoints points = block_of_points(cell_size, -0.4, -0.2, 8, 4);
    for (size_t p = 0; p < points.count; ++p) {
        points[velocity_x][p] = speed_x - spin * points[position_y][p];
        points[velocity_y][p] = speed_y + spin * points[position_x][p];
        points[affine_xy][p] = -spin;
        points[affine_yx][p] = spin;
    }
    ExplicitMotion block(cell_size, {}, 0, {{elasticity(1e6, 0.3)}}, std::move(points), 1);
    const double dt = block.critical_step();
    Momentum last = momentum_of(block.points(), cell_size);
    const double linear = std::hypot(last.x, last.y), angular = std::abs(last.angular);
    const double volume = volume_of(block.points());
    FlightErrors errors{0, 0, 0};
    for (int64_t step = 0; step < steps; ++step) {
        block.step(dt, true);
        const Momentum now = momentum_of(block.points(), cell_size);
        errors.linear = std::max(errors.linear, std::hypot(now.x - last.x, now.y - last.y) / linear);
        errors.angular = std::max(errors.angular, std::abs(now.angular - last.angular) / angular);
        last = now;
    }
    errors.volume = std::abs(volume_of(block.points()) / volume - 1);
    return errors;
}

}  // namespace talus::test
