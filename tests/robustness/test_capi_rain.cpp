// Bad rain: refused with a text that names it, or replaced as the host's policy says and counted.
#include "capi_host.hpp"

#include <cmath>
#include <limits>
#include <vector>

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

talus_status push(const host::Engine& engine, const std::vector<double>& time, const std::vector<double>& rate) {
    return talus_engine_push_rain(engine.get(), 0, static_cast<int64_t>(time.size()), time.data(), rate.data());
}

host::Engine with_policy(int32_t policy) {
    talus_options options = TALUS_OPTIONS_INIT;
    options.rain_policy = policy;
    return host::engine(host::column_text, &options);
}

/// Rain that fell in the column and values replaced, after 300 s with rates of 100 s each.
talus_step_report after(const host::Engine& engine, const std::vector<double>& rate) {
    REQUIRE_MESSAGE(push(engine, {0, 100, 200}, rate) == TALUS_OK, talus_last_error());
    talus_step_report report = TALUS_STEP_REPORT_INIT;
    REQUIRE(talus_engine_step(engine.get(), 300, &report) == TALUS_OK);
    return report;
}

}  // namespace

TEST_CASE("C API: bad rain is refused and changes nothing") {
    const host::Engine engine = host::engine(host::column_text);
    const host::Engine untouched = host::engine(host::column_text);
    const auto refused = [&](const std::vector<double>& time, const std::vector<double>& rate, const char* part) {
        CHECK(push(engine, time, rate) == TALUS_INVALID_ARGUMENT);
        CHECK_MESSAGE(host::contains(talus_engine_error(engine.get()), part), talus_engine_error(engine.get()));
    };
    refused({0, 100}, {1e-5, not_a_number}, "[1]");
    refused({0, 100}, {1e-5, -1e-5}, "[1]");
    refused({0, 100}, {1e-5, std::numeric_limits<double>::infinity()}, "[1]");
    refused({0, 100, 100}, {0, 0, 0}, "time[2]");
    refused({100, 0}, {0, 0}, "time[1]");
    refused({not_a_number}, {0}, "time[0]");
    refused({-1}, {0}, "time[0]");
    refused({0}, {12}, "mm/h");
    CHECK(talus_engine_push_rain(engine.get(), 0, 0, nullptr, nullptr) == TALUS_INVALID_ARGUMENT);
    CHECK(talus_engine_set_rain(engine.get(), 0, not_a_number) == TALUS_INVALID_ARGUMENT);
    CHECK(talus_engine_set_rain(engine.get(), 0, 12) == TALUS_INVALID_ARGUMENT);

    REQUIRE(talus_engine_step(engine.get(), 60, nullptr) == TALUS_OK);
    REQUIRE(talus_engine_step(untouched.get(), 60, nullptr) == TALUS_OK);
    CHECK(host::hash(engine) == host::hash(untouched));
    CHECK(push(engine, {59}, {0}) == TALUS_INVALID_ARGUMENT);  // the past
}

TEST_CASE("C API: a policy replaces bad rates and counts them") {
    const auto [held, zeroed] = std::pair(with_policy(TALUS_RAIN_HOLD), with_policy(TALUS_RAIN_ZERO));
    const talus_step_report hold = after(held, {5e-5, not_a_number, -1});
    CHECK(hold.water_rain == doctest::Approx(5e-5 * 300));
    CHECK(hold.rain_substitutions == 2);
    const talus_step_report zero = after(zeroed, {5e-5, not_a_number, -1});
    CHECK(zero.water_rain == doctest::Approx(5e-5 * 100));
    CHECK(zero.rain_substitutions == 2);
}

TEST_CASE("C API: a held rate is that of the push before, and there must be one") {
    const host::Engine engine = with_policy(TALUS_RAIN_HOLD);
    CHECK(push(engine, {0}, {not_a_number}) == TALUS_INVALID_ARGUMENT);
    REQUIRE(push(engine, {0}, {2e-5}) == TALUS_OK);
    REQUIRE(talus_engine_set_rain(engine.get(), 0, not_a_number) == TALUS_OK);
    CHECK(push(engine, {0, 0}, {not_a_number, not_a_number}) == TALUS_INVALID_ARGUMENT);  // refused: not counted
    talus_step_report report = TALUS_STEP_REPORT_INIT;
    REQUIRE(talus_engine_step(engine.get(), 100, &report) == TALUS_OK);
    CHECK(report.water_rain == doctest::Approx(2e-3));
    CHECK(report.rain_substitutions == 1);
}

TEST_CASE("C API: no policy makes implausible rates or disordered times good") {
    for (const int32_t policy : {TALUS_RAIN_HOLD, TALUS_RAIN_ZERO}) {
        const host::Engine engine = with_policy(policy);
        CHECK(push(engine, {0}, {12}) == TALUS_INVALID_ARGUMENT);
        CHECK(push(engine, {1, 0}, {0, 0}) == TALUS_INVALID_ARGUMENT);
    }
    talus_options options = TALUS_OPTIONS_INIT;
    options.rain_policy = 3;
    talus_engine* out = nullptr;
    CHECK(talus_engine_create(host::scene(host::column_text).get(), &options, &out) == TALUS_INVALID_ARGUMENT);
    options.rain_policy = 0;
    options.tolerance = not_a_number;
    CHECK(talus_engine_create(host::scene(host::column_text).get(), &options, &out) == TALUS_INVALID_ARGUMENT);
}

TEST_CASE("C API: a forecast may be revised") {
    const host::Engine engine = host::engine(host::column_text);
    REQUIRE(push(engine, {0, 100, 200}, {1e-5, 2e-5, 3e-5}) == TALUS_OK);
    REQUIRE(talus_engine_step(engine.get(), 100, nullptr) == TALUS_OK);
    REQUIRE(push(engine, {150}, {4e-5}) == TALUS_OK);
    talus_step_report report = TALUS_STEP_REPORT_INIT;
    REQUIRE(talus_engine_advance_to(engine.get(), 300, &report) == TALUS_OK);
    CHECK(report.time == 300);
    CHECK(report.water_rain == doctest::Approx(1e-5 * 100 + 2e-5 * 50 + 4e-5 * 150));
}
