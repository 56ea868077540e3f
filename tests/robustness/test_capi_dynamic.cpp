// Dynamic ground through the C API: what hosts see of it, and steps that are undone to the last bit.
#include "capi_host.hpp"

#include <cmath>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

namespace {

/// A heap of dry sand that falls down and spreads over a base with friction, to the right of a wall.
const char* const heap_text = R"({
    "name": "heap",
    "physics": {"water": false, "regime": "dynamic"},
    "soils": [{"name": "sand", "dryDensity": 1560, "porosity": 0.4,
               "solid": {"youngModulus": 2e6, "poissonRatio": 0.3,
                         "strength": {"model": "constant", "cohesion": 0, "frictionAngle": 31}}}],
    "ground": {"section": {"terrain": [[0, 0.2], [0.1, 0.2]], "base": [[0, 0], [0.1, 0]], "layers": [{"soil": "sand"}],
                           "columnWidth": 0.02, "surfaceCellHeight": 0.02, "growth": 1, "largestCellHeight": 0.02}},
    "boundaries": [{"side": "base", "motion": "friction", "frictionAngle": 31}, {"side": "left", "motion": "roller"}],
    "initial": {"stress": "k0", "k0": 0.5},
    "dynamics": {"cellSize": 0.01},
    "probes": [{"name": "corner", "place": [0.0975, 0.1975]}]
})";

/// A slope of dry clay whose face crosses the grid at an angle; it stands.
const char* const slope_text = R"({
    "name": "slope",
    "physics": {"water": false, "regime": "dynamic"},
    "soils": [{"name": "clay", "dryDensity": 1800, "porosity": 0.4,
               "solid": {"youngModulus": 5e6, "poissonRatio": 0.3,
                         "strength": {"model": "constant", "cohesion": 12e3, "frictionAngle": 30}}}],
    "ground": {"section": {"terrain": [[0, 7], [6, 7], [11, 2], [16.2, 2]], "base": [[0, 0], [16.2, 0]],
                           "layers": [{"soil": "clay"}], "columnWidth": 0.5, "surfaceCellHeight": 0.5, "growth": 1,
                           "largestCellHeight": 0.5}},
    "boundaries": [{"side": "base", "motion": "fixed"}, {"side": "left", "motion": "roller"},
                   {"side": "right", "motion": "roller"}],
    "dynamics": {"cellSize": 0.5}
})";

/// A bank of wet soil that stands in the rain, its water table below the toe.
const char* const wet_text = R"({
    "name": "wet",
    "physics": {"regime": "dynamic"},
    "water": {"bulkModulus": 1e8},
    "soils": [{"name": "soil", "dryDensity": 1800, "porosity": 0.4,
               "hydraulics": {"retention": {"model": "vanGenuchten", "alpha": 4e-05, "n": 1.2},
                              "conductivity": {"along": 1e-04}},
               "solid": {"youngModulus": 10e6, "poissonRatio": 0.3,
                         "strength": {"model": "vanapalli", "cohesion": 12e3, "frictionAngle": 30}}}],
    "ground": {"section": {"terrain": [[0, 6], [4, 6], [10, 3], [14, 3]], "base": [[0, 0], [14, 0]],
                           "layers": [{"soil": "soil"}], "columnWidth": 0.5, "surfaceCellHeight": 0.5, "growth": 1,
                           "largestCellHeight": 0.5}},
    "boundaries": [{"side": "base", "motion": "fixed"}, {"side": "left", "motion": "roller"},
                   {"side": "right", "motion": "roller"}],
    "surface": {"zones": [{"name": "rain", "time": [0, 0.2], "rate": [1e-4, 0]}]},
    "initial": {"flow": "hydrostatic", "waterTable": 2},
    "dynamics": {"cellSize": 0.5},
    "probes": [{"name": "A", "place": [5, 4]}]
})";

