// Steps that cannot be done change nothing; views live as long as the header says.
#include "capi_host.hpp"

#include <atomic>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

/// Cancels by its return value once `calls` calls were made.
struct Impatient {
    int calls = 0;
    int limit = 0;
    static int32_t progress(void* user, double fraction) {
        auto* self = static_cast<Impatient*>(user);
        CHECK(fraction >= 0);
        CHECK(fraction <= 1);
        return ++self->calls == self->limit ? 1 : 0;
    }
};

talus_options watched_by(Impatient& impatient) {
    talus_options options = TALUS_OPTIONS_INIT;
    options.progress = Impatient::progress;
    options.progress_user = &impatient;
    return options;
}

std::vector<double> values(const talus_field& field) {
    const auto* first = static_cast<const double*>(field.data);
    return {first, first + field.shape[0]};
}

}  // namespace

TEST_CASE("C API: absurd steps are refused and change nothing") {
    const host::Engine engine = host::engine(host::bank_text);
    const int64_t before = host::hash(engine);
    const double infinite = std::numeric_limits<double>::infinity();
    for (const double dt : {0.0, -1.0, infinite, -infinite, std::nan(""), 1e300}) {
        CHECK(talus_engine_step(engine.get(), dt, nullptr) == TALUS_INVALID_ARGUMENT);
        CHECK(std::string(talus_engine_error(engine.get())).size() > 10);
        CHECK(talus_engine_advance_to(engine.get(), dt, nullptr) == TALUS_INVALID_ARGUMENT);
    }
    CHECK(host::hash(engine) == before);
    CHECK(talus_engine_time(engine.get()) == 0);
    CHECK(talus_engine_step(engine.get(), 3600, nullptr) == TALUS_OK);
    CHECK(talus_engine_step(engine.get(), 1e-14, nullptr) == TALUS_INVALID_ARGUMENT);  // too small to change the time
    CHECK(talus_engine_time(engine.get()) == 3600);
}

TEST_CASE("C API: a long step may follow a very short one") {
    const host::Engine engine = host::engine(host::bank_text);
    CHECK(talus_engine_step(engine.get(), 3600, nullptr) == TALUS_OK);
    CHECK(talus_engine_step(engine.get(), 1e-7, nullptr) == TALUS_OK);
    CHECK(talus_engine_step(engine.get(), 7200, nullptr) == TALUS_OK);
}

TEST_CASE("C API: dry ground fails where its load exceeds what it bears, within one step") {
    const host::Engine engine = host::engine(R"({
        "name": "strip",
        "physics": {"water": false},
        "soils": [{"name": "clay", "dryDensity": 1800, "porosity": 0.4,
                   "solid": {"youngModulus": 1e9, "poissonRatio": 0.4,
                             "strength": {"model": "constant", "cohesion": 10e3, "frictionAngle": 0}}}],
        "ground": {"section": {"terrain": [[0, 3], [6, 3]], "base": [[0, 0], [6, 0]], "layers": [{"soil": "clay"}],
                               "columnWidth": 0.25, "surfaceCellHeight": 0.25, "growth": 1, "largestCellHeight": 0.25}},
        "boundaries": [{"name": "base", "side": "base", "motion": "fixed"},
                       {"name": "left", "side": "left", "motion": "roller"},
                       {"name": "right", "side": "right", "motion": "roller"},
                       {"name": "load", "side": "surface", "xTo": 1, "motion": "traction",
                        "motionY": {"time": [0, 100], "value": [0, -200e3]}}],
        "initial": {"stress": "k0", "k0": 1}
    })");
    CHECK(talus_engine_step(engine.get(), 100, nullptr) == TALUS_OK);
    int64_t events = 0;
    REQUIRE(talus_engine_event_count(engine.get(), &events) == TALUS_OK);
    REQUIRE(events == 1);
    talus_event event = TALUS_EVENT_INIT;
    REQUIRE(talus_engine_event(engine.get(), 0, &event) == TALUS_OK);
    CHECK(event.kind == TALUS_LOSS_OF_EQUILIBRIUM);
    CHECK(event.time > 25.7);  // Prandtl: 5.14 c
    CHECK(event.time < 28);
}

