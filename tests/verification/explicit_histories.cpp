// Histories of explicit motion in columns one cell wide, as JSON, for the rows of tests/verification/explicit_motion.py.
#include "materials/hydraulic/curves.hpp"
#include "motion/explicit/explicit_mixture.hpp"
#include "verification/explicit_cases.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

using namespace talus;
using namespace talus::test;

namespace {

struct Ground {
    double height, porosity, grain_density;  // m, -, kg/m3
    Elasticity elastic;
    double mobility;      // m2/(Pa s)
    double bulk_modulus;  // of the water, Pa
    double filled;        // share of the pores
};

constexpr double water_density = 1000;

Walls rollers(double cell_size) {
    return {{WallKind::roller, 0, 0}, {WallKind::roller, cell_size, 0}, {WallKind::roller, 0, 0}};
}

/// One point beside the other would move alike: a single row of them stands in the column's middle.
FreePoints column_of_points(const Ground& ground, size_t cells, size_t fields = wet_fields) {
    const double cell_size = ground.height / static_cast<double>(cells), spacing = cell_size / 2;
    FreePoints points;
    points.assign(2 * cells, fields);
    for (size_t p = 0; p < points.count; ++p) {
        points[position_x][p] = spacing;
        points[position_y][p] = (static_cast<double>(p) + 0.5) * spacing;
        points[point_volume][p] = cell_size * spacing;
        points[solid_mass][p] = (1 - ground.porosity) * ground.grain_density * points[point_volume][p];
        points[water_mass][p] = ground.porosity * ground.filled * water_density * points[point_volume][p];
    }
    return points;
}

template <Filling filling>
ExplicitMixture<filling> column_of(const Ground& ground, size_t cells, double gravity, FreePoints points,
                                   std::vector<SaturationTable> tables) {
    const double cell_size = ground.height / static_cast<double>(cells);
    return {cell_size,
            rollers(cell_size),
            gravity,
            {{ground.elastic}},
            {{ground.grain_density, ground.mobility}},
            std::move(tables),
            {water_density, ground.bulk_modulus},
            std::move(points),
            1};
}

/// Indices of the points from the base up.
template <class Column>
std::vector<size_t> upwards(const Column& column) {
    std::vector<size_t> order(column.points().count);
    for (size_t p = 0; p < order.size(); ++p) order[static_cast<size_t>(column.points().number[p])] = p;
    return order;
}

void print(const char* name, const std::vector<double>& values, const char* end) {
    std::printf("\"%s\": [", name);
    for (size_t i = 0; i < values.size(); ++i) std::printf("%s%.17g", i == 0 ? "" : ", ", values[i]);
    std::printf("]%s\n", end);
}

/// de Boer's column under 3 kPa (1 - cos 75 t): displacement of the surface, pressures at points.
void saturated_wave(size_t cells) {
    const Ground ground{10, 0.33, 2000, {5.5833e6, 8.3750e6}, 1e-2 / (water_density * 9.81), 2e11, 1};
    auto column = column_of<Filling::saturated>(ground, cells, 0, column_of_points(ground, cells), {});
    column.set_immersed(true);
    constexpr int outputs = 50;
    constexpr double duration = 0.2;
    const auto steps = static_cast<int64_t>(std::ceil(duration / column.critical_step() / outputs));
    const double dt = duration / static_cast<double>(outputs * steps);
    std::vector<double> times, depths, displacements, pressures;
    for (int output = 1; output <= outputs; ++output) {
        for (int64_t i = 1; i <= steps; ++i) {
            const double time = dt * (static_cast<double>((output - 1) * steps + i) - 0.5);
            column.set_edge_pressure(3000 * (1 - std::cos(75 * time)));
            column.step(dt, i == steps);
        }
        times.push_back(dt * static_cast<double>(output * steps));
        const std::vector<size_t> order = upwards(column);
        for (const double depth : {0.0, 1.0, 5.0}) {
            const auto row = static_cast<size_t>(static_cast<double>(2 * cells) * (1 - depth / ground.height)) - 1;
            const double start = (static_cast<double>(row) + 0.5) * ground.height / static_cast<double>(2 * cells);
            depths.push_back(ground.height - start);
            displacements.push_back(start - column.points()[position_y][order[row]]);
            pressures.push_back(column.pressure(order[row]));
        }
    }
    std::puts("{");
    print("time", times, ",");
    print("depth", depths, ",");
    print("displacement", displacements, ",");
    print("pressure", pressures, "}");
}

/// A standing wave of a quarter wave length in a column whose surface is held at no pressure: the solid's momentum in it, in time.
void standing_wave(size_t cells, double solid, double liquid, double mobility, double duration) {
    const Ground ground{1, 0.4, 2650, elasticity(20e6, 0.3), mobility, 2e9, 1};
    FreePoints points = column_of_points(ground, cells);
    const double number = std::numbers::pi / 2 / ground.height;
    for (size_t p = 0; p < points.count; ++p) {
        const double shape = 1e-3 * std::sin(number * points[position_y][p]);
        const double slope = 1e-3 * number * std::cos(number * points[position_y][p]);
        points[velocity_y][p] = solid * shape;
        points[liquid_velocity_y][p] = liquid * shape;
        points[affine_yy][p] = solid * slope;
        points[liquid_affine_yy][p] = liquid * slope;
    }
    auto column = column_of<Filling::saturated>(ground, cells, 0, std::move(points), {});
    column.set_immersed(true);
    const auto steps = static_cast<int64_t>(std::ceil(duration / column.critical_step()));
    const double dt = duration / static_cast<double>(steps);
    std::vector<double> amplitude;
    for (int64_t i = 1; i <= steps; ++i) {
        column.step(dt, true);
        double sum = 0;
        for (size_t p = 0; p < column.points().count; ++p)
            sum += column.points()[velocity_y][p] * std::sin(number * column.points()[position_y][p]);
        amplitude.push_back(sum);
    }
    std::printf("{\"step\": %.17g,\n", dt);
    print("amplitude", amplitude, "}");
}

/// Masses of the air in a column whose gas has one pressure, Pa.
void fill_with_air(const Ground& ground, const ExplicitGas& air, double pressure, FreePoints& points) {
    for (size_t p = 0; p < points.count; ++p)
        points[gas_mass][p] = air.density * (1 + pressure / air.atmosphere) * ground.porosity * (1 - ground.filled) *
                              points[point_volume][p];
}

ExplicitMixture<Filling::three_phase> column_with_gas(const Ground& ground, size_t cells, double gravity,
                                                      double gas_mobility, bool closed, FreePoints points,
                                                      const Hydraulics& soil, const ExplicitGas& air) {
    const double cell_size = ground.height / static_cast<double>(cells);
    Walls walls = rollers(cell_size);
    if (closed) walls.top = {WallKind::roller, ground.height, 0};
    return {cell_size,
            walls,
            gravity,
            {{ground.elastic}},
            {{ground.grain_density, ground.mobility, 0, false, gas_mobility}},
            {{soil, ground.bulk_modulus}},
            {water_density, ground.bulk_modulus},
            std::move(points),
            1,
            air};
}

/// A closed column whose fluids exchange water and air, at 20 degrees, without weight.
ExplicitMixture<Filling::exchange> closed_column(const Ground& ground, size_t cells, double gas_mobility,
                                                 FreePoints points, const Hydraulics& soil,
                                                 const ExplicitExchange& exchange) {
    const double cell_size = ground.height / static_cast<double>(cells);
    Walls walls = rollers(cell_size);
    walls.top = {WallKind::roller, ground.height, 0};
    const FluidExchange& fluids = exchange.fluids;
    return {cell_size,
            walls,
            0,
            {{ground.elastic}},
            {{ground.grain_density, ground.mobility, 0, false, gas_mobility}},
            {{soil, ground.bulk_modulus}},
            {water_density, ground.bulk_modulus},
            std::move(points),
            1,
            {fluids.atmosphere / fluids.air, fluids.atmosphere},
            exchange};
}

struct WaterAndAir {
    double water = 0, air = 0;  // kg per metre of thickness
};

WaterAndAir held(const FreePoints& points) {
    WaterAndAir sum;
    for (size_t p = 0; p < points.count; ++p) {
        const double vapour = points[vapour_mass][p] + points[vapour_due][p];
        const double dissolved = points[dissolved_mass][p] + points[dissolved_due][p];
        sum.water += points[water_mass][p] + points[water_due][p] - dissolved + vapour;
        sum.air += points[gas_mass][p] + points[gas_due][p] - vapour + dissolved;
    }
    return sum;
}

template <class Column>
int64_t advance(Column& column, double duration) {
    const auto steps = static_cast<int64_t>(std::ceil(duration / column.critical_step()));
    for (int64_t i = 1; i <= steps; ++i)
        if (!column.step(duration / static_cast<double>(steps), i == steps)) std::exit(1);  // it came to no number
    return steps;
}

/// Air let into next to dry, next to rigid ground at its top: profiles of the gas's pressure above the start's at some times. As the top
/// has no pressure above the atmosphere, the atmosphere is by the step above that of the start.
void gas_diffusion(size_t cells, double step, double mobility, const std::vector<double>& times) {
    const Ground ground{1, 0.4, 2650, elasticity(2e8, 0.3), 1e-9, 1e7, 1e-3};
    constexpr double start = 101325;
    const ExplicitGas air{1.2041 * (start + step) / start, start + step};
    FreePoints points = column_of_points(ground, cells, gas_fields);
    fill_with_air(ground, air, -step, points);
    auto column = column_with_gas(ground, cells, 0, mobility, false, std::move(points), van_genuchten(1e-3, 2), air);
    std::puts("[");
    double now = 0;
    for (const double time : times) {
        advance(column, time - now);
        now = time;
        std::vector<double> height, pressure;
        for (const size_t p : upwards(column)) {
            height.push_back(column.points()[position_y][p]);
            pressure.push_back(column.gas_pressure(p) + step);
        }
        std::printf("{\"time\": %.17g,\n", time);
        print("height", height, ",");
        print("pressure", pressure, time == times.back() ? "}" : "},");
    }
    std::puts("]");
}

/// A standing wave of half a wave length in a closed column of three phases: the solid's momentum in it, in time.
void gas_wave(size_t cells, const std::array<double, 3>& motion, double alpha, double liquid_mobility,
              double gas_mobility, double duration) {
    const Ground ground{1, 0.4, 2650, elasticity(20e6, 0.3), liquid_mobility, 2e9, 0.8};
    const ExplicitGas air{1.2, 101325};
    FreePoints points = column_of_points(ground, cells, gas_fields);
    fill_with_air(ground, air, 0, points);
    const double number = std::numbers::pi / ground.height;
    const std::array<PointField, 3> velocity{velocity_y, liquid_velocity_y, gas_velocity_y};
    const std::array<PointField, 3> affine{affine_yy, liquid_affine_yy, gas_affine_yy};
    for (size_t p = 0; p < points.count; ++p) {
        for (size_t phase = 0; phase < 3; ++phase) {
            points[velocity[phase]][p] = 1e-4 * motion[phase] * std::sin(number * points[position_y][p]);
            points[affine[phase]][p] = 1e-4 * motion[phase] * number * std::cos(number * points[position_y][p]);
        }
    }
    auto column =
        column_with_gas(ground, cells, 0, gas_mobility, true, std::move(points), van_genuchten(alpha, 2), air);
    const auto steps = static_cast<int64_t>(std::ceil(duration / column.critical_step()));
    const double dt = duration / static_cast<double>(steps);
    std::array<std::vector<double>, 3> amplitude;
    for (int64_t i = 1; i <= steps; ++i) {
        column.step(dt, true);
        for (size_t phase = 0; phase < 3; ++phase) {
            double sum = 0;
            for (size_t p = 0; p < column.points().count; ++p)
                sum += column.points()[velocity[phase]][p] * std::sin(number * column.points()[position_y][p]);
            amplitude[phase].push_back(sum);
        }
    }
    std::printf("{\"step\": %.17g,\n", dt);
    print("solid", amplitude[0], ",");
    print("liquid", amplitude[1], ",");
    print("gas", amplitude[2], "}");
}

/// The stress of the paper's soil and its water at the start.
void load_with_weight(const Ground& ground, double gravity, FreePoints& points) {
    for (size_t p = 0; p < points.count; ++p) {
        const double depth = ground.height - points[position_y][p];
        points[stress_yy][p] = -(1800 + 340) * gravity * depth;
        points[stress_xx][p] = points[stress_zz][p] = points[stress_yy][p] * 3 / 7;
    }
}

/// The paper's column: profiles of pressure and saturation, means over cells, at its five times. As in the reference, the column is next to
/// rigid and the last of them is when its last pore is filled: later by the water that it and its pores are compressed by.
void column_explicit(size_t cells) {
    const double conductivity = 1e-4, gravity = 9.81;
    const Ground ground{1, 0.4, 3000, elasticity(2e8, 0.3), conductivity / (water_density * gravity), 1e8, 0.85};
    FreePoints points = column_of_points(ground, cells);
    load_with_weight(ground, gravity, points);
    auto column = column_of<Filling::unsaturated>(ground, cells, gravity, std::move(points),
                                                  {{van_genuchten(4e-5, 1.2), ground.bulk_modulus}});
    column.set_rain([](double) { return 1e-4; });
    std::puts("[");
    double now = 0, initial = 0;
    for (size_t p = 0; p < column.points().count; ++p) initial += column.points()[water_mass][p];
    for (const double time : {20.0, 80.0, 160.0, 320.0, 600.5}) {
        const int64_t steps = advance(column, time - now);
        now = time;
        const std::vector<size_t> order = upwards(column);
        std::vector<double> height, pressure, saturation;
        double water = 0;
        for (size_t cell = 0; cell < cells; ++cell) {
            const size_t low = order[2 * cell], high = order[2 * cell + 1];
            const auto mean = [&](double a, double b) { return (a + b) / 2; };
            height.push_back(mean(column.points()[position_y][low], column.points()[position_y][high]));
            pressure.push_back(mean(column.pressure(low), column.pressure(high)));
            saturation.push_back(mean(column.saturation(low), column.saturation(high)));
            for (const size_t p : {low, high}) water += column.points()[water_mass][p] + column.points()[water_due][p];
        }
        const double missed = (water - initial - column.rained() + column.run_off() + column.seepage()) / initial;
        std::printf("{\"time\": %.17g, \"steps\": %lld, \"missed\": %.17g,\n", time, static_cast<long long>(steps),
                    missed);
        print("height", height, ",");
        print("pressure", pressure, ",");
        print("saturation", saturation, time < 600 ? "}," : "}");
    }
    std::puts("]");
}

/// The paper's column with air that can leave through its surface alone.
void column_three_phase(size_t cells) {
    const double conductivity = 1e-4, gravity = 9.81, mobility = conductivity / (water_density * gravity);
    const Ground ground{1, 0.4, 3000, elasticity(2e7, 0.3), mobility, 1e7, 0.85};
    const ExplicitGas air{101325 * 0.02896 / (8.314 * 293.15), 101325};
    FreePoints points = column_of_points(ground, cells, gas_fields);
    fill_with_air(ground, air, 0, points);
    load_with_weight(ground, gravity, points);
    auto column = column_with_gas(ground, cells, gravity, mobility * 1e-3 / 1.8e-5, false, std::move(points),
                                  van_genuchten(4e-5, 1.2), air);
    column.set_rain([](double) { return 1e-4; });
    const auto held = [&](PointField mass, PointField due) {
        double sum = 0;
        for (size_t p = 0; p < column.points().count; ++p) sum += column.points()[mass][p] + column.points()[due][p];
        return sum;
    };
    const double width = ground.height / static_cast<double>(cells);
    const double water = held(water_mass, water_due), gas = held(gas_mass, gas_due);
    std::puts("[");
    double now = 0;
    for (const double time : {20.0, 80.0, 160.0, 320.0, 600.0}) {
        advance(column, time - now);
        now = time;
        std::vector<double> height, pressure, gas_pressure, saturation;
        for (const size_t p : upwards(column)) {
            height.push_back(column.points()[position_y][p]);
            pressure.push_back(column.pressure(p));
            gas_pressure.push_back(column.gas_pressure(p));
            saturation.push_back(column.saturation(p));
        }
        const double infiltrated = column.rained() - column.run_off() - column.seepage();
        const double gained = held(water_mass, water_due) - water, lost = gas - held(gas_mass, gas_due);
        std::printf("{\"time\": %.17g, \"infiltrated\": %.17g, \"escaped\": %.17g, ", time,
                    infiltrated / (water_density * width), column.gas_escaped() / (air.density * width));
        std::printf("\"water_missed\": %.17g, \"air_missed\": %.17g,\n", (gained - infiltrated) / water,
                    (lost - column.gas_escaped()) / gas);
        print("height", height, ",");
        print("pressure", pressure, ",");
        print("gas_pressure", gas_pressure, ",");
        print("saturation", saturation, time < 600 ? "}," : "}");
    }
    std::puts("]");
}

/// A closed box whose lower half is wetter than the upper one and under more pressure, all gas dry and all water without air: where it
/// comes to rest.
void exchange_box(size_t cells, double lower, double upper, double pressure, double alpha, double duration) {
    const Ground ground{0.1, 0.4, 2650, elasticity(1e10, 0.3), 1e-6, 2e9, lower};
    const ExplicitExchange exchange{fluid_exchange(1.2041, 101325, 293.15, 7.8e-6)};
    FreePoints points = column_of_points(ground, cells, point_fields);
    for (size_t p = 0; p < points.count; ++p) {
        const bool is_low = points[position_y][p] < 0.5 * ground.height;
        const double pores = ground.porosity * points[point_volume][p], filled = is_low ? lower : upper;
        const FluidExchange& fluids = exchange.fluids;
        points[water_mass][p] = water_density * filled * pores;
        points[gas_mass][p] = (fluids.atmosphere + (is_low ? pressure : 0)) / fluids.air * (1 - filled) * pores;
    }
    const WaterAndAir before = held(points);
    auto column = closed_column(ground, cells, 1e-6, std::move(points), van_genuchten(alpha, 1.5), exchange);
    const int64_t steps = advance(column, duration);
    const WaterAndAir after = held(column.points());
    std::printf("{\"steps\": %lld, \"water_missed\": %.17g, \"air_missed\": %.17g,\n", static_cast<long long>(steps),
                (after.water - before.water) / before.water, (after.air - before.air) / before.air);
    std::vector<double> saturation, gas_pressure, vapour, dissolved;
    for (const size_t p : upwards(column)) {
        saturation.push_back(column.saturation(p));
        gas_pressure.push_back(column.gas_pressure(p));
        vapour.push_back(column.relative_humidity(p) * exchange.fluids.saturated_vapour);
        dissolved.push_back(column.dissolved_air(p));
    }
    print("saturation", saturation, ",");
    print("gas_pressure", gas_pressure, ",");
    print("vapour", vapour, ",");
    print("dissolved", dissolved, "}");
}

/// Vapour that spreads along a closed column whose lower half is moister than the upper one, through gas of one pressure: profiles of the
/// relative humidity. `saturation`: of the liquid, which does not flow, at `humidity`; 0: there is none.
void vapour_diffusion(size_t cells, double lower, double upper, const Hydraulics& soil, double diffusivity,
                      const std::vector<double>& times) {
    const Ground ground{0.1, 0.4, 2650, elasticity(1e7, 0.3), 1e-30, 1e7, 0};
    ExplicitExchange exchange{fluid_exchange(1.2041, 101325, 293.15, 7.8e-6)};
    exchange.vapour_diffusivity = diffusivity;
    const FluidExchange& fluids = exchange.fluids;
    FreePoints points = column_of_points(ground, cells, point_fields);
    for (size_t p = 0; p < points.count; ++p) {
        const double humidity = points[position_y][p] < 0.5 * ground.height ? lower : upper;
        const double suction = -std::log(humidity) * fluids.liquid_density * fluids.vapour;
        const double wet = saturation(soil.retention, suction), pores = ground.porosity * points[point_volume][p];
        const double vapour = humidity * fluids.saturated_vapour;
        points[water_mass][p] = water_density * wet * pores;
        points[vapour_mass][p] = vapour * (1 - wet) * pores;
        points[gas_mass][p] =
            points[vapour_mass][p] + (fluids.atmosphere - fluids.vapour * vapour) / fluids.air * (1 - wet) * pores;
    }
    auto column = closed_column(ground, cells, 3e-7, std::move(points), soil, exchange);
    std::puts("[");
    double now = 0;
    for (const double time : times) {
        advance(column, time - now);
        now = time;
        std::vector<double> height, humidity, gas_pressure;
        for (const size_t p : upwards(column)) {
            height.push_back(column.points()[position_y][p]);
            humidity.push_back(column.relative_humidity(p));
            gas_pressure.push_back(column.gas_pressure(p));
        }
        std::printf("{\"time\": %.17g,\n", time);
        print("height", height, ",");
        print("gas_pressure", gas_pressure, ",");
        print("humidity", humidity, time == times.back() ? "}" : "},");
    }
    std::puts("]");
}

}  // namespace

