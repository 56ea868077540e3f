// The structs' fields by their names in the schema, once for reading and writing.
//
// A visitor has
//   visit(name, value)               numbers, flags, texts, enumerations, arrays, places, structs and lists of structs
//   visit.positive(name, value)      a number that the schema leaves open by NaN, the struct by 0
//   visit.optional(name, has, value) an enumeration whose first enumerant in the schema says that there is none
//   visit.one_of(kind, {names}, values...)  a union
#pragma once

#include "scene/scene.hpp"

#include <concepts>

namespace talus {

template <typename T, typename Struct>
concept Is = std::same_as<std::remove_const_t<T>, Struct>;

void fields(auto& visit, Is<Physics> auto& physics) {
    visit("water", physics.water);
    visit("deforming", physics.deforming);
    visit("stress", physics.stress);
    visit("regime", physics.regime);
    visit("gas", physics.gas);
    visit("exchange", physics.exchange);
}

void fields(auto& visit, Is<Water> auto& water) {
    visit("density", water.density);
    visit("bulkModulus", water.bulk_modulus);
}

void fields(auto& visit, Is<Gas> auto& gas) {
    visit("density", gas.density);
    visit("viscosityRatio", gas.viscosity_ratio);
    visit("atmosphere", gas.atmosphere);
    visit("temperature", gas.temperature);
    visit("henryConstant", gas.henry_constant);
    visit("vapourDiffusivity", gas.vapour_diffusivity);
    visit("airDiffusivity", gas.air_diffusivity);
    visit("humidity", gas.humidity);
}

// --- soils -----------------------------------------------------------------------------------------------------------

void fields(auto& visit, Is<Retention> auto& retention) {
    visit("model", retention.model);
    visit.positive("alpha", retention.alpha);
    visit.positive("n", retention.n);
    visit("residualSaturation", retention.residual_saturation);
    visit("maximumSaturation", retention.maximum_saturation);
    visit("suction", retention.suction);
    visit("saturation", retention.saturation);
}

void fields(auto& visit, Is<RelativePermeability> auto& permeability) {
    visit("model", permeability.model);
    visit("poreConnectivity", permeability.pore_connectivity);
    visit.positive("alpha", permeability.alpha);
    visit.positive("exponent", permeability.exponent);
    visit("suction", permeability.suction);
    visit("relativePermeability", permeability.relative_permeability);
}

void fields(auto& visit, Is<Conductivity> auto& conductivity) {
    visit.positive("along", conductivity.along);
    visit.positive("across", conductivity.across);
    visit("dip", conductivity.dip);
    visit("porosityDependence", conductivity.porosity_dependence);
}

void fields(auto& visit, Is<Hydraulics> auto& hydraulics) {
    visit("retention", hydraulics.retention);
    visit("relativePermeability", hydraulics.relative_permeability);
    visit("conductivity", hydraulics.conductivity);
}

void fields(auto& visit, Is<Strength> auto& strength) {
    visit("model", strength.model);
    visit("cohesion", strength.cohesion);
    visit("frictionAngle", strength.friction_angle);
    visit("suctionFrictionAngle", strength.suction_friction_angle);
    visit("cohesionGain", strength.cohesion_gain);
    visit("cohesionRate", strength.cohesion_rate);
    visit("frictionGain", strength.friction_gain);
}

void fields(auto& visit, Is<Softening> auto& softening) {
    visit("residualCohesion", softening.residual_cohesion);
    visit("residualFrictionAngle", softening.residual_friction_angle);
    visit.positive("slip", softening.slip);
}

void fields(auto& visit, Is<InertialFriction> auto& friction) {
    visit("limitFrictionAngle", friction.limit_friction_angle);
    visit("inertialNumber", friction.inertial_number);
    visit.positive("grainDiameter", friction.grain_diameter);
}

void fields(auto& visit, Is<Solid> auto& solid) {
    visit("model", solid.model);
    visit.positive("youngModulus", solid.young_modulus);
    visit("poissonRatio", solid.poisson_ratio);
    visit("strength", solid.strength);
    visit("dilationAngle", solid.dilation_angle);
    visit("tensileStrength", solid.tensile_strength);
    visit("softening", solid.softening);
    visit("inertialFriction", solid.inertial_friction);
}

void fields(auto& visit, Is<Soil> auto& soil) {
    visit("name", soil.name);
    visit("dryDensity", soil.dry_density);
    visit("porosity", soil.porosity);
    visit("hydraulics", soil.hydraulics);
    visit("solid", soil.solid);
}

// --- ground ----------------------------------------------------------------------------------------------------------

void fields(auto& visit, Is<ColumnLayer> auto& layer) {
    visit("soil", layer.soil);
    visit("top", layer.top);
}

void fields(auto& visit, Is<ColumnGround> auto& column) {
    visit.positive("height", column.height);
    visit("cells", column.cells);
    visit("layers", column.layers);
}

void fields(auto& visit, Is<SectionLayer> auto& layer) {
    visit("soil", layer.soil);
    visit("top", layer.top);
}

void fields(auto& visit, Is<SectionGround> auto& section) {
    visit("terrain", section.terrain);
    visit("base", section.base);
    visit("layers", section.layers);
    visit.positive("columnWidth", section.column_width);
    visit.positive("surfaceCellHeight", section.surface_cell_height);
    visit("gradedDepth", section.graded_depth);
    visit.positive("growth", section.growth);
    visit.positive("largestCellHeight", section.largest_cell_height);
    visit.positive("bendColumnWidth", section.bend_column_width);
}

void fields(auto& visit, Is<MeshGround> auto& mesh) {
    visit("file", mesh.file);
    visit("position", mesh.position);
    visit("cellStart", mesh.cell_start);
    visit("cellNodes", mesh.cell_nodes);
    visit("cellSoil", mesh.cell_soil);
}

void fields(auto& visit, Is<Ground> auto& ground) {
    visit.one_of(ground.kind, {"column", "section", "mesh"}, ground.column, ground.section, ground.mesh);
}

// --- boundaries and rain ---------------------------------------------------------------------------------------------

void fields(auto& visit, Is<Series> auto& series) {
    visit("time", series.time);
    visit("value", series.value);
}

void fields(auto& visit, Is<Boundary> auto& boundary) {
    visit("name", boundary.name);
    visit("side", boundary.side);
    visit("xFrom", boundary.x_from);
    visit("xTo", boundary.x_to);
    visit("yFrom", boundary.y_from);
    visit("yTo", boundary.y_to);
    visit.optional("flow", boundary.has_flow, boundary.flow);
    visit("flowValue", boundary.flow_value);
    visit.optional("motion", boundary.has_motion, boundary.motion);
    visit("motionX", boundary.motion_x);
    visit("motionY", boundary.motion_y);
    visit("frictionAngle", boundary.friction_angle);
}

void fields(auto& visit, Is<RainZone> auto& zone) {
    visit("name", zone.name);
    visit("xFrom", zone.x_from);
    visit("xTo", zone.x_to);
    visit("time", zone.time);
    visit("rate", zone.rate);
    visit("rainEnd", zone.rain_end);
}

void fields(auto& visit, Is<Surface> auto& surface) {
    visit("pondingDepth", surface.ponding_depth);
    visit("zones", surface.zones);
}

// --- initial state, numerics, schedule -------------------------------------------------------------------------------

void fields(auto& visit, Is<Initial> auto& initial) {
    visit("flow", initial.flow);
    visit("suction", initial.suction);
    visit("saturation", initial.saturation);
    visit("waterTable", initial.water_table);
    visit("surfacePressure", initial.surface_pressure);
    visit("surfaceRain", initial.surface_rain);
    visit("stress", initial.stress);
    visit("k0", initial.k0);
}

void fields(auto& visit, Is<Numerics> auto& numerics) { visit("tolerance", numerics.tolerance); }

void fields(auto& visit, Is<Dynamics> auto& dynamics) {
    visit.positive("cellSize", dynamics.cell_size);
    visit.positive("restSpeed", dynamics.rest_speed);
    visit("xFrom", dynamics.x_from);
    visit("xTo", dynamics.x_to);
    visit("yFrom", dynamics.y_from);
    visit("yTo", dynamics.y_to);
    visit("atEnds", dynamics.at_ends);
}

void fields(auto& visit, Is<Schedule> auto& schedule) {
    visit("duration", schedule.duration);
    visit("step", schedule.step);
    visit("motionStep", schedule.motion_step);
    visit("outputs", schedule.outputs);
}

void fields(auto& visit, Is<Probe> auto& probe) {
    visit("name", probe.name);
    visit("place", probe.place);
}

void fields(auto& visit, Is<Scene> auto& scene) {
    visit("name", scene.name);
    visit("title", scene.title);
    visit("physics", scene.physics);
    visit("gravity", scene.gravity);
    visit("water", scene.water);
    visit("gas", scene.gas);
    visit("soils", scene.soils);
    visit("ground", scene.ground);
    visit("boundaries", scene.boundaries);
    visit("surface", scene.surface);
    visit("initial", scene.initial);
    visit("numerics", scene.numerics);
    visit("dynamics", scene.dynamics);
    visit("schedule", scene.schedule);
    visit("probes", scene.probes);
}

}  // namespace talus
