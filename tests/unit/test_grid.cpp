// The Cartesian background's splines, and points that move through it.
#include "background/grid.hpp"
#include "doctest/doctest.h"
#include "verification/explicit_cases.hpp"

#include <cmath>

using namespace talus;
using namespace talus::test;

TEST_CASE("splines of the grid add up to one and reproduce places") {
    const Grid grid{0.25, {-1, 2}, {12, 9}};
    const std::array<double, 3> x{-0.74, 0.5, 1.2499}, y{2.251, 2.75, 3.9};
    SplineBlock spline;
    spline.find(grid, x.data(), y.data(), x.size());
    for (size_t k = 0; k < x.size(); ++k) {
        double one = 0, place_x = 0, place_y = 0, slope_x = 0, slope_y = 0;
        for (size_t j = 0; j < 3; ++j) {
            for (size_t i = 0; i < 3; ++i) {
                const auto node = static_cast<size_t>(spline.first[k]) + j * 12 + i;
                const double share = spline.value_x[i][k] * spline.value_y[j][k];
                one += share;
                place_x += share * (-1 + 0.25 * (static_cast<double>(node % 12) + 0.5));
                place_y += share * (2 + 0.25 * (static_cast<double>(node / 12) + 0.5));
                slope_x += spline.slope_x[i][k] * (0.25 * static_cast<double>(i));
                slope_y += spline.slope_y[j][k] * (0.25 * static_cast<double>(j));
            }
        }
        CHECK(one == doctest::Approx(1).epsilon(1e-14));
        CHECK(place_x == doctest::Approx(x[k]).epsilon(1e-13));
        CHECK(place_y == doctest::Approx(y[k]).epsilon(1e-13));
        CHECK(slope_x / 3 == doctest::Approx(1).epsilon(1e-13));
        CHECK(slope_y / 3 == doctest::Approx(1).epsilon(1e-13));
    }
}

namespace {

/// A block that falls onto a fixed base, slides off a frictional one, or hits a roller, for a while.
FreePoints fall(const Walls& walls, int32_t threads, int64_t steps) {
    const double cell_size = 0.05;
    FreePoints points = block_of_points(cell_size, 0.5, 0.02, 20, 20);
    for (size_t p = 0; p < points.count; ++p) points[velocity_x][p] = 1;
    ExplicitSoil soil{elasticity(1e6, 0.3), true, mohr_coulomb({100, 30}, 0, 1e300)};
    ExplicitMotion motion(cell_size, walls, 9.81, {soil}, std::move(points), threads);
    for (int64_t step = 1; step <= steps; ++step) motion.step(motion.critical_step(), step == steps);
    return motion.points();
}

}  // namespace

TEST_CASE("explicit motion gives the same bits with one and two threads, and keeps every point") {
    const Walls walls{{}, {WallKind::roller, 3, 0}, {WallKind::friction, 0, 0.3}};
    const FreePoints one = fall(walls, 1, 400), two = fall(walls, 2, 400);
    for (size_t f = 0; f < point_fields; ++f) CHECK(one.field[f] == two.field[f]);
    CHECK(one.number == two.number);
    std::vector<int32_t> numbers = one.number;
    std::sort(numbers.begin(), numbers.end());
    for (size_t p = 0; p < one.count; ++p) CHECK(numbers[p] == static_cast<int32_t>(p));
}

TEST_CASE("walls hold the points") {
    const Walls walls{{}, {WallKind::roller, 1.8, 0}, {WallKind::friction, 0, 0.3}};
    const FreePoints points = fall(walls, 1, 3000);
    for (size_t p = 0; p < points.count; ++p) {
        CHECK(points[position_y][p] > 0);
        CHECK(points[position_x][p] < 1.8);
    }
}

TEST_CASE("friction slows a block as Coulomb has it") {
    // Sliding with the friction coefficient 0.3 takes 0.3 g off the speed.
    const double cell_size = 0.1, dt = 1e-3;
    FreePoints points = block_of_points(cell_size, 0, 0, 10, 2);
    for (size_t p = 0; p < points.count; ++p) {
        points[velocity_x][p] = 2;
        points[stress_yy][p] = -block_density * 9.81 * (0.2 - points[position_y][p]);
    }
    ExplicitMotion motion(cell_size, {{}, {}, {WallKind::friction, 0, 0.3}}, 9.81, {{elasticity(1e6, 0)}},
                          std::move(points), 1);
    const auto steps = static_cast<int64_t>(0.4 / dt);
    for (int64_t step = 1; step <= steps; ++step) motion.step(dt, step == steps);
    double momentum = 0, mass = 0;
    for (size_t p = 0; p < motion.points().count; ++p) {
        momentum += motion.points()[solid_mass][p] * motion.points()[velocity_x][p];
        mass += motion.points()[solid_mass][p];
    }
    CHECK(momentum / mass == doctest::Approx(2 - 0.3 * 9.81 * 0.4).epsilon(0.01));
}

