// What validate() lets pass, and what only a host that fills the structs can do wrong. The table of wrong scenes
// (test_scene_wrong.cpp) has the rest.
#include "error.hpp"
#include "scene/read.hpp"
#include "scene/validate.hpp"
#include "unit/scene_files.hpp"

#include <doctest/doctest.h>
#include <limits>

namespace {

using namespace talus;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

Scene sample(const std::string& name) { return read_json(sample_text(name)); }

std::string joined_problems(const Scene& scene) {
    std::string text;
    for (const std::string& problem : problems(scene)) text += (text.empty() ? "" : "\n") + problem;
    return text;
}

/// The sample with a change is still sound.
template <typename Change>
void check_sound(const std::string& name, Change change) {
    Scene scene = sample(name);
    change(scene);
    CHECK(joined_problems(scene) == "");
}

template <typename Change>
void check_problem(const std::string& name, const std::string& expected, Change change) {
    Scene scene = sample(name);
    change(scene);
    CHECK(joined_problems(scene) == expected);
}

TEST_CASE("the samples are sound") {
    for (const char* name : {"column", "column_constant_k", "slope", "slope_failure", "slope_gentle"}) {
        CHECK(joined_problems(sample(name)) == "");
        CHECK_NOTHROW(validate(sample(name)));
    }
}

TEST_CASE("all problems are said at once") {
    Scene scene = sample("slope");
    scene.soils[0].porosity = 40;
    scene.soils[0].solid.young_modulus = 0;
    scene.boundaries[1].side = "west";
    scene.schedule.step = unset;
    const std::string expected =
        "soils[0].porosity = 40: must be between 0.01 and 0.95 (did you mean percent?)\n"
        "soils[0].solid.youngModulus: is missing; mohrCoulomb needs it\n"
        "boundaries[1].side: 'west' is no side of this ground; must be one of base, left, right, surface\n"
        "schedule.step: is missing; a duration needs it";
    CHECK(joined_problems(scene) == expected);
    CHECK_THROWS_WITH_AS(validate(scene), expected.c_str(), Error);
}

TEST_CASE("soils and forcings of the extremes are sound") {
    for (const double n : {1.01, 1.03, 12.0})
        check_sound("slope", [=](Scene& s) { s.soils[0].hydraulics.retention.n = n; });
    for (const double alpha : {1e-4 / 1000, 10.0 / 1000}) {
        check_sound("slope", [=](Scene& s) { s.soils[0].hydraulics.retention.alpha = alpha; });
    }
    for (const double k : {1e-13, 1e-1}) {
        check_sound("slope", [=](Scene& s) { s.soils[0].hydraulics.conductivity = {.along = k, .across = k}; });
    }
    for (const double mm_per_hour : {0.0, 0.1, 1000.0}) {
        check_sound("slope", [=](Scene& s) { s.surface.zones[0].rate = {mm_per_hour * 1e-3 / 3600}; });
    }
    for (const double porosity : {0.05, 0.9}) check_sound("slope", [=](Scene& s) { s.soils[0].porosity = porosity; });
    for (const double nu : {0.0, 0.4999}) check_sound("slope", [=](Scene& s) { s.soils[0].solid.poisson_ratio = nu; });
    for (const double modulus : {1e5, 1e7 * 1e6})
        check_sound("slope", [=](Scene& s) { s.soils[0].solid.young_modulus = modulus; });
    for (const double phi : {1.0, 50.0}) {
        check_sound("slope", [=](Scene& s) {
            s.soils[0].solid.strength.friction_angle = s.soils[0].solid.dilation_angle = phi;
        });
    }
    for (const char* moving : {"column_explicit", "column_three_phase", "slope_run_out"}) {
        check_sound(moving, [](Scene& s) { s.soils[0].hydraulics.conductivity = {1e-4, 1e-6, -30}; });
    }
    check_sound("slope", [](Scene& s) { s.soils[0].solid.strength.cohesion = 0; });
    check_sound("slope", [](Scene& s) { s.soils[0].solid.strength.friction_angle = 0; });
    check_sound("slope", [](Scene& s) { s.soils[0].solid.tensile_strength = 0; });
    for (const double suction : {0.0, 1e9}) {
        check_sound("slope", [=](Scene& s) { s.initial = {.flow = InitialFlow::suction, .suction = suction}; });
    }
    check_sound("slope", [](Scene& s) { s.schedule = {.duration = 3.2e9, .step = 1e-6, .outputs = {1e9, 3.2e9}}; });
    check_sound("column", [](Scene& s) { s.ground.column.height = 1000; });
    check_sound("slope", [](Scene& s) {
        s.ground.section.terrain = {{0, 1000}, {1000, 100}};
        s.ground.section.base = {{0, 0}, {1000, 0}};
        s.boundaries.resize(3);
        s.probes.clear();
    });
}

TEST_CASE("a host's numbers that are none are named") {
    check_problem("slope", "gravity: is not a number", [](Scene& s) { s.gravity = not_a_number; });
    check_problem("slope", "surface.zones[0].rate[0]: is not a number",
                  [](Scene& s) { s.surface.zones[0].rate = {not_a_number}; });
    check_problem("slope", "boundaries[3].yTo: is not a number", [](Scene& s) { s.boundaries[3].y_to = not_a_number; });
    check_problem("slope", "soils[0].solid.tensileStrength: is not a number",
                  [](Scene& s) { s.soils[0].solid.tensile_strength = not_a_number; });
    check_problem("slope", "ground.section.growth = inf: must be between 1 and 4",
                  [](Scene& s) { s.ground.section.growth = infinite; });
    check_problem("slope", "soils[0].solid.youngModulus = inf Pa: must be between 20000 and 1e+15 Pa",
                  [](Scene& s) { s.soils[0].solid.young_modulus = infinite; });
    check_problem("column",
                  "schedule.outputs[4] = inf s: must be between 0 and 100000000000 s\n"
                  "schedule.outputs[4] = inf s: must be at most the duration, 600 s",
                  [](Scene& s) { s.schedule.outputs[4] = infinite; });
}

TEST_CASE("what a scene does not need may be left as the structs have it") {
    Scene dry = sample("slope");
    dry.physics.water = false;
    dry.soils[0].hydraulics = {};
    dry.boundaries.resize(3);
    dry.boundaries[0].has_flow = false;
    dry.surface = {};
    dry.initial = {};
    CHECK(joined_problems(dry) == "");

    Scene rigid = sample("column");
    rigid.soils[0].solid = {};
    rigid.schedule = {};
    rigid.surface.zones.clear();
    CHECK(joined_problems(rigid) == "");
}

TEST_CASE("layers may end between others") {
    check_sound("slope", [](Scene& s) {
        s.soils.push_back(s.soils[0]);
        s.soils[1].name = "lens";
        s.ground.section.layers = {{"soil", {}}, {"lens", {{0, 20}, {60, 5}}}, {"soil", {{0, 20}, {30, 5}, {60, 5}}}};
    });
}

TEST_CASE("boundaries and zones may touch") {
    check_sound("slope", [](Scene& s) {
        Boundary above;
        above.side = "left";
        above.y_from = s.boundaries[3].y_to;
        above.has_flow = true;
        s.boundaries.push_back(above);
        s.surface.zones.push_back(s.surface.zones[0]);
        s.surface.zones[0].x_to = s.surface.zones[1].x_from = 30;
        s.surface.zones[1].name = "downhill";
    });
}

TEST_CASE("a mesh's cells are checked") {
    Scene scene = sample("slope");
    scene.boundaries.resize(3);
    scene.probes.clear();
    scene.ground.kind = GroundKind::mesh;
    MeshGround& mesh = scene.ground.mesh;
    mesh.position = {0, 0, 1, 0, 1, 1, 0, 1, 2, 0};
    mesh.cell_start = {0, 4, 7};
    mesh.cell_nodes = {0, 1, 2, 3, 1, 4, 2};
    mesh.cell_soil = {0, 0};
    CHECK(joined_problems(scene) == "");
    std::swap(mesh.cell_nodes[4], mesh.cell_nodes[5]);
    CHECK(
        joined_problems(scene) ==
        "ground.mesh.cellNodes[4]: cell 1 is inverted or flat: its nodes must go counter-clockwise around a convex cell "
        "(twice the area at its worst corner is -1 m2)");
}

}  // namespace
