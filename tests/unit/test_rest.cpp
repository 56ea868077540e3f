// Moist ground at rest, which is held until something comes near; dry ground: test_grid.cpp.
#include "doctest/doctest.h"
#include "materials/hydraulic/saturation_table.hpp"
#include "motion/explicit/explicit_mixture.hpp"
#include "verification/explicit_cases.hpp"

#include <cmath>

using namespace talus;
using namespace talus::test;

namespace {

constexpr double cell_size = 0.1, poisson = 0.3, young = 1e6;
constexpr double porosity = 0.4, filled = 0.6, rain = 1e-6;

/// A block at rest, and 2 m from it a smaller one that comes nearer by 1 m/s.
struct Collision {
    FreePoints points;
    size_t resting;
};

Collision collision() {
    FreePoints points = block_of_points(cell_size, 0, 0, 20, 5);
    const FreePoints block = points, other = block_of_points(cell_size, 4, 0, 5, 5);
    points.assign(block.count + other.count, wet_fields);
    for (size_t p = 0; p < points.count; ++p) {
        const bool rests = p < block.count;
        const FreePoints& from = rests ? block : other;
        for (const PointField name : {position_x, position_y, point_volume, solid_mass})
            points[name][p] = from[name][rests ? p : p - block.count];
        if (!rests) points[velocity_x][p] = -1;
        points[water_mass][p] = 1000 * porosity * filled * points[point_volume][p];
        points[liquid_velocity_x][p] = points[velocity_x][p];
    }
    return {std::move(points), block.count};
}

ExplicitMixture<Filling::unsaturated> moist(FreePoints points, int32_t threads, double rest_speed) {
    const double mobility = 1e-4 / (1000 * 9.81);
    return {cell_size,
            {},
            0,
            {{elasticity(young, poisson)}},
            {{block_density / (1 - porosity), mobility}},
            {{van_genuchten(4e-5, 1.2), 1e6}},
            {1000, 1e6},
            std::move(points),
            threads,
            {},
            {},
            rest_speed};
}

void run(auto& motion, int steps) {
    for (int i = 1; i <= steps; ++i) CHECK(motion.step(1e-3, i % 16 == 0));
}

/// 1.1 s to come near, 1.4 s with the impact; begun anew between, from a copy if so wished.
FreePoints collide(double rest_speed, int32_t threads, bool is_put_back) {
    auto [points, resting] = collision();
    auto motion = moist(std::move(points), threads, rest_speed);
    run(motion, 1120);
    int32_t quiet = 0;
    for (const int32_t substeps : motion.points().quiet) quiet += substeps >= 1000 ? 1 : 0;
    CHECK(quiet == (rest_speed > 0 ? static_cast<int32_t>(resting) : 0));
    if (is_put_back) motion = moist(motion.points(), threads, rest_speed);
    motion.restart();
    run(motion, 1392);
    return motion.points();
}

std::vector<double> places(const FreePoints& points) {
    std::vector<double> x(points.count);
    for (size_t p = 0; p < points.count; ++p) x[static_cast<size_t>(points.number[p])] = points[position_x][p];
    return x;
}

double water_of(const FreePoints& points) {
    double sum = 0;
    for (size_t p = 0; p < points.count; ++p) sum += points[water_mass][p] + points[water_due][p];
    return sum;
}

}  // namespace

/// Whenever others are held the nodes begin anew, which in a mixture takes the rate of the volumetric strain from the points' affine velocity: begun anew once
/// during the impact, ground that is never held comes to lie elsewhere by 5e-4 of its way.
TEST_CASE("moist ground at rest is held until something comes near, and hardly anything else is changed by that") {
    const FreePoints held = collide(1e-3, 1, false);
    const std::vector<double> start = places(collision().points), place = places(collide(0, 1, false)),
                              held_place = places(held);
    const double pushed = start[0] - place[0];
    CHECK(pushed > 0.01);
    for (size_t p = 0; p < place.size(); ++p) CHECK(std::abs(held_place[p] - place[p]) < 2e-3 * pushed);
    const FreePoints again = collide(1e-3, 2, true);  // with two threads, and put back
    for (size_t f = 0; f < wet_fields; ++f) CHECK(held.field[f] == again.field[f]);
}

TEST_CASE("ground that is held loses no water, and all the rain on it runs off") {
    const auto fall = [](double rest_speed) {
        auto motion = moist(collision().points, 1, rest_speed);
        const double before = water_of(motion.points());
        motion.set_rain([](double) { return rain; });
        run(motion, 2400);
        CHECK(water_of(motion.points()) + motion.seepage() ==
              doctest::Approx(before + motion.rained() - motion.run_off()).epsilon(1e-13));
        return std::array{motion.rained(), motion.run_off()};
    };
    const auto [fallen, run_off] = fall(0);
    const auto [fallen_on_held, run_off_held] = fall(1e-3);
    CHECK(fallen_on_held ==
          doctest::Approx(fallen).epsilon(1e-2));  // on whole columns of cells, as the blocks move through them
    CHECK(run_off < 1e-6 * fallen);
    CHECK(run_off_held > 0.2 * fallen);
}