TEST_CASE("C API: soft saturated ground may be squeezed by a tenth of its height") {
    const host::Engine engine = host::engine(R"({
        "name": "mud",
        "soils": [{"name": "mud", "dryDensity": 1600, "porosity": 0.4,
                   "hydraulics": {"retention": {"model": "vanGenuchten", "alpha": 1e-05, "n": 2},
                                  "conductivity": {"along": 1e-09}},
                   "solid": {"model": "elastic", "youngModulus": 1e6, "poissonRatio": 0.3}}],
        "ground": {"column": {"height": 10, "cells": 50, "layers": [{"soil": "mud"}]}},
        "boundaries": [{"name": "base", "side": "base", "motion": "fixed"},
                       {"name": "drain", "side": "surface", "flow": "pressure", "flowValue": {"value": [0]}},
                       {"name": "load", "side": "surface", "motion": "traction",
                        "motionY": {"time": [0, 1], "value": [0, -130e3]}}],
        "initial": {"flow": "hydrostatic", "waterTable": 10}
    })");
    for (const double time : {0.5, 1e6, 1e9}) {
        CHECK(talus_engine_advance_to(engine.get(), time, nullptr) == TALUS_OK);
    }
    talus_step_report report = TALUS_STEP_REPORT_INIT;
    REQUIRE(talus_engine_report(engine.get(), &report) == TALUS_OK);
    // Logarithmic strain: H [1 - exp(-q m_v)], the load being carried by the skeleton alone.
    CHECK(report.largest_displacement == doctest::Approx(10 * (1 - std::exp(-130e3 * 0.742857e-6))).epsilon(0.01));
}

TEST_CASE("C API: ground that is full from the start does not fill") {
    std::string text = host::column_text;
    const std::string initial = R"({"flow": "saturation", "saturation": 0.85})";
    text.replace(text.find(initial), initial.size(), R"({"flow": "hydrostatic", "waterTable": 1})");
    const host::Engine engine = host::engine(text.c_str());
    CHECK(talus_engine_set_rain(engine.get(), 0, 0) == TALUS_OK);
    CHECK(talus_engine_step(engine.get(), 10, nullptr) == TALUS_OK);
    int64_t events = -1;
    CHECK(talus_engine_event_count(engine.get(), &events) == TALUS_OK);
    CHECK(events == 0);
}

TEST_CASE("C API: a step cancelled by its progress callback is undone bit for bit, wherever it is cancelled") {
    Impatient impatient;
    const talus_options options = watched_by(impatient);
    const host::Engine engine = host::engine(host::bank_text, &options);
    const host::Engine alone = host::engine(host::bank_text);
    REQUIRE(talus_engine_step(engine.get(), 1800, nullptr) == TALUS_OK);
    REQUIRE(talus_engine_step(alone.get(), 1800, nullptr) == TALUS_OK);
    const int64_t before = host::hash(engine);
    const talus_field pressure = host::view(engine, "pressure");
    const talus_field suction = host::view(engine, "suction");
    const std::vector<double> kept = values(pressure);
    const std::vector<double> kept_suction = values(suction);

    for (const int limit : {1, 2, 3, 5}) {
        impatient = {0, limit};
        talus_step_report report = TALUS_STEP_REPORT_INIT;
        report.time = -1;
        REQUIRE(talus_engine_step(engine.get(), 7200, &report) == TALUS_CANCELLED);
        CHECK(report.time == -1);
        CHECK(host::hash(engine) == before);
        CHECK(talus_engine_time(engine.get()) == 1800);
        CHECK(talus_engine_epoch(engine.get()) == pressure.epoch);
        CHECK(values(pressure) == kept);  // the epoch did not change, so the views hold
        CHECK(values(suction) == kept_suction);
    }
    impatient = {0, 0};
    REQUIRE(talus_engine_step(engine.get(), 7200, nullptr) == TALUS_OK);
    REQUIRE(talus_engine_step(alone.get(), 7200, nullptr) == TALUS_OK);
    CHECK(impatient.calls > 0);
    CHECK(host::hash(engine) == host::hash(alone));
}

