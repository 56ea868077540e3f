// The layout of talus.h's structs is frozen: they may grow at the end, and nothing in them may move.
#include "capi_host.hpp"

#include <cstddef>
#include <cstring>

TEST_CASE("C API: sizes and offsets of the structs are as released") {
    CHECK(sizeof(talus_options) == 56);
    CHECK(offsetof(talus_options, tolerance) == 8);
    CHECK(offsetof(talus_options, log) == 16);
    CHECK(offsetof(talus_options, progress_user) == 40);
    CHECK(offsetof(talus_options, threads) == 48);
    CHECK(sizeof(talus_array) == 32);
    CHECK(offsetof(talus_array, count) == 24);
    CHECK(sizeof(talus_field) == 120);
    CHECK(offsetof(talus_field, shape) == 16);
    CHECK(offsetof(talus_field, strides) == 48);
    CHECK(offsetof(talus_field, data) == 80);
    CHECK(offsetof(talus_field, epoch) == 112);
    CHECK(sizeof(talus_step_report) == 264);
    CHECK(offsetof(talus_step_report, time) == 8);
    CHECK(offsetof(talus_step_report, rain_substitutions) == 64);
    CHECK(offsetof(talus_step_report, water_residual) == 136);
    CHECK(offsetof(talus_step_report, seconds_total) == 184);
    CHECK(offsetof(talus_step_report, motion_substeps) == 192);
    CHECK(offsetof(talus_step_report, run_out) == 256);
    CHECK(sizeof(talus_event) == 48);
    CHECK(offsetof(talus_event, message) == 40);
    CHECK(sizeof(talus_history) == 40);
    CHECK(offsetof(talus_history, value) == 24);
    CHECK(sizeof(talus_raster) == 48);
    CHECK(offsetof(talus_raster, dy) == 40);
}

TEST_CASE("C API: a host of an older header gets what its struct has room for") {
    const host::Engine engine = host::engine(host::column_text);
    struct Old {
        int32_t struct_size, regime;
        double time;
        double beyond;
    } old{16, -1, -1, 1234};
    REQUIRE(talus_engine_step(engine.get(), 1, reinterpret_cast<talus_step_report*>(&old)) == TALUS_OK);
    CHECK(old.struct_size == 16);
    CHECK(old.time == 1);
    CHECK(old.beyond == 1234);
}

TEST_CASE("C API: a host of a newer header may ask for nothing that this library does not have") {
    const host::Scene scene = host::scene(host::column_text);
    struct {
        talus_options known;
        int64_t news;
    } newer{TALUS_OPTIONS_INIT, 0};
    newer.known.struct_size = sizeof newer;
    talus_engine* out = nullptr;
    REQUIRE(talus_engine_create(scene.get(), &newer.known, &out) == TALUS_OK);
    talus_engine_destroy(out);
    newer.news = 1;
    CHECK(talus_engine_create(scene.get(), &newer.known, &out) == TALUS_INVALID_ARGUMENT);
    CHECK(out == nullptr);
    CHECK(host::contains(talus_last_error(), "newer TALUS_OPTIONS_INIT"));
}

TEST_CASE("C API: what a newer header's struct has beyond this library's is zeroed") {
    const host::Engine engine = host::engine(host::column_text);
    struct {
        talus_step_report known;
        int64_t news;
    } newer{TALUS_STEP_REPORT_INIT, -1};
    newer.known.struct_size = sizeof newer;
    REQUIRE(talus_engine_step(engine.get(), 1, &newer.known) == TALUS_OK);
    CHECK(newer.known.time == 1);
    CHECK(newer.known.struct_size == sizeof newer);
    CHECK(newer.news == 0);
}

TEST_CASE("C API: a struct that was not begun is refused, before the step") {
    const host::Engine engine = host::engine(host::column_text);
    const int64_t before = host::hash(engine);
    talus_step_report report;
    std::memset(&report, 0, sizeof report);
    for (const int32_t size : {0, 4, -8, 1 << 20}) {
        report.struct_size = size;
        CHECK(talus_engine_step(engine.get(), 1, &report) == TALUS_INVALID_ARGUMENT);
        CHECK(host::contains(talus_engine_error(engine.get()), "TALUS_STEP_REPORT_INIT"));
    }
    CHECK(host::hash(engine) == before);
}
