// Wrong handles and missing arguments: an error code and a text, for every function.
#include "capi_host.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace {

/// Every function that takes an engine, with sound arguments.
std::vector<std::function<talus_status(talus_engine*)>> calls_on_engine() {
    static const char* text = nullptr;
    static int32_t number = 0;
    static int64_t big = 0;
    static std::array<double, 64> values{};
    static talus_step_report report = TALUS_STEP_REPORT_INIT;
    static talus_field field = TALUS_FIELD_INIT;
    static talus_history history = TALUS_HISTORY_INIT;
    static talus_event event = TALUS_EVENT_INIT;
    static talus_raster raster = TALUS_RASTER_INIT;
    return {
        [](talus_engine* e) { return talus_engine_describe(e, &text); },
        [](talus_engine* e) { return talus_engine_zone(e, "rain", &number); },
        [](talus_engine* e) { return talus_engine_push_rain(e, 0, 1, values.data(), values.data()); },
        [](talus_engine* e) { return talus_engine_set_rain(e, 0, 0); },
        [](talus_engine* e) { return talus_engine_boundary(e, "base", &number); },
        [](talus_engine* e) { return talus_engine_push_flow_value(e, 0, 1, values.data(), values.data()); },
        [](talus_engine* e) { return talus_engine_push_motion_value(e, 0, 0, 1, values.data(), values.data()); },
        [](talus_engine* e) { return talus_engine_step(e, 1, &report); },
        [](talus_engine* e) { return talus_engine_advance_to(e, 1e6, &report); },
        [](talus_engine* e) { return talus_engine_report(e, &report); },
        [](talus_engine* e) { return talus_engine_field_count(e, &number); },
        [](talus_engine* e) { return talus_engine_field_name(e, 0, &text); },
        [](talus_engine* e) { return talus_engine_view(e, "pressure", &field); },
        [](talus_engine* e) { return talus_engine_read(e, "pressure", 21, values.data()); },
        [](talus_engine* e) { return talus_engine_sample(e, "pressure", 1, values.data(), values.data()); },
        [](talus_engine* e) { return talus_engine_sample_raster(e, "pressure", &raster, 1, values.data()); },
        [](talus_engine* e) { return talus_engine_probe(e, "top", &number); },
        [](talus_engine* e) { return talus_engine_add_probe(e, "new", 0, 0.5, &number); },
        [](talus_engine* e) { return talus_engine_probe_history(e, 0, "pressure", &history); },
        [](talus_engine* e) { return talus_engine_event_count(e, &big); },
        [](talus_engine* e) { return talus_engine_event(e, 0, &event); },
        [](talus_engine* e) { return talus_engine_hash(e, &big); },
    };
}

void check_refused(talus_engine* handle, const char* why) {
    for (const auto& call : calls_on_engine()) {
        CHECK(call(handle) == TALUS_INVALID_HANDLE);
        CHECK(host::contains(talus_last_error(), why));
    }
    talus_engine_cancel(handle);
    CHECK(std::isnan(talus_engine_time(handle)));
    CHECK(talus_engine_epoch(handle) == -1);
    CHECK(talus_engine_error(handle) != nullptr);
}

}  // namespace

TEST_CASE("C API: NULL and foreign handles are an error code") {
    check_refused(nullptr, "the engine is NULL");
    alignas(16) std::array<char, 4096> foreign{};
    check_refused(reinterpret_cast<talus_engine*>(foreign.data() + 1), "not the handle of a living engine");
    const host::Scene scene = host::scene(host::column_text);
    check_refused(reinterpret_cast<talus_engine*>(scene.get()), "not the handle of a living engine");
    talus_engine_destroy(nullptr);
    talus_engine_destroy(reinterpret_cast<talus_engine*>(foreign.data()));

    talus_engine* out = nullptr;
    CHECK(talus_engine_create(nullptr, nullptr, &out) == TALUS_INVALID_HANDLE);
    const host::Engine engine = host::engine(host::column_text);
    auto* as_scene = reinterpret_cast<talus_scene*>(engine.get());
    CHECK(talus_engine_create(as_scene, nullptr, &out) == TALUS_INVALID_HANDLE);
    CHECK(talus_scene_retain(as_scene) == TALUS_INVALID_HANDLE);
    CHECK(talus_scene_release(nullptr) == TALUS_INVALID_HANDLE);
    CHECK(out == nullptr);
}