/// A steep bank that stands by its suction, until rain takes it.
const char* const failing_text = R"({
    "name": "failing",
    "physics": {"regime": "auto"},
    "water": {"bulkModulus": 1e7},
    "soils": [{"name": "soil", "dryDensity": 1800, "porosity": 0.4,
               "hydraulics": {"retention": {"model": "vanGenuchten", "alpha": 4e-04, "n": 2},
                              "conductivity": {"along": 1e-04}},
               "solid": {"youngModulus": 10e6, "poissonRatio": 0.3,
                         "strength": {"cohesion": 500, "frictionAngle": 30},
                         "softening": {"residualCohesion": 0, "residualFrictionAngle": 15, "slip": 0.05}}}],
    "ground": {"section": {"terrain": [[0, 4], [3, 4], [6, 1], [12, 1]], "base": [[0, 0], [12, 0]],
                           "layers": [{"soil": "soil"}], "columnWidth": 0.5, "surfaceCellHeight": 0.4, "growth": 1,
                           "largestCellHeight": 0.5}},
    "boundaries": [{"side": "base", "motion": "fixed"}, {"side": "left", "motion": "roller"},
                   {"side": "right", "motion": "roller"}],
    "surface": {"zones": [{"name": "rain", "time": [0], "rate": [3e-5]}]},
    "initial": {"flow": "suction", "suction": 2e4},
    "dynamics": {"cellSize": 0.5},
    "numerics": {"tolerance": 0.1},
    "probes": [{"name": "A", "place": [3.5, 3]}]
})";

std::vector<double> read(const host::Engine& engine, const char* field) {
    const talus_field shape = host::view(engine, field);
    std::vector<double> values(static_cast<size_t>(shape.shape[0] * (shape.rank == 2 ? shape.shape[1] : 1)));
    REQUIRE(talus_engine_read(engine.get(), field, static_cast<int64_t>(values.size()), values.data()) == TALUS_OK);
    return values;
}

/// Cancels at the given call.
struct Impatient {
    int calls = 0;
    int limit = 0;
    static int32_t progress(void* user, double) {
        auto* self = static_cast<Impatient*>(user);
        return ++self->calls == self->limit ? 1 : 0;
    }
};

/// An engine after two steps, the second of which (s) was cancelled first: its fields are those of a twin that was left alone, and it has its water.
host::Engine undone_and_done_again(const std::string& text, double second, std::initializer_list<const char*> fields,
                                   Impatient& impatient) {
    talus_options options = TALUS_OPTIONS_INIT;
    options.progress = Impatient::progress;
    options.progress_user = &impatient;
    host::Engine engine = host::engine(text.c_str(), &options);
    const host::Engine twin = host::engine(text.c_str());
    talus_step_report report = TALUS_STEP_REPORT_INIT, plain = TALUS_STEP_REPORT_INIT;
    REQUIRE(talus_engine_step(engine.get(), 0.1, &report) == TALUS_OK);
    impatient.limit = impatient.calls + 3;
    CHECK(talus_engine_step(engine.get(), second, &report) == TALUS_CANCELLED);
    REQUIRE(talus_engine_step(engine.get(), second, &report) == TALUS_OK);
    REQUIRE(talus_engine_step(twin.get(), 0.1, &plain) == TALUS_OK);
    REQUIRE(talus_engine_step(twin.get(), second, &plain) == TALUS_OK);
    for (const char* field : fields) CHECK(read(engine, field) == read(twin, field));
    CHECK(std::abs(report.water_residual) < 1e-12 * report.water_stored);
    return engine;
}

}  // namespace

