// The mean k_r of a link: what its flow may never do, and how accurate it is.
#include "flow/mean_permeability.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace talus;

namespace {

struct NamedSoil {
    std::string name;
    HydraulicTable table;
};

Hydraulics curves(RetentionModel retention, PermeabilityModel permeability, double n, double alpha) {
    Hydraulics hydraulics;
    hydraulics.retention.model = retention;
    hydraulics.retention.n = n;
    hydraulics.retention.alpha = alpha;
    hydraulics.relative_permeability.model = permeability;
    hydraulics.relative_permeability.alpha = alpha;
    return hydraulics;
}

const std::vector<NamedSoil>& soils() {
    using R = RetentionModel;
    using P = PermeabilityModel;
    static const std::vector<NamedSoil> all = {
        {"the paper's", HydraulicTable(curves(R::van_genuchten, P::mualem, 1.2, 4e-5))},
        {"N = 1.05", HydraulicTable(curves(R::van_genuchten, P::mualem, 1.05, 4e-5))},
        {"N = 4", HydraulicTable(curves(R::van_genuchten, P::mualem, 4, 1e-4))},
        {"Gardner's", HydraulicTable(curves(R::gardner, P::gardner, 0, 2e-4))},
        {"Brooks and Corey's", HydraulicTable(curves(R::brooks_corey, P::brooks_corey, 0.4, 2e-5))},
        {"constant k_r", HydraulicTable(curves(R::van_genuchten, P::constant, 1.2, 4e-5))},
    };
    return all;
}

LinkEnd end_at(const HydraulicTable& table, double pressure) { return {pressure, table.at(pressure)}; }

double flow(const HydraulicTable& table, double upper, double lower, double fall) {
    return mean_permeability(table, end_at(table, upper), end_at(table, lower), fall).value * (upper + fall - lower);
}

/// From -1e6 to 1e5 Pa, evenly in the logarithm on either side of 0, down to 1 Pa.
std::vector<double> pressures(int a_decade) {
    std::vector<double> all;
    for (int i = 6 * a_decade; i >= 0; --i) all.push_back(-std::pow(10, static_cast<double>(i) / a_decade));
    all.push_back(0);
    for (int i = 0; i <= 5 * a_decade; ++i) all.push_back(std::pow(10, static_cast<double>(i) / a_decade));
    return all;
}

constexpr double falls[] = {1, 10, 100, 1e3, 1e4, 1e5};

}  // namespace

TEST_CASE("the flow of a link grows with the upper pressure and falls with the lower one") {
    const std::vector<double> at = pressures(10);
    for (const auto& [name, table] : soils()) {
        std::vector<LinkEnd> end;
        for (const double p : at) end.push_back(end_at(table, p));
        constexpr double tolerance = 1e-7;
        for (const double fall : falls) {
            double worst_upper = 0, worst_lower = 0;
            std::vector<double> row_before, row(at.size());
            for (size_t u = 0; u < at.size(); ++u) {
                for (size_t l = 0; l < at.size(); ++l) {
                    row[l] = mean_permeability(table, end[u], end[l], fall).value * (at[u] + fall - at[l]);
                    const double round_off = 1e-13 * std::max({fall, std::abs(at[u]), std::abs(at[l])});
                    const auto turned = [&](double rise, double other) {
                        return (rise - round_off) / (round_off + std::abs(row[l]) + std::abs(other));
                    };
                    if (l > 0) worst_lower = std::max(worst_lower, turned(row[l] - row[l - 1], row[l - 1]));
                    if (u > 0) worst_upper = std::max(worst_upper, turned(row_before[l] - row[l], row_before[l]));
                }
                row_before = row;
            }
            CAPTURE(name);
            CAPTURE(fall);
            CHECK(worst_upper < tolerance);
            CHECK(worst_lower < tolerance);
        }
    }
}

