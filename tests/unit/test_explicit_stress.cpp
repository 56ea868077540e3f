// Stress of material points in motion under a given gradient of velocity.
#include "doctest/doctest.h"
#include "motion/explicit/stress.hpp"

#include <cmath>

using namespace talus;

namespace {

constexpr double grain_density = 2600, diameter = 1e-3, inertial_number = 0.279;  // kg/m3, m

/// Sand of 30 degrees, or 60 at a boundless rate of shear.
ExplicitSoil sand() {
    ExplicitSoil soil{elasticity(2e6, 0.3), true, mohr_coulomb({0, 30}, 0, 1e300)};
    soil.friction_rise = std::sin(std::acos(0.5)) - 0.5;
    soil.inertial_root = diameter * std::sqrt(grain_density) / inertial_number;
    return soil;
}

/// Ratio of shear stress to pressure in the plane of a point that is sheared at a rate (1/s) until it flows, under a pressure (Pa) at the
/// start.
double flow_ratio(double rate, double pressure, double& end_pressure) {
    FreePoints points;
    points.assign(1, dry_fields);
    points[point_volume][0] = 1;
    for (const PointField name : {stress_xx, stress_yy, stress_zz}) points[name][0] = -pressure;
    const std::vector<ExplicitSoil> soils{sand()};
    GradientBlock gradient{};
    gradient.xy[0] = rate;
    MaterialBlock material;
    const double dt = 1e-5 / rate;
    for (int step = 0; step < 10000; ++step) {
        set_elasticity(soils, points, 0, 1, material);
        strain_elastically(points, 0, 1, dt, gradient, material);
        set_strength(soils, points, 0, 1, 1.0, material);
        add_inertial_friction(soils, points, 0, 1, gradient, material);
        return_stresses(points, 0, 1, material);
    }
    end_pressure = -(points[stress_xx][0] + points[stress_yy][0] + points[stress_zz][0]) / 3;
    return points[stress_xy][0] / (-0.5 * (points[stress_xx][0] + points[stress_yy][0]));
}

}  // namespace

TEST_CASE("sand in shear has the friction of its inertial number") {
    for (const double rate : {1e-4, 1.0, 30.0, 1e3, 1e6}) {
        for (const double pressure : {100.0, 1e4}) {
            double end_pressure = 0;
            const double ratio = flow_ratio(rate, pressure, end_pressure);
            const double number = rate * diameter / std::sqrt(end_pressure / grain_density);
            const double wanted = 0.5 + sand().friction_rise / (1 + inertial_number / number);
            CAPTURE(rate);
            CHECK(ratio == doctest::Approx(wanted).epsilon(1e-3));
        }
    }
}
