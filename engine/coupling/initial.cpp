// The ground and its state before anything happens.
#include "coupling/background.hpp"
#include "coupling/simulation.hpp"
#include "error.hpp"
#include "ground/build.hpp"
#include "materials/hydraulic/curves.hpp"
#include "motion/geostatic.hpp"
#include "points/quadrature.hpp"
#include "scene/problems.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace talus {
namespace {

double vertical_extent(const Mesh& mesh) {
    double low = mesh.position[static_cast<size_t>(mesh.dimension) - 1];
    double high = low;
    for (size_t i = static_cast<size_t>(mesh.dimension) - 1; i < mesh.position.size();
         i += static_cast<size_t>(mesh.dimension)) {
        low = std::min(low, mesh.position[i]);
        high = std::max(high, mesh.position[i]);
    }
    return high - low;
}

/// Suction at which a soil has a given saturation.
double suction_of(const HydraulicTable& table, const Soil& soil, size_t number, double saturation) {
    const Retention& retention = soil.hydraulics.retention;
    if (saturation >= retention.maximum_saturation) return 0.0;
    if (saturation <= retention.residual_saturation) {
        throw Error(Status::invalid_scene,
                    "initial.saturation = " + value_text(saturation) + ": must be above the residual saturation " +
                        value_text(retention.residual_saturation) + " of soils[" + std::to_string(number) + "]");
    }
    return -table.pressure_of_saturation(saturation);
}

}  // namespace

Simulation::Simulation(const Scene& scene, double tolerance, int32_t threads, bool stop_at_motion)
    : forcing(scene),
      scene_(scene),
      tolerance_(tolerance),
      threads_(threads),
      stop_at_motion_(stop_at_motion),
      mesh_(build_mesh(scene)),
      reference_mesh_(mesh_) {
    if (scene.physics.regime != MotionRegime::quasi_static) check_between_ends(scene.dynamics, mesh_);
    state_.points = make_points(mesh_);
    state_.node_position = mesh_.position;
    initial_volume_ = state_.points.volume;
    agreement_pressure_ = 0.1 * tolerance * scene.water.density * scene.gravity * vertical_extent(mesh_);
    if (scene.physics.water) make_flow();
    if (scene.physics.deforming) make_motion();
    if (flow_) set_initial_flow();
    if (equilibrium_) set_initial_stress();
    if (scene.physics.regime == MotionRegime::dynamic) make_dynamic(threads);
    update_points();
}

void Simulation::make_flow() {
    const auto points = static_cast<size_t>(state_.points.count);
    flow_ = std::make_unique<FlowSystem>(scene_, mesh_.node_count(), make_network(mesh_, scene_),
                                         make_flow_boundaries(mesh_, mesh_, scene_));
    // What Newton's method left in the pressures would be noise between the two that no exchange settles.
    constexpr double share = 0.1;
    integrator_ = scene_.physics.deforming
                      ? std::make_unique<FlowIntegrator>(*flow_, tolerance_, share * agreement_pressure_)
                      : std::make_unique<FlowIntegrator>(*flow_, tolerance_);
    flow_->forcing.rain.assign(flow_->boundaries.surface.size(), 0.0);
    flow_->forcing.held.resize(flow_->boundaries.held.size());
    flow_->forcing.flux.resize(flow_->boundaries.flux_shares.size());
    for (auto* field : {&state_.points.pressure, &state_.points.saturation, &state_.points.porosity})
        field->resize(points);
    state_.points.darcy_flux.resize(points * static_cast<size_t>(mesh_.dimension));

    const size_t portions = flow_->network.portions.size();
    state_.pore_volume.assign(portions, 0.0);
    for (size_t c = 0; c < mesh_.cell_soil.size(); ++c) {
        for (auto corner = static_cast<size_t>(mesh_.cell_start[c]);
             corner < static_cast<size_t>(mesh_.cell_start[c + 1]); ++corner) {
            state_.pore_volume[static_cast<size_t>(flow_->network.corner_portion[corner])] +=
                scene_.soils[static_cast<size_t>(mesh_.cell_soil[c])].porosity * flow_->network.corner_volume[corner];
        }
    }
    flow_->skeleton.pore_volume.resize(portions);
    for (size_t i = 0; i < portions; ++i) flow_->skeleton.pore_volume[i] = {state_.pore_volume[i], 0.0};
    if (!scene_.physics.deforming) return;

    flow_->skeleton.softness.assign(portions, 0.0);
    flow_->skeleton.expected_stress.resize(portions);
    flow_->skeleton.projection.resize(flow_->network.neighbours.size());
    state_.flow_pore_volume = state_.pore_volume;
    state_.displacement_rate.assign(mesh_.position.size(), 0.0);
    for (auto* field : {&state_.pore_volume_rate, &state_.pore_stress_rate, &start_stress_, &end_stress_, &end_volume_,
                        &taken_volume_, &found_volume_, &portion_stress_, &correction_})
        field->assign(portions, 0.0);
    acceleration_ = Anderson(portions);
    point_pressure_.resize(points);
    point_saturation_.resize(points);
    conductivity_factor_.assign(mesh_.cell_soil.size(), 1.0);
}