int main(int count, char** arguments) {
    const std::string name = count > 2 ? arguments[1] : "";
    const size_t cells = count > 2 ? std::strtoul(arguments[2], nullptr, 10) : 0;
    if (name == "saturated_wave" && count == 3) {
        saturated_wave(cells);
    } else if (name == "standing_wave" && count == 7) {
        standing_wave(cells, std::atof(arguments[3]), std::atof(arguments[4]), std::atof(arguments[5]),
                      std::atof(arguments[6]));
    } else if (name == "column_explicit" && count == 3) {
        column_explicit(cells);
    } else if (name == "column_three_phase" && count == 3) {
        column_three_phase(cells);
    } else if (name == "gas_diffusion" && count > 5) {
        std::vector<double> times;
        for (int i = 5; i < count; ++i) times.push_back(std::atof(arguments[i]));
        gas_diffusion(cells, std::atof(arguments[3]), std::atof(arguments[4]), times);
    } else if (name == "gas_wave" && count == 10) {
        std::array<double, 7> number{};
        for (size_t i = 0; i < number.size(); ++i) number[i] = std::atof(arguments[i + 3]);
        gas_wave(cells, {number[0], number[1], number[2]}, number[3], number[4], number[5], number[6]);
    } else if (name == "exchange_box" && count == 8) {
        exchange_box(cells, std::atof(arguments[3]), std::atof(arguments[4]), std::atof(arguments[5]),
                     std::atof(arguments[6]), std::atof(arguments[7]));
    } else if (name == "vapour_diffusion" && count > 8) {
        std::vector<double> times;
        for (int i = 8; i < count; ++i) times.push_back(std::atof(arguments[i]));
        vapour_diffusion(cells, std::atof(arguments[3]), std::atof(arguments[4]),
                         van_genuchten(std::atof(arguments[5]), std::atof(arguments[6])), std::atof(arguments[7]),
                         times);
    } else {
        std::fputs(
            "usage: explicit_histories saturated_wave|column_explicit|column_three_phase CELLS\n"
            "       explicit_histories standing_wave CELLS SOLID LIQUID MOBILITY DURATION\n"
            "       explicit_histories gas_diffusion CELLS STEP MOBILITY TIME...\n"
            "       explicit_histories gas_wave CELLS SOLID LIQUID GAS ALPHA LIQUID_MOBILITY GAS_MOBILITY DURATION\n",
            stderr);
        return 2;
    }
    return 0;
}
