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
void GridMixture<true, true>::lose(const SoluteReturn& rate) {
    seepage -= flow_time * rate.dissolved;
    gas.escaped += flow_time * (rate.dissolved - rate.vapour);
    solutes.evaporated += flow_time * rate.vapour;
}

template <>
void GridMixture<true, true>::fold_solutes() {
    for_each_meeting([this](NodePair nodes, const Mirror&, const Mirror&) {
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
    });
}

template <>
void GridMixture<true, true>::fold_solute_means() {
    for_each_meeting([this](NodePair nodes, const Mirror&, const Mirror& mirror) {
        SoluteGradients &inside = solutes.gradients[nodes.inside], &beyond = solutes.gradients[nodes.beyond];
        add_mirrored(inside.dissolved, mirror, beyond.dissolved);
        add_mirrored(inside.vapour, mirror, beyond.vapour);
        beyond = {};
        SoluteMeans &mean = solutes.means[nodes.inside], &mean_beyond = solutes.means[nodes.beyond];
        mean.dissolved += mean_beyond.dissolved;
        mean.dissolved_spread += mean_beyond.dissolved_spread;
        mean.vapour += mean_beyond.vapour;
        mean.vapour_spread += mean_beyond.vapour_spread;
        mean_beyond = {};
    });
}

/// What came to a node that all points have left is out of the ground: its water as seepage and vapour, its air with the gas.
template <>
void GridMixture<true, true>::find_solute_rates() {
    for_each_node([this](size_t i) {
        const SoluteGains& own = solutes.gains[i];
        const SoluteReturn& returned = solutes.returned[i];
        const double mass = momentum[i].mass;
        solutes.rates[i] = {shared(own.dissolved_gain + returned.dissolved, own.dissolved, mass),
                            shared(own.vapour_gain + returned.vapour, own.vapour, gas.weight[i])};
        if (!(mass > 0)) lose(returned);
    });
}

template <>
void GridMixture<true, true>::carry_solutes(double dt) {
    for_each_node([this, dt](size_t i) {
        solutes.fluxes[i] = solutes.evenings[i] = solutes.mixings[i] = {};
        solutes.returned[i] = {};
        if (!(momentum[i].mass > 0) || !(means[i].volume > 0)) return;
        const bool is_open = is_at_edge(i) && !immersed;
        const NodeVector outwards{gradients[i].edge_x, gradients[i].edge_y};
        const GroundEdge edge(is_open ? outwards : NodeVector{}, means[i].volume / cell_volume(), grid.cell_size);
        carry_dissolved(i, edge, dt);
        carry_vapour(i, edge, dt);
    });
}

/// At the surface water is in equilibrium with the atmosphere's air, whether it goes in or comes out.
template <>
void GridMixture<true, true>::carry_dissolved(size_t node, const GroundEdge& edge, double dt) {
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
    gas.escaped -= dt * crossing;
}

/// Gas that comes in is as moist as the atmosphere. Through the edge vapour diffuses as far as rain leaves it dry, against air.
template <>
void GridMixture<true, true>::carry_vapour(size_t node, const GroundEdge& edge, double dt) {
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
    solutes.evaporated -= dt * inflow;
    gas.escaped += dt * inflow;
}

template <>
void GridMixture<true, true>::mirror_solutes() {
    for_each_meeting([this](NodePair nodes, const Mirror&, const Mirror& mirror) {
        solutes.fluxes[nodes.beyond] = mirrored(solutes.fluxes[nodes.inside], mirror);
        for (auto* field : {&solutes.evenings, &solutes.mixings, &solutes.rates})
            (*field)[nodes.beyond] = (*field)[nodes.inside];
    });
}

}  // namespace talus