void Simulation::make_motion() {
    const auto points = static_cast<size_t>(state_.points.count);
    const auto dimension = static_cast<size_t>(mesh_.dimension);
    Points& fields = state_.points;
    fields.displacement.assign(points * dimension, 0.0);
    fields.skeleton_stress.assign(points * 4, 0.0);
    fields.strain.assign(points * 4, 0.0);
    fields.plastic_strain.assign(points, 0.0);
    fields.mobilised_strength.assign(points, 0.0);
    point_pore_stress_.assign(points, 0.0);
    point_density_.assign(points, 0.0);
    point_strength_.resize(points);
    const auto softens = [](const Soil& soil) { return soil.solid.softening.slip > 0; };
    if (scene_.physics.regime == MotionRegime::automatic &&
        std::any_of(scene_.soils.begin(), scene_.soils.end(), softens)) {
        for (auto* field : {&lost_strength_, &settled_lost_strength_, &settled_plastic_strain_})
            field->assign(points, 0.0);
    }

    const size_t freedoms = mesh_.position.size();
    state_.displacement.assign(freedoms, 0.0);
    state_.velocity.assign(freedoms, 0.0);
    node_force_.assign(freedoms, 0.0);
    prescribed_displacement_.assign(freedoms, 0.0);
    const std::vector<uint8_t> prescribed = hold_nodes();
    motion_unknowns_ = static_cast<size_t>(std::count(prescribed.begin(), prescribed.end(), uint8_t{0}));

    std::vector<Solid> solids;
    for (const Soil& soil : scene_.soils) {
        solids.push_back(soil.solid);
        // The skeleton's answer to pore stress at constant total stress: the fixed-stress split's modulus, lambda + G in plane strain and the
        // oedometric one in a column. The pressure projection (Bochev, Dohrmann & Gunzburger 2006) has the oedometric one in both: with it
        // an undrained step answers a pressure of any wavelength as the continuum does, be it one that the cells do not see at all
        // (Aguilar, Gaspar, Lisbona & Rodrigo, Int. J. Numer. Methods Eng. 75, 2008). In a column that makes it a lumped one, hence monotone.
        const double shear = soil.solid.young_modulus / (2.0 * (1.0 + soil.solid.poisson_ratio));
        const double lame = 2.0 * shear * soil.solid.poisson_ratio / (1.0 - 2.0 * soil.solid.poisson_ratio);
        const double oedometric = lame + 2.0 * shear;
        softness_.push_back(1.0 / (dimension == 1 ? oedometric : lame + shear));
        projection_softness_.push_back(1.0 / oedometric);
    }
    equilibrium_ = std::make_unique<Equilibrium>(mesh_, state_.points, std::move(solids), prescribed, scene_.gravity);
    refresh_geometry();
    if (flow_) set_projection();
}

