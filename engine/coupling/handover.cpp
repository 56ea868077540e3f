#include "coupling/handover.hpp"

#include "background/locate.hpp"
#include "coupling/background.hpp"
#include "materials/hydraulic/curves.hpp"
#include "points/quadrature.hpp"
#include "points/seeding.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace talus {
namespace {

// --- from the scene --------------------------------------------------------------------------------------------------

ExplicitSoil explicit_soil(const Soil& entry) {
    const Solid& solid = entry.solid;
    ExplicitSoil soil;
    soil.elastic = elasticity(solid.young_modulus, solid.poisson_ratio);
    soil.yields = solid.model == SolidModel::mohr_coulomb;
    if (!soil.yields) return soil;
    soil.strength =
        mohr_coulomb(shear_strength(solid.strength, 0.0, 1.0), solid.dilation_angle, solid.tensile_strength);
    if (solid.softening.slip > 0) {
        soil.residual_cohesion = solid.softening.residual_cohesion;
        soil.residual_sin_friction = sin_degrees(solid.softening.residual_friction_angle);
        soil.softening_slip = solid.softening.slip;
    }
    const InertialFriction& inertial = solid.inertial_friction;
    if (inertial.grain_diameter > 0) {
        soil.friction_rise = sin_degrees(inertial.limit_friction_angle) - soil.strength.sin_friction;
        soil.inertial_root =
            inertial.grain_diameter * std::sqrt(entry.dry_density / (1 - entry.porosity)) / inertial.inertial_number;
    }
    return soil;
}

// --- the points ------------------------------------------------------------------------------------------------------

/// Values at a place from those of the mesh's points, `rows`; outside the mesh, where the middle of a piece of concave ground may lie, the cell's first one's.
template <size_t components>
std::array<double, components> from_mesh_points(const Mesh& mesh, const Points& points, std::span<const double> rows,
                                                const CellPlace& place, int32_t cell) {
    std::array<double, components> values{};
    const auto found = static_cast<size_t>(place.cell >= 0 ? place.cell : cell);
    const double* first = rows.data() + components * static_cast<size_t>(points.cell_start[found]);
    if (place.cell < 0) {
        std::copy_n(first, components, values.begin());
        return values;
    }
    with_shape(mesh.cell_start[found + 1] - mesh.cell_start[found], [&](auto shape) {
        using Shape = decltype(shape);
        typename Shape::Natural at{};
        std::copy_n(place.natural.begin(), Shape::dimension, at.begin());
        sample_points<Shape>(first, components, at, values);
    });
    return values;
}

SeededPoints make_free_points(const Scene& scene, const Mesh& mesh, const Points& mesh_points, const Locator& locator,
                              const Walls& walls, double cell_size) {
    std::vector<double> density;
    for (const Soil& soil : scene.soils) density.push_back(soil.dry_density);
    const double corner = walls.left.kind != WallKind::none ? walls.left.place : walls.right.place;
    SeededPoints seeded = seed_points(mesh, cell_size, {corner, walls.base.place}, density);
    if (scene.initial.stress == InitialStress::zero) return seeded;
    for (size_t p = 0; p < seeded.points.count; ++p) {
        const CellPlace place = locator.locate(seeded.points[position_x][p], seeded.points[position_y][p]);
        const auto stress = from_mesh_points<4>(mesh, mesh_points, mesh_points.skeleton_stress, place, seeded.cell[p]);
        for (const size_t k : {0, 1, 2, 3}) seeded.points.field[stress_xx + k][p] = stress[k];
    }
    return seeded;
}

// --- water -----------------------------------------------------------------------------------------------------------

ExplicitHydraulics explicit_hydraulics(const Soil& soil, const Scene& scene) {
    ExplicitHydraulics hydraulics;
    hydraulics.grain_density = soil.dry_density / (1 - soil.porosity);
    hydraulics.mobility = mean_conductivity(soil.hydraulics.conductivity) / (scene.water.density * scene.gravity);
    hydraulics.anisotropy = anisotropy_of(soil.hydraulics.conductivity);
    hydraulics.gas_mobility = hydraulics.mobility / scene.gas.viscosity_ratio;
    hydraulics.residual_water =
        soil.hydraulics.retention.residual_saturation * soil.porosity * scene.water.density / soil.dry_density;
    if (soil.hydraulics.conductivity.porosity_dependence == PorosityDependence::kozeny_carman)
        hydraulics.initial_conductance = kozeny_carman(soil.porosity);
    if (soil.solid.model != SolidModel::mohr_coulomb) return hydraulics;
    const Strength& strength = soil.solid.strength;
    if (strength.model == StrengthModel::fredlund)
        hydraulics.suction_tangent = tan_degrees(strength.suction_friction_angle);
    if (strength.model == StrengthModel::vanapalli) {
        hydraulics.suction_tangent = tan_degrees(strength.friction_angle);
        hydraulics.weighs_suction = true;
    }
    if (strength.model == StrengthModel::exponential) hydraulics.strength = strength;
    return hydraulics;
}

ExplicitExchange explicit_exchange(const Scene& scene) {
    const Gas& gas = scene.gas;
    FluidExchange fluids = fluid_exchange(gas.density, gas.atmosphere, gas.temperature, gas.henry_constant);
    fluids.liquid_density = scene.water.density;
    return {fluids, gas.vapour_diffusivity, gas.air_diffusivity, gas.humidity};
}

/// Value at a place, from the mesh's nodes; outside the mesh, of the given cell's first node.
double value_at(const Mesh& mesh, std::span<const double> node_value, const CellPlace& place, int32_t cell) {
    const auto found = static_cast<size_t>(place.cell >= 0 ? place.cell : cell);
    const int32_t* nodes = &mesh.cell_nodes[static_cast<size_t>(mesh.cell_start[found])];
    if (place.cell < 0) return node_value[static_cast<size_t>(nodes[0])];
    double value = 0;
    with_shape(mesh.cell_start[found + 1] - mesh.cell_start[found], [&](auto shape) {
        using Shape = decltype(shape);
        typename Shape::Natural at{};
        std::copy_n(place.natural.begin(), Shape::dimension, at.begin());
        const auto share = Shape::values(at);
        for (size_t a = 0; a < Shape::nodes; ++a) value += share[a] * node_value[static_cast<size_t>(nodes[a])];
    });
    return value;
}

/// What a point's grains leave of its volume, m2.
double pores(const Scene& scene, const FreePoints& points, size_t p) {
    const Soil& soil = scene.soils[static_cast<size_t>(points.soil[p])];
    return points[point_volume][p] - points[solid_mass][p] * (1 - soil.porosity) / soil.dry_density;
}

/// The water that each point holds at the pressure of the place it lies in.
void fill_with_water(const Scene& scene, const Mesh& mesh, const Locator& locator, std::span<const double> pressure,
                     const std::vector<int32_t>& cell, FreePoints& points) {
    std::vector<HydraulicTable> tables;
    for (const Soil& soil : scene.soils) tables.emplace_back(soil.hydraulics);
    for (size_t f = dry_fields; f < wet_fields; ++f) points.field[f].assign(points.count, 0.0);
    for (size_t p = 0; p < points.count; ++p) {
        const CellPlace place = locator.locate(points[position_x][p], points[position_y][p]);
        const double here = value_at(mesh, pressure, place, cell[p]);
        const auto soil = static_cast<size_t>(points.soil[p]);
        const double saturation =
            tables[soil].at(here).saturation * (1 + std::max(here, 0.0) / scene.water.bulk_modulus);
        points[water_mass][p] = scene.water.density * saturation * pores(scene, points, p);
    }
}

/// What a point's water leaves of its pores, m2.
double room_for_gas(const Scene& scene, const FreePoints& points, size_t p) {
    return std::max(pores(scene, points, p) - points[water_mass][p] / scene.water.density, 0.0);
}

/// Gas at the atmosphere's pressure in what the water leaves of the pores.
void fill_with_gas(const Scene& scene, FreePoints& points) {
    for (size_t f = wet_fields; f < gas_fields; ++f) points.field[f].assign(points.count, 0.0);
    for (size_t p = 0; p < points.count; ++p) points[gas_mass][p] = scene.gas.density * room_for_gas(scene, points, p);
}

/// The same of moist air over water with dissolved air, in equilibrium.
void fill_with_moist_gas(const Scene& scene, std::span<const SaturationTable> tables, const FluidExchange& fluids,
                         FreePoints& points) {
    for (size_t f = wet_fields; f < point_fields; ++f) points.field[f].assign(points.count, 0.0);
    for (size_t p = 0; p < points.count; ++p) {
        const double room = room_for_gas(scene, points, p), liquid = points[water_mass][p] / scene.water.density;
        const SaturationTable& table = tables[static_cast<size_t>(points.soil[p])];
        const double vapour = fluids.vapour_density(-table.at(liquid / (liquid + room)).pressure);
        const double air = (fluids.atmosphere - fluids.vapour * vapour) / fluids.air;
        points[vapour_mass][p] = vapour * room;
        points[gas_mass][p] = (air + vapour) * room;
        points[dissolved_mass][p] = fluids.solubility * air * liquid;
    }
}

/// The plastic strain with which the points have lost their share of strength.
void soften(const Scene& scene, const Mesh& mesh, const Points& mesh_points, const Locator& locator,
            std::span<const double> lost_strength, SeededPoints& seeded, double cell_size) {
    for (size_t p = 0; p < seeded.points.count; ++p) {
        const CellPlace place = locator.locate(seeded.points[position_x][p], seeded.points[position_y][p]);
        const auto [lost] = from_mesh_points<1>(mesh, mesh_points, lost_strength, place, seeded.cell[p]);
        const double slip = scene.soils[static_cast<size_t>(seeded.points.soil[p])].solid.softening.slip;
        seeded.points[plastic_shear_strain][p] = lost * slip / band_slip(1.0, cell_size);
    }
}

/// The mass of each soil, which the mesh's deformation did not change.
void keep_mass(const std::vector<double>& soil_mass, FreePoints& points) {
    std::vector<double> found(soil_mass.size(), 0.0);
    for (size_t p = 0; p < points.count; ++p) found[static_cast<size_t>(points.soil[p])] += points[solid_mass][p];
    for (size_t p = 0; p < points.count; ++p) {
        const auto soil = static_cast<size_t>(points.soil[p]);
        points[solid_mass][p] *= soil_mass[soil] / found[soil];
    }
}

/// What the points' water is short of the mesh's, by their place between its nodes, goes to those that are neither full nor empty; what they have no room for is
/// pressed into all.
void keep_water(const Scene& scene, double water, FreePoints& points) {
    double missing = scene.water.density * water, room = 0, held = 0;
    std::vector<double> share(points.count);
    for (size_t p = 0; p < points.count; ++p) {
        missing -= points[water_mass][p];
        held += points[water_mass][p];
        const auto soil = static_cast<size_t>(points.soil[p]);
        const Retention& retention = scene.soils[soil].hydraulics.retention;
        const double pores = scene.water.density * scene.soils[soil].porosity * points[point_volume][p];
        const double saturation = points[water_mass][p] / pores;
        share[p] = pores * std::max(retention.maximum_saturation - saturation, 0.0) *
                   std::max(saturation - retention.residual_saturation, 0.0);
        room += share[p];
    }
    const double moved = std::clamp(missing, -0.5 * room, 0.5 * room), pressed = missing - moved;
    for (size_t p = 0; p < points.count; ++p)
        points[water_mass][p] += (room > 0 ? moved * share[p] / room : 0.0) + pressed * points[water_mass][p] / held;
}

}  // namespace

