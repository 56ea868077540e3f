// What flow and boundaries load the skeleton with, and what the points take from the nodes.
#include "coupling/simulation.hpp"
#include "materials/hydraulic/curves.hpp"
#include "points/quadrature.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace talus {

void Simulation::update_points() {
    Points& points = state_.points;
    if (!flow_) return;
    const double unit_weight = scene_.water.density * scene_.gravity;
    interpolate(mesh_, points, mesh_.cell_nodes, state_.flow.pressure, points.pressure);
    interpolate_gradient(mesh_, points, state_.flow.pressure, points.darcy_flux);
    interpolate(mesh_, points, flow_->network.corner_portion, portion_saturation(state_.flow), points.saturation);
    const auto dimension = static_cast<size_t>(points.dimension);
    for (size_t c = 0; c < mesh_.cell_soil.size(); ++c) {
        const auto soil = static_cast<size_t>(mesh_.cell_soil[c]);
        const double factor = conductivity_factor_.empty() ? 1.0 : conductivity_factor_[c];
        const Tensor k = conductivity_tensor(scene_.soils[soil].hydraulics.conductivity);
        for (auto p = static_cast<size_t>(points.cell_start[c]); p < static_cast<size_t>(points.cell_start[c + 1]);
             ++p) {
            const HydraulicState here = flow_->table(soil).at(points.pressure[p]);
            points.porosity[p] = porosity(p);
            double* flux = &points.darcy_flux[p * dimension];  // holds the pressure's gradient
            const double mobility = -factor * here.permeability;
            if (dimension == 1) {
                flux[0] = mobility * k.yy * (flux[0] / unit_weight + 1.0);
            } else {
                const double slope_x = flux[0] / unit_weight;
                const double slope_y = flux[1] / unit_weight + 1.0;
                flux[0] = mobility * (k.xx * slope_x + k.xy * slope_y);
                flux[1] = mobility * (k.xy * slope_x + k.yy * slope_y);
            }
        }
    }
}

// What the flow stores water by, and holds to its tolerance. The saturation that the curve gives at a pressure between two nodes is not: behind
// a front it follows a hundredfold what hardly changes the water of a nearly dry or a full node.
std::vector<double> Simulation::portion_saturation(const FlowState& flow) const {
    std::vector<double> saturation;
    saturation.reserve(flow_->network.portions.size());
    for (const Portion& portion : flow_->network.portions) {
        const double pressure = flow.pressure[static_cast<size_t>(portion.node)];
        saturation.push_back(flow_->table(static_cast<size_t>(portion.soil)).at(pressure).saturation);
    }
    return saturation;
}

// Grains keep their volume, so that all change of volume is of the pores: D n / D t = (1 - n) div v.
double Simulation::porosity(size_t point) const {
    const double initial = scene_.soils[static_cast<size_t>(state_.points.soil[point])].porosity;
    return 1.0 - (1.0 - initial) * initial_volume_[point] / state_.points.volume[point];
}