// Which degrees of freedom the boundaries give, and where they pull.
std::vector<uint8_t> Simulation::hold_nodes() {
    const auto dimension = static_cast<size_t>(mesh_.dimension);
    std::vector<uint8_t> prescribed(mesh_.position.size(), 0);
    for (size_t b = 0; b < scene_.boundaries.size(); ++b) {
        const Boundary& boundary = scene_.boundaries[b];
        if (!boundary.has_motion) continue;
        for (size_t f = 0; f < mesh_.facets.size(); ++f) {
            const Facet& facet = mesh_.facets[f];
            if (!covers(boundary, mesh_, facet)) continue;
            if (boundary.motion == MotionCondition::traction) given_tractions_.push_back({f, b});
            for (const int32_t node : {facet.node_a, facet.node_b}) {
                if (node < 0) continue;
                for (size_t component = 0; component < dimension; ++component) {
                    const size_t freedom = static_cast<size_t>(node) * dimension + component;
                    const size_t axis = dimension == 1 ? 1 : component;
                    if (holds(boundary, facet, axis)) prescribed[freedom] = 1;
                    if (boundary.motion == MotionCondition::displacement && forcing.has_motion_value(b, axis)) {
                        prescribed[freedom] = 1;
                        given_displacements_.push_back({freedom, b, axis});
                    }
                }
            }
        }
    }
    return prescribed;
}

// A fixed boundary holds both components, a roller the one across it; ground at rest sticks to a base with friction, and has settled along an
// upright wall with friction.
bool Simulation::holds(const Boundary& boundary, const Facet& facet, size_t axis) const {
    const bool rubs = boundary.motion == MotionCondition::friction;
    if (boundary.motion == MotionCondition::fixed || (rubs && boundary.side == "base")) return true;
    if (boundary.motion != MotionCondition::roller && !rubs) return false;
    if (mesh_.dimension == 1) return true;
    const Place a = place_of(facet.node_a);
    const Place b = place_of(facet.node_b);
    const bool upright = std::abs(b[1] - a[1]) > std::abs(b[0] - a[0]);
    return axis == (upright ? 0u : 1u);
}

void Simulation::set_initial_flow() {
    const auto nodes = static_cast<size_t>(mesh_.node_count());
    const Initial& initial = scene_.initial;
    FlowState& flow = state_.flow;
    flow.pressure.assign(nodes, 0.0);
    switch (initial.flow) {
        case InitialFlow::suction: std::fill(flow.pressure.begin(), flow.pressure.end(), -initial.suction); break;
        case InitialFlow::saturation:
            for (const Portion& portion : flow_->network.portions) {
                const auto soil = static_cast<size_t>(portion.soil);
                flow.pressure[static_cast<size_t>(portion.node)] =
                    -suction_of(flow_->table(soil), scene_.soils[soil], soil, initial.saturation);
            }
            break;
        case InitialFlow::hydrostatic:
            for (size_t i = 0; i < nodes; ++i) {
                flow.pressure[i] = scene_.water.density * scene_.gravity *
                                   (initial.water_table - place_of(static_cast<int32_t>(i))[1]);
            }
            break;
        case InitialFlow::steady: find_steady_flow(); break;
    }
    set_flow_forcing(1.0);
    for (size_t h = 0; h < flow_->boundaries.held.size(); ++h)
        flow.pressure[static_cast<size_t>(flow_->boundaries.held[h].node)] = flow_->forcing.held[h].start;
    hold_skeleton();
    flow_->evaluate(0.0, flow.pressure);
    flow.stored.assign(flow_->stored().begin(), flow_->stored().end());
    for (const double water : flow.stored) initial_water_ += water;
    state_.watch.is_saturated = is_full(flow.pressure);
}

// The steady state under the boundaries' values at the start and, on the ground surface, a held pressure or a rain.
void Simulation::find_steady_flow() {
    const Initial& initial = scene_.initial;
    set_flow_forcing(1.0);
    FlowBoundaries boundaries = flow_->boundaries;
    FlowForcing steady = flow_->forcing;
    for (Ramp& value : steady.held) value.rate = 0;
    for (Ramp& value : steady.flux) value.rate = 0;
    if (std::isnan(initial.surface_pressure)) {
        for (size_t i = 0; i < boundaries.surface.size(); ++i)
            steady.rain[i] = boundaries.surface[i].rain_area * initial.surface_rain;
    } else {
        for (const SurfaceNode& surface : boundaries.surface) {
            boundaries.held.push_back({surface.node, -1});
            steady.held.push_back({initial.surface_pressure, 0.0});
        }
        boundaries.surface.clear();
        boundaries.zone_shares.clear();
        steady.rain.clear();
    }
    FlowSystem system(scene_, mesh_.node_count(), flow_->network, boundaries);
    system.forcing = steady;
    system.skeleton.pore_volume = flow_->skeleton.pore_volume;
    FlowIntegrator integrator(system, tolerance_);
    state_.flow.pressure = steady_guess();
    if (!integrator.find_steady(state_.flow)) {
        throw Error(Status::not_converged,
                    "initial.flow = steady: no steady state was found under the boundaries given");
    }
}

