#include "flow/system.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace talus {
namespace {

// `here` is the state at the pressure, whose capacity may be larger than the curve's.
double moved_by_saturation(const HydraulicTable& table, double pressure, double change, const HydraulicState& here) {
    const double turn = table.switch_pressure();
    const HydraulicState at_turn = table.at(turn);
    if (at_turn.capacity <= 0) return pressure + change;
    const double target = pressure >= turn ? at_turn.saturation + at_turn.capacity * (pressure + change - turn)
                                           : here.saturation + here.capacity * change;
    if (target >= at_turn.saturation) return turn + (target - at_turn.saturation) / at_turn.capacity;
    constexpr double largest_loss = 0.9;  // of what is above the residual saturation
    const double mobile = std::min(here.saturation, at_turn.saturation) - table.residual_saturation();
    const double least = table.residual_saturation() + (1.0 - largest_loss) * mobile;
    return table.pressure_of_saturation(std::max(target, least));
}

}  // namespace

FlowSystem::FlowSystem(const Scene& scene, int32_t nodes, Network network_in, FlowBoundaries boundaries_in)
    : network(std::move(network_in)), boundaries(std::move(boundaries_in)), scene_(scene) {
    for (const Soil& soil : scene.soils) tables_.emplace_back(soil.hydraulics);
    const auto count = static_cast<size_t>(nodes);
    held_node_.assign(count, 0);
    for (const HeldNode& held : boundaries.held) held_node_[static_cast<size_t>(held.node)] = 1;
    surface_node_.assign(count, 0);
    for (const SurfaceNode& surface : boundaries.surface) surface_node_[static_cast<size_t>(surface.node)] = 1;
    for (auto* array : {&stored_, &inflow_, &stored_slope_, &inflow_slope_, &node_pore_volume_})
        array->assign(count, 0.0);
    state_.resize(network.portions.size());
    link_state_.resize(network.links.size());
    if (scene.physics.deforming) {
        pore_stress_.resize(network.portions.size());
        pore_stress_slope_.resize(network.portions.size());
        effective_saturation_.resize(network.portions.size());
        effective_saturation_slope_.resize(network.portions.size());
    }
    list_portions(count);
}

void FlowSystem::list_portions(size_t nodes) {
    std::vector<double> volume(network.portions.size(), 0.0);
    for (size_t corner = 0; corner < network.corner_portion.size(); ++corner)
        volume[static_cast<size_t>(network.corner_portion[corner])] += network.corner_volume[corner];
    std::vector<std::vector<NodePortion>> of_node(nodes);
    for (size_t i = 0; i < network.portions.size(); ++i)
        of_node[static_cast<size_t>(network.portions[i].node)].push_back({volume[i], network.portions[i].soil});
    for (auto& here : of_node) {
        std::stable_sort(here.begin(), here.end(), [](const auto& a, const auto& b) { return a.volume > b.volume; });
        node_portions_start_.push_back(node_portions_.size());
        node_portions_.insert(node_portions_.end(), here.begin(), here.end());
    }
    node_portions_start_.push_back(node_portions_.size());
}

SparseMatrix FlowSystem::make_matrix() {
    const auto node = [&](int32_t portion) { return network.portions[static_cast<size_t>(portion)].node; };
    const auto ends = [&](int32_t link) {
        const Link& of = network.links[static_cast<size_t>(link)];
        return std::array{node(of.portion_a), node(of.portion_b)};
    };
    std::vector<std::array<int32_t, 2>> pairs;
    for (const auto* list : {&network.links, &network.neighbours})
        for (const Link& link : *list) pairs.push_back({node(link.portion_a), node(link.portion_b)});
    for (const Crossing& crossing : network.crossings) {
        for (const int32_t i : ends(crossing.link_a))
            for (const int32_t j : ends(crossing.link_b)) pairs.push_back({i, j});
    }
    SparseMatrix matrix = symmetric_pattern(node_count(), pairs);

    const auto places = [&](std::array<int32_t, 2> rows, std::array<int32_t, 2> columns) {
        return Places{matrix.place(rows[0], columns[0]), matrix.place(rows[0], columns[1]),
                      matrix.place(rows[1], columns[0]), matrix.place(rows[1], columns[1])};
    };
    link_places_.clear();
    neighbour_places_.clear();
    cross_places_.clear();
    const auto own_places = [&](const Link& link) {
        const std::array both{node(link.portion_a), node(link.portion_b)};
        return places(both, both);
    };
    for (const Link& link : network.links) link_places_.push_back(own_places(link));
    for (const Link& link : network.neighbours) neighbour_places_.push_back(own_places(link));
    for (const Crossing& crossing : network.crossings) {
        cross_places_.push_back(places(ends(crossing.link_a), ends(crossing.link_b)));
        cross_places_.push_back(places(ends(crossing.link_b), ends(crossing.link_a)));
    }
    diagonal_.clear();
    for (int32_t i = 0; i < node_count(); ++i) diagonal_.push_back(matrix.place(i, i));
    return matrix;
}

