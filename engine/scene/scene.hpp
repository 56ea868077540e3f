// What is simulated: plain structs, filled from JSON, from Cap'n Proto bytes or by the host, checked by validate().
// SI units; angles in degrees. x is horizontal, y is up. Names are those of the schema (scene.capnp), in snake_case.
#pragma once

#include "materials/hydraulic/parameters.hpp"
#include "materials/solid/parameters.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace talus {

/// A number that the scene leaves open.
inline constexpr double unset = std::numeric_limits<double>::quiet_NaN();

using Place = std::array<double, 2>;  ///< x, y in m; x is 0 in a column

/// A value in time: linear between the times of a boundary's value, constant after the last.
struct Series {
    std::vector<double> time;   ///< s, increasing
    std::vector<double> value;  ///< one value a time
};

// --- soils -----------------------------------------------------------------------------------------------------------

struct Soil {
    std::string name;
    double dry_density = unset;  ///< dry bulk density, kg/m3 of soil; needed where the skeleton deforms
    double porosity = unset;     ///< -
    Hydraulics hydraulics;       ///< used unless the scene is dry
    Solid solid;                 ///< used where the skeleton deforms
};

struct Water {
    double density = 1000;      ///< kg/m3 at zero pressure
    double bulk_modulus = 2e9;  ///< Pa; rho = density exp(p / bulk_modulus)
};

/// Of a gas that moves: ideal, at one temperature.
struct Gas {
    double density = 1.2041;         ///< at the atmosphere's pressure, kg/m3
    double viscosity_ratio = 0.018;  ///< over the water's, -
    double atmosphere = 101325;      ///< Pa, absolute
    // Of exchange with the water:
    double temperature = 293.15;         ///< K
    double henry_constant = 7.8e-6;      ///< mol/(m3 Pa)
    double vapour_diffusivity = 2.4e-5;  ///< in air, m2/s
    double air_diffusivity = 2e-9;       ///< in water, m2/s
    double humidity = 1;                 ///< of the atmosphere, relative
    bool operator==(const Gas&) const = default;
};

// --- ground ----------------------------------------------------------------------------------------------------------

/// A layer of a column: from `top` (m above the column's base) down to the next layer's top.
struct ColumnLayer {
    std::string soil;
    double top = unset;  ///< m
};

/// A vertical column of equal cells, one-dimensional.
struct ColumnGround {
    double height = 0;  ///< m
    int32_t cells = 0;
    std::vector<ColumnLayer> layers;  ///< from top to bottom; the first one's top is the height
};

/// A layer of a section: from `top` (a profile over x) down to the next layer's top; the first one's top is the terrain.
struct SectionLayer {
    std::string soil;
    std::vector<Place> top;  ///< x increasing; empty for the first layer
};

/// Columns of quads over a terrain profile, graded towards the surface, conforming to the layer interfaces.
struct SectionGround {
    std::vector<Place> terrain;        ///< x increasing, from the left side to the right one
    std::vector<Place> base;           ///< x increasing, over the same x
    std::vector<SectionLayer> layers;  ///< from top to bottom
    double column_width = 0;           ///< target width of a column, m
    double surface_cell_height = 0;    ///< height of the uppermost cell, m
    double graded_depth = 0;           ///< down to this depth cells have surface_cell_height, m
    double growth = 0;                 ///< ratio of a cell's height to the one above it; NaN or 0: even growth
    double largest_cell_height = 0;    ///< m
    double bend_column_width = 0;      ///< width of a column beside a bend of the terrain, m; NaN or 0: column_width
};

/// A given mesh of triangles and quads, counter-clockwise.
struct MeshGround {
    std::string file;                 ///< Gmsh .msh (2.2 or 4.1 ASCII), or empty when the arrays are given
    std::vector<double> position;     ///< nodes x 2, m
    std::vector<int32_t> cell_start;  ///< cells + 1 offsets into cell_nodes
    std::vector<int32_t> cell_nodes;  ///< node numbers, from 0
    std::vector<int32_t> cell_soil;   ///< number of the soil in Scene::soils, one a cell
};

enum class GroundKind { column, section, mesh };

struct Ground {
    GroundKind kind = GroundKind::column;
    ColumnGround column;
    SectionGround section;
    MeshGround mesh;
};

// --- boundaries ------------------------------------------------------------------------------------------------------

/// The sides every ground has. A mesh file may name more (its physical lines).
///   base, left, right, surface (all the rest)
enum class FlowCondition { impermeable, pressure, hydrostatic, flux, surface };
enum class MotionCondition { free, roller, fixed, displacement, traction, friction };

