// Million point-updates a second of explicit motion, by composition: a column of 1 m x 1 m that collapses in a box of 4 m x 1.5 m.
// Prints a JSON array of rows. Usage: throughput THREADS
#include "motion/explicit/explicit_mixture.hpp"
#include "motion/explicit/explicit_motion.hpp"
#include "verification/explicit_cases.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <numbers>

using namespace talus;

namespace {

constexpr double density = 1800, porosity = 0.4, grain_density = density / (1 - porosity), step = 1e-4;
constexpr double filled = 0.8;        // of the pores, where gas moves
constexpr double scene_step = 0.018;  // s, in cells of a metre: a little less than the engine allows itself
constexpr int64_t steps = 300;
const Elasticity elastic = elasticity(1e6, 0.3);
const Walls box{{WallKind::roller, 0, 0}, {WallKind::roller, 4, 0}, {WallKind::fixed, 0, 0}};

FreePoints column(int32_t cells, size_t fields) {
    FreePoints points;
    const auto side = static_cast<size_t>(2 * cells);
    points.assign(side * side, fields);
    const double spacing = 1.0 / static_cast<double>(side), volume = spacing * spacing;
    for (size_t p = 0; p < points.count; ++p) {
        points[position_x][p] = (static_cast<double>(p % side) + 0.5) * spacing;
        points[position_y][p] = (static_cast<double>(p / side) + 0.5) * spacing;
        points[point_volume][p] = volume;
        points[solid_mass][p] = density * volume;
        if (fields > dry_fields) points[water_mass][p] = 1000 * porosity * volume * (fields > wet_fields ? filled : 1);
        if (fields > wet_fields) points[gas_mass][p] = ExplicitGas{}.density * porosity * volume * (1 - filled);
    }
    return points;
}

/// The best of five runs: the others were disturbed.
template <class Make>
void time(const char* name, int32_t cells, int32_t threads, bool last, const Make& make, double dt = step) {
    double best = 1e300;
    size_t points = 0, bytes = 0;
    for (int run = 0; run < 5; ++run) {
        auto motion = make();
        points = motion.points().count;
        bytes = motion.points().bytes_a_point();
        const auto start = std::chrono::steady_clock::now();
        for (int64_t i = 1; i <= steps; ++i) motion.step(dt, i == steps);
        best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    const double rate = static_cast<double>(steps) * static_cast<double>(points) / best / 1e6;
    std::printf(
        " {\"composition\": \"%s\", \"cells_a_metre\": %d, \"threads\": %d, \"points\": %zu, \"bytes_a_point\": %zu, "
        "\"million_point_updates_a_second\": %.2f}%s\n",
        name, cells, threads, points, bytes, rate, last ? "" : ",");
}

void run(int32_t cells, int32_t threads, bool last) {
    const double size = 1.0 / cells;
    const ExplicitSoil soft{elastic, false, {}};
    const ExplicitSoil yielding{elastic, true, mohr_coulomb({10, 30}, 0, 1e300)};
    time("dry_elastic", cells, threads, false,
         [&] { return ExplicitMotion(size, box, 9.81, {soft}, column(cells, dry_fields), threads); });
    time("dry_mohr_coulomb", cells, threads, false,
         [&] { return ExplicitMotion(size, box, 9.81, {yielding}, column(cells, dry_fields), threads); });
    // As the scene of tests/precision/composition_cost.py.
    const ExplicitSoil sand{elastic, true, mohr_coulomb({50, 30}, 0, 1e300)};
    time(
        "dry_scene_alone", cells, threads, false,
        [&] {
            return ExplicitMotion(size, {{WallKind::roller, 0, 0}, {}, {WallKind::fixed, 0, 0}}, 9.81, {sand},
                                  column(cells, dry_fields), threads);
        },
        scene_step / cells);
    // Water as soft as the step of the dry column bears; the work is the same.
    time("two_phase", cells, threads, false, [&] {
        return ExplicitMixture<Filling::saturated>(size, box, 9.81, {yielding}, {{grain_density, 1e-8, 0, false}}, {},
                                                   {1000, 1e6}, column(cells, wet_fields), threads);
    });
    // Gas is faster than that ground.
    const auto with_gas = [&]<Filling filling>(size_t fields) {
        return ExplicitMixture<filling>(size, box, 9.81, {yielding}, {{grain_density, 1e-8, 0, false, 1e-6}},
                                        {{test::van_genuchten(4e-5, 1.2), 1e6}}, {1000, 1e6}, column(cells, fields),
                                        threads, {}, {fluid_exchange(1.2041, 101325, 293.15, 7.8e-6)});
    };
    time(
        "three_phase", cells, threads, false,
        [&] { return with_gas.template operator()<Filling::three_phase>(gas_fields); }, step / 10);
    time(
        "exchange", cells, threads, last, [&] { return with_gas.template operator()<Filling::exchange>(point_fields); },
        step / 10);
}

}  // namespace

int main(int count, char** arguments) {
    const int32_t threads = count == 2 ? std::atoi(arguments[1]) : 0;
    if (threads < 1) {
        std::fputs("usage: throughput THREADS\n", stderr);
        return 2;
    }
    std::puts("[");
    run(64, threads, false);
    run(128, threads, true);
    std::puts("]");
    return 0;
}