TEST_CASE("C API: cancelled from another thread, and no cancel is lost") {
    struct Meeting {
        std::atomic<bool> inside = false;
        std::atomic<bool> asked = false;
        static int32_t progress(void* user, double) {
            auto* self = static_cast<Meeting*>(user);
            self->inside = true;
            while (!self->asked) std::this_thread::yield();
            return 0;
        }
    } meeting;
    talus_options options = TALUS_OPTIONS_INIT;
    options.progress = Meeting::progress;
    options.progress_user = &meeting;
    const host::Engine engine = host::engine(host::column_text, &options);
    const int64_t before = host::hash(engine);
    std::thread canceller([&] {
        while (!meeting.inside) std::this_thread::yield();
        CHECK(talus_engine_time(engine.get()) == 0);
        talus_engine_cancel(engine.get());
        meeting.asked = true;
    });
    CHECK(talus_engine_step(engine.get(), 60, nullptr) == TALUS_CANCELLED);
    canceller.join();
    CHECK(host::hash(engine) == before);

    talus_engine_cancel(engine.get());  // no step runs: it ends the next one, once
    CHECK(talus_engine_step(engine.get(), 60, nullptr) == TALUS_CANCELLED);
    CHECK(talus_engine_step(engine.get(), 60, nullptr) == TALUS_OK);
}

TEST_CASE("C API: a callback may throw, and may not call back") {
    struct Caller {
        talus_engine* engine = nullptr;
        bool throws = false;
        talus_status nested = TALUS_OK;
        std::string nested_text;
        static int32_t progress(void* user, double) {
            auto* self = static_cast<Caller*>(user);
            if (self->throws) throw std::runtime_error("the host's own trouble");
            self->nested = talus_engine_step(self->engine, 1, nullptr);
            self->nested_text = talus_last_error();
            talus_engine_destroy(self->engine);  // refused too
            return 0;
        }
    } caller;
    talus_options options = TALUS_OPTIONS_INIT;
    options.progress = Caller::progress;
    options.progress_user = &caller;
    const host::Engine engine = host::engine(host::column_text, &options);
    caller.engine = engine.get();
    CHECK(talus_engine_step(engine.get(), 10, nullptr) == TALUS_OK);
    CHECK(caller.nested == TALUS_BUSY);
    CHECK(host::contains(caller.nested_text.c_str(), "another call"));
    CHECK(talus_engine_time(engine.get()) == 10);

    const int64_t before = host::hash(engine);
    caller.throws = true;
    CHECK(talus_engine_step(engine.get(), 10, nullptr) == TALUS_INTERNAL);
    CHECK(host::contains(talus_engine_error(engine.get()), "the host's own trouble"));
    CHECK(host::hash(engine) == before);
    caller.throws = false;
    CHECK(talus_engine_step(engine.get(), 10, nullptr) == TALUS_OK);
}

TEST_CASE("C API: a step may be cut without changing where it lands") {
    const host::Engine engine = host::engine(host::column_text);
    REQUIRE(talus_engine_advance_to(engine.get(), 0.1, nullptr) == TALUS_OK);
    REQUIRE(talus_engine_advance_to(engine.get(), 0.3, nullptr) == TALUS_OK);
    CHECK(talus_engine_time(engine.get()) == 0.3);  // 0.1 + (0.3 - 0.1) would not be
    CHECK(talus_engine_advance_to(engine.get(), 0.3, nullptr) == TALUS_INVALID_ARGUMENT);
}