TEST_CASE("motion between two walls fades to none, not to numbers that processors are slow with") {
    const double cell_size = 0.1;
    FreePoints points = block_of_points(cell_size, 0, 0, 1, 4);
    std::fill_n(points[velocity_x], points.count, 1e-300);
    const Walls walls{{WallKind::roller, 0, 0}, {WallKind::roller, cell_size, 0}, {WallKind::roller, 0, 0}};
    ExplicitMotion motion(cell_size, walls, 0, {{elasticity(1e6, 0)}}, std::move(points), 1);
    for (int step = 1; step <= 200; ++step) motion.step(1e-3, step == 200);
    for (size_t p = 0; p < motion.points().count; ++p) CHECK(motion.points()[velocity_x][p] == 0);
}

TEST_CASE("ground that rubs on both walls of a corner gains no energy there") {
    const double cell_size = 0.25, poisson = 0.45;
    const Walls walls{{WallKind::friction, 0, 0.7}, {WallKind::friction, 2, 0.55}, {WallKind::friction, 0, 0.035}};
    FreePoints points = block_of_points(cell_size, 0, 0, 8, 4);
    for (size_t p = 0; p < points.count; ++p) {
        const double vertical = -block_density * 9.81 * (1 - points[position_y][p]);
        points[stress_yy][p] = vertical;
        points[stress_xx][p] = points[stress_zz][p] = poisson / (1 - poisson) * vertical;
    }
    ExplicitMotion motion(cell_size, walls, 9.81, {{elasticity(1e7, poisson)}}, std::move(points), 1);
    const auto energy = [&] {
        const Energies parts = motion.energies();
        return parts.kinetic + parts.elastic + parts.potential;
    };
    const double start = energy(), dt = motion.critical_step();
    for (int64_t step = 1; step <= 500; ++step) motion.step(dt, step == 500);
    CHECK(energy() - start < 0.02 * motion.energies().elastic);
}

TEST_CASE("ground at rest is held until something comes near, and nothing else is changed by that") {
    const double cell_size = 0.1;
    const auto collide = [&](double rest_speed, int32_t threads, bool is_put_back) {
        FreePoints points = block_of_points(cell_size, 0, 0, 20, 10);
        const FreePoints other = block_of_points(cell_size, 0, 0, 5, 10);
        const size_t resting = points.count;
        points.assign(resting + other.count, dry_fields);
        const FreePoints block = block_of_points(cell_size, 0, 0, 20, 10);
        for (size_t p = 0; p < points.count; ++p) {
            const FreePoints& from = p < resting ? block : other;
            const size_t k = p < resting ? p : p - resting;
            for (const PointField name : {position_x, position_y, point_volume, solid_mass})
                points[name][p] = from[name][k];
            if (p < resting) continue;
            points[position_x][p] += 6;
            points[velocity_x][p] = -1;
        }
        const std::vector<ExplicitSoil> soils{{elasticity(1e6, 0.3)}};
        const auto motion_of = [&](FreePoints of) {
            return ExplicitMotion(cell_size, {}, 0, soils, std::move(of), threads, rest_speed);
        };
        ExplicitMotion motion = motion_of(std::move(points));
        const auto run = [&](int steps) {
            for (int i = 1; i <= steps; ++i) motion.step(1.5e-3, i % 16 == 0);
        };
        run(1600);  // 2.4 s
        int32_t quiet = 0;
        for (const int32_t substeps : motion.points().quiet) quiet += substeps >= 1000 ? 1 : 0;
        CHECK(quiet == (rest_speed > 0 ? static_cast<int32_t>(resting) : 0));
        if (is_put_back) motion = motion_of(motion.points());
        motion.restart();
        run(1600);
        return motion.points();
    };
    const FreePoints free = collide(0, 1, false), held = collide(1e-3, 1, false);
    std::vector<double> place(2 * free.count), held_place(2 * free.count);
    for (size_t p = 0; p < free.count; ++p) {
        const auto at = [](const FreePoints& points, size_t k) { return static_cast<size_t>(points.number[k]); };
        place[at(free, p)] = free[position_x][p];
        held_place[at(held, p)] = held[position_x][p];
    }
    CHECK(place[0] < -0.1);  // pushed by the impact
    for (size_t p = 0; p < place.size(); ++p) CHECK(std::abs(held_place[p] - place[p]) < 1e-3 * 0.02);
    const FreePoints two = collide(1e-3, 2, false), again = collide(1e-3, 1, true);
    for (size_t f = 0; f < dry_fields; ++f) {
        CHECK(held.field[f] == two.field[f]);
        CHECK(held.field[f] == again.field[f]);
    }
}
