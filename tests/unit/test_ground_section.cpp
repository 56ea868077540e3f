#include "ground/edges.hpp"
#include "ground_scenes.hpp"

using namespace talus;

namespace {

/// Every edge belongs to one cell and is a facet, or to two that run along it in opposite directions.
void check_conforming(const Mesh& mesh) {
    const std::vector<Edge> edges = sorted_edges(mesh);
    size_t boundary = 0;
    for (size_t i = 0; i < edges.size();) {
        const bool shared = i + 1 < edges.size() && edges[i].joins_same_nodes(edges[i + 1]);
        if (shared) CHECK(edges[i].a == edges[i + 1].b);
        boundary += shared ? 0 : 1;
        i += shared ? 2 : 1;
    }
    CHECK(boundary == mesh.facets.size());
    for (const Facet& facet : mesh.facets) {
        const auto nodes = cell_nodes(mesh, facet.cell);
        const auto a = std::find(nodes.begin(), nodes.end(), facet.node_a);
        REQUIRE(a != nodes.end());
        CHECK(*(a + 1 == nodes.end() ? nodes.begin() : a + 1) == facet.node_b);
    }
}

}  // namespace

TEST_CASE("the slope's mesh has the polygon's area, sides and corners") {
    const Mesh mesh = build_mesh(slope_scene());
    CHECK(soil_area(mesh, -1) == doctest::Approx(1200).epsilon(1e-12));
    CHECK(mesh.sides == std::vector<std::string>{"base", "left", "right", "surface"});
    CHECK(side_length(mesh, "base") == doctest::Approx(60).epsilon(1e-12));
    CHECK(side_length(mesh, "left") == doctest::Approx(30).epsilon(1e-12));
    CHECK(side_length(mesh, "right") == doctest::Approx(10).epsilon(1e-12));
    CHECK(side_length(mesh, "surface") == doctest::Approx(40 + std::sqrt(800.)).epsilon(1e-12));
    check_conforming(mesh);
    for (int32_t cell = 0; cell < mesh.cell_count(); ++cell) CHECK(cell_nodes(mesh, cell).size() == 4);
    for (const double x : {0., 20., 40., 60.}) CHECK(elevations_at(mesh, x).size() == elevations_at(mesh, 7).size());
}

TEST_CASE("facets have the ground on their left") {
    const Mesh mesh = build_mesh(slope_scene());
    for (const Facet& facet : mesh.facets) {
        const Place a = node_place(mesh, facet.node_a);
        const Place b = node_place(mesh, facet.node_b);
        const Place normal = {b[1] - a[1], a[0] - b[0]};  // outward, by the contract
        if (facet.side == 0) CHECK(normal[1] < 0);
        if (facet.side == 1) CHECK(normal[0] < 0);
        if (facet.side == 2) CHECK(normal[0] > 0);
        if (facet.side == 3) CHECK(normal[1] > 0);
    }
}

TEST_CASE("upper rows keep their heights where the ground is deep enough, and deeper ones grow smoothly") {
    const Mesh mesh = build_mesh(slope_scene());
    for (int32_t column = 0; column <= 60; ++column) {
        const std::vector<double> y = elevations_at(mesh, column);
        REQUIRE(y.size() > 41);
        for (size_t row = 0; row < 40; ++row) CHECK(y[row] - y[row + 1] == doctest::Approx(0.15).epsilon(1e-9));
        for (size_t row = 40; row + 1 < y.size(); ++row) {
            const double ratio = (y[row] - y[row + 1]) / (y[row - 1] - y[row]);
            CHECK(ratio > 1 - 1e-9);
            CHECK(ratio < 1.3 + 1e-9);
            CHECK(y[row] - y[row + 1] < 1.5 + 1e-9);
        }
    }
}