TEST_CASE("C API: a heap falls, spreads, and comes to rest, and its energy goes into friction") {
    const host::Engine engine = host::engine(heap_text);
    talus_step_report report = TALUS_STEP_REPORT_INIT;
    REQUIRE(talus_engine_report(engine.get(), &report) == TALUS_OK);
    CHECK(report.regime == TALUS_DYNAMIC);
    const double weight = 1560 * 9.81 * 0.02;
    CHECK(report.potential_energy == doctest::Approx(weight * 0.1).epsilon(1e-12));
    CHECK(report.kinetic_energy == 0);
    CHECK(report.dissipated_energy == 0);
    CHECK(report.run_out == 0);
    const double start = report.potential_energy + report.elastic_energy;

    REQUIRE(talus_engine_step(engine.get(), 0.15, &report) == TALUS_OK);
    CHECK(report.motion_substeps > 100);
    CHECK(report.peak_velocity > 0.3);
    CHECK(report.peak_velocity >= report.largest_velocity);
    CHECK(report.run_out > 0.01);

    REQUIRE(talus_engine_step(engine.get(), 1.85, &report) == TALUS_OK);
    CHECK(report.time == 2);
    CHECK(report.largest_velocity < 0.02);
    CHECK(report.kinetic_energy < 1e-4 * start);
    CHECK(report.run_out > 0.1);
    CHECK(report.run_out < 0.4);
    CHECK(report.front_x == doctest::Approx(0.0975 + report.run_out).epsilon(1e-6));
    CHECK(report.sliding_volume > 0.005);
    CHECK(report.sliding_volume < 0.03);
    CHECK(report.dissipated_energy > 0.3 * start);
    const double rest = report.kinetic_energy + report.elastic_energy + report.potential_energy;
    CHECK(rest + report.dissipated_energy == doctest::Approx(start).epsilon(1e-12));
}

TEST_CASE("C API: a dynamic step that was cancelled is undone to the last bit, and what follows is the same") {
    Impatient impatient;
    talus_options options = TALUS_OPTIONS_INIT;
    options.progress = Impatient::progress;
    options.progress_user = &impatient;
    const host::Engine engine = host::engine(heap_text, &options);
    const host::Engine undisturbed = host::engine(heap_text);
    for (const host::Engine* each : {&engine, &undisturbed})
        REQUIRE(talus_engine_step(each->get(), 0.1, nullptr) == TALUS_OK);
    const int64_t before = host::hash(engine);
    CHECK(before == host::hash(undisturbed));
    impatient.limit = impatient.calls + 12;  // far enough for points to be arranged anew and for the grid to grow
    CHECK(talus_engine_step(engine.get(), 1.0, nullptr) == TALUS_CANCELLED);
    CHECK(impatient.calls == impatient.limit);
    CHECK(host::hash(engine) == before);
    CHECK(talus_engine_time(engine.get()) == 0.1);
    for (const host::Engine* each : {&engine, &undisturbed})
        REQUIRE(talus_engine_step(each->get(), 0.3, nullptr) == TALUS_OK);
    CHECK(host::hash(engine) != before);
    CHECK(host::hash(engine) == host::hash(undisturbed));
}

TEST_CASE("C API: a dynamic ground moves the same with one thread and with two") {
    talus_options options = TALUS_OPTIONS_INIT;
    const host::Engine one = host::engine(heap_text, &options);
    options.threads = 2;
    const host::Engine two = host::engine(heap_text, &options);
    for (const double dt : {0.1, 0.2, 0.05}) {
        REQUIRE(talus_engine_step(one.get(), dt, nullptr) == TALUS_OK);
        REQUIRE(talus_engine_step(two.get(), dt, nullptr) == TALUS_OK);
        CHECK(host::hash(one) == host::hash(two));
    }
    talus_engine* none = nullptr;
    for (const int32_t threads : {-1, 100000}) {
        options.threads = threads;
        CHECK(talus_engine_create(host::scene(heap_text).get(), &options, &none) == TALUS_INVALID_ARGUMENT);
        CHECK(host::contains(talus_last_error(), "options.threads"));
    }
}

TEST_CASE("C API: a dynamic ground has fields of its points, in an order that does not change") {
    const host::Engine engine = host::engine(heap_text);
    const std::vector<double> start = read(engine, "point_position");
    REQUIRE(start.size() == 2 * 800);
    CHECK(host::view(engine, "point_position").location == TALUS_POINT);
    REQUIRE(talus_engine_step(engine.get(), 0.3, nullptr) == TALUS_OK);
    const std::vector<double> position = read(engine, "point_position"), displacement = read(engine, "displacement");
    for (size_t i = 0; i < start.size(); ++i)
        CHECK(position[i] - start[i] == doctest::Approx(displacement[i]).epsilon(1e-12));
    CHECK(read(engine, "point_soil") == std::vector<double>(800, 0.0));
    for (const double share : read(engine, "mobilised_strength")) {
        CHECK(share >= 0);
        CHECK(share <= 1);
    }
    talus_field field = TALUS_FIELD_INIT;
    for (const char* name : {"node_position", "pressure", "cell_nodes", "strain", "colour"}) {
        CHECK(talus_engine_view(engine.get(), name, &field) == TALUS_UNKNOWN_NAME);
        CHECK(host::contains(talus_engine_error(engine.get()), name));
    }
}

