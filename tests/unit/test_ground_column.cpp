#include "ground_scenes.hpp"

using namespace talus;

namespace {

Scene column_scene(double height, int32_t cells, const std::vector<ColumnLayer>& layers) {
    Scene scene = scene_with_soils({"sand", "clay"});
    scene.ground.column = {height, cells, layers};
    return scene;
}

}  // namespace

TEST_CASE("a column of one layer has equal cells from the base up") {
    const Mesh mesh = build_mesh(column_scene(1, 100, {{"clay", 1}}));
    CHECK(mesh.dimension == 1);
    REQUIRE(mesh.cell_count() == 100);
    REQUIRE(mesh.node_count() == 101);
    for (int32_t cell = 0; cell < 100; ++cell) {
        const auto nodes = cell_nodes(mesh, cell);
        REQUIRE(nodes == std::vector<int32_t>{cell, cell + 1});
        CHECK(mesh.position[static_cast<size_t>(cell) + 1] - mesh.position[static_cast<size_t>(cell)] ==
              doctest::Approx(0.01).epsilon(1e-12));
        CHECK(mesh.cell_soil[static_cast<size_t>(cell)] == 1);
    }
    CHECK(mesh.position.front() == 0);
    CHECK(mesh.position.back() == 1);
    REQUIRE(mesh.facets.size() == 2);
    CHECK(mesh.facets[0].node_a == 0);
    CHECK(mesh.facets[0].node_b == -1);
    CHECK(mesh.facets[0].cell == 0);
    CHECK(mesh.sides[static_cast<size_t>(mesh.facets[0].side)] == "base");
    CHECK(mesh.facets[1].node_a == 100);
    CHECK(mesh.facets[1].cell == 99);
    CHECK(mesh.sides[static_cast<size_t>(mesh.facets[1].side)] == "surface");
}

TEST_CASE("boundaries between a column's layers fall on cell boundaries") {
    const Mesh mesh = build_mesh(column_scene(2, 10, {{"sand", 2}, {"clay", 1.25}, {"sand", 0.31}}));
    REQUIRE(mesh.cell_count() == 10);
    CHECK(std::count(mesh.position.begin(), mesh.position.end(), 1.25) == 1);
    CHECK(std::count(mesh.position.begin(), mesh.position.end(), 0.31) == 1);
    for (size_t cell = 0; cell < 10; ++cell) {
        const double middle = (mesh.position[cell] + mesh.position[cell + 1]) / 2;
        const int32_t expected = middle < 1.25 && middle > 0.31 ? 1 : 0;
        CHECK(mesh.cell_soil[cell] == expected);
        CHECK(mesh.position[cell + 1] - mesh.position[cell] == doctest::Approx(0.2).epsilon(0.3));
    }
}

TEST_CASE("a column's layer as thin as a cell gets one, a thinner one is refused by name") {
    CHECK(build_mesh(column_scene(1, 10, {{"sand", 1}, {"clay", 0.55}, {"sand", 0.45}})).cell_count() == 10);
    const std::string message = build_failure(column_scene(1, 10, {{"sand", 1}, {"clay", 0.55}, {"sand", 0.47}}));
    CHECK(mentions(message, "ground.column.layers[1]"));
    CHECK(mentions(message, "0.08 m thick"));
    CHECK(mentions(build_failure(column_scene(1, 10, {{"sand", 1}, {"clay", 1.2}})), "ground.column.layers[0]"));
}

TEST_CASE("a column's unknown soil is named with those that exist") {
    const std::string message = build_failure(column_scene(1, 10, {{"sand", 1}, {"peat", 0.5}}));
    CHECK(mentions(message, "ground.column.layers[1].soil: no soil is called 'peat'"));
    CHECK(mentions(message, "sand, clay"));
}