void FlowSystem::evaluate(double t, std::span<const double> pressure, std::span<const double> beyond) {
    std::fill(stored_.begin(), stored_.end(), 0.0);
    std::fill(stored_slope_.begin(), stored_slope_.end(), 0.0);
    std::fill(inflow_.begin(), inflow_.end(), 0.0);
    std::fill(node_pore_volume_.begin(), node_pore_volume_.end(), 0.0);
    total_rates_.fill(0.0);
    for (size_t i = 0; i < state_.size(); ++i) {
        const Portion& portion = network.portions[i];
        state_[i] = tables_[static_cast<size_t>(portion.soil)].at(pressure[static_cast<size_t>(portion.node)]);
    }
    if (skeleton.softness.empty()) {
        evaluate_rigid(pressure);
    } else {
        evaluate_deforming(t, pressure);
    }
    evaluate_links(pressure, beyond);
    evaluate_common_permeability();
    evaluate_crossings();
    evaluate_surface(pressure, beyond);
    evaluate_flux(t);
}

void FlowSystem::evaluate_rigid(std::span<const double> pressure) {
    for (size_t i = 0; i < state_.size(); ++i) {
        const auto node = static_cast<size_t>(network.portions[i].node);
        const double pores = skeleton.pore_volume[i].start;
        const double density = std::exp(pressure[node] / scene_.water.bulk_modulus);
        stored_[node] += pores * state_[i].saturation * density;
        stored_slope_[node] +=
            pores * density * (state_[i].capacity + state_[i].saturation / scene_.water.bulk_modulus);
        node_pore_volume_[node] += pores;
    }
}

void FlowSystem::evaluate_deforming(double t, std::span<const double> pressure) {
    const bool bishop = scene_.physics.stress == StressMeasure::bishop;
    for (size_t i = 0; i < state_.size(); ++i) {
        const auto node = static_cast<size_t>(network.portions[i].node);
        const double p = pressure[node];
        const HydraulicState& here = state_[i];
        const Retention& retention = scene_.soils[static_cast<size_t>(network.portions[i].soil)].hydraulics.retention;
        const double range = retention.maximum_saturation - retention.residual_saturation;
        const double effective = effective_of_saturation(retention, here.saturation);
        effective_saturation_[i] = effective;
        effective_saturation_slope_[i] = here.capacity / range;
        pore_stress_[i] = bishop ? effective * p : std::max(p, 0.0);
        pore_stress_slope_[i] = bishop ? effective + p * here.capacity / range : p > 0 ? 1.0 : 0.0;
        const double pores = skeleton.pore_volume[i].at(t) +
                             skeleton.softness[i] * (pore_stress_[i] - skeleton.expected_stress[i].at(t));
        const double density = std::exp(p / scene_.water.bulk_modulus);
        stored_[node] += pores * here.saturation * density;
        stored_slope_[node] += density * (pores * (here.capacity + here.saturation / scene_.water.bulk_modulus) +
                                          skeleton.softness[i] * pore_stress_slope_[i] * here.saturation);
        node_pore_volume_[node] += pores;
    }
    for (size_t i = 0; i < network.neighbours.size(); ++i) {
        const auto a = static_cast<size_t>(network.neighbours[i].portion_a);
        const auto b = static_cast<size_t>(network.neighbours[i].portion_b);
        const double exchanged = skeleton.projection[i] * effective_saturation_[a] * effective_saturation_[b] *
                                 (pore_stress_[a] - pore_stress_[b]);
        stored_[static_cast<size_t>(network.portions[a].node)] += exchanged;
        stored_[static_cast<size_t>(network.portions[b].node)] -= exchanged;
    }
}

