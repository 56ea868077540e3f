// What the nodes do with the solutes of their fluids.
#include "motion/explicit/grid_mixture.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

/// Of a fluid at a node, as its solute needs it.
struct Carrier {
    NodeVector flux;      // F, kg/(m2 s)
    NodeVector outwards;  // sum of V grad N
    double volume;        // sum of N V
    double weight;        // of what the points weigh their fractions by
};

struct Carried {
    NodeVector flux;    // F_w
    NodeVector mixing;  // of the points' fractions
};

/// `pushed`: sum of V w grad N; `diffusion`: rho D tau without the fluid's own spreading.
Carried carry(double fraction, const NodeVector& pushed, double diffusion, const Carrier& fluid, const GroundEdge& edge,
              double cell_size) {
    const double conductance = std::max(diffusion, 0.5 * cell_size * std::sqrt(dot(fluid.flux, fluid.flux)));
    const NodeVector inner =
        edge.stretched({pushed.x - fraction * fluid.outwards.x, pushed.y - fraction * fluid.outwards.y});
    const double driven = (1 - smoothing) * conductance / fluid.volume;
    const NodeVector diffused = edge.stretched({driven * inner.x, driven * inner.y});
    const double spread = conductance * fluid.volume / (cell_size * cell_size * fluid.weight);
    return {{fraction * fluid.flux.x + diffused.x, fraction * fluid.flux.y + diffused.y}, {spread, spread * fraction}};
}

/// Points share a gain by their weight, a loss by what they hold.
NodeVector shared(double gain, double held, double weight) {
    if (gain < 0 && held > 0) return {0, gain / held};
    return {weight > 0 ? gain / weight : 0.0, 0};
}

}  // namespace

void NodeSolutes::resize(size_t nodes) {
    gains.assign(nodes, {});
    gradients.assign(nodes, {});
    means.assign(nodes, {});
    returned.resize(nodes);
    for (auto* field : {&fluxes, &evenings, &mixings, &rates}) field->resize(nodes);
}

template <>
SoluteReturn GridMixture<true, true>::returned_solutes() const {
    SoluteReturn sum;
    for_each_node([&](size_t i) {
        sum.dissolved += solutes.returned[i].dissolved;
        sum.vapour += solutes.returned[i].vapour;
    });
    return sum;
}

template <>
void GridMixture<true, true>::lose(const SoluteReturn& rate, PartSums& part) const {
    part.seepage -= flow_time * rate.dissolved;
    part.escaped += flow_time * (rate.dissolved - rate.vapour);
    part.evaporated += flow_time * rate.vapour;
}

template <>
void GridMixture<true, true>::lose(const SoluteReturn& rate) {
    PartSums lost{SpeedBound(least_mass)};
    lose(rate, lost);
    add_to_totals(lost);
}

template <>
void GridMixture<true, true>::fold_solutes(NodePair nodes) {
    SoluteGains &inside = solutes.gains[nodes.inside], &beyond = solutes.gains[nodes.beyond];
    inside.dissolved += beyond.dissolved;
    inside.dissolved_gain += beyond.dissolved_gain;
    inside.vapour += beyond.vapour;
    inside.vapour_gain += beyond.vapour_gain;
    beyond = {};
    SoluteReturn &back = solutes.returned[nodes.inside], &back_beyond = solutes.returned[nodes.beyond];
    back.dissolved += back_beyond.dissolved;
    back.vapour += back_beyond.vapour;
    back_beyond = {};
}

template <>
void GridMixture<true, true>::fold_solute_means(NodePair nodes, const Mirror& even) {
    SoluteGradients &inside = solutes.gradients[nodes.inside], &beyond = solutes.gradients[nodes.beyond];
    add_mirrored(inside.dissolved, even, beyond.dissolved);
    add_mirrored(inside.vapour, even, beyond.vapour);
    beyond = {};
    SoluteMeans &mean = solutes.means[nodes.inside], &mean_beyond = solutes.means[nodes.beyond];
    mean.dissolved += mean_beyond.dissolved;
    mean.dissolved_spread += mean_beyond.dissolved_spread;
    mean.vapour += mean_beyond.vapour;
    mean.vapour_spread += mean_beyond.vapour_spread;
    mean_beyond = {};
}

