#include "runner/records.hpp"

#include <array>
#include <charconv>
#include <vector>

namespace runner {

namespace {

const char* regime_name(int32_t regime) {
    constexpr const char* names[] = {"quasi_static", "equilibrium_lost", "dynamic", "at_rest"};
    return names[regime];
}

}  // namespace

Json report_json(const talus_step_report& report) {
    return {
        {"time", report.time},
        {"regime", regime_name(report.regime)},
        {"flow_substeps", report.flow_substeps},
        {"flow_failures", report.flow_failures},
        {"flow_iterations", report.flow_iterations},
        {"coupling_steps", report.coupling_steps},
        {"coupling_iterations", report.coupling_iterations},
        {"motion_iterations", report.motion_iterations},
        {"rain_substitutions", report.rain_substitutions},
        {"water_rain", report.water_rain},
        {"water_infiltrated", report.water_infiltrated},
        {"water_run_off", report.water_run_off},
        {"water_seepage", report.water_seepage},
        {"water_inflow", report.water_inflow},
        {"water_drained", report.water_drained},
        {"water_stored", report.water_stored},
        {"water_initial", report.water_initial},
        {"water_residual", report.water_residual},
        {"largest_displacement", report.largest_displacement},
        {"largest_velocity", report.largest_velocity},
        {"least_factor_of_safety", report.least_factor_of_safety},
        {"seconds_flow", report.seconds_flow},
        {"seconds_motion", report.seconds_motion},
        {"seconds_total", report.seconds_total},
        {"motion_substeps", report.motion_substeps},
        {"kinetic_energy", report.kinetic_energy},
        {"elastic_energy", report.elastic_energy},
        {"potential_energy", report.potential_energy},
        {"dissipated_energy", report.dissipated_energy},
        {"peak_velocity", report.peak_velocity},
        {"sliding_volume", report.sliding_volume},
        {"front_x", report.front_x},
        {"run_out", report.run_out},
    };
}

namespace {

Json event_json(const talus_event& event) {
    static constexpr std::array kinds = {
        "",           "saturated",      "ponding_started", "ponding_ended", "seepage_started", "loss_of_equilibrium",
        "rain_ended", "motion_started", "came_to_rest",    "settled",       "left_background"};
    const auto kind = static_cast<size_t>(event.kind);
    return {
        {"kind", kind < kinds.size() ? kinds[kind] : "unknown"},
        {"time", event.time},
        {"x", event.x},
        {"y", event.y},
        {"value", event.value},
        {"message", event.message},
    };
}

std::string number(double value) {
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

talus_history history(const Engine& engine, int32_t probe, const std::string& quantity) {
    talus_history out = TALUS_HISTORY_INIT;
    check(talus_engine_probe_history(engine.get(), probe, quantity.c_str(), &out));
    return out;
}

}  // namespace

Json events_json(const Engine& engine) {
    int64_t count = 0;
    check(talus_engine_event_count(engine.get(), &count));
    Json events = Json::array();
    for (int64_t i = 0; i < count; ++i) {
        talus_event event = TALUS_EVENT_INIT;
        check(talus_engine_event(engine.get(), i, &event));
        events.push_back(event_json(event));
    }
    return events;
}

std::string probes_csv(const Engine& engine, const Json& description) {
    std::vector<talus_history> columns;
    std::string csv = "time";
    int32_t probe = 0;
    for (const Json& named : description.at("probes")) {
        for (const Json& quantity : description.at("probe_quantities")) {
            columns.push_back(history(engine, probe, quantity));
            csv.append(1, ',').append(named.at("name")).append(1, '.').append(quantity);
        }
        ++probe;
    }
    if (columns.empty()) return {};
    for (int64_t row = 0; row < columns.front().count; ++row) {
        csv.append(1, '\n').append(number(columns.front().time[row]));
        for (const talus_history& column : columns) csv.append(1, ',').append(number(column.value[row]));
    }
    return csv.append(1, '\n');
}

std::string hash_text(const Engine& engine) {
    int64_t hash = 0;
    check(talus_engine_hash(engine.get(), &hash));
    std::array<char, 17> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), static_cast<uint64_t>(hash), 16).ptr;
    const std::string digits(text.data(), end);
    return std::string(16 - digits.size(), '0') + digits;
}

}  // namespace runner