void FlowSystem::evaluate_links(std::span<const double> pressure, std::span<const double> beyond) {
    for (size_t l = 0; l < network.links.size(); ++l) {
        const Portion& a = network.portions[static_cast<size_t>(network.links[l].portion_a)];
        const Portion& b = network.portions[static_cast<size_t>(network.links[l].portion_b)];
        const LinkEnd end_a{pressure[static_cast<size_t>(a.node)],
                            state_[static_cast<size_t>(network.links[l].portion_a)]};
        const LinkEnd end_b{pressure[static_cast<size_t>(b.node)],
                            state_[static_cast<size_t>(network.links[l].portion_b)]};
        const HydraulicTable& table = tables_[static_cast<size_t>(a.soil)];
        LinkState& link = link_state_[l];
        link.head = end_a.pressure - end_b.pressure + network.fall[l];
        if (!beyond.empty()) link.head += beyond[static_cast<size_t>(a.node)] - beyond[static_cast<size_t>(b.node)];
        if (network.fall[l] >= 0) {
            const MeanPermeability mean = mean_permeability(table, end_a, end_b, network.fall[l]);
            link.permeability = mean.value;
            link.permeability_slope = {mean.slope_upper, mean.slope_lower};
        } else {
            const MeanPermeability mean = mean_permeability(table, end_b, end_a, -network.fall[l]);
            link.permeability = mean.value;
            link.permeability_slope = {mean.slope_lower, mean.slope_upper};
        }
        add_flow(network.links[l], network.transmissibility[l] * link.permeability * link.head);
    }
}

// The mean of a link's own flow all but jumps where its ends come to hydrostatic balance, full below and dry above: no flow is there divided by
// no head. Other water must not meet that, nor leave a dry end as if it were wet.
void FlowSystem::evaluate_common_permeability() {
    if (network.crossings.empty()) return;
    for (size_t l = 0; l < network.links.size(); ++l) {
        const HydraulicState& a = state_[static_cast<size_t>(network.links[l].portion_a)];
        const HydraulicState& b = state_[static_cast<size_t>(network.links[l].portion_b)];
        LinkState& link = link_state_[l];
        const double of_ends = std::sqrt(a.permeability * b.permeability);
        if (of_ends > 0 && of_ends < link.permeability) {
            link.common_permeability = of_ends;
            link.common_slope = {0.5 * of_ends * a.permeability_slope / a.permeability,
                                 0.5 * of_ends * b.permeability_slope / b.permeability};
        } else {
            link.common_permeability = of_ends > 0 ? link.permeability : 0.0;
            link.common_slope = link.permeability_slope;
        }
    }
}

// Along each of two links flows C sqrt(k_a k_b) times the head lost along the other.
void FlowSystem::evaluate_crossings() {
    for (size_t c = 0; c < network.crossings.size(); ++c) {
        const auto a = static_cast<size_t>(network.crossings[c].link_a);
        const auto b = static_cast<size_t>(network.crossings[c].link_b);
        const LinkState& link_a = link_state_[a];
        const LinkState& link_b = link_state_[b];
        const double conductance =
            network.cross_transmissibility[c] * std::sqrt(link_a.common_permeability * link_b.common_permeability);
        add_flow(network.links[a], conductance * link_b.head);
        add_flow(network.links[b], conductance * link_a.head);
    }
}

void FlowSystem::add_flow(const Link& link, double flow) {
    inflow_[static_cast<size_t>(network.portions[static_cast<size_t>(link.portion_a)].node)] -= flow;
    inflow_[static_cast<size_t>(network.portions[static_cast<size_t>(link.portion_b)].node)] += flow;
}

void FlowSystem::evaluate_surface(std::span<const double> pressure, std::span<const double> beyond) {
    const double unit_weight = scene_.water.density * scene_.gravity;
    const double pond_pressure = unit_weight * scene_.surface.ponding_depth;
    for (size_t i = 0; i < boundaries.surface.size(); ++i) {
        const SurfaceNode& surface = boundaries.surface[i];
        const auto node = static_cast<size_t>(surface.node);
        const double rain = forcing.rain[i];
        total_rates_[rain_total] += rain;
        inflow_slope_[node] = 0.0;
        if (held_node_[node] != 0) {  // a held node takes its water from what holds it
            total_rates_[run_off_total] += rain;
            continue;
        }
        inflow_[node] += rain;
        const double p = pressure[node];
        if (p <= 0) continue;
        stored_[node] += surface.pond_area * std::min(p, pond_pressure) / unit_weight;
        if (p < pond_pressure) stored_slope_[node] += surface.pond_area / unit_weight;
        if (p <= pond_pressure) continue;
        const double conductance = (surface.area * surface.conductivity + rain) / (unit_weight * weir_thickness);
        const double excess = conductance * (p - pond_pressure + (beyond.empty() ? 0.0 : beyond[node]));
        inflow_[node] -= excess;
        inflow_slope_[node] = -conductance;
        total_rates_[run_off_total] += std::min(excess, rain);
        total_rates_[seepage_total] += std::max(excess - rain, 0.0);
    }
}