/// What came to a node that all points have left is out of the ground: its water as seepage and vapour, its air with the gas.
template <>
void GridMixture<true, true>::find_solute_rates(size_t node, PartSums& part) {
    const SoluteGains& own = solutes.gains[node];
    const SoluteReturn& back = solutes.returned[node];
    const double mass = momentum[node].mass;
    solutes.rates[node] = {shared(own.dissolved_gain + back.dissolved, own.dissolved, mass),
                           shared(own.vapour_gain + back.vapour, own.vapour, gas.weight[node])};
    if (!(mass > 0)) lose(back, part);
}

template <>
void GridMixture<true, true>::carry_solutes(size_t node, double dt, PartSums& part) {
    solutes.fluxes[node] = solutes.evenings[node] = solutes.mixings[node] = {};
    solutes.returned[node] = {};
    const double volume = means[node].volume;
    if (!(momentum[node].mass > 0) || !(volume > 0)) return;
    const bool is_open = is_at_edge(node) && !immersed;
    const NodeVector outwards{gradients[node].edge_x, gradients[node].edge_y};
    const GroundEdge edge(is_open ? outwards : NodeVector{}, volume / cell_volume(), grid.cell_size);
    carry_dissolved(node, edge, dt, part);
    carry_vapour(node, edge, dt, part);
}

/// At the surface water is in equilibrium with the atmosphere's air, whether it goes in or comes out.
template <>
void GridMixture<true, true>::carry_dissolved(size_t node, const GroundEdge& edge, double dt, PartSums& part) {
    const SoluteMeans& mean = solutes.means[node];
    const double mass = momentum[node].mass, fraction = mean.dissolved / mass;
    const Carrier liquid{flux[node].liquid, {gradients[node].edge_x, gradients[node].edge_y}, means[node].volume, mass};
    const double diffusion = solutes.air_diffusivity * mean.dissolved_spread / liquid.volume;
    const Carried air = carry(fraction, solutes.gradients[node].dissolved, diffusion, liquid, edge, grid.cell_size);
    solutes.fluxes[node].liquid = air.flux;
    solutes.mixings[node].liquid = air.mixing;
    solutes.evenings[node].liquid = {fraction * evening[node].liquid.x, fraction * evening[node].liquid.y};
    const double crossing = solutes.outer_air * (returned[node] - dot(liquid.flux, liquid.outwards));
    solutes.returned[node].dissolved = dot(air.flux, liquid.outwards) + crossing;
    returned[node] += crossing;
    part.escaped -= dt * crossing;
}

/// Gas that comes in is as moist as the atmosphere. Through the edge vapour diffuses as far as rain leaves it dry, against air.
template <>
void GridMixture<true, true>::carry_vapour(size_t node, const GroundEdge& edge, double dt, PartSums& part) {
    const double volume = gas.means[node].volume, content = volume / means[node].volume;
    if (!(content > least_gas_share)) return;
    const SoluteMeans& mean = solutes.means[node];
    const double fraction = mean.vapour / volume;
    const Carrier fluid{flux[node].gas, {gas.gradients[node].edge_x, gas.gradients[node].edge_y}, volume, volume};
    const double diffusion = solutes.vapour_diffusivity * mean.vapour_spread / volume;
    const Carried vapour = carry(fraction, solutes.gradients[node].vapour, diffusion, fluid, edge, grid.cell_size);
    solutes.fluxes[node].gas = vapour.flux;
    solutes.mixings[node].gas = vapour.mixing;
    solutes.evenings[node].gas = {fraction * evening[node].gas.x, fraction * evening[node].gas.y};
    const double crossing = gas.returned[node] - dot(fluid.flux, fluid.outwards);
    double inflow = crossing * (crossing > 0 ? solutes.outer_vapour : fraction);
    if (edge.distance > 0) {
        const double drier = solutes.outer_vapour - fraction;
        inflow += (1 - wetted_share(node)) * content * diffusion * edge.length * drier / gas_distance(node, edge);
    }
    solutes.returned[node].vapour = dot(vapour.flux, fluid.outwards) + inflow;
    part.evaporated -= dt * inflow;
    part.escaped += dt * inflow;
}

template <>
void GridMixture<true, true>::mirror_solutes(NodePair nodes, const Mirror& even) {
    solutes.fluxes[nodes.beyond] = mirrored(solutes.fluxes[nodes.inside], even);
    for (auto* field : {&solutes.evenings, &solutes.mixings, &solutes.rates})
        (*field)[nodes.beyond] = (*field)[nodes.inside];
}

}  // namespace talus