TEST_CASE("without a growth heights are linear in the depth, on every mesh the same but for a factor") {
    const auto heights = [](double factor) {
        Scene scene = slope_scene();
        scene.ground.section.growth = 0;
        scene.ground.section.graded_depth = 0;
        scene.ground.section.surface_cell_height = 0.1 * factor;
        scene.ground.section.largest_cell_height = 2 * factor;
        const Mesh mesh = build_mesh(scene);
        check_conforming(mesh);
        return elevations_at(mesh, 0);
    };
    for (const double factor : {0.5, 1., 2.}) {
        const std::vector<double> y = heights(factor);
        for (size_t row = 0; row + 1 < y.size(); ++row) {
            const double middle = 30 - 0.5 * (y[row] + y[row + 1]);
            const double linear = factor * (0.1 + 1.9 * middle / 30);
            CHECK(y[row] - y[row + 1] < 1.1 * linear);
            CHECK(y[row] - y[row + 1] > 0.8 * linear);
        }
    }
}

TEST_CASE("where the ground is too thin for its rows they shrink in proportion") {
    Scene scene = slope_scene();
    scene.ground.section.terrain = {{0, 30}, {20, 30}, {40, 5}, {60, 5}};
    const Mesh mesh = build_mesh(scene);
    const std::vector<double> y = elevations_at(mesh, 50);
    for (size_t row = 0; row + 1 < y.size(); ++row) {
        CHECK(y[row] - y[row + 1] == doctest::Approx(5. / static_cast<double>(y.size() - 1)).epsilon(1e-9));
    }
    CHECK(soil_area(mesh, -1) == doctest::Approx(600 + 350 + 100).epsilon(1e-12));
}

TEST_CASE("grid lines stand at every vertex of terrain, base and layers, and no farther apart than asked") {
    Scene scene = slope_scene();
    SectionGround& section = scene.ground.section;
    section.column_width = 0.7;
    section.base = {{0, 0}, {33.3, -2}, {60, 0}};
    section.layers = {{"sand", {}}, {"clay", {{0, 20}, {25.1, 12}, {60, 6}}}};
    const Mesh mesh = build_mesh(scene);
    for (const double x : {0., 20., 25.1, 33.3, 40., 60.}) CHECK(!elevations_at(mesh, x).empty());
    std::vector<double> lines;
    for (const Facet& facet : mesh.facets) {
        if (facet.side == 0) lines.push_back(node_place(mesh, facet.node_b)[0] - node_place(mesh, facet.node_a)[0]);
    }
    CHECK(*std::max_element(lines.begin(), lines.end()) < 0.7 + 1e-9);
    CHECK(soil_area(mesh, -1) == doctest::Approx(1200 + 60).epsilon(1e-12));
    check_conforming(mesh);
}

TEST_CASE("cells conform to the layers") {
    Scene scene = slope_scene();
    scene.ground.section.layers = {{"sand", {}}, {"clay", {{0, 20}, {30, 8}, {60, 4}}}};
    const Mesh mesh = build_mesh(scene);
    const double clay = 30 * (20 + 8) / 2. + 30 * (8 + 4) / 2.;
    CHECK(soil_area(mesh, 1) == doctest::Approx(clay).epsilon(1e-12));
    CHECK(soil_area(mesh, 0) == doctest::Approx(1200 - clay).epsilon(1e-12));
    for (int32_t cell = 0; cell < mesh.cell_count(); ++cell) {
        for (const int32_t node : cell_nodes(mesh, cell)) {
            const Place place = node_place(mesh, node);
            const double top = place[0] < 30 ? 20 - 0.4 * place[0] : 8 - (place[0] - 30) * 4 / 30;
            if (mesh.cell_soil[static_cast<size_t>(cell)] == 1)
                CHECK(place[1] < top + 1e-9);
            else
                CHECK(place[1] > top - 1e-9);
        }
    }
    check_conforming(mesh);
}