std::vector<ExplicitSoil> explicit_soils(const Scene& scene) {
    std::vector<ExplicitSoil> soils;
    for (const Soil& soil : scene.soils) soils.push_back(explicit_soil(soil));
    return soils;
}

Motion make_motion(const Scene& scene, const Mesh& mesh, const Points& mesh_points, const Handover& handover,
                   int32_t threads) {
    const auto [cell_size, walls] = make_background(scene, mesh);
    const Locator locator(mesh);
    SeededPoints seeded = make_free_points(scene, mesh, mesh_points, locator, walls, cell_size);
    if (!handover.soil_mass.empty()) keep_mass(handover.soil_mass, seeded.points);
    if (!handover.lost_strength.empty())
        soften(scene, mesh, mesh_points, locator, handover.lost_strength, seeded, cell_size);
    if (handover.pressure.empty()) {
        return Motion(std::in_place_type<ExplicitMotion>, cell_size, walls, scene.gravity, explicit_soils(scene),
                      std::move(seeded.points), threads, scene.dynamics.rest_speed);
    }
    fill_with_water(scene, mesh, locator, handover.pressure, seeded.cell, seeded.points);
    if (handover.water > 0) keep_water(scene, handover.water, seeded.points);
    std::vector<ExplicitHydraulics> hydraulics;
    std::vector<SaturationTable> tables;
    for (const Soil& soil : scene.soils) {
        hydraulics.push_back(explicit_hydraulics(soil, scene));
        tables.emplace_back(soil.hydraulics, scene.water.bulk_modulus);
    }
    const bool is_net = scene.physics.stress == StressMeasure::net;
    const ExplicitWater water{scene.water.density, scene.water.bulk_modulus,
                              is_net ? PoreStress::net : PoreStress::bishop};
    const ExplicitGas gas{scene.gas.density, scene.gas.atmosphere};
    if (scene.physics.exchange) {
        const ExplicitExchange exchange = explicit_exchange(scene);
        fill_with_moist_gas(scene, tables, exchange.fluids, seeded.points);
        return Motion(std::in_place_type<Exchange>, cell_size, walls, scene.gravity, explicit_soils(scene),
                      std::move(hydraulics), std::move(tables), water, std::move(seeded.points), threads, gas,
                      exchange);
    }
    if (scene.physics.gas) {
        fill_with_gas(scene, seeded.points);
        return Motion(std::in_place_type<ThreePhases>, cell_size, walls, scene.gravity, explicit_soils(scene),
                      std::move(hydraulics), std::move(tables), water, std::move(seeded.points), threads, gas);
    }
    return Motion(std::in_place_type<Mixture>, cell_size, walls, scene.gravity, explicit_soils(scene),
                  std::move(hydraulics), std::move(tables), water, std::move(seeded.points), threads, ExplicitGas{},
                  ExplicitExchange{}, scene.dynamics.rest_speed);
}

void subtract_displacement(const Mesh& mesh, std::span<const double> displacement, const FreePoints& points,
                           std::vector<double>& position) {
    const Locator locator(mesh);
    std::vector<double> along(displacement.size() / 2);
    for (const size_t axis : {size_t{0}, size_t{1}}) {
        for (size_t i = 0; i < along.size(); ++i) along[i] = displacement[2 * i + axis];
        for (size_t p = 0; p < points.count; ++p) {
            const CellPlace place = locator.locate(points[position_x][p], points[position_y][p]);
            if (place.cell < 0) continue;
            position[2 * static_cast<size_t>(points.number[p]) + axis] -= value_at(mesh, along, place, place.cell);
        }
    }
}

}  // namespace talus