void FlowSystem::evaluate_flux(double t) {
    for (size_t i = 0; i < boundaries.flux_shares.size(); ++i) {
        const auto node = static_cast<size_t>(boundaries.flux_shares[i].node);
        if (held_node_[node] != 0) continue;
        const double flux = forcing.flux[i].at(t);
        inflow_[node] += flux;
        total_rates_[flux > 0 ? inflow_total : drained_total] += std::abs(flux);
    }
}

void FlowSystem::assemble(double step, SparseMatrix& matrix) const { assemble(1.0, step, matrix); }

void FlowSystem::assemble_steady(SparseMatrix& matrix) const { assemble(0.0, 1.0, matrix); }

// storage d(stored)/dp - step d(inflow)/dp
void FlowSystem::assemble(double storage, double step, SparseMatrix& matrix) const {
    std::fill(matrix.value.begin(), matrix.value.end(), 0.0);
    for (size_t i = 0; i < diagonal_.size(); ++i) {
        matrix.value[static_cast<size_t>(diagonal_[i])] =
            held_node_[i] != 0 ? 1.0 : storage * stored_slope_[i] - step * inflow_slope_[i];
    }
    assemble_links(step, matrix);
    assemble_crossings(step, matrix);
    if (skeleton.softness.empty() || storage == 0) return;
    for (size_t i = 0; i < neighbour_places_.size(); ++i) {
        const double softness = storage * skeleton.projection[i];
        const Link& pair = network.neighbours[i];
        const auto a = static_cast<size_t>(pair.portion_a);
        const auto b = static_cast<size_t>(pair.portion_b);
        const double difference = pore_stress_[a] - pore_stress_[b];
        add_exchange(
            pair, neighbour_places_[i],
            {softness * effective_saturation_[b] *
                 (effective_saturation_slope_[a] * difference + effective_saturation_[a] * pore_stress_slope_[a]),
             softness * effective_saturation_[a] *
                 (effective_saturation_slope_[b] * difference - effective_saturation_[b] * pore_stress_slope_[b])},
            matrix);
    }
}

void FlowSystem::assemble_links(double step, SparseMatrix& matrix) const {
    for (size_t l = 0; l < link_places_.size(); ++l) {
        const LinkState& link = link_state_[l];
        const double conductance = step * network.transmissibility[l] * link.permeability;
        const double steepness = step * network.transmissibility[l] * link.head;
        add_exchange(network.links[l], link_places_[l],
                     {conductance + steepness * link.permeability_slope[0],
                      steepness * link.permeability_slope[1] - conductance},
                     matrix);
    }
}

void FlowSystem::assemble_crossings(double step, SparseMatrix& matrix) const {
    for (size_t c = 0; c < network.crossings.size(); ++c) {
        const auto a = static_cast<size_t>(network.crossings[c].link_a);
        const auto b = static_cast<size_t>(network.crossings[c].link_b);
        const LinkState& link_a = link_state_[a];
        const LinkState& link_b = link_state_[b];
        const double mean = std::sqrt(link_a.common_permeability * link_b.common_permeability);
        if (mean == 0) continue;
        const double conductance = step * network.cross_transmissibility[c] * mean;
        const double steepness_a = 0.5 * conductance / link_a.common_permeability;
        const double steepness_b = 0.5 * conductance / link_b.common_permeability;
        const auto own = [](double conductance_here, double steepness, const std::array<double, 2>& slope) {
            return std::array{conductance_here + steepness * slope[0], steepness * slope[1] - conductance_here};
        };
        const auto& slope_a = link_a.common_slope;
        const auto& slope_b = link_b.common_slope;
        add_exchange(network.links[a], link_places_[a], own(0.0, steepness_a * link_b.head, slope_a), matrix);
        add_exchange(network.links[b], link_places_[b], own(0.0, steepness_b * link_a.head, slope_b), matrix);
        add_exchange(network.links[a], cross_places_[2 * c], own(conductance, steepness_b * link_b.head, slope_b),
                     matrix);
        add_exchange(network.links[b], cross_places_[2 * c + 1], own(conductance, steepness_a * link_a.head, slope_a),
                     matrix);
    }
}