TEST_CASE("nothing flows at hydrostatic pressure and the mean k_r is never negative") {
    for (const auto& [name, table] : soils()) {
        for (const double fall : falls) {
            for (const double upper : pressures(3)) {
                CAPTURE(name);
                CHECK(std::abs(flow(table, upper, upper + fall, fall)) <= 1e-12 * (fall + std::abs(upper)));
                for (const double lower : pressures(3))
                    CHECK(mean_permeability(table, end_at(table, upper), end_at(table, lower), fall).value >= 0);
            }
        }
    }
}

TEST_CASE("upward flow and flow along a level link have the integral mean of k_r, between the least and the greatest") {
    for (const auto& [name, table] : soils()) {
        for (const double upper : pressures(3)) {
            for (const double lower : pressures(3)) {
                const LinkEnd a = end_at(table, upper), b = end_at(table, lower);
                const auto [least, greatest] = std::minmax(a.state.permeability, b.state.permeability);
                const double level = mean_permeability(table, a, b, 0).value;
                CAPTURE(name);
                CHECK(level >= least * (1 - 1e-12));
                CHECK(level <= greatest * (1 + 1e-12));
                const double difference = a.state.potential - b.state.potential;
                const double lost_digits = 1e-13 * (std::abs(a.state.potential) + std::abs(b.state.potential));
                CHECK(std::abs(level * (upper - lower) - difference) <= 2e-6 * std::abs(difference) + lost_digits);
                if (upper + 100 <= lower) CHECK(mean_permeability(table, a, b, 100).value == level);
            }
        }
    }
}

TEST_CASE("the mean k_r is of second order where gravity does not dominate a link") {
    const HydraulicTable& table = soils().front().table;
    const double exact = table.at(-12000).permeability;
    const auto error = [&](double step) {
        return std::abs(flow(table, -12000 + step / 2, -12000 - step / 2, step) / (2 * step) - exact);
    };
    CHECK(error(800) < 0.01 * exact);
    CHECK(error(800) / error(400) == doctest::Approx(4).epsilon(0.05));
}

TEST_CASE("the slopes of the mean k_r are its derivatives") {
    int tried = 0;
    for (const auto& [name, table] : soils()) {
        for (const double fall : {10., 1500., 3e4}) {
            for (const double upper : {-3.3e5, -2.1e4, -3.7e3, -150., 700.}) {
                for (const double lower : {-2.9e5, -1.7e4, -2.9e3, -88., 950.}) {
                    const auto value = [&](double by_upper, double by_lower) {
                        return mean_permeability(table, end_at(table, upper + by_upper),
                                                 end_at(table, lower + by_lower), fall)
                            .value;
                    };
                    const MeanPermeability mean =
                        mean_permeability(table, end_at(table, upper), end_at(table, lower), fall);
                    const auto check = [&](double slope, double before, double after, double step, double pressure) {
                        // A millionth of the largest slope that k_r itself has over its suction; round-off of the potential.
                        const double tolerance =
                            3e-3 * std::abs(slope) + 1e-4 * mean.value / std::abs(pressure) + 1e-9 / step;
                        CAPTURE(name);
                        CAPTURE(fall);
                        CAPTURE(upper);
                        CAPTURE(lower);
                        CHECK(std::abs((after - before) / (2 * step) - slope) <= tolerance);
                        ++tried;
                    };
                    const double du = 1e-4 * std::abs(upper), dl = 1e-4 * std::abs(lower);
                    check(mean.slope_upper, value(-du, 0), value(du, 0), du, upper);
                    check(mean.slope_lower, value(0, -dl), value(0, dl), dl, lower);
                }
            }
        }
    }
    CHECK(tried == 900);
}

TEST_CASE("a filled cell above a dry one keeps half of its diffusion") {
    const HydraulicTable& table = soils().front().table;
    for (const double lower : {-1e5, -2e4, -3e3, -100.}) {
        const double step = 1e-4 * std::abs(lower);
        const double slope = (flow(table, 0, lower + step, 1000) - flow(table, 0, lower - step, 1000)) / (2 * step);
        CHECK(slope <= -0.499 * table.at(lower).permeability);
    }
}
