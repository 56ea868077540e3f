// Material points cut out of a fitted mesh.
#include "ground_scenes.hpp"
#include "points/seeding.hpp"

#include <array>
#include <numeric>

namespace {

using namespace talus;

constexpr std::array<double, 2> density{1000, 2000};

double total(const FreePoints& points, PointField name) {
    return std::accumulate(points.field[name].begin(), points.field[name].end(), 0.0);
}

double volume_of_soil(const FreePoints& points, int32_t soil) {
    double volume = 0;
    for (size_t p = 0; p < points.count; ++p)
        if (points.soil[p] == soil) volume += points[point_volume][p];
    return volume;
}

/// First moments of all cells about the origin, from triangles about each cell's first node.
Place moments(const Mesh& mesh) {
    Place sum{};
    for (int32_t cell = 0; cell < mesh.cell_count(); ++cell) {
        const std::vector<int32_t> nodes = cell_nodes(mesh, cell);
        const Place a = node_place(mesh, nodes[0]);
        for (size_t k = 1; k + 1 < nodes.size(); ++k) {
            const Place b = node_place(mesh, nodes[k]), c = node_place(mesh, nodes[k + 1]);
            const double area = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
            for (const size_t axis : {0, 1}) sum[axis] += area * (a[axis] + b[axis] + c[axis]) / 3;
        }
    }
    return sum;
}

/// A slope of two soils whose border crosses grid cells at an angle.
Mesh layered_slope() {
    Scene scene = slope_scene();
    scene.ground.section.layers.push_back({"clay", {{0, 12.3}, {31, 7.7}, {60, 4.1}}});
    return build_mesh(scene);
}

}  // namespace

TEST_CASE("seeded points hold the ground's volume, mass and moments exactly, soil by soil") {
    const Mesh mesh = layered_slope();
    for (const double cell_size : {0.3, 0.77, 2.0, 9.0}) {
        const auto [points, cell] = seed_points(mesh, cell_size, {0, 0}, density);
        const double sand = soil_area(mesh, 0), clay = soil_area(mesh, 1);
        CHECK(std::abs(volume_of_soil(points, 0) / sand - 1) < 1e-12);
        CHECK(std::abs(volume_of_soil(points, 1) / clay - 1) < 1e-12);
        CHECK(std::abs(total(points, solid_mass) / (1000 * sand + 2000 * clay) - 1) < 1e-12);
        Place sum{};
        for (size_t p = 0; p < points.count; ++p) {
            sum[0] += points[point_volume][p] * points[position_x][p];
            sum[1] += points[point_volume][p] * points[position_y][p];
        }
        CHECK(sum[0] == doctest::Approx(moments(mesh)[0]).epsilon(1e-12));
        CHECK(sum[1] == doctest::Approx(moments(mesh)[1]).epsilon(1e-12));
    }
}

TEST_CASE("no seeded point is a sliver, and quarters inside the ground are whole") {
    const Mesh mesh = layered_slope();
    const double cell_size = 0.77, quarter = cell_size * cell_size / 4;
    const auto [points, cell] = seed_points(mesh, cell_size, {0, 0}, density);
    size_t whole = 0;
    for (size_t p = 0; p < points.count; ++p) {
        const double share = points[point_volume][p] / quarter;
        CHECK(share >= 0.1);
        CHECK(share < 1.2);
        if (std::abs(share - 1) > 1e-9) continue;
        ++whole;
        const double column = points[position_x][p] / (cell_size / 2), row = points[position_y][p] / (cell_size / 2);
        CHECK(column - std::floor(column) == doctest::Approx(0.5).epsilon(1e-6));
        CHECK(row - std::floor(row) == doctest::Approx(0.5).epsilon(1e-6));
    }
    CHECK(static_cast<double>(whole) > 0.9 * static_cast<double>(points.count));
}

TEST_CASE("seeded points lie in the cell they are said to be of, and have numbers of their own") {
    const Mesh mesh = layered_slope();
    const auto [points, cell] = seed_points(mesh, 0.5, {0.1, -0.2}, density);
    REQUIRE(cell.size() == points.count);
    for (size_t p = 0; p < points.count; ++p) {
        CHECK(points.number[p] == static_cast<int32_t>(p));
        CHECK(mesh.cell_soil[static_cast<size_t>(cell[p])] == points.soil[p]);
        const Place corner = node_place(mesh, cell_nodes(mesh, cell[p])[0]);
        CHECK(std::hypot(points[position_x][p] - corner[0], points[position_y][p] - corner[1]) < 2.5);
    }
}

TEST_CASE("too small cells for a ground are refused") {
    CHECK_THROWS_AS(seed_points(layered_slope(), 0.001, {0, 0}, density), Error);
}