TEST_CASE("C API: places of a dynamic ground have the value of the nearest point, within a cell") {
    const host::Engine engine = host::engine(heap_text);
    REQUIRE(talus_engine_step(engine.get(), 0.3, nullptr) == TALUS_OK);
    const std::vector<double> position = read(engine, "point_position"), velocity = read(engine, "velocity");
    const std::vector<double> places{position[200] + 1e-5, position[201], 0.05, 5.0, std::nan(""), 0.0};
    std::vector<double> values(6, 0.0);
    CHECK(talus_engine_sample(engine.get(), "velocity", 3, places.data(), values.data()) == TALUS_OUTSIDE);
    CHECK(values[0] == velocity[200]);
    CHECK(values[1] == velocity[201]);
    for (size_t k = 2; k < 6; ++k) CHECK(std::isnan(values[k]));
}

TEST_CASE("C API: a probe follows the point that was nearest at the start") {
    const host::Engine engine = host::engine(heap_text);
    REQUIRE(talus_engine_step(engine.get(), 0.2, nullptr) == TALUS_OK);
    talus_history history = TALUS_HISTORY_INIT;
    REQUIRE(talus_engine_probe_history(engine.get(), 0, "displacement.y", &history) == TALUS_OK);
    REQUIRE(history.count == 2);
    CHECK(history.value[0] == 0);
    const std::vector<double> displacement = read(engine, "displacement");
    CHECK(history.value[1] == displacement[2 * 799 + 1]);  // the last point is the one in the upper right corner
    CHECK(history.value[1] < -0.05);
    CHECK(talus_engine_add_probe(engine.get(), "far", 5, 5, nullptr) == TALUS_INVALID_ARGUMENT);
    CHECK(talus_engine_add_probe(engine.get(), "near", 0.005, 0.005, nullptr) == TALUS_OK);
}

TEST_CASE("C API: a step of any length does what the motion needs, or is refused and changes nothing") {
    const host::Engine engine = host::engine(heap_text);
    talus_step_report report = TALUS_STEP_REPORT_INIT;
    REQUIRE(talus_engine_step(engine.get(), 1e-9, &report) == TALUS_OK);
    CHECK(report.motion_substeps == 1);
    REQUIRE(talus_engine_advance_to(engine.get(), 0.01, &report) == TALUS_OK);
    CHECK(talus_engine_time(engine.get()) == 0.01);
    const int64_t before = host::hash(engine);
    CHECK(talus_engine_step(engine.get(), 1e-19, nullptr) == TALUS_INVALID_ARGUMENT);
    CHECK(host::hash(engine) == before);
}

TEST_CASE("C API: a dynamic ground that does not stand may start from an elastic stress, not from equilibrium") {
    std::string text = heap_text;
    const std::string k0 = R"("stress": "k0", "k0": 0.5)";
    const size_t at = text.find(k0);
    REQUIRE(at != std::string::npos);
    talus_scene* scene = nullptr;
    talus_engine* engine = nullptr;
    REQUIRE(talus_scene_from_json(text.replace(at, k0.size(), R"("stress": "gravity")").c_str(), -1, &scene) ==
            TALUS_OK);
    CHECK(talus_engine_create(scene, nullptr, &engine) == TALUS_INVALID_SCENE);
    CHECK(host::contains(talus_last_error(), "a dynamic ground may start from elastic, k0 or zero"));
    talus_scene_release(scene);
    text = heap_text;
    const host::Engine elastic = host::engine(text.replace(at, k0.size(), R"("stress": "elastic")").c_str());
    REQUIRE(talus_engine_step(elastic.get(), 0.1, nullptr) == TALUS_OK);
}