TEST_CASE("C API: a missing argument is named") {
    const host::Engine engine = host::engine(host::column_text);
    talus_engine* e = engine.get();
    const double number[] = {0.5, 0.5};
    double value[64];
    talus_scene* scene = nullptr;
    talus_array array = TALUS_ARRAY_INIT;
    const auto refused = [](talus_status status, const char* name) {
        CHECK(status == TALUS_INVALID_ARGUMENT);
        CHECK_MESSAGE(host::contains(talus_last_error(), (std::string(name) + " is NULL").c_str()), talus_last_error());
    };
    refused(talus_scene_from_json(nullptr, 0, &scene), "text");
    refused(talus_scene_from_json("{}", -1, nullptr), "out");
    refused(talus_scene_from_bytes(nullptr, 8, &scene), "bytes");
    refused(talus_scene_from_file(nullptr, &scene), "path");
    refused(talus_scene_from_json_with_arrays("{}", -1, 1, nullptr, &scene), "arrays");
    refused(talus_scene_from_json_with_arrays("{}", -1, 1, &array, &scene), "array.entry");
    refused(talus_engine_create(host::scene(host::column_text).get(), nullptr, nullptr), "out");
    refused(talus_engine_describe(e, nullptr), "json");
    refused(talus_engine_zone(e, nullptr, nullptr), "name");
    refused(talus_engine_zone(e, "rain", nullptr), "zone");
    refused(talus_engine_push_rain(e, 0, 1, nullptr, number), "time");
    refused(talus_engine_push_rain(e, 0, 1, number, nullptr), "rate");
    refused(talus_engine_boundary(e, "base", nullptr), "boundary");
    refused(talus_engine_push_flow_value(e, 0, 1, number, nullptr), "value");
    refused(talus_engine_push_motion_value(e, 0, 0, 1, nullptr, number), "time");
    refused(talus_engine_report(e, nullptr), "report");
    refused(talus_engine_field_count(e, nullptr), "count");
    refused(talus_engine_field_name(e, 0, nullptr), "name");
    refused(talus_engine_view(e, nullptr, nullptr), "field");
    refused(talus_engine_view(e, "pressure", nullptr), "out");
    refused(talus_engine_read(e, "pressure", 21, nullptr), "values");
    refused(talus_engine_sample(e, "pressure", 1, nullptr, value), "places");
    refused(talus_engine_sample(e, "pressure", 1, number, nullptr), "values");
    refused(talus_engine_sample_raster(e, "pressure", nullptr, 1, value), "raster");
    refused(talus_engine_probe(e, "top", nullptr), "probe");
    refused(talus_engine_add_probe(e, nullptr, 0, 0, nullptr), "name");
    refused(talus_engine_probe_history(e, 0, "pressure", nullptr), "out");
    refused(talus_engine_event_count(e, nullptr), "count");
    refused(talus_engine_event(e, 0, nullptr), "out");
    refused(talus_engine_hash(e, nullptr), "hash");
}