TEST_CASE("no cell of a layered section is higher than the grading says for its depth") {
    Scene scene = slope_scene();
    SectionGround& section = scene.ground.section;
    section.layers = {{"sand", {}}, {"clay", {{0, 20}, {60, 5}}}};
    const Mesh mesh = build_mesh(scene);
    for (int32_t x = 0; x <= 60; ++x) {
        const std::vector<double> y = elevations_at(mesh, x);
        for (size_t row = 0; row + 1 < y.size(); ++row) {
            const double below = y.front() - y[row] - section.graded_depth;
            const double highest = below < -1e-9 ? 0.15 : std::min(1.5, 1.3 * 0.15 + 0.3 * std::max(0., below));
            CHECK(y[row] - y[row + 1] < highest + 1e-9);
        }
    }
}

TEST_CASE("a lens pinches out in triangles") {
    Scene scene = slope_scene();
    scene.ground.section.layers = {{"sand", {}},
                                   {"clay", {{0, 20}, {10, 20}, {20, 20}, {35, 5}, {60, 5}}},
                                   {"sand", {{0, 20}, {10, 20}, {20, 15}, {35, 5}, {60, 5}}}};
    const Mesh mesh = build_mesh(scene);
    CHECK(soil_area(mesh, -1) == doctest::Approx(1200).epsilon(1e-12));
    CHECK(soil_area(mesh, 1) == doctest::Approx(10 * 5 / 2. + 15 * 5 / 2.).epsilon(1e-12));
    bool triangles = false;
    for (int32_t cell = 0; cell < mesh.cell_count(); ++cell) triangles |= cell_nodes(mesh, cell).size() == 3;
    CHECK(triangles);
    check_conforming(mesh);
}

TEST_CASE("a layer may pinch out at the surface and at the base") {
    Scene scene = slope_scene();
    scene.ground.section.layers = {{"sand", {}}, {"clay", {{0, 0}, {20, 10}, {40, 10}, {60, 10}}}};
    const Mesh mesh = build_mesh(scene);
    CHECK(soil_area(mesh, 1) == doctest::Approx(100 + 200 + 200).epsilon(1e-12));
    CHECK(side_length(mesh, "surface") == doctest::Approx(40 + std::sqrt(800.)).epsilon(1e-12));
    CHECK(side_length(mesh, "base") == doctest::Approx(60).epsilon(1e-12));
    check_conforming(mesh);
}

TEST_CASE("a section at a map's coordinates has the mesh of the one at the origin") {
    Scene scene = slope_scene();
    const Mesh at_origin = build_mesh(scene);
    for (auto* profile : {&scene.ground.section.terrain, &scene.ground.section.base}) {
        for (Place& place : *profile) place = {place[0] + 4.5e6, place[1] + 2000};
    }
    const Mesh far = build_mesh(scene);
    CHECK(far.cell_nodes == at_origin.cell_nodes);
    CHECK(far.facets.size() == at_origin.facets.size());
    CHECK(side_length(far, "surface") == doctest::Approx(side_length(at_origin, "surface")).epsilon(1e-9));
}

TEST_CASE("crossing layers are refused with the place") {
    Scene scene = slope_scene();
    scene.ground.section.layers = {{"sand", {}}, {"clay", {{0, 20}, {60, 12}}}};
    const std::string message = build_failure(scene);
    CHECK(mentions(message, "ground.section.layers[1].top: at x = 35 m"));
    CHECK(mentions(message, "above the terrain"));

    scene.ground.section.layers = {{"sand", {}}, {"clay", {{0, 8}, {60, 4}}}, {"sand", {{0, 5}, {60, 5}}}};
    CHECK(mentions(build_failure(scene), "above the top of layers[1]"));

    scene = slope_scene();
    scene.ground.section.base = {{0, 0}, {50, 10.5}, {60, 0}};
    CHECK(mentions(build_failure(scene), "ground.section.base: at x = "));
    scene.ground.section.base = {{0, 0}, {50, 10}, {60, 0}};
    CHECK(mentions(build_failure(scene), "ground.section.base: at x = 50 m it meets the terrain"));
}