/// What holds on a part of one side. A part of a side that no boundary names is impermeable and free, but the surface, which
/// takes rain, ponds and seeps unless a boundary says otherwise.
struct Boundary {
    std::string name;  ///< for messages and for changes in time
    std::string side;  ///< base, left, right, surface or a physical line of the mesh file
    double x_from = -std::numeric_limits<double>::infinity();  ///< the part of the side, m
    double x_to = std::numeric_limits<double>::infinity();
    double y_from = -std::numeric_limits<double>::infinity();
    double y_to = std::numeric_limits<double>::infinity();
    bool has_flow = false;  ///< whether it says anything on the flow
    FlowCondition flow = FlowCondition::impermeable;
    Series
        flow_value;  ///< pressure: Pa; hydrostatic: elevation of the water table, m; flux: inflow normal to the side, m/s
    bool has_motion = false;  ///< whether it says anything on the motion
    MotionCondition motion = MotionCondition::free;
    Series motion_x;  ///< displacement: m; traction: Pa; empty: free in this direction
    Series motion_y;
    double friction_angle = unset;  ///< degrees, friction only
};

/// A part of the ground surface with a rain of its own. Rain is a volume per horizontal area, m/s, constant from each time to the
/// next: rate[k] holds over [time[k], time[k+1]), the last one until changed unless rain_end says when the series ends.
struct RainZone {
    std::string name;
    double x_from = -std::numeric_limits<double>::infinity();  ///< m
    double x_to = std::numeric_limits<double>::infinity();
    std::vector<double> time;  ///< s, increasing
    std::vector<double> rate;  ///< m/s
    double rain_end = unset;   ///< s: the forcing is known until here; a step past it is said aloud
};

struct Surface {
    double ponding_depth = 0;     ///< m of water that the surface may hold before it runs off
    std::vector<RainZone> zones;  ///< parts not covered have no rain
};

// --- initial state, numerics, schedule -------------------------------------------------------------------------------

enum class InitialFlow { suction, saturation, hydrostatic, steady };
enum class InitialStress { gravity, k0, zero, elastic };

struct Initial {
    InitialFlow flow = InitialFlow::hydrostatic;
    double suction = unset;           ///< Pa, uniform
    double saturation = unset;        ///< -, uniform
    double water_table = unset;       ///< m, hydrostatic
    double surface_pressure = unset;  ///< Pa, held on the ground surface of the steady state
    double surface_rain = unset;      ///< m/s, on the ground surface of the steady state
    InitialStress stress = InitialStress::gravity;
    double k0 = unset;  ///< ratio of horizontal to vertical net (or effective) stress
};

enum class StressMeasure { net, bishop };

/// dynamic: by momentum, on a Cartesian grid.
enum class MotionRegime { quasi_static, dynamic, automatic };

/// What the scene's physics is; what it does not name is left out of the engine.
struct Physics {
    bool water = true;      ///< false: dry
    bool deforming = true;  ///< false: rigid skeleton
    StressMeasure stress = StressMeasure::net;
    MotionRegime regime = MotionRegime::quasi_static;
    bool gas = false;       ///< whether the gas moves; false: its pressure is the atmosphere's
    bool exchange = false;  ///< whether water evaporates into it and it dissolves in the water
};

struct Numerics {
    double tolerance =
        1e-3;  ///< error allowed in saturation per unit of its range, and in pressure relative to the scene's own
};

/// What happens to ground that comes to an end of the background: it goes on, is taken out, or a wall stops it.
enum class EndPolicy { extend, absorb, stop };

/// Of a dynamic ground.
struct Dynamics {
    double cell_size = 0;                                      ///< m
    double rest_speed = 0;                                     ///< m/s; 0: nothing is held
    double x_from = -std::numeric_limits<double>::infinity();  ///< ends of the background, m
    double x_to = std::numeric_limits<double>::infinity();
    double y_from = -std::numeric_limits<double>::infinity();
    double y_to = std::numeric_limits<double>::infinity();
    EndPolicy at_ends = EndPolicy::extend;
};

/// What a host that only follows the scene (the runner) does.
struct Schedule {
    double duration = unset;      ///< s
    double step = unset;          ///< s, the host's step
    double motion_step = unset;   ///< s, the host's step while ground of the regime auto moves
    std::vector<double> outputs;  ///< s, times of the field files
};

struct Probe {
    std::string name;
    Place place{};
};

struct Scene {
    std::string name;
    std::string title;
    Physics physics;
    double gravity = 9.81;  ///< m/s2, downwards
    Water water;
    Gas gas;
    std::vector<Soil> soils;
    Ground ground;
    std::vector<Boundary> boundaries;
    Surface surface;
    Initial initial;
    Numerics numerics;
    Dynamics dynamics;
    Schedule schedule;
    std::vector<Probe> probes;
};

}  // namespace talus