// What leaves the first end of a link and enters the second, by two pressures.
void FlowSystem::add_exchange(const Link& link, const Places& place, std::array<double, 2> slope,
                              SparseMatrix& matrix) const {
    if (held_node_[static_cast<size_t>(network.portions[static_cast<size_t>(link.portion_a)].node)] == 0) {
        matrix.value[static_cast<size_t>(place.aa)] += slope[0];
        matrix.value[static_cast<size_t>(place.ab)] += slope[1];
    }
    if (held_node_[static_cast<size_t>(network.portions[static_cast<size_t>(link.portion_b)].node)] == 0) {
        matrix.value[static_cast<size_t>(place.ba)] -= slope[0];
        matrix.value[static_cast<size_t>(place.bb)] -= slope[1];
    }
}

double FlowSystem::imbalance() const {
    std::vector<double> passing(inflow_.size(), 0.0);
    for (size_t l = 0; l < network.links.size(); ++l) {
        const auto a = static_cast<size_t>(network.links[l].portion_a);
        const auto b = static_cast<size_t>(network.links[l].portion_b);
        const double driving = std::abs(link_state_[l].head - network.fall[l]) + std::abs(network.fall[l]);
        for (const size_t end : {a, b}) {
            passing[static_cast<size_t>(network.portions[end].node)] +=
                network.transmissibility[l] * link_state_[l].permeability * driving;
        }
    }
    double largest = 0;
    for (size_t i = 0; i < passing.size(); ++i)
        if (held_node_[i] == 0 && passing[i] > 0) largest = std::max(largest, std::abs(inflow_[i]) / passing[i]);
    return largest;
}

// Of a node's soils, the one whose stored water changes most with the pressure: another may have none left to lose.
const HydraulicTable& FlowSystem::storing_table(size_t node, double pressure) const {
    const size_t first = node_portions_start_[node];
    const size_t end = node_portions_start_[node + 1];
    size_t storing = first;
    double most = -1.0;
    for (size_t i = first; i < end && end - first > 1; ++i) {
        const NodePortion& portion = node_portions_[i];
        const double capacity = portion.volume * tables_[static_cast<size_t>(portion.soil)].at(pressure).capacity;
        if (capacity > most) storing = i;
        most = std::max(most, capacity);
    }
    return tables_[static_cast<size_t>(node_portions_[storing].soil)];
}

// Brenner & Cances (2017): Newton in the variable whose curves are straight. Below the steepest point of the retention that is the
// saturation, above it the pressure; the two join with the slope of that point. A node that dries stops at saturation first, where the
// curves show their unsaturated slopes: those above it are flat and lead too far. So dry that water yields by its compressibility rather
// than by leaving, it is the pressure again. A wet surface node stops where a pond begins, with the slopes of the pond: it stores 1e5 times what
// compressing the water below it does, which leads far beyond.
double FlowSystem::moved(size_t node, double pressure, double change) const {
    const HydraulicTable& table = storing_table(node, pressure);
    const double turn = table.switch_pressure();
    if (pressure > 0 && pressure + change < 0) return 0.0;
    if (pressure >= turn && pressure <= 0 && pressure + change > 0 && surface_node_[node] != 0)
        return std::numeric_limits<double>::min();
    constexpr double straight = 1e-3;  // the curves are so over this share of the suction
    if (pressure >= turn && pressure + change >= turn) return pressure + change;
    if (std::abs(change) < straight * std::abs(pressure)) return pressure + change;
    HydraulicState here = table.at(pressure);
    const double yielding = here.saturation / scene_.water.bulk_modulus;
    if (pressure >= turn || here.capacity > yielding) return moved_by_saturation(table, pressure, change, here);
    if (change < 0) return pressure + change;
    here.capacity += yielding;
    return std::min(pressure + change, moved_by_saturation(table, pressure, change, here));
}

double FlowSystem::moved_steadily(size_t node, double pressure, double change) const {
    const HydraulicTable& table = tables_[static_cast<size_t>(node_portions_[node_portions_start_[node]].soil)];
    const HydraulicState here = table.at(pressure);
    constexpr double largest_loss = 0.9;  // of what is above the potential of dry soil
    const double least = here.potential - largest_loss * (here.potential - table.least_potential());
    return table.pressure_of_potential(std::max(here.potential + here.permeability * change, least));
}

double FlowSystem::pore_stress(size_t soil, double pressure) const {
    if (scene_.physics.stress == StressMeasure::net) return std::max(pressure, 0.0);
    const Retention& retention = scene_.soils[soil].hydraulics.retention;
    return effective_of_saturation(retention, tables_[soil].at(pressure).saturation) * pressure;
}

}  // namespace talus