TEST_CASE("C API: a view is the engine's memory, read is its copy, the epoch tells when they part") {
    const host::Engine engine = host::engine(host::bank_text);
    int32_t count = 0;
    REQUIRE(talus_engine_field_count(engine.get(), &count) == TALUS_OK);
    REQUIRE(count > 10);
    for (int32_t i = 0; i < count; ++i) {
        const char* name = nullptr;
        REQUIRE(talus_engine_field_name(engine.get(), i, &name) == TALUS_OK);
        const talus_field field = host::view(engine, name);
        CAPTURE(name);
        CHECK(std::string(field.name) == name);
        CHECK(std::string(field.units).size() > 0);
        CHECK(field.standard_name != nullptr);
        CHECK(field.epoch == talus_engine_epoch(engine.get()));
        CHECK(host::view(engine, name).data == field.data);  // no copy is made for the second one
        const int64_t components = field.rank == 1 ? 1 : field.shape[1];
        const int64_t size = field.type == TALUS_FLOAT64 ? 8 : 4;
        CHECK(field.strides[0] == components * size);
        std::vector<double> copy(static_cast<size_t>(field.shape[0] * components));
        REQUIRE(talus_engine_read(engine.get(), name, static_cast<int64_t>(copy.size()), copy.data()) == TALUS_OK);
        for (size_t k = 0; k < copy.size(); ++k) {
            const double viewed = field.type == TALUS_FLOAT64 ? static_cast<const double*>(field.data)[k]
                                                              : static_cast<const int32_t*>(field.data)[k];
            if (viewed != copy[k]) CHECK(viewed == copy[k]);
        }
    }
    const int64_t epoch = talus_engine_epoch(engine.get());
    talus_engine_set_rain(engine.get(), 0, 1e-6);
    CHECK(talus_engine_add_probe(engine.get(), "new", 6, 3, nullptr) == TALUS_OK);
    CHECK(talus_engine_epoch(engine.get()) == epoch);
    REQUIRE(talus_engine_step(engine.get(), 600, nullptr) == TALUS_OK);
    CHECK(talus_engine_epoch(engine.get()) != epoch);
}

TEST_CASE("C API: samples, rasters and probes agree") {
    const host::Engine engine = host::engine(host::bank_text);
    REQUIRE(talus_engine_step(engine.get(), 3600, nullptr) == TALUS_OK);
    const double places[] = {5, 4, 5, 99};
    double sampled[2] = {};
    CHECK(talus_engine_sample(engine.get(), "saturation", 2, places, sampled) == TALUS_OUTSIDE);
    CHECK(std::isnan(sampled[1]));
    CHECK(talus_engine_sample(engine.get(), "saturation", 1, places, sampled) == TALUS_OK);

    talus_raster raster = TALUS_RASTER_INIT;
    raster.columns = 3;
    raster.rows = 2;
    raster.x = 4;
    raster.y = 5;
    raster.dx = 1;
    raster.dy = -1;  // from the top down
    std::vector<double> grid(6);
    CHECK(talus_engine_sample_raster(engine.get(), "saturation", &raster, 6, grid.data()) == TALUS_OK);
    CHECK(grid[1 * 3 + 1] == sampled[0]);  // column 1, row 1: (5, 4)
    CHECK(talus_engine_sample_raster(engine.get(), "saturation", &raster, 5, grid.data()) == TALUS_INVALID_ARGUMENT);
    raster.dx = 0;
    CHECK(talus_engine_sample_raster(engine.get(), "saturation", &raster, 6, grid.data()) == TALUS_INVALID_ARGUMENT);

    int32_t probe = -1;
    REQUIRE(talus_engine_add_probe(engine.get(), "late", 5, 4, &probe) == TALUS_OK);
    talus_history late = TALUS_HISTORY_INIT;
    REQUIRE(talus_engine_probe_history(engine.get(), probe, "saturation", &late) == TALUS_OK);
    talus_history early = TALUS_HISTORY_INIT;
    REQUIRE(talus_engine_probe_history(engine.get(), 0, "saturation", &early) == TALUS_OK);
    REQUIRE(early.count == 2);
    REQUIRE(late.count == 2);
    CHECK(late.time[1] == 3600);
    CHECK(std::isnan(late.value[0]));
    CHECK(late.value[1] == doctest::Approx(early.value[1]).epsilon(1e-6));
}