TEST_CASE("C API: a slope that stands in equilibrium stands in motion too") {
    const host::Engine engine = host::engine(slope_text);
    const char* description = nullptr;
    REQUIRE(talus_engine_describe(engine.get(), &description) == TALUS_OK);
    CHECK(host::contains(description, R"("regime":"dynamic")"));
    CHECK(host::contains(description, R"("cell_size":0.490909090909)"));  // 33 cells between the walls
    talus_step_report report = TALUS_STEP_REPORT_INIT;
    REQUIRE(talus_engine_step(engine.get(), 1, &report) == TALUS_OK);
    CHECK(report.peak_velocity < 0.05);          // without its stress it would fall at 1 m/s
    CHECK(report.largest_displacement < 0.002);  // and settle by 70 mm
    CHECK(report.sliding_volume == 0);
    for (const double strain : read(engine, "plastic_strain")) CHECK(strain < 1e-3);
}

TEST_CASE("C API: the bonds of a column of clay break with slip, and it falls where it would have stood") {
    std::string text = heap_text;
    const std::string strength = R"("cohesion": 0, "frictionAngle": 31})";
    const size_t at = text.find(strength);
    REQUIRE(at != std::string::npos);
    const auto run_out = [&](const std::string& clay) {
        std::string changed = text;
        const host::Engine engine = host::engine(changed.replace(at, strength.size(), clay).c_str());
        talus_step_report report = TALUS_STEP_REPORT_INIT;
        REQUIRE(talus_engine_step(engine.get(), 1, &report) == TALUS_OK);
        return report.run_out;
    };
    const std::string bonds = R"("cohesion": 600, "frictionAngle": 20})";
    const double standing = run_out(bonds);
    const double breaking =
        run_out(bonds + R"(, "softening": {"residualCohesion": 0, "residualFrictionAngle": 15, "slip": 0.001})");
    CHECK(standing == 0);
    CHECK(breaking > 0.2);
}

TEST_CASE("C API: ground that is too soft for its weight ends the step, which is undone to the last bit") {
    std::string text = heap_text;
    const std::string stiffness = R"("youngModulus": 2e6)";
    const size_t at = text.find(stiffness);
    REQUIRE(at != std::string::npos);
    text.replace(at, stiffness.size(), R"("youngModulus": 2e4)");
    text.insert(text.find(R"("soils")"), R"("gravity": 300, )");
    const std::string k0 = R"("stress": "k0", "k0": 0.5)";
    text.replace(text.find(k0), k0.size(), R"("stress": "zero")");
    const host::Engine engine = host::engine(text.c_str());
    REQUIRE(talus_engine_step(engine.get(), 1e-3, nullptr) == TALUS_OK);
    const int64_t before = host::hash(engine);
    for (int tries = 0; tries < 2; ++tries) {
        CHECK(talus_engine_step(engine.get(), 1, nullptr) == TALUS_NOT_CONVERGED);
        CHECK(host::contains(talus_engine_error(engine.get()), "pressed to less than the volume of its grains"));
        CHECK(host::contains(talus_engine_error(engine.get()), "t = 0.0"));
        CHECK(host::hash(engine) == before);
        CHECK(talus_engine_time(engine.get()) == 1e-3);
    }
    CHECK(talus_engine_step(engine.get(), 1e-3, nullptr) == TALUS_OK);
}

TEST_CASE("C API: sand that dilates becomes lighter and is still followed") {
    std::string text = heap_text;
    const std::string angle = R"("frictionAngle": 31}})";
    const size_t at = text.find(angle);
    REQUIRE(at != std::string::npos);
    text.replace(at, angle.size(), R"("frictionAngle": 31}, "dilationAngle": 31})");
    const std::string size = R"("cellSize": 0.01)";
    text.replace(text.find(size), size.size(), R"("cellSize": 0.02)");
    const host::Engine engine = host::engine(text.c_str());
    talus_step_report report = TALUS_STEP_REPORT_INIT;
    REQUIRE_MESSAGE(talus_engine_step(engine.get(), 1, &report) == TALUS_OK, talus_engine_error(engine.get()));
    CHECK(report.dissipated_energy > 0);
    CHECK(report.peak_velocity < 4);  // sqrt(2 g h) is 2
}

