// Meshes given as arrays: what is accepted, how their sides are found, and what is refused.
#include "ground_scenes.hpp"

#include <limits>

using namespace talus;

namespace {

/// Two quads beside each other and a triangle on the right one.
Scene array_scene() {
    Scene scene = scene_with_soils({"sand", "clay"});
    scene.ground.kind = GroundKind::mesh;
    scene.ground.mesh.position = {0, 0, 1, 0, 2, 0, 0, 1, 1, 1, 2, 1, 2, 2};
    scene.ground.mesh.cell_start = {0, 4, 8, 11};
    scene.ground.mesh.cell_nodes = {0, 1, 4, 3, 1, 2, 5, 4, 4, 5, 6};
    scene.ground.mesh.cell_soil = {0, 1, 1};
    return scene;
}

/// Squares of side 1 in a grid, those left out that `keep` says no to.
template <class Keep>
Scene grid_scene(int32_t width, int32_t height, Keep keep) {
    Scene scene = scene_with_soils({"sand"});
    scene.ground.kind = GroundKind::mesh;
    MeshGround& mesh = scene.ground.mesh;
    mesh.cell_start = {0};
    std::vector<int32_t> number(static_cast<size_t>((width + 1) * (height + 1)), -1);
    const auto node = [&](int32_t x, int32_t y) {
        int32_t& n = number[static_cast<size_t>(y * (width + 1) + x)];
        if (n < 0) {
            n = static_cast<int32_t>(mesh.position.size() / 2);
            mesh.position.insert(mesh.position.end(), {static_cast<double>(x), static_cast<double>(y)});
        }
        return n;
    };
    for (int32_t y = 0; y < height; ++y) {
        for (int32_t x = 0; x < width; ++x) {
            if (!keep(x, y)) continue;
            for (const int32_t n : {node(x, y), node(x + 1, y), node(x + 1, y + 1), node(x, y + 1)})
                mesh.cell_nodes.push_back(n);
            mesh.cell_start.push_back(static_cast<int32_t>(mesh.cell_nodes.size()));
            mesh.cell_soil.push_back(0);
        }
    }
    return scene;
}

}  // namespace

TEST_CASE("arrays become the mesh as they are, with sides") {
    const Scene scene = array_scene();
    const Mesh mesh = build_mesh(scene);
    CHECK(mesh.position == scene.ground.mesh.position);
    CHECK(mesh.cell_nodes == scene.ground.mesh.cell_nodes);
    CHECK(mesh.cell_soil == scene.ground.mesh.cell_soil);
    CHECK(mesh.facets.size() == 7);
    CHECK(side_length(mesh, "base") == doctest::Approx(2));
    CHECK(side_length(mesh, "left") == doctest::Approx(1));
    CHECK(side_length(mesh, "right") == doctest::Approx(2));
    CHECK(side_length(mesh, "surface") == doctest::Approx(1 + std::sqrt(2.)));
}

TEST_CASE("steps of the bedrock are base, cliffs and overhangs are surface") {
    // Bedrock one step up from x = 2; the ground two high on the left, with an overhang to x = 3, and one high on the
    // right.
    const auto keep = [](int32_t x, int32_t y) {
        if (x < 2) return true;
        return (x == 2 && (y == 1 || y == 3)) || (x > 2 && y == 1);
    };
    const Mesh mesh = build_mesh(grid_scene(5, 4, keep));
    CHECK(side_length(mesh, "base") == doctest::Approx(2 + 1 + 3));
    CHECK(side_length(mesh, "left") == doctest::Approx(4));
    CHECK(side_length(mesh, "right") == doctest::Approx(1));
    CHECK(side_length(mesh, "surface") == doctest::Approx(3 + 1 + 1 + 1 + 3));
    CHECK(mesh.sides.size() == 4);
}

TEST_CASE("a hole has a side of its own") {
    const Mesh mesh = build_mesh(grid_scene(3, 3, [](int32_t x, int32_t y) { return x != 1 || y != 1; }));
    CHECK(mesh.sides == std::vector<std::string>{"base", "left", "right", "surface", "hole"});
    CHECK(side_length(mesh, "hole") == doctest::Approx(4));
    for (const char* side : {"base", "left", "right", "surface"}) CHECK(side_length(mesh, side) == doctest::Approx(3));
}

TEST_CASE("ground that ends in points has no left and right side") {
    Scene scene = scene_with_soils({"sand"});
    scene.ground.kind = GroundKind::mesh;
    scene.ground.mesh = {"", {0, 0, 1, -1, 2, 0, 1, 1}, {0, 4}, {1, 2, 3, 0}, {0}};
    const Mesh mesh = build_mesh(scene);
    CHECK(side_length(mesh, "base") == doctest::Approx(2 * std::sqrt(2.)));
    CHECK(side_length(mesh, "surface") == doctest::Approx(2 * std::sqrt(2.)));
    CHECK(side_length(mesh, "left") + side_length(mesh, "right") == 0);
}