void Simulation::set_loads(const FlowState& flow, double until) {
    const Points& points = state_.points;
    if (flow_) {
        interpolate(mesh_, points, mesh_.cell_nodes, flow.pressure, point_pressure_);
        interpolate(mesh_, points, flow_->network.corner_portion, portion_saturation(flow), point_saturation_);
        const auto& portions = flow_->network.portions;
        for (size_t i = 0; i < portions.size(); ++i) {
            portion_stress_[i] = flow_->pore_stress(static_cast<size_t>(portions[i].soil),
                                                    flow.pressure[static_cast<size_t>(portions[i].node)]);
        }
        interpolate(mesh_, points, flow_->network.corner_portion, portion_stress_, point_pore_stress_);
    }
    for (size_t p = 0; p < static_cast<size_t>(points.count); ++p) {
        const auto number = static_cast<size_t>(points.soil[p]);
        const Soil& soil = scene_.soils[number];
        double suction = 0;
        double effective = 1;
        point_density_[p] = soil.dry_density * initial_volume_[p] / points.volume[p];
        if (flow_) {
            const Retention& retention = soil.hydraulics.retention;
            const double saturation = point_saturation_[p];
            const double water_density =
                scene_.water.density * std::exp(point_pressure_[p] / scene_.water.bulk_modulus);
            point_density_[p] += porosity(p) * saturation * water_density;
            suction = std::max(0.0, -point_pressure_[p]);
            effective = effective_of_saturation(retention, saturation);
        }
        point_strength_[p] = shear_strength(soil.solid.strength, suction, effective);
        if (!lost_strength_.empty()) point_strength_[p] = softened(point_strength_[p], soil.solid, lost_strength_[p]);
    }
    std::fill(node_force_.begin(), node_force_.end(), 0.0);
    for (const GivenTraction& given : given_tractions_) add_traction(given, until);
    if (flow_) {
        for (const int32_t f : flow_->boundaries.surface_facets)
            add_pond(mesh_.facets[static_cast<size_t>(f)], flow.pressure);
    }
    for (const GivenDisplacement& given : given_displacements_) {
        prescribed_displacement_[given.freedom] =
            forcing.motion_value(given.boundary, given.component, until) - state_.displacement[given.freedom];
    }
}

// By the slip of the accepted state: the strength stays as it is through an exchange. A band is as thin as a cell, as in motion.
void Simulation::soften() {
    if (lost_strength_.empty()) return;
    const Points& points = state_.points;
    for (size_t c = 0; c < mesh_.cell_soil.size(); ++c) {
        const double slip = scene_.soils[static_cast<size_t>(mesh_.cell_soil[c])].solid.softening.slip;
        if (!(slip > 0)) continue;
        const auto first = static_cast<size_t>(points.cell_start[c]),
                   last = static_cast<size_t>(points.cell_start[c + 1]);
        const double size = std::sqrt(std::accumulate(initial_volume_.begin() + points.cell_start[c],
                                                      initial_volume_.begin() + points.cell_start[c + 1], 0.0));
        for (size_t p = first; p < last; ++p) {
            const double strain = points.plastic_strain[p] - settled_plastic_strain_[p];
            lost_strength_[p] = std::min(settled_lost_strength_[p] + band_slip(strain, size) / slip, 1.0);
        }
    }
}

void Simulation::add_traction(const GivenTraction& given, double time) {
    const Facet& facet = mesh_.facets[given.facet];
    if (mesh_.dimension == 1) {
        node_force_[static_cast<size_t>(facet.node_a)] += forcing.motion_value(given.boundary, 1, time);
        return;
    }
    const auto a = 2 * static_cast<size_t>(facet.node_a);
    const auto b = 2 * static_cast<size_t>(facet.node_b);
    const double length =
        std::hypot(mesh_.position[b] - mesh_.position[a], mesh_.position[b + 1] - mesh_.position[a + 1]);
    for (size_t component = 0; component < 2; ++component) {
        const double force = 0.5 * length * forcing.motion_value(given.boundary, component, time);
        node_force_[a + component] += force;
        node_force_[b + component] += force;
    }
}