// Hydrostatic under the mean head that the boundaries hold, and not drier than the surface.
std::vector<double> Simulation::steady_guess() const {
    const double unit_weight = scene_.water.density * scene_.gravity;
    const double driest = std::isnan(scene_.initial.surface_pressure) ? 0.0 : scene_.initial.surface_pressure;
    const auto nodes = static_cast<size_t>(mesh_.node_count());
    const std::vector<HeldNode>& held = flow_->boundaries.held;
    if (held.empty()) return std::vector<double>(nodes, driest);
    double head = 0;
    for (size_t h = 0; h < held.size(); ++h) {
        head +=
            (flow_->forcing.held[h].start / unit_weight + place_of(held[h].node)[1]) / static_cast<double>(held.size());
    }
    std::vector<double> guess(nodes);
    for (size_t i = 0; i < nodes; ++i)
        guess[i] = std::max(driest, unit_weight * (head - place_of(static_cast<int32_t>(i))[1]));
    return guess;
}

void Simulation::set_initial_stress() {
    set_loads(state_.flow, state_.time);
    for (const GivenDisplacement& given : given_displacements_) prescribed_displacement_[given.freedom] = 0;
    const Loads loads{point_density_, point_pore_stress_, point_strength_, node_force_, prescribed_displacement_};
    outcome_ = find_initial_stress(loads);
    if (outcome_.status == EquilibriumStatus::converged) {
        if (scene_.physics.regime != MotionRegime::dynamic && !equilibrium_->is_stable(loads)) {
            throw Error(Status::invalid_scene,
                        "initial.stress: the ground is too soft to stay in equilibrium under its own weight: a nudge, "
                        "however small, would grow");
        }
        return;
    }
    const auto [x, y] = outcome_.collapse.place;
    const std::string where = " at (" + value_text(x) + ", " + value_text(y) + ") m";
    if (outcome_.status == EquilibriumStatus::no_equilibrium) {
        const bool may_fall = scene_.physics.regime == MotionRegime::dynamic;
        throw Error(Status::invalid_scene,
                    "initial.stress: the ground does not stand under its own weight: it fails" + where +
                        (may_fall ? "; a dynamic ground may start from elastic, k0 or zero" : ""));
    }
    throw Error(
        Status::not_converged,
        "initial.stress: no equilibrium was found under the ground's own weight; this says nothing about the slope");
}

EquilibriumOutcome Simulation::find_initial_stress(const Loads& loads) {
    EquilibriumOutcome none;
    none.status = EquilibriumStatus::converged;
    switch (scene_.initial.stress) {
        case InitialStress::zero: return none;
        case InitialStress::elastic: return turn_on_gravity_elastically(*equilibrium_, loads);
        case InitialStress::gravity: return turn_on_gravity(*equilibrium_, loads);
        case InitialStress::k0: break;
    }
    if (scene_.physics.regime != MotionRegime::dynamic)
        return set_k0_stress(*equilibrium_, mesh_, state_.points, loads, scene_.gravity, scene_.initial.k0);
    put_k0_stress(mesh_, state_.points, loads, scene_.gravity, scene_.initial.k0);
    return none;
}

// What moves are the points alone: the mesh and its equilibrium have served.
void Simulation::make_dynamic(int32_t threads) {
    dynamic_ = std::make_unique<DynamicGround>(scene_, mesh_, state_.points, Handover{state_.flow.pressure}, threads);
    equilibrium_.reset();
    integrator_.reset();
    flow_.reset();
    initial_water_ = dynamic_->water();
    motion_unknowns_ = 0;
    state_ = {};
}

}  // namespace talus
