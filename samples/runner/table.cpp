#include "runner/table.hpp"

#include "runner/progress.hpp"

#include <cmath>
#include <cstdio>

namespace runner {
namespace {

void row(const char* name, const std::string& value) { std::printf("%-24s %s\n", name, value.c_str()); }

std::string joined(const Json& texts) {
    std::string line;
    for (const Json& text : texts) line += (line.empty() ? "" : ", ") + text.get<std::string>();
    return line.empty() ? "-" : line;
}

std::string names(const Json& things) {
    Json list = Json::array();
    for (const Json& thing : things) list.push_back(thing.at("name"));
    return joined(list);
}

std::string count(const Json& number) { return number.dump(); }

std::string physics_text(const Json& physics) {
    const std::string water = physics.at("water") ? "pore water" : "dry";
    const std::string skeleton = !physics.at("deforming")            ? "rigid skeleton"
                                 : physics.at("regime") == "dynamic" ? "dynamic"
                                                                     : "deforming";
    return water + ", " + skeleton;
}

void print_sizes(const Json& description) {
    if (description.at("nodes") != 0)
        return row("mesh", count(description.at("nodes")) + " nodes, " + count(description.at("cells")) + " cells, " +
                               count(description.at("points")) + " points");
    row("points", count(description.at("points")) + " of " + count(description.at("bytes_a_point")) +
                      " bytes, in cells of " + formatted("%.4g m", description.at("cell_size").get<double>()));
}

void print_water(const talus_step_report& last, const char* unit) {
    const auto water = [&](const char* name, double value) { row(name, formatted("%12.6g %s", value, unit)); };
    water("rain", last.water_rain);
    water("  infiltrated", last.water_infiltrated);
    water("  run-off", last.water_run_off);
    water("seepage", last.water_seepage);
    water("inflow", last.water_inflow);
    water("drained", last.water_drained);
    water("stored more", last.water_stored - last.water_initial);
    water("missed by the balance", last.water_residual);
}

void print_motion(const talus_step_report& last) {
    row("velocity at the end", formatted("%12.6g m/s", last.largest_velocity));
    row("sliding volume", formatted("%12.6g m3/m", last.sliding_volume));
    row("front at x", formatted("%12.6g m", last.front_x));
    row("run-out", formatted("%12.6g m", last.run_out));
    row("kinetic energy", formatted("%12.6g J/m", last.kinetic_energy));
    row("dissipated energy", formatted("%12.6g J/m", last.dissipated_energy));
}

}  // namespace

void print_description(const Json& description) {
    row("scene", description.at("name").get<std::string>() + ": " + description.at("title").get<std::string>());
    row("physics", physics_text(description.at("physics")));
    row("left out", joined(description.at("left_out")));
    print_sizes(description);
    row("rain zones", names(description.at("zones")));
    row("boundaries", names(description.at("boundaries")));
    row("probes", names(description.at("probes")));
    const Json& duration = description.at("schedule").at("duration");
    row("duration", duration.is_null() ? "-" : duration_text(duration.get<double>()));
}

void print_table(const Json& description, const talus_step_report& last, const Json& events, double wall) {
    const char* unit = description.at("dimension") == 1 ? "m3/m2" : "m3/m";
    const Json& physics = description.at("physics");
    print_description(description);
    row("simulated", duration_text(last.time) + " in " + duration_text(wall) +
                         formatted(" (%.3g x real time)", last.time / std::fmax(wall, 1e-9)));
    if (physics.at("water")) print_water(last, unit);
    if (physics.at("deforming")) row("largest displacement", formatted("%12.6g m", last.largest_displacement));
    if (physics.at("regime") == "dynamic") {
        print_motion(last);
    } else if (physics.at("deforming")) {
        row("least factor of safety",
            last.least_factor_of_safety > 0 ? formatted("%12.4g local", last.least_factor_of_safety) : "-");
    }
    for (const Json& event : events) row("event", event.at("message"));
}

}  // namespace runner