TEST_CASE("wrong arrays are refused, naming cell or node and place") {
    const auto failure = [](auto change) {
        Scene scene = array_scene();
        change(scene.ground.mesh);
        const std::string message = build_failure(scene);
        CHECK(mentions(message, "ground.mesh"));
        return message;
    };
    using M = MeshGround;
    CHECK(mentions(failure([](M& m) { m = {}; }), "no cells"));
    CHECK(mentions(failure([](M& m) { m.position.pop_back(); }), "13 numbers"));
    CHECK(mentions(failure([](M& m) { m.cell_start.pop_back(); }), "cell_start has 3 entries"));
    CHECK(mentions(failure([](M& m) { m.cell_start.back() = 10; }), "end with the number of cell_nodes, 11"));
    CHECK(mentions(failure([](M& m) { m.cell_start[1] = 9; }), "cell 0 has 9 nodes"));
    CHECK(mentions(failure([](M& m) { m.cell_start[1] = 2; }), "cell 0 has 2 nodes"));
    CHECK(mentions(failure([](M& m) { m.cell_start[1] = -2000000000; }), "cell 0 has"));
    CHECK(mentions(failure([](M& m) { m.cell_start = {0, 4, 2000000000, 11}; }), "cell 1 has"));
    CHECK(mentions(failure([](M& m) { m.cell_nodes[5] = 7; }), "cell 1 has node 7; nodes are 0 to 6"));
    CHECK(mentions(failure([](M& m) { m.cell_nodes[5] = -1; }), "cell 1 has node -1"));
    CHECK(mentions(failure([](M& m) { m.cell_nodes[5] = 1; }), "cell 1 has node 1 twice"));
    CHECK(mentions(failure([](M& m) { m.cell_soil[2] = -1; }), "cell 2 has soil -1"));
    CHECK(mentions(failure([](M& m) { m.cell_soil[2] = 2; }),
                   "ground.mesh.cellSoil[2]: is 2; the scene's soils are numbered 0 to 1"));
    CHECK(mentions(failure([](M& m) { m.position[4] = std::numeric_limits<double>::quiet_NaN(); }),
                   "node 2 has a place that is not a finite number"));
    CHECK(mentions(failure([](M& m) {
                       m.position.insert(m.position.end(), {5, 5});
                   }),
                   "node 7 at (5, 5) m belongs to no cell"));
    CHECK(mentions(failure([](M& m) { std::reverse(m.cell_nodes.begin() + 4, m.cell_nodes.begin() + 8); }),
                   "cell 1 at (1.5, 0.5) m is inverted"));
    CHECK(mentions(failure([](M& m) { std::swap(m.cell_nodes[5], m.cell_nodes[6]); }),
                   "cell 1 at (1.5, 0.5) m is inverted, folded or not convex"));
    CHECK(mentions(failure([](M& m) { m.position[10] = 1.4, m.position[11] = 0.4; }), "cell 1 at"));
    CHECK(mentions(failure([](M& m) {
                       m.position[13] = 1;
                       m.position[12] = 3;
                   }),
                   "cell 2 at (2, 1) m is flat"));
}

TEST_CASE("meshes that hang together wrongly are refused") {
    const auto all = [](int32_t, int32_t) { return true; };
    CHECK(mentions(build_failure(grid_scene(3, 1, [](int32_t x, int32_t) { return x != 1; })), "several pieces"));
    CHECK(mentions(build_failure(grid_scene(2, 2, [](int32_t x, int32_t y) { return x == y; })),
                   "two parts of the boundary touch in node 2 at (1, 1) m"));

    Scene fan = grid_scene(1, 1, all);
    fan.ground.mesh = {"", {0, 0, 1, 0, 0, 1, 1, -1, 1, 1}, {0, 3, 6, 9}, {0, 1, 2, 1, 0, 3, 0, 1, 4}, {0, 0, 0}};
    CHECK(mentions(build_failure(fan), "3 cells share the edge from node 0 at (0, 0) m to node 1 at (1, 0) m"));

    Scene same_side = grid_scene(1, 1, all);
    same_side.ground.mesh = {"", {0, 0, 1, 0, 1, 1, 0.5, 2}, {0, 3, 6}, {0, 1, 2, 0, 1, 3}, {0, 0}};
    CHECK(mentions(build_failure(same_side), "lie on the same side of the edge from node 0"));

    Scene crack = grid_scene(1, 1, all);
    crack.ground.mesh = {
        "", {0, 0, 1, 0, 1, 1, 0, 1, 1, 1e-12, 2, 0, 2, 1}, {0, 4, 8}, {0, 1, 2, 3, 4, 5, 6, 2}, {0, 0}};
    CHECK(mentions(build_failure(crack), "node 4 at (1, 1e-12) m is at the same place as node 1"));
}
