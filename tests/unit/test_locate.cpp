#include "background/locate.hpp"

#include <random>

#include "background/shape.hpp"
#include "ground_scenes.hpp"

using namespace talus;

namespace {

/// Place of what was found, by the cell's shape.
Place place_of(const Mesh& mesh, const CellPlace& found) {
    const auto c = static_cast<size_t>(found.cell);
    const int32_t* nodes = &mesh.cell_nodes[static_cast<size_t>(mesh.cell_start[c])];
    if (mesh.cell_start[c + 1] - mesh.cell_start[c] == 3) {
        return place_in_cell<Tri3>(gather_places<Tri3>(mesh.position.data(), nodes), found.natural);
    }
    return place_in_cell<Quad4>(gather_places<Quad4>(mesh.position.data(), nodes), found.natural);
}

bool natural_inside(const Mesh& mesh, const CellPlace& found) {
    const auto c = static_cast<size_t>(found.cell);
    const auto [xi, eta] = found.natural;
    constexpr double near = 1e-6;
    if (mesh.cell_start[c + 1] - mesh.cell_start[c] == 3) return xi > -near && eta > -near && xi + eta < 1 + near;
    return std::abs(xi) < 1 + near && std::abs(eta) < 1 + near;
}

Scene triangles_scene() {
    Scene scene = scene_with_soils({"soil"});
    scene.ground.kind = GroundKind::mesh;
    scene.ground.mesh.file = TALUS_SOURCE_DIR "/samples/scenes/slope_triangles.msh";
    return scene;
}

Scene lens_scene() {
    Scene scene = slope_scene();
    scene.ground.section.layers = {
        {"sand", {}}, {"clay", {{0, 20}, {20, 20}, {35, 5}, {60, 5}}}, {"sand", {{0, 20}, {20, 15}, {35, 5}, {60, 5}}}};
    return scene;
}

bool in_slope(double x, double y) { return y >= 0 && x >= 0 && x <= 60 && y <= std::min(30., std::max(10., 50 - x)); }

}  // namespace

TEST_CASE("every place of the slope is found with its natural coordinates, and none outside") {
    for (const Scene& scene : {slope_scene(), lens_scene(), triangles_scene()}) {
        const Mesh mesh = build_mesh(scene);
        const Locator locator(mesh);
        std::mt19937_64 random(3);
        std::uniform_real_distribution<double> x_range(-3, 63), y_range(-3, 33);
        for (int32_t i = 0; i < 20000; ++i) {
            const double x = x_range(random), y = y_range(random);
            const CellPlace found = locator.locate(x, y);
            REQUIRE((found.cell >= 0) == in_slope(x, y));
            if (found.cell < 0) continue;
            const Place place = place_of(mesh, found);
            REQUIRE(std::hypot(place[0] - x, place[1] - y) < 1e-11);
            REQUIRE(natural_inside(mesh, found));
        }
    }
}

TEST_CASE("nodes, edges and the boundary belong to a cell") {
    for (const Scene& scene : {slope_scene(), lens_scene(), triangles_scene()}) {
        const Mesh mesh = build_mesh(scene);
        const Locator locator(mesh);
        for (int32_t cell = 0; cell < mesh.cell_count(); ++cell) {
            const auto nodes = cell_nodes(mesh, cell);
            for (size_t i = 0; i < nodes.size(); ++i) {
                const Place a = node_place(mesh, nodes[i]);
                const Place b = node_place(mesh, nodes[(i + 1) % nodes.size()]);
                for (const double t : {0., 1. / 3, 0.7}) {
                    const Place at = {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
                    const CellPlace found = locator.locate(at[0], at[1]);
                    REQUIRE(found.cell >= 0);
                    const Place place = place_of(mesh, found);
                    REQUIRE(std::hypot(place[0] - at[0], place[1] - at[1]) < 1e-7);
                    REQUIRE(natural_inside(mesh, found));
                }
            }
        }
    }
}

TEST_CASE("natural coordinates of distorted quads are found back") {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> shift(-0.45, 0.45), natural(-1, 1);
    for (int32_t i = 0; i < 500; ++i) {
        Mesh mesh;
        for (const double corner : {0., 0., 1., 0., 1., 1., 0., 1.})
            mesh.position.push_back(100 + corner + shift(random));
        mesh.cell_start = {0, 4};
        mesh.cell_nodes = {0, 1, 2, 3};
        mesh.cell_soil = {0};
        const auto places = gather_places<Quad4>(mesh.position.data(), mesh.cell_nodes.data());
        double least = 1;
        for (const Quad4::Natural corner : {Quad4::Natural{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
            least = std::min(least, map_shape<Quad4>(places, corner).determinant);
        }
        if (least < 1e-3) continue;  // not a cell that a mesh may have
        const Locator locator(mesh);
        for (int32_t k = 0; k < 20; ++k) {
            const Quad4::Natural at = {natural(random), natural(random)};
            const Place place = place_in_cell<Quad4>(places, at);
            const CellPlace found = locator.locate(place[0], place[1]);
            REQUIRE(found.cell == 0);
            CHECK(found.natural[0] == doctest::Approx(at[0]).epsilon(1e-8));
            CHECK(found.natural[1] == doctest::Approx(at[1]).epsilon(1e-8));
        }
    }
}

TEST_CASE("a column is located by elevation alone") {
    Scene scene = scene_with_soils({"sand"});
    scene.ground.column = {2, 8, {{"sand", 2}}};
    const Mesh mesh = build_mesh(scene);
    const Locator locator(mesh);
    CHECK(locator.locate(0, 0).cell == 0);
    CHECK(locator.locate(17, 2).cell == 7);
    const CellPlace found = locator.locate(-4, 0.3125);
    CHECK(found.cell == 1);
    CHECK(found.natural[0] == doctest::Approx(-0.5));
    CHECK(locator.locate(0, -1e-6).cell == -1);
    CHECK(locator.locate(0, 2 + 1e-6).cell == -1);
    CHECK(locator.locate(0, 2 + 1e-10).cell == 7);
}

TEST_CASE("places that are no numbers lie outside") {
    const Mesh mesh = build_mesh(slope_scene());
    const Locator locator(mesh);
    const double nan = std::nan(""), infinite = INFINITY;
    CHECK(locator.locate(nan, 5).cell == -1);
    CHECK(locator.locate(5, nan).cell == -1);
    CHECK(locator.locate(infinite, 5).cell == -1);
    CHECK(locator.locate(5, -infinite).cell == -1);
    CHECK(locator.locate(1e300, 1e300).cell == -1);
}