TEST_CASE("C API: arrays of the host's stand for entries of the text") {
    // Two quads, 2 m x 1 m, whose mesh comes from memory.
    const char* text = R"({
        "name": "quads", "physics": {"deforming": false},
        "soils": [{"name": "soil", "porosity": 0.4,
                   "hydraulics": {"retention": {"model": "vanGenuchten", "alpha": 4e-05, "n": 1.2},
                                  "conductivity": {"along": 1e-04}}}],
        "ground": {"mesh": {}},
        "surface": {"zones": [{"name": "rain"}]},
        "initial": {"flow": "suction", "suction": 10000}
    })";
    double position[] = {0, 0, 1, 0, 2, 0, 0, 1, 1, 1, 2, 1};
    int32_t cell_start[] = {0, 4, 8};
    int32_t cell_nodes[] = {0, 1, 4, 3, 1, 2, 5, 4};
    int32_t cell_soil[] = {0, 0};
    double time[] = {0, 100};
    double rate[] = {1e-6, 2e-6};
    const auto array = [](const char* entry, int32_t type, const void* data, int64_t count) {
        return talus_array{sizeof(talus_array), type, entry, data, count};
    };
    talus_array arrays[] = {
        array("ground.mesh.position", TALUS_FLOAT64, position, 12),
        array("ground.mesh.cellStart", TALUS_INT32, cell_start, 3),
        array("ground.mesh.cellNodes", TALUS_INT32, cell_nodes, 8),
        array("ground.mesh.cellSoil", TALUS_INT32, cell_soil, 2),
        array("surface.zones[0].time", TALUS_FLOAT64, time, 2),
        array("surface.zones[0].rate", TALUS_FLOAT64, rate, 2),
    };
    talus_scene* scene = nullptr;
    REQUIRE_MESSAGE(talus_scene_from_json_with_arrays(text, -1, 6, arrays, &scene) == TALUS_OK, talus_last_error());
    position[0] = std::nan("");  // copied: the host's memory is its own again
    talus_engine* out = nullptr;
    REQUIRE_MESSAGE(talus_engine_create(scene, nullptr, &out) == TALUS_OK, talus_last_error());
    const host::Engine engine(out);
    talus_scene_release(scene);
    CHECK(host::view(engine, "node_position").shape[0] == 6);
    talus_step_report report = TALUS_STEP_REPORT_INIT;
    REQUIRE(talus_engine_step(engine.get(), 200, &report) == TALUS_OK);
    CHECK(report.water_rain == doctest::Approx(2 * (1e-6 * 100 + 2e-6 * 100)));

    const auto refused = [&](const talus_array& wrong, talus_status status, const char* part) {
        talus_scene* none = nullptr;
        CHECK(talus_scene_from_json_with_arrays(text, -1, 1, &wrong, &none) == status);
        CHECK_MESSAGE(host::contains(talus_last_error(), part), talus_last_error());
        CHECK(none == nullptr);
    };
    refused(arrays[0], TALUS_INVALID_SCENE, "ground.mesh");  // the rest is missing
    refused(array("ground.mesh.colour", TALUS_FLOAT64, time, 2), TALUS_INVALID_ARGUMENT, "ground.mesh.colour");
    refused(array("ground.section.terrain", TALUS_FLOAT64, time, 2), TALUS_INVALID_ARGUMENT, "ground.section.terrain");
    refused(array("ground.mesh.position", TALUS_INT32, cell_soil, 2), TALUS_INVALID_ARGUMENT, "float64");
    refused(array("ground.mesh.cellSoil", TALUS_FLOAT64, time, 2), TALUS_INVALID_ARGUMENT, "int32");
    refused(array("ground.mesh.cellSoil", 7, time, 2), TALUS_INVALID_ARGUMENT, "type");
    refused(array("surface.zones[3].rate", TALUS_FLOAT64, time, 2), TALUS_INVALID_ARGUMENT, "index 3");
    refused(array("surface.zones[].rate", TALUS_FLOAT64, time, 2), TALUS_INVALID_ARGUMENT, "no such array");
    refused(array("surface.zones", TALUS_FLOAT64, time, 2), TALUS_INVALID_ARGUMENT, "no such array");
    refused(array("", TALUS_FLOAT64, time, 2), TALUS_INVALID_ARGUMENT, "no such array");
    refused(array("soils[0].name", TALUS_FLOAT64, time, 2), TALUS_INVALID_ARGUMENT, "no such array");
}