TEST_CASE("sections with too many cells are refused before they are made") {
    Scene scene = slope_scene();
    scene.ground.section.column_width = 1e-12;
    CHECK(mentions(build_failure(scene), "ground.section.columnWidth"));
    scene = slope_scene();
    scene.ground.section.surface_cell_height = 1e-12;
    CHECK(mentions(build_failure(scene), "ground.section.surfaceCellHeight"));
    scene = slope_scene();
    scene.ground.section.column_width = 1e-3;
    scene.ground.section.surface_cell_height = 1e-3;
    CHECK(mentions(build_failure(scene), "more than"));
}

namespace {

/// Widths of the columns between two places of the slope's surface.
std::vector<double> column_widths(const Mesh& mesh, double from, double to) {
    std::vector<double> x;
    for (const Facet& facet : mesh.facets) {
        if (mesh.sides[static_cast<size_t>(facet.side)] != "surface") continue;
        for (const int32_t node : {facet.node_a, facet.node_b})
            if (const double at = node_place(mesh, node)[0]; at > from - 1e-9 && at < to + 1e-9) x.push_back(at);
    }
    std::sort(x.begin(), x.end());
    x.erase(std::unique(x.begin(), x.end(), [](double a, double b) { return b - a < 1e-9; }), x.end());
    std::vector<double> widths;
    for (size_t i = 1; i < x.size(); ++i) widths.push_back(x[i] - x[i - 1]);
    return widths;
}

}  // namespace

TEST_CASE("columns are narrow beside the bends of the terrain and widen away from them") {
    Scene scene = slope_scene();
    scene.ground.section.column_width = 1.5;
    scene.ground.section.bend_column_width = 0.3;
    const Mesh mesh = build_mesh(scene);
    check_conforming(mesh);
    const double growth = scene.ground.section.growth;
    for (const auto& [from, to] : {std::array{0., 20.}, {20., 40.}, {40., 60.}}) {
        std::vector<double> widths = column_widths(mesh, from, to);
        if (from == 0) std::reverse(widths.begin(), widths.end());  // from the bend at 20 outwards
        REQUIRE(widths.size() > 10);
        // The first width is the mean over it of one that grows from bendColumnWidth on; whole numbers of columns make all a bit narrower.
        CHECK(widths.front() > 0.9 * 0.3);
        CHECK(widths.front() < growth * 0.3);
        for (size_t i = 0; i < widths.size(); ++i) {
            CHECK(widths[i] <= 1.5 * (1 + 1e-12));
            if (i > 0) CHECK(widths[i] <= growth * widths[i - 1] * (1 + 1e-9));
        }
        CHECK(*std::max_element(widths.begin(), widths.end()) > 1.2);
        if (from == 20) {
            for (size_t i = 0; i < widths.size(); ++i)
                CHECK(widths[i] == doctest::Approx(widths[widths.size() - 1 - i]).epsilon(1e-9));
        }
    }
}

TEST_CASE("without a growth columns widen evenly to where bends are farthest") {
    Scene scene = slope_scene();
    scene.ground.section.growth = 0;
    scene.ground.section.column_width = 2;
    scene.ground.section.bend_column_width = 0.4;
    const Mesh mesh = build_mesh(scene);
    check_conforming(mesh);
    double from_bend = 0;
    for (const double width : column_widths(mesh, 40, 60)) {
        CHECK(width == doctest::Approx(0.4 + 1.6 * (from_bend + width / 2) / 20).epsilon(0.06));
        from_bend += width;
    }
    for (const double width : column_widths(mesh, 20, 40)) CHECK(width < 0.4 + 1.6 / 2 + 1e-9);
}

TEST_CASE("without a width at the bends, or with the columns' own, columns are equal") {
    Scene scene = slope_scene();
    const Mesh plain = build_mesh(scene);
    scene.ground.section.bend_column_width = scene.ground.section.column_width;
    CHECK(build_mesh(scene).position == plain.position);
    for (const double width : column_widths(plain, 0, 60)) CHECK(width == doctest::Approx(1).epsilon(1e-9));
}