TEST_CASE("C API: wet ground in motion takes the rain, loses no water, and an undone step leaves no trace") {
    Impatient impatient;
    talus_options options = TALUS_OPTIONS_INIT;
    options.progress = Impatient::progress;
    options.progress_user = &impatient;
    const host::Engine engine = host::engine(wet_text, &options), twin = host::engine(wet_text);
    talus_step_report report = TALUS_STEP_REPORT_INIT;
    REQUIRE(talus_engine_step(engine.get(), 0.1, &report) == TALUS_OK);
    impatient.limit = impatient.calls + 3;
    CHECK(talus_engine_step(engine.get(), 0.2, &report) == TALUS_CANCELLED);
    REQUIRE(talus_engine_step(engine.get(), 0.2, &report) == TALUS_OK);
    talus_step_report plain = TALUS_STEP_REPORT_INIT;
    REQUIRE(talus_engine_step(twin.get(), 0.1, &plain) == TALUS_OK);
    REQUIRE(talus_engine_step(twin.get(), 0.2, &plain) == TALUS_OK);
    CHECK(read(engine, "point_pressure") == read(twin, "point_pressure"));
    CHECK(report.water_stored == plain.water_stored);

    CHECK(report.regime == TALUS_DYNAMIC);
    CHECK(report.water_rain == doctest::Approx(1e-4 * 0.2 * 14).epsilon(1e-9));
    CHECK(std::abs(report.water_residual) < 1e-12 * report.water_stored);
    CHECK(report.largest_displacement < 0.01);
    const std::vector<double> place = read(engine, "point_position"), pressure = read(engine, "point_pressure"),
                              saturation = read(engine, "saturation"), net = read(engine, "net_stress"),
                              total = read(engine, "total_stress");
    for (size_t p = 0; p < pressure.size(); ++p) {
        CHECK(saturation[p] > 0.5);
        CHECK(saturation[p] <= 1.0);
        CHECK(total[4 * p] == doctest::Approx(net[4 * p] - std::max(pressure[p], 0.0)));
        const double hydrostatic = 9810 * (2 - place[2 * p + 1]);
        if (place[2 * p + 1] < 2) CHECK(std::abs(pressure[p] - hydrostatic) < 0.5 * 9810 * 0.5);
    }
    CHECK(read(engine, "darcy_flux").size() == place.size());
}

TEST_CASE("C API: gas that moves has a pressure of its own, and an undone step leaves no trace of it") {
    std::string text = wet_text;
    text.replace(text.find("\"regime\""), 0, "\"gas\": true, ");
    text.replace(text.find("\"water\": {"), 0, "\"gas\": {\"viscosityRatio\": 0.02}, ");
    Impatient impatient;
    const host::Engine engine = undone_and_done_again(text, 0.2, {"gas_pressure"}, impatient);
    const std::vector<double> pressure = read(engine, "point_pressure"), gas = read(engine, "gas_pressure"),
                              suction = read(engine, "suction"), net = read(engine, "net_stress"),
                              total = read(engine, "total_stress");
    for (size_t p = 0; p < pressure.size(); ++p) {
        CHECK(suction[p] == doctest::Approx(gas[p] - pressure[p]));
        CHECK(total[4 * p] == doctest::Approx(net[4 * p] - gas[p]));
    }
    const host::Engine passive = host::engine(wet_text);
    const auto leaves_out_gas = [](const host::Engine& of) {
        const char* description = nullptr;
        REQUIRE(talus_engine_describe(of.get(), &description) == TALUS_OK);
        return std::string(description).find("gas flow") != std::string::npos;
    };
    CHECK(leaves_out_gas(passive));
    CHECK(!leaves_out_gas(engine));
}

