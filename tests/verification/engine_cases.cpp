// Verification cases that a scene cannot express: the program prints the rows of one of them as JSON, for tests/verify.
#include "verification/explicit_cases.hpp"
#include "verification/flow_cases.hpp"
#include "verification/footing.hpp"
#include "verification/skeleton_cases.hpp"

#include <chrono>
#include <cstdio>
#include <ctime>
#include <map>
#include <string>

using namespace talus;
using namespace talus::test;

namespace {

struct Requirement {
    const char* quantity;
    const char* norm;
    double bound;
    const char* reference;
};

class Rows {
public:
    explicit Rows(std::string name) : name_(std::move(name)) {}

    /// Prints the row of the error that `find` finds, of one shape of cells.
    template <class Find>
    void add(CellKind kind, const Requirement& requirement, const Find& find) {
        add(std::string(requirement.quantity) + (kind == CellKind::quads ? ", quads" : ", triangles"), requirement,
            find);
    }

    template <class Find>
    void add(const std::string& quantity, const Requirement& requirement, const Find& find) {
        const auto wall = std::chrono::steady_clock::now();
        const std::clock_t cpu = std::clock();
        const double error = find();
        const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
        const double cpu_s = static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
        std::printf(
            "%s{\"case\": \"%s\", \"quantity\": \"%s\", \"norm\": \"%s\", \"error\": %.17g, \"bound\": %g, \"unit\": \"1\", "
            "\"reference\": \"%s\", \"wall_s\": %.6f, \"cpu_s\": %.6f, \"threads\": 1, \"met\": %s}",
            any_ ? ",\n " : "[", name_.c_str(), quantity.c_str(), requirement.norm,
            std::isfinite(error) ? error : 1e300, requirement.bound, requirement.reference, wall_s, cpu_s,
            error <= requirement.bound ? "true" : "false");
        any_ = true;
    }

    ~Rows() { std::puts(any_ ? "]" : "[]"); }
    Rows(const Rows&) = delete;
    Rows& operator=(const Rows&) = delete;

private:
    std::string name_;
    bool any_ = false;
};

constexpr std::array<CellKind, 2> both_kinds{CellKind::quads, CellKind::triangles};

void press_footing(Rows& rows, CellKind kind, int32_t cells_under_strip, bool rough) {
    const std::string quantity =
        std::string("N_c, ") + (rough ? "rough" : "smooth") + ", " + std::to_string(cells_under_strip) + " cells";
    rows.add(quantity, {"", "rel", 0.03, "Prandtl 1920: 2 + pi"}, [&] {
        const Footing footing = press_footing(kind, cells_under_strip, rough);
        if (!footing.converged) return std::numeric_limits<double>::infinity();
        return std::abs(footing.bearing_factor / (2 + std::numbers::pi) - 1);
    });
}

void press_quads(Rows& rows) {
    for (const bool rough : {false, true}) press_footing(rows, CellKind::quads, 16, rough);
}

void press_triangles(Rows& rows) { press_footing(rows, CellKind::triangles, 12, false); }

void patch(Rows& rows) {
    for (const CellKind kind : both_kinds) {
        rows.add(kind, {"displacement", "max", 1e-10, "linear in x and y"},
                 [&] { return skeleton_patch_error(kind).displacement; });
        rows.add(kind, {"stress", "max", 1e-10, "uniform"}, [&] { return skeleton_patch_error(kind).stress; });
        rows.add(kind, {"steady pressure", "max", 1e-10, "head linear in x and y"},
                 [&] { return flow_patch_error(kind); });
    }
}

/// How far the observed order falls short of 2, from the errors at two resolutions of which the second is twice as fine.
double shortfall(double coarse, double fine) { return std::max(0.0, 2 - std::log2(coarse / fine)); }

void order(Rows& rows) {
    constexpr double bound = 0.1;
    for (const CellKind kind : both_kinds) {
        rows.add(kind, {"2 - order of displacement", "L2", bound, "curl of sin^2 sin^2, nu = 0.3"},
                 [&] { return shortfall(displacement_error(kind, 32, 0.3), displacement_error(kind, 64, 0.3)); });
        rows.add(kind, {"2 - order, kept volume", "L2", bound, "the same, nu = 0.4999"},
                 [&] { return shortfall(displacement_error(kind, 32, 0.4999), displacement_error(kind, 64, 0.4999)); });
        rows.add(kind, {"2 - order of saturated flow", "L2", bound, "harmonic head"}, [&] {
            return shortfall(steady_error(kind, 32, saturated_pressure), steady_error(kind, 64, saturated_pressure));
        });
        rows.add(kind, {"2 - order of unsaturated flow", "L2", bound, "Gardner, linear in exp(alpha p)"}, [&] {
            return shortfall(steady_error(kind, 32, gardner_pressure), steady_error(kind, 64, gardner_pressure));
        });
    }
    rows.add("2 - order in time of flow", {"", "max", bound, "100 times smaller steps"},
             [] { return shortfall(redistribution_error(16), redistribution_error(32)); });
}

void vibrate(Rows& rows) {
    for (const size_t cells : {25, 50, 100}) {
        const std::string resolution = ", " + std::to_string(cells) + " cells";
        BarErrors errors{};
        rows.add("energy over 100 periods" + resolution, {"", "rel", 0.01, "kept"}, [&] {
            errors = vibrate_bar(cells, 0.5, 100);
            return errors.energy;
        });
        rows.add("period" + resolution, {"", "rel", 0.005, "4 L / c"}, [&] { return errors.period; });
    }
}

void fly(Rows& rows) {
    FlightErrors errors{};
    rows.add("linear momentum, a step of 10,000", {"", "rel", 1e-12, "kept"}, [&] {
        errors = fly_block(10000);
        return errors.linear;
    });
    rows.add("angular momentum, a step of 10,000", {"", "rel", 1e-12, "kept"}, [&] { return errors.angular; });
    rows.add("volume, after 10,000 steps", {"", "rel", 1e-2, "kept"}, [&] { return errors.volume; });
}

const std::map<std::string, void (*)(Rows&)> cases{
    {"elastic_bar", vibrate},        {"rotation", fly}, {"footing_q4", press_quads},
    {"footing_t3", press_triangles}, {"patch", patch},  {"order", order},
};

}  // namespace

int main(int count, char** arguments) {
    const auto found = count == 2 ? cases.find(arguments[1]) : cases.end();
    if (found == cases.end()) {
        std::fputs("usage: engine_cases CASE, one of:", stderr);
        for (const auto& [name, run] : cases) std::fprintf(stderr, " %s", name.c_str());
        std::fputs("\n", stderr);
        return 2;
    }
    Rows rows(found->first);
    found->second(rows);
    return 0;
}
