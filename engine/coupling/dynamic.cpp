#include "coupling/dynamic.hpp"

#include "background/locate.hpp"
#include "coupling/background.hpp"
#include "error.hpp"
#include "materials/hydraulic/curves.hpp"
#include "points/quadrature.hpp"
#include "points/seeding.hpp"
#include "scene/problems.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace talus {
namespace {

constexpr int64_t substeps_a_look = 16;
constexpr double rest_share = 1e-3;  // of the largest kinetic energy of the motion: below it for
constexpr double rest_time = 1;      // s, the ground rests;
constexpr double window_falls = 30;  // or where within so many times sqrt(h / g), about that of a fall through a cell,
constexpr double rest_come = 0.1;    // no point has come further by so much of the cell: elastic ground rings on
constexpr double most_nodes = 2e7;   // of the grid: 1.3 GB

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

std::vector<ExplicitSoil> explicit_soils(const Scene& scene) {
    std::vector<ExplicitSoil> soils;
    for (const Soil& soil : scene.soils) soils.push_back(explicit_soil(soil));
    return soils;
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

double sum(const Energies& energies) { return energies.kinetic + energies.elastic + energies.potential; }

double held(const FreePoints& points, PointField mass, PointField due) {
    double sum = 0;
    for (size_t p = 0; p < points.count; ++p) sum += points[mass][p] + points[due][p];
    return sum;
}

double largest_speed(const FreePoints& points) {
    double largest = 0;
    for (size_t p = 0; p < points.count; ++p)
        largest = std::max(largest, std::hypot(points[velocity_x][p], points[velocity_y][p]));
    return largest;
}

/// Whether all of a field are numbers: the sum of finite values is one, below what ground can have.
bool is_finite(const FreePoints& points, PointField name) {
    double total = 0;
    for (size_t p = 0; p < points.count; ++p) total += points[name][p];
    return std::isfinite(total);
}

[[noreturn]] void stop(double time, const std::string& problem) {
    throw Error(Status::not_converged,
                "t = " + value_text(time) + " s: " + problem + "; this says nothing about the slope");
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

/// Where the points lay before the mesh's nodes moved.
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

}  // namespace

DynamicGround::Motion DynamicGround::make_motion(const Scene& scene, const Mesh& mesh, const Points& mesh_points,
                                                 const Handover& handover, int32_t threads) {
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

DynamicGround::DynamicGround(const Scene& scene, const Mesh& mesh, const Points& mesh_points, const Handover& handover,
                             int32_t threads)
    : soils_(explicit_soils(scene)),
      motion_(make_motion(scene, mesh, mesh_points, handover, threads)),
      water_density_(scene.water.density),
      may_rest_(scene.physics.regime == MotionRegime::automatic),
      dynamics_(scene.dynamics) {
    start_solutes_ = solutes();
    start_energy_ = std::visit([](const auto& motion) { return sum(motion.energies()); }, motion_);
    for (const Soil& soil : scene.soils) grain_density_.push_back(soil.dry_density / (1 - soil.porosity));
    start_position_.resize(2 * points().count);
    start_position_ = positions();
    window_ = window_falls * std::sqrt(cell_size() / scene.gravity);
    watch_.moved_last = handover.time;
    if (may_rest_) start_window(handover.time);
    if (!handover.displacement.empty()) subtract_displacement(mesh, handover.displacement, points(), start_position_);
}

// The macro step of a dynamic ground: substeps of equal length, as long as the fastest wave and the fastest motion allow.
bool DynamicGround::advance(double from, double until, const RainAt& rain, const Cancelled& cancelled) {
    substeps_ = 0;
    peak_velocity_ = 0;
    rests_ = false;
    end_reached_.reset();
    water_exchange_ = {};
    if (points().count == 0) {  // all were taken out
        rests_ = may_rest_;
        time_ = until;
        return true;
    }
    std::visit([](auto& motion) { motion.restart(); }, motion_);  // what follows depends on the points alone
    return std::visit(
        [&](auto& motion) {
            if constexpr (requires { motion.set_rain(rain); }) motion.set_rain(rain);
            return move(motion, from, until, cancelled);
        },
        motion_);
}

template <class Moving>
bool DynamicGround::move(Moving& motion, double from, double until, const Cancelled& cancelled) {
    double time = from;
    while (time < until) {
        const double left = until - time;
        const double count = std::ceil(left / motion.critical_step());
        const bool is_last = count <= 1;
        const double next = is_last ? until : time + left / count;
        if (!(next > time)) stop(time, "the motion became too fast to be followed");
        const bool looks = is_last || substeps_ % substeps_a_look == substeps_a_look - 1;
        if (!motion.step(next - time, looks))
            stop(next, "ground moved across several cells in a substep, or its velocity came to no number");
        ++substeps_;
        time = next;
        if (!looks) continue;
        look(motion, time);
        look_for_ends(motion, time);
        if (points().count == 0) time = until;
        if (cancelled((time - from) / (until - from))) return false;
        if (rests_) break;
    }
    time_ = time;
    check_numbers();
    const WaterExchange through_surface = exchanged_water();
    water_exchange_ = {through_surface.rain, through_surface.run_off, through_surface.seepage,
                       water_exchange_.absorbed};
    return true;
}

/// Of the last substep: another one would not do with what is no number.
void DynamicGround::check_numbers() const {
    for (const PointField name :
         {position_x, position_y, velocity_x, velocity_y, stress_xx, stress_yy, stress_zz, stress_xy, point_volume}) {
        if (!is_finite(points(), name)) stop(time_, "the state of the ground came to no number");
    }
}

template <class Moving>
void DynamicGround::look(const Moving& motion, double time) {
    const FreePoints& points = motion.points();
    check_pores(time);
    if (static_cast<double>(motion.grid().nodes()) > most_nodes)
        stop(time, "the ground spread over more than " + value_text(most_nodes) +
                       " cells; dynamics.xFrom, xTo, yFrom and yTo end the background");
    peak_velocity_ = std::max(peak_velocity_, largest_speed(points));
    if (!may_rest_) return;
    const double kinetic = motion.energies().kinetic;
    watch_.peak_energy = std::max(watch_.peak_energy, kinetic);
    if (kinetic > rest_share * watch_.peak_energy) watch_.moved_last = time;
    rests_ = time - watch_.moved_last >= rest_time;
    if (time - watch_.window_start < window_) return;
    rests_ = rests_ || come_in_window() < rest_come * cell_size();
    start_window(time);
}

/// What has come to an end of the background is told the first time, and taken out where the scene says so.
template <class Moving>
void DynamicGround::look_for_ends(Moving& motion, double time) {
    const std::vector<int32_t> found = points_at_ends(dynamics_, points(), cell_size());
    const bool absorbs = dynamics_.at_ends == EndPolicy::absorb;
    if (found.empty() || (has_come_to_end_ && !absorbs)) return;
    const auto first = static_cast<size_t>(found.front());
    const Place place{points()[position_x][first], points()[position_y][first]};
    if (!end_reached_) end_reached_ = EndReached{time, place, 0};
    has_come_to_end_ = true;
    if (absorbs) absorb(motion, found);
}

template <class Moving>
void DynamicGround::absorb(Moving& motion, const std::vector<int32_t>& leaving) {
    const FreePoints& points = motion.points();
    std::vector<int32_t> staying;
    auto next = leaving.begin();
    for (size_t p = 0; p < points.count; ++p) {
        if (next == leaving.end() || *next != static_cast<int32_t>(p)) {
            staying.push_back(static_cast<int32_t>(p));
            continue;
        }
        ++next;
        absorbed_.number.push_back(points.number[p]);
        absorbed_.position.insert(absorbed_.position.end(), {points[position_x][p], points[position_y][p]});
        absorbed_.volume.push_back(points[point_volume][p]);
        end_reached_->absorbed += points[point_volume][p];
    }
    const double energy_before = sum(motion.energies()), water_before = water();
    motion.keep(staying);
    absorbed_.energy += energy_before - sum(motion.energies());
    water_exchange_.absorbed += water_before - water();
}

void DynamicGround::start_window(double time) {
    watch_.window_start = time;
    watch_.window_position = positions();
}

double DynamicGround::come_in_window() const {
    const FreePoints& points = this->points();
    double farthest = 0;
    for (size_t p = 0; p < points.count; ++p) {
        const double* start = &watch_.window_position[2 * static_cast<size_t>(points.number[p])];
        farthest = std::max(farthest, std::hypot(points[position_x][p] - start[0], points[position_y][p] - start[1]));
    }
    return farthest;
}

void DynamicGround::restore(const MovingState& state) {
    absorbed_ = state.absorbed;
    watch_ = state.rest_watch;
    has_come_to_end_ = state.has_come_to_end;
    std::visit([&](auto& motion) { motion.points() = state.points; }, motion_);
}

std::vector<double> DynamicGround::positions() const {
    std::vector<double> position(start_position_.size());
    const auto put = [&](int32_t number, double x, double y) {
        position[2 * static_cast<size_t>(number)] = x;
        position[2 * static_cast<size_t>(number) + 1] = y;
    };
    const FreePoints& points = this->points();
    for (size_t p = 0; p < points.count; ++p) put(points.number[p], points[position_x][p], points[position_y][p]);
    for (size_t k = 0; k < absorbed_.number.size(); ++k)
        put(absorbed_.number[k], absorbed_.position[2 * k], absorbed_.position[2 * k + 1]);
    return position;
}

const FreePoints& DynamicGround::points() const {
    return std::visit([](const auto& motion) -> const FreePoints& { return motion.points(); }, motion_);
}

double DynamicGround::cell_size() const {
    return std::visit([](const auto& motion) { return motion.grid().cell_size; }, motion_);
}

const Walls& DynamicGround::walls() const {
    return std::visit([](const auto& motion) -> const Walls& { return motion.walls(); }, motion_);
}

double DynamicGround::rain_on(const RainAt& rain) const {
    const Grid& grid = std::visit([](const auto& motion) -> const Grid& { return motion.grid(); }, motion_);
    std::vector<uint8_t> held(static_cast<size_t>(grid.cells[0]), 0);
    for (size_t p = 0; p < points().count; ++p) held[static_cast<size_t>(grid.cell_of(points()[position_x][p], 0))] = 1;
    double sum = 0;
    for (size_t column = 0; column < held.size(); ++column) {
        if (held[column] == 0) continue;
        sum += grid.cell_size * rain(grid.corner[0] + (static_cast<double>(column) + 0.5) * grid.cell_size);
    }
    return sum;
}

template <class Query>
auto DynamicGround::of_mixture(const Query& query) const {
    return std::visit(
        [&](const auto& motion) {
            using Result = decltype(query(std::declval<const Mixture&>()));
            if constexpr (requires { motion.rained(); }) {
                return query(motion);
            } else {
                return Result{};
            }
        },
        motion_);
}

double DynamicGround::pressure(size_t point) const {
    return of_mixture([&](const auto& mixture) { return mixture.pressure(point); });
}

double DynamicGround::gas_pressure(size_t point) const {
    return of_mixture([&](const auto& mixture) { return mixture.gas_pressure(point); });
}

double DynamicGround::saturation(size_t point) const {
    return of_mixture([&](const auto& mixture) { return mixture.saturation(point); });
}

double DynamicGround::relative_humidity(size_t point) const {
    return has_exchange() ? std::get<Exchange>(motion_).relative_humidity(point) : 0;
}

double DynamicGround::dissolved_air(size_t point) const {
    return has_exchange() ? std::get<Exchange>(motion_).dissolved_air(point) : 0;
}

double DynamicGround::pore_stress(size_t point) const {
    return of_mixture([&](const auto& mixture) { return mixture.pore_stress(point); });
}

double DynamicGround::water() const {
    if (!has_water()) return 0;
    return (held(points(), water_mass, water_due) - solutes() + start_solutes_) / water_density_;
}

double DynamicGround::solutes() const {
    if (!has_exchange()) return 0;
    return held(points(), dissolved_mass, dissolved_due) - held(points(), vapour_mass, vapour_due);
}

double DynamicGround::porosity(size_t point) const {
    const double grains = grain_density_[static_cast<size_t>(points().soil[point])] * points()[point_volume][point];
    return 1 - points()[solid_mass][point] / grains;
}

double DynamicGround::lost_strength(size_t point) const {
    const ExplicitSoil& soil = soils_[static_cast<size_t>(points().soil[point])];
    if (soil.softening_slip <= 0) return 0;
    return share_lost(soil, points()[plastic_shear_strain][point], cell_size());
}

WaterExchange DynamicGround::exchanged_water() const {
    return of_mixture([this](const auto& mixture) {
        const auto volume = [this](double mass) { return mass / water_density_; };
        return WaterExchange{volume(mixture.rained()), volume(mixture.run_off()),
                             volume(mixture.seepage() + mixture.evaporated()), 0};
    });
}

/// Grains keep their volume: no ground is denser than they are.
void DynamicGround::check_pores(double time) const {
    const FreePoints& points = this->points();
    for (size_t p = 0; p < points.count; ++p) {
        const double grains = grain_density_[static_cast<size_t>(points.soil[p])] * points[point_volume][p];
        if (points[solid_mass][p] <= grains) continue;
        stop(time, "at (" + value_text(points[position_x][p]) + ", " + value_text(points[position_y][p]) +
                       ") m the ground is pressed to less than the volume of its grains, too soft for what it bears");
    }
}

MotionReport DynamicGround::report() const {
    const FreePoints& points = this->points();
    MotionReport report;
    report.substeps = substeps_;
    const Energies energies = std::visit([](const auto& motion) { return motion.energies(); }, motion_);
    report.kinetic_energy = energies.kinetic;
    report.elastic_energy = energies.elastic;
    report.potential_energy = energies.potential;
    report.dissipated_energy = start_energy_ - absorbed_.energy - sum(energies);
    report.largest_velocity = largest_speed(points);
    report.peak_velocity = std::max(peak_velocity_, report.largest_velocity);
    std::vector<double> volume(numbers(), 0.0);
    for (size_t p = 0; p < points.count; ++p) volume[static_cast<size_t>(points.number[p])] = points[point_volume][p];
    for (size_t k = 0; k < absorbed_.number.size(); ++k)
        volume[static_cast<size_t>(absorbed_.number[k])] = absorbed_.volume[k];
    report_slide(positions(), volume, report);
    return report;
}

/// Of all points that there ever were, by their numbers; one that was taken out slides as far as the end.
void DynamicGround::report_slide(const std::vector<double>& position, const std::vector<double>& volume,
                                 MotionReport& report) const {
    double advance = 0;  // m3 m: of the sliding volume along x
    std::vector<size_t> sliding;
    for (size_t number = 0; number < volume.size(); ++number) {
        const double* start = &start_position_[2 * number];
        const double along = position[2 * number] - start[0];
        const double displacement = std::hypot(along, position[2 * number + 1] - start[1]);
        report.largest_displacement = std::max(report.largest_displacement, displacement);
        if (displacement <= cell_size()) continue;
        sliding.push_back(number);
        report.sliding_volume += volume[number];
        advance += volume[number] * along;
    }
    if (sliding.empty()) return;
    const double forwards = advance < 0 ? -1 : 1;
    double front = -std::numeric_limits<double>::infinity(), start_front = front;
    for (const size_t number : sliding) {
        front = std::max(front, forwards * position[2 * number]);
        start_front = std::max(start_front, forwards * start_position_[2 * number]);
    }
    report.front_x = forwards * front;
    report.run_out = front - start_front;
}

double DynamicGround::mobilised_strength(size_t point) const {
    const FreePoints& points = this->points();
    if (!soils_[static_cast<size_t>(points.soil[point])].yields) return 0;
    const MohrCoulomb material = std::visit([point](const auto& motion) { return motion.strength(point); }, motion_);
    return talus::mobilised_strength(material, {points[stress_xx][point], points[stress_yy][point],
                                                points[stress_zz][point], points[stress_xy][point]});
}

}  // namespace talus