TEST_CASE(
    "C API: water that evaporates and air that dissolves are in the balance, and an undone step leaves no trace of them") {
    std::string text = wet_text;
    text.replace(text.find("\"regime\""), 0, "\"gas\": true, \"exchange\": true, ");
    text.replace(text.find("\"water\": {"), 0, "\"gas\": {\"humidity\": 0.3}, ");
    Impatient impatient;
    const host::Engine engine =
        undone_and_done_again(text, 0.1, {"gas_pressure", "relative_humidity", "dissolved_air"}, impatient);
    const std::vector<double> suction = read(engine, "suction"), humidity = read(engine, "relative_humidity"),
                              dissolved = read(engine, "dissolved_air");
    for (size_t p = 0; p < suction.size(); ++p) {
        // At 20 degrees the suction that halves the humidity is 93.8 MPa; a cubic metre of water takes up 22.3 g of air.
        CHECK(humidity[p] == doctest::Approx(std::exp2(-suction[p] / 93.8e6)).epsilon(1e-4));
        CHECK(dissolved[p] / 0.0223 == doctest::Approx(1).epsilon(0.2));
    }
    const char* description = nullptr;
    REQUIRE(talus_engine_describe(engine.get(), &description) == TALUS_OK);
    CHECK(std::string(description).find("\"exchange\":true") != std::string::npos);
    text.replace(text.find("\"gas\": {\"humidity\": 0.3}, "), 26, "");
    text.replace(text.find(", \"exchange\": true"), 18, "");
    const host::Engine without = host::engine(text.c_str());
    REQUIRE(talus_engine_describe(without.get(), &description) == TALUS_OK);
    CHECK(std::string(description).find("exchange between the fluids") != std::string::npos);
    talus_field field = TALUS_FIELD_INIT;
    CHECK(talus_engine_view(without.get(), "relative_humidity", &field) == TALUS_UNKNOWN_NAME);
}

TEST_CASE("C API: a host that wants to see the ground move stops where it starts and where it rests") {
    talus_options options = TALUS_OPTIONS_INIT;
    options.stop_at_motion = 1;
    const host::Engine engine = host::engine(failing_text, &options);
    talus_step_report report = TALUS_STEP_REPORT_INIT;
    talus_status status = TALUS_OK;
    while (status == TALUS_OK && report.time < 12000) status = talus_engine_step(engine.get(), 600, &report);
    CHECK(status == TALUS_ENDED_EARLY);
    CHECK(report.regime == TALUS_DYNAMIC);
    CHECK(report.kinetic_energy == 0);
    CHECK(report.time == talus_engine_time(engine.get()));
    talus_event event = TALUS_EVENT_INIT;
    REQUIRE(talus_engine_event(engine.get(), 0, &event) == TALUS_OK);
    CHECK(event.kind == TALUS_MOTION_STARTED);
    CHECK(event.time == report.time);

    REQUIRE(talus_engine_step(engine.get(), 0.5, &report) == TALUS_OK);
    CHECK(report.kinetic_energy > 0);
    CHECK(report.time == event.time + 0.5);
    CHECK(talus_engine_step(engine.get(), 600, &report) == TALUS_ENDED_EARLY);
    CHECK(report.regime == TALUS_AT_REST);
    CHECK(report.time < event.time + 600);
}