TEST_CASE("C API: names, numbers and counts that do not exist") {
    const host::Engine engine = host::engine(host::column_text);
    talus_engine* e = engine.get();
    int32_t number = 0;
    double values[64] = {};
    talus_field field = TALUS_FIELD_INIT;
    talus_event event = TALUS_EVENT_INIT;
    talus_history history = TALUS_HISTORY_INIT;
    const char* name = nullptr;
    CHECK(talus_engine_zone(e, "snow", &number) == TALUS_UNKNOWN_NAME);
    CHECK(host::contains(talus_engine_error(e), "snow"));
    CHECK(talus_engine_boundary(e, "lid", &number) == TALUS_UNKNOWN_NAME);
    CHECK(talus_engine_probe(e, "nowhere", &number) == TALUS_UNKNOWN_NAME);
    CHECK(talus_engine_view(e, "temperature", &field) == TALUS_UNKNOWN_NAME);
    CHECK(talus_engine_view(e, "displacement", &field) == TALUS_UNKNOWN_NAME);  // left out: the skeleton is rigid
    CHECK(talus_engine_probe_history(e, 0, "temperature", &history) == TALUS_UNKNOWN_NAME);
    CHECK(talus_engine_probe_history(e, 99, "pressure", &history) == TALUS_INVALID_ARGUMENT);
    CHECK(talus_engine_set_rain(e, 7, 0) == TALUS_INVALID_ARGUMENT);
    CHECK(talus_engine_set_rain(e, -1, 0) == TALUS_INVALID_ARGUMENT);
    CHECK(talus_engine_push_flow_value(e, 0, 1, values, values) == TALUS_INVALID_ARGUMENT);  // no boundary at all
    CHECK(talus_engine_field_name(e, -1, &name) == TALUS_INVALID_ARGUMENT);
    CHECK(talus_engine_field_name(e, 999, &name) == TALUS_INVALID_ARGUMENT);
    CHECK(talus_engine_event(e, 0, &event) == TALUS_INVALID_ARGUMENT);
    CHECK(talus_engine_read(e, "pressure", 3, values) == TALUS_INVALID_ARGUMENT);
    CHECK(host::contains(talus_engine_error(e), "pressure has 21 values"));
    CHECK(talus_engine_sample(e, "pressure", -1, values, values) == TALUS_INVALID_ARGUMENT);
    CHECK(talus_engine_sample(e, "pressure", INT64_MAX, values, values) == TALUS_INVALID_ARGUMENT);
    CHECK(talus_engine_sample(e, "cell_nodes", 1, values, values) == TALUS_INVALID_ARGUMENT);
    CHECK(talus_engine_add_probe(e, "sky", 0, 99, &number) == TALUS_INVALID_ARGUMENT);
}

TEST_CASE("C API: the text of a failure stays with its engine and its thread") {
    const host::Engine one = host::engine(host::column_text);
    const host::Engine other = host::engine(host::column_text);
    CHECK(std::string(talus_engine_error(one.get())).empty());
    CHECK(talus_engine_step(one.get(), -1, nullptr) == TALUS_INVALID_ARGUMENT);
    CHECK(host::contains(talus_engine_error(one.get()), "-1"));
    CHECK(std::string(talus_engine_error(other.get())).empty());
    CHECK(std::string(talus_last_error()) == talus_engine_error(one.get()));
}

TEST_CASE("C API: scenes are counted, and engines keep theirs") {
    talus_scene* scene = host::scene(host::column_text).release();
    REQUIRE(talus_scene_retain(scene) == TALUS_OK);
    REQUIRE(talus_scene_release(scene) == TALUS_OK);
    talus_engine* out = nullptr;
    REQUIRE(talus_engine_create(scene, nullptr, &out) == TALUS_OK);
    const host::Engine engine(out);
    REQUIRE(talus_scene_release(scene) == TALUS_OK);
    CHECK(talus_engine_step(engine.get(), 1, nullptr) == TALUS_OK);
}

TEST_CASE("C API: a wrong scene is refused with all that is wrong with it") {
    talus_scene* scene = nullptr;
    CHECK(talus_scene_from_json("{\"soils\": [{\"name\": \"a\", \"porosity\": 40}], \"colour\": 1}", -1, &scene) ==
          TALUS_INVALID_SCENE);
    CHECK(host::contains(talus_last_error(), "colour"));
    CHECK(talus_scene_from_json("{\"soils\": [{\"name\": \"a\", \"porosity\": 40}]}", -1, &scene) ==
          TALUS_INVALID_SCENE);
    CHECK(host::contains(talus_last_error(), "soils[0].porosity"));
    CHECK(host::contains(talus_last_error(), "ground"));
    CHECK(talus_scene_from_json("{", 1, &scene) == TALUS_INVALID_SCENE);
    CHECK(talus_scene_from_bytes("12345678", 8, &scene) == TALUS_INVALID_SCENE);
    CHECK(talus_scene_from_file("no/such/scene.json", &scene) == TALUS_INPUT_OUTPUT);
    CHECK(host::contains(talus_last_error(), "no/such/scene.json"));
    CHECK(talus_scene_from_file("/", &scene) == TALUS_INPUT_OUTPUT);
    CHECK(scene == nullptr);
}

TEST_CASE("C API: version, build and statuses have names") {
    CHECK(std::string(talus_version()) == "0.1.0");
    CHECK(talus_abi() == TALUS_ABI);
    CHECK(host::contains(talus_build_info(), "\"compiler\""));
    CHECK(std::string(talus_status_name(TALUS_NOT_CONVERGED)) == "not_converged");
    CHECK(std::string(talus_status_name(12345)) == "unknown");
}