// The weight of water that stands on the surface: as deep as it may pond, for a pressure beyond is what drives water out of the ground.
// What a boundary holds there is the host's, with the traction that it gives.
void Simulation::add_pond(const Facet& facet, std::span<const double> pressure) {
    const double deepest = scene_.water.density * scene_.gravity * scene_.surface.ponding_depth;
    const auto standing = [&](int32_t node) {
        const auto index = static_cast<size_t>(node);
        return flow_->is_held(index) ? 0.0 : std::clamp(pressure[index], 0.0, deepest);
    };
    const double at_a = standing(facet.node_a);
    if (mesh_.dimension == 1) {
        node_force_[static_cast<size_t>(facet.node_a)] -= at_a;
        return;
    }
    const double at_b = standing(facet.node_b);
    const auto a = 2 * static_cast<size_t>(facet.node_a);
    const auto b = 2 * static_cast<size_t>(facet.node_b);
    // times the facet's length
    const std::array<double, 2> normal{mesh_.position[b + 1] - mesh_.position[a + 1],
                                       mesh_.position[a] - mesh_.position[b]};
    for (size_t component = 0; component < 2; ++component) {
        node_force_[a + component] -= (2.0 * at_a + at_b) / 6.0 * normal[component];
        node_force_[b + component] -= (at_a + 2.0 * at_b) / 6.0 * normal[component];
    }
}

void Simulation::refresh_geometry() {
    if (!flow_ || !equilibrium_) return;
    const Points& points = state_.points;
    for (size_t c = 0; c < conductivity_factor_.size(); ++c) {
        const Soil& soil = scene_.soils[static_cast<size_t>(mesh_.cell_soil[c])];
        conductivity_factor_[c] = 1.0;
        if (soil.hydraulics.conductivity.porosity_dependence == PorosityDependence::none) continue;
        double initial = 0;
        double now = 0;
        for (auto p = static_cast<size_t>(points.cell_start[c]); p < static_cast<size_t>(points.cell_start[c + 1]);
             ++p) {
            initial += initial_volume_[p];
            now += points.volume[p];
        }
        const double n = 1.0 - (1.0 - soil.porosity) * initial / now;
        conductivity_factor_[c] = kozeny_carman(n) / kozeny_carman(soil.porosity);
    }
    talus::refresh_geometry(flow_->network, mesh_, scene_, conductivity_factor_);
    flow_->boundaries = make_flow_boundaries(mesh_, reference_mesh_, scene_);
    std::vector<double>& softness = flow_->skeleton.softness;
    std::fill(softness.begin(), softness.end(), 0.0);
    for (size_t c = 0; c < mesh_.cell_soil.size(); ++c) {
        for (auto corner = static_cast<size_t>(mesh_.cell_start[c]);
             corner < static_cast<size_t>(mesh_.cell_start[c + 1]); ++corner) {
            softness[static_cast<size_t>(flow_->network.corner_portion[corner])] +=
                flow_->network.corner_volume[corner] * softness_[static_cast<size_t>(mesh_.cell_soil[c])];
        }
    }
}

// The pressure projection in the stored water: per cell, volume / corners^2 times the difference of each pair of corners, which is what the
// cell's mean pressure leaves out of the pressures at its nodes (Bochev, Dohrmann & Gunzburger, SIAM J. Numer. Anal. 44, 2006). Of the mesh at the start: volumes that
// followed its motion would change the stored water between two exchanges, by nobody's flow.
void Simulation::set_projection() {
    const Network& network = flow_->network;
    std::vector<double>& projection = flow_->skeleton.projection;
    std::fill(projection.begin(), projection.end(), 0.0);
    for (size_t c = 0; c < mesh_.cell_soil.size(); ++c) {
        const auto first = network.corner_volume.begin() + mesh_.cell_start[c];
        const auto last = network.corner_volume.begin() + mesh_.cell_start[c + 1];
        const auto corners = static_cast<double>(last - first);
        // In triangles the skeleton sees the pressures averaged three times: over the cell, over the patches of its nodes, over their cells.
        const double averages = corners == 3 ? 3.0 : 1.0;
        const double share = averages * std::accumulate(first, last, 0.0) / (corners * corners);
        for (auto pair = static_cast<size_t>(network.pair_start[c]);
             pair < static_cast<size_t>(network.pair_start[c + 1]); ++pair) {
            projection[static_cast<size_t>(network.pair_neighbours[pair])] +=
                share * projection_softness_[static_cast<size_t>(mesh_.cell_soil[c])];
        }
    }
}

}  // namespace talus