TEST_CASE("C API: from the storm through failure and motion to rest, with every drop of water") {
    Impatient impatient;
    talus_options options = TALUS_OPTIONS_INIT;
    options.progress = Impatient::progress;
    options.progress_user = &impatient;
    Impatient counter;
    talus_options counting = options;
    counting.progress_user = &counter;
    const host::Engine engine = host::engine(failing_text, &options), twin = host::engine(failing_text, &counting);
    talus_step_report report = TALUS_STEP_REPORT_INIT, plain = TALUS_STEP_REPORT_INIT;
    double before = 0;
    int64_t events = 0;
    while (events == 0 && plain.time < 12000) {
        before = plain.time;
        counter.calls = 0;
        REQUIRE(talus_engine_step(twin.get(), 600, &plain) == TALUS_OK);
        REQUIRE(talus_engine_event_count(twin.get(), &events) == TALUS_OK);
    }
    CHECK(plain.regime == TALUS_QUASI_STATIC);
    CHECK(plain.peak_velocity > 0.1);
    CHECK(plain.sliding_volume > 1);
    CHECK(plain.run_out > 0);
    CHECK(plain.largest_displacement > 1);
    CHECK(std::abs(plain.water_residual) < 1e-8 * plain.water_rain);
    CHECK(plain.water_rain == doctest::Approx(3e-5 * 12 * plain.time).epsilon(1e-6));
    REQUIRE(events >= 3);
    for (int64_t i = 0; i < 3; ++i) {
        talus_event event = TALUS_EVENT_INIT;
        REQUIRE(talus_engine_event(twin.get(), i, &event) == TALUS_OK);
        const int32_t kinds[] = {TALUS_MOTION_STARTED, TALUS_CAME_TO_REST, TALUS_SETTLED};
        CHECK(event.kind == kinds[i]);
        CHECK(event.time > before);
    }

    // The step of the failure, cancelled while the ground moves and after it has settled, leaves no trace: done again, it comes to the same.
    while (report.time < before) REQUIRE(talus_engine_step(engine.get(), 600, &report) == TALUS_OK);
    const std::vector<double> standing = read(engine, "net_stress"), pressure = read(engine, "pressure");
    const int64_t hash = host::hash(engine);
    for (const int limit : {counter.calls / 2, counter.calls}) {
        impatient.calls = 0;
        impatient.limit = limit;
        CHECK(talus_engine_step(engine.get(), 600, &report) == TALUS_CANCELLED);
        CHECK(read(engine, "net_stress") == standing);
        CHECK(read(engine, "pressure") == pressure);
        CHECK(host::hash(engine) == hash);
    }
    impatient.limit = -1;
    REQUIRE(talus_engine_step(engine.get(), 600, &report) == TALUS_OK);
    CHECK(report.sliding_volume == plain.sliding_volume);
    CHECK(read(engine, "pressure") == read(twin, "pressure"));
    CHECK(host::hash(engine) == host::hash(twin));

    // The storm goes on, and the ground takes its rain in.
    int32_t probe = 0;
    talus_history history = TALUS_HISTORY_INIT;
    const double rain = plain.water_rain, infiltrated = plain.water_infiltrated;
    for (int i = 0; i < 3; ++i) REQUIRE(talus_engine_step(twin.get(), 600, &plain) == TALUS_OK);
    CHECK(plain.water_infiltrated - infiltrated > 0.9 * (plain.water_rain - rain));
    CHECK(std::abs(plain.water_residual) < 1e-8 * plain.water_rain);
    REQUIRE(talus_engine_probe(twin.get(), "A", &probe) == TALUS_OK);
    REQUIRE(talus_engine_probe_history(twin.get(), probe, "pressure", &history) == TALUS_OK);
    for (int64_t k = 0; k < history.count; ++k) CHECK(std::isfinite(history.value[k]));
    REQUIRE(talus_engine_probe_history(twin.get(), probe, "displacement.y", &history) == TALUS_OK);
    CHECK(history.value[history.count - 1] < -0.1);  // it lay in what slid
}

TEST_CASE("C API: ground that ran out thin rests where it lies, and rain runs off") {
    std::string text = failing_text;
    text.replace(text.find("[6, 1], [12, 1]]"), 16, "[7.5, 0.5]]");
    text.replace(text.find("[12, 0]]"), 8, "[7.5, 0]]");
    text.replace(text.find(R"({"side": "left", "motion": "roller"},)"), 37,
                 R"({"side": "left", "motion": "roller"}],)");
    text.erase(text.find(R"({"side": "right", "motion": "roller"}],)"), 39);
    const host::Engine engine = host::engine(text.c_str());
    talus_step_report report = TALUS_STEP_REPORT_INIT;
    while (report.regime == TALUS_QUASI_STATIC && report.time < 12000)
        REQUIRE(talus_engine_step(engine.get(), 600, &report) == TALUS_OK);
    REQUIRE(report.regime == TALUS_AT_REST);
    CHECK(report.run_out > 1);
    const std::vector<double> place = read(engine, "point_position");
    const double rain = report.water_rain, run_off = report.water_run_off;
    REQUIRE(talus_engine_step(engine.get(), 3600, &report) == TALUS_OK);
    CHECK(report.regime == TALUS_AT_REST);
    CHECK(read(engine, "point_position") == place);
    CHECK(report.water_rain > rain);
    CHECK(report.water_run_off - run_off == doctest::Approx(report.water_rain - rain));
}
