#include "motion/explicit/grid_mixture.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

constexpr double thin_share = 0.25;  // of a cell's volume: less than any node has whose place is in the ground
constexpr double full_share = 0.95;  // of a cell's volume: with less, a node is at the ground's edge,
constexpr double cut_share =
    0.85;  // and with a neighbour that has less than this: an edge half a cell and more above a node leaves it 5/6

/// Gas is never thinner than this share of the atmosphere where a density is divided by.
constexpr double least_density_share = 1e-6;

template <class Axes>
ImpulseAnswer answer_to_impulse(const Axes& axes, const PhaseAnswers<Axes>& answers, const NodeVector& direction) {
    const auto coupled = of_each(answers, [](const PhaseAnswer& own) { return own.coupled; });
    const auto liquid =
        of_each(answers, [](const PhaseAnswer& own) { return own.liquid.drag / (1 + own.liquid.drag); });
    const auto gas = of_each(answers, [](const PhaseAnswer& own) { return own.gas.drag / (1 + own.gas.drag); });
    return {axes.along(coupled, direction), axes.product(liquid, direction), axes.product(gas, direction)};
}

}  // namespace

void NodeGas::resize(size_t nodes) {
    momentum.assign(nodes, {});
    weight.assign(nodes, 0.0);
    gradients.assign(nodes, {});
    means.assign(nodes, {});
    returned.resize(nodes);
}

template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::resize() {
    const size_t nodes = grid.nodes();
    momentum.assign(nodes, {});
    liquid_momentum.assign(nodes, {});
    force.assign(nodes, {});
    gradients.assign(nodes, {});
    means.assign(nodes, {});
    if (has_bedding) anisotropy.assign(nodes, {});
    if (evens && !has_gas) {
        moments.assign(nodes, {});
        places.assign(nodes, {});
        surroundings.assign(nodes, {});
    }
    returned.resize(nodes);
    capacity.resize(nodes);
    velocity.resize(nodes);
    for (auto* field : {&fluid_velocity, &flux, &rates, &evening}) field->resize(nodes);
    if constexpr (has_gas) gas.resize(nodes);
    if constexpr (exchanges) solutes.resize(nodes);
}

template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::find_velocities(size_t node) {
    if (is_still(node)) {
        velocity[node] = {};
        fluid_velocity[node] = {};
        return;
    }
    const NodeMomentum& solid = momentum[node];
    velocity[node] = velocity_of(solid.x, solid.y, solid.mass > 0 ? 1 / solid.mass : 0);
    const auto own_velocity = [&](const NodeMomentum& fluid) {
        return fluid.mass > 0 ? velocity_of(fluid.x, fluid.y, 1 / fluid.mass) : velocity[node];
    };
    liquid_of(fluid_velocity[node]) = own_velocity(liquid_momentum[node]);
    if constexpr (has_gas) fluid_velocity[node].gas = own_velocity(gas.momentum[node]);
}

/// Velocities and rates of a node from what the points gave. `part` gets what has left with the surface: what came to a node that the last point has left.
template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::start(size_t node, PartSums& part) {
    const NodeMomentum &solid = momentum[node], &liquid = liquid_momentum[node];
    if (!(solid.mass > 0)) {
        part.seepage += flow_time * returned[node];
        returned[node] = 0;
    }
    find_velocities(node);
    part.bound.add(solid.mass, velocity[node]);
    const double inverse = solid.mass > 0 ? 1 / solid.mass : 0;
    liquid_of(rates[node]) = {solid.more * inverse, (liquid.more + returned[node]) * inverse};
    if constexpr (has_gas) {
        const NodeMomentum& own = gas.momentum[node];
        const double gain = own.more + gas.returned[node];
        const bool loses = gain < 0 && own.mass > 0;
        rates[node].gas = {};
        if (loses) rates[node].gas.y = gain / own.mass;
        if (!loses && gas.weight[node] > 0) rates[node].gas.x = gain / gas.weight[node];
        if (!loses && !(gas.weight[node] > 0)) part.escaped += flow_time * gain;
    }
    if constexpr (exchanges) find_solute_rates(node, part);
}

template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::begin_step() {
    fold_momenta();
    start_speed = for_each_part([this](size_t number, PartSums& part) {
        fold_momenta_of(number);
        for_each_node_of(number, [&](size_t i) { start(i, part); });
        mirror_part(number);
    });
    mirror();
}

template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::end_step(double dt) {
    fold_forces(dt);
    if (!surroundings.empty()) find_surroundings();
    part_edges_.resize(parts());
    const double inner_speed = for_each_part([this, dt](size_t number, PartSums& part) {
        if (surroundings.empty()) fold_forces_of(number);
        solve_inner_nodes(number, dt, part);
    });
    find_surface();
    const double edge_speed = for_each_part([this, dt](size_t number, PartSums& part) {
        for (const auto [node, up] : part_edges_[number]) {
            solve(node, dt, part);
            part.bound.add(momentum[node].mass, velocity[node]);
        }
        if (surroundings.empty()) finish_edge(number);
    });
    speed = std::max(inner_speed, edge_speed);
    if (!surroundings.empty()) {
        for_each_part([this](size_t number, PartSums&) { finish_edge(number); });
    }
    if (!immersed) cross_surface(dt);
    if constexpr (exchanges) {
        for_each_part([this, dt](size_t number, PartSums& part) {
            for_each_node_of(number, [&](size_t i) {
                carry_solutes(i, dt, part);
                clear_sums(i);
            });
            mirror_part(number);
        });
    }
    mirror();
    flow_time = dt;
}

/// With exchange, solutes are to be carried first.
template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::finish_edge(size_t part) {
    if constexpr (exchanges) return;
    for (const auto [node, up] : part_edges_[part]) clear_sums(node);
    mirror_part(part);
}

/// For what the points give next.
template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::clear_sums(size_t node) {
    momentum[node] = {};
    liquid_momentum[node] = {};
    force[node] = {};
    gradients[node] = {};
    means[node] = {};
    if (!anisotropy.empty()) anisotropy[node] = {};
    if (!moments.empty()) {
        moments[node] = {};
        places[node] = {};
    }
    if constexpr (has_gas) {
        gas.momentum[node] = {};
        gas.weight[node] = 0;
        gas.gradients[node] = {};
        gas.means[node] = {};
    }
    if constexpr (exchanges) {
        solutes.gains[node] = {};
        solutes.gradients[node] = {};
        solutes.means[node] = {};
    }
}

template <bool has_gas, bool exchanges>
bool GridMixture<has_gas, exchanges>::is_at_edge(size_t node) const {
    if (is_still(node)) return false;
    const double share = means[node].volume / cell_volume();
    if (!(share > 0) || share < full_share) return share > 0;
    if (surroundings.empty()) return false;
    const auto stride = static_cast<size_t>(grid.cells[0]);
    const auto is_cut = [this](size_t neighbour) {
        return !is_still(neighbour) && surroundings[neighbour].share < cut_share;
    };
    return is_cut(node - 1) || is_cut(node + 1) || is_cut(node - stride) || is_cut(node + stride);
}

/// In a pass of its own: in the next one nodes look at their neighbours'.
template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::find_surroundings() {
    const auto mirror = [this](NodePair nodes, const Mirror&, const Mirror&) {
        surroundings[nodes.beyond] = surroundings[nodes.inside];
    };
    for_each_part([&](size_t number, PartSums&) {
        fold_forces_of(number);
        for_each_node_of(number, [&](size_t i) {
            const double mass = momentum[i].mass;
            const NodeSurroundings own{means[i].lambda(mass) / means[i].edge_lambda(mass),
                                       means[i].volume / cell_volume()};
            surroundings[i] = mass > 0 ? own : NodeSurroundings{};
        });
        for_each_meeting_of(number, mirror);
    });
    for_each_meeting(mirror);
}

template <bool has_gas, bool exchanges>
double GridMixture<has_gas, exchanges>::total(const std::vector<double>& values) const {
    double sum = 0;
    for_each_node([&](size_t i) { sum += values[i]; });
    return sum;
}

/// Those at the edge are left: they share the surface.
template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::solve_inner_nodes(size_t number, double dt, PartSums& part) {
    std::vector<EdgeNode>& edge = part_edges_[number];
    edge.clear();
    for_each_node_of(number, [&](size_t i) {
        if (is_at_edge(i)) {
            edge.push_back({i, facing_up(i)});
            return;
        }
        solve(i, dt, part);
        part.bound.add(momentum[i].mass, velocity[i]);
        if constexpr (!exchanges) clear_sums(i);
    });
}

/// The nodes at the edge, and how wide that is in each column where it faces up.
template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::find_surface() {
    const auto columns = static_cast<size_t>(grid.cells[0]);
    surfaces_.assign(columns, {});
    edge_.clear();
    for (const auto& part : part_edges_) edge_.insert(edge_.end(), part.begin(), part.end());
    for (const auto [node, up] : edge_) surfaces_[node % columns].width += up;
}

/// Rain on a node whose edge faces up by so many metres, kg/s.
template <bool has_gas, bool exchanges>
double GridMixture<has_gas, exchanges>::falls_on(size_t node, double up) const {
    if (rain.empty() || !(up > 0)) return 0;
    const size_t column = node % static_cast<size_t>(grid.cells[0]);
    return rain[column] * grid.cell_size * up / surfaces_[column].width;
}

/// Whether it rains on a column whose surface is that of held ground.
template <bool has_gas, bool exchanges>
bool GridMixture<has_gas, exchanges>::lies_still(size_t column) const {
    return !still.empty() && !rain.empty() && !(surfaces_[column].width > 0);
}

/// Every column's rain falls on its nodes at the edge in proportion to the edge's horizontal width there. What one of them cannot take, or
/// gives back, is offered to the others. What none takes leaves: within the column's own rain it is run-off, the rest seepage. Held ground takes none.
template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::cross_surface(double dt) {
    const auto columns = static_cast<size_t>(grid.cells[0]);
    for (const auto [node, up] : edge_) {
        const double fallen = falls_on(node, up), taken = std::min(fallen, capacity[node]);
        returned[node] += taken;
        if (!(up > 0)) {
            seepage -= dt * taken;
            continue;
        }
        OpenSurface& surface = surfaces_[node % columns];
        surface.fallen += fallen;
        surface.left += fallen - taken;
        surface.room += capacity[node] - taken;
    }
    for (const auto [node, up] : edge_) {
        const OpenSurface& surface = surfaces_[node % columns];
        if (!(up > 0) || !(surface.left > 0) || !(surface.room > 0)) continue;
        const double taken = std::min(falls_on(node, up), capacity[node]);
        returned[node] += (capacity[node] - taken) * std::min(surface.left / surface.room, 1.0);
    }
    for (size_t column = 0; column < columns; ++column) {
        OpenSurface& surface = surfaces_[column];
        if (lies_still(column)) surface.fallen = surface.left = rain[column] * grid.cell_size;
        const double leaves = std::max(surface.left - surface.room, 0.0), runs_off = std::min(leaves, surface.fallen);
        rained += dt * surface.fallen;
        run_off += dt * runs_off;
        seepage += dt * (leaves - runs_off);
    }
}

template <bool has_gas, bool exchanges>
LiquidAnswer GridMixture<has_gas, exchanges>::answer_of_liquid(size_t node, double dt, double lambda) const {
    const double mass = liquid_momentum[node].mass, content = mass / (liquid_density * means[node].volume);
    const double drag = dt * content / (lambda * liquid_density);
    return {drag, mass / (1 + drag), dt * content / (1 + drag)};
}

/// How the gas at a node answers to forces along an axis of this anisotropy.
template <bool has_gas, bool exchanges>
GasAnswer GridMixture<has_gas, exchanges>::answer_of_gas(size_t node, double dt, double anisotropy) const {
    const double volume = means[node].volume, mass = gas.momentum[node].mass;
    const GasMeans& mean = gas.means[node];
    GasAnswer answer;
    if (!(mass > 0)) return answer;
    if (mean.volume < least_gas_share * volume) {
        answer.drag = locked;
        answer.moved = mass / (1 + locked);
        return answer;
    }
    const double density = std::max(mean.mass / mean.volume, least_density_share * gas.density);
    answer.push = mean.push / mean.volume;
    answer.drag = dt * mean.volume / volume * momentum[node].mass * (1 - anisotropy) / (mean.mobility * density);
    answer.density = mass / mean.volume;
    answer.response = dt / mean.volume;
    answer.moved = mass / (1 + answer.drag);
    answer.spread = answer.moved * dt / (cell_volume() * mean.volume);
    answer.evened = smoothing * answer.moved * dt / (mean.volume * mean.volume);
    return answer;
}

/// Gas that would cross more than half a cell in a step feels more drag, so that no point loses more of it than it holds: at that speed, more than half of
/// its wave's, Darcy's law is none.
void GasAnswer::choke(const NodeVector& relative_velocity, double most) {
    const double needed = std::sqrt(dot(relative_velocity, relative_velocity)) / most - 1;
    if (needed <= drag) return;
    const double share = (1 + drag) / (1 + needed);
    drag = needed;
    moved *= share;
    evened *= share;
}

/// The edge of the ground about a node at it.
template <bool has_gas, bool exchanges>
GroundEdge GridMixture<has_gas, exchanges>::edge_at(size_t node) const {
    const NodeVector outwards{gradients[node].edge_x, gradients[node].edge_y};
    const double volume = means[node].volume, per_mass = 1 / momentum[node].mass;
    GroundEdge edge(outwards, volume / cell_volume(), grid.cell_size);
    if (!moments.empty())
        edge.fit(volume, outwards, {places[node].x * per_mass, places[node].y * per_mass}, moments[node]);
    return edge;
}

/// What the pressure does to a node's surroundings at the edge, per volume, N/m3: for a linear field, the field's own.
template <bool has_gas, bool exchanges>
NodeVector GridMixture<has_gas, exchanges>::drive_at(size_t node) const {
    const GroundEdge edge = edge_at(node);
    const NodeGradients& sums = gradients[node];
    const double push = means[node].push / momentum[node].mass, per_volume = 1 / means[node].volume;
    const NodeVector driven =
        edge.stretched(edge.stretched({sums.push_x - push * sums.edge_x, sums.push_y - push * sums.edge_y}));
    return {per_volume * driven.x, per_volume * driven.y};
}

/// The next node into the ground; the node itself where there is none that sees more.
template <bool has_gas, bool exchanges>
size_t GridMixture<has_gas, exchanges>::into_ground(size_t node, const NodeVector& outwards) const {
    const auto stride = static_cast<size_t>(grid.cells[0]);
    const bool is_level = std::abs(outwards.y) > std::abs(outwards.x);
    const size_t next =
        is_level ? (outwards.y > 0 ? node - stride : node + stride) : (outwards.x > 0 ? node - 1 : node + 1);
    const bool sees_more = surroundings[next].share > thin_share && is_at_edge(next);
    return surroundings[node].share < thin_share && sees_more ? next : node;
}

/// What flows by gravity has the permeability that it comes with, where the ground above is wetter: by the mean, which falls steeply from full soil, less
/// would flow below a full node than comes from above. So much is added to the flow downwards, kg/(m2 s): the wetter ground's share of what of
/// the water's velocity through the solid is gravity's, and no more than it adds to Darcy's law. `lambda_down`: of a push downwards and the flow that way;
/// `pushed_up`: a push upwards that drives as much up as the whole push does.
template <bool has_gas, bool exchanges>
double GridMixture<has_gas, exchanges>::falls_more(size_t node, double lambda_down, double pushed_up,
                                                   double velocity_up) const {
    const size_t above = node + static_cast<size_t>(grid.cells[0]);
    const double more = surroundings[above].permeability / surroundings[node].permeability - 1;
    if (!(more > 0) || !(pushed_up < 0) || !(velocity_up < 0)) return 0;
    const double volume = means[node].volume, weight = gravity * liquid_density * volume;
    const double of_gravity = std::min(weight / -pushed_up, 1.0);
    const double flow = liquid_momentum[node].mass * -velocity_up;
    const double by_darcy = liquid_density * lambda_down * -pushed_up;
    return more * of_gravity * std::min(flow, by_darcy) / volume;
}

template <bool has_gas, bool exchanges>
void GridMixture<has_gas, exchanges>::solve(size_t node, double dt, PartSums& part) {
    const double mass = momentum[node].mass;
    flux[node] = {};
    returned[node] = 0;
    capacity[node] = 0;
    evening[node] = {};
    if constexpr (has_gas) gas.returned[node] = 0;
    if (!(mass > 0) || !(means[node].volume > 0) || is_still(node)) return;
    const NodeVector sum = anisotropy.empty() ? NodeVector{} : anisotropy[node];
    if (sum.x == 0 && sum.y == 0) return solve(AnyAxes{}, node, dt, part);
    const double inverse = 1 / means[node].anisotropy_weight(mass);
    solve(BeddingAxes({inverse * sum.x, inverse * sum.y}), node, dt, part);
}

/// Along each of the axes phases answer on their own. Points even out by what flows along that which conducts least.
template <bool has_gas, bool exchanges>
template <class Axes>
void GridMixture<has_gas, exchanges>::solve(const Axes& axes, size_t node, double dt, PartSums& part) {
    const double mass = momentum[node].mass, liquid_mass = liquid_momentum[node].mass;
    const NodeGradients& sums = gradients[node];
    const Means& mean = means[node];
    const double push = mean.push / mass;
    const double lambda = mean.lambda(mass);
    PhaseAnswers<Axes> answers = axes.each([&](double anisotropy) {
        PhaseAnswer answer{answer_of_liquid(node, dt, lambda / (1 - anisotropy)), {}, 0};
        answer.coupled = mass + answer.liquid.moved * answer.liquid.drag;
        if constexpr (has_gas) answer.gas = answer_of_gas(node, dt, anisotropy);
        return answer;
    });
    const PhaseAnswer& least = answers.back();
    const double spread = least.liquid.conductance * mean.volume / (cell_volume() * mass);
    liquid_of(evening[node]) = {spread, spread * push};
    const double response = dt / (liquid_density * mean.volume);
    const double evened = evens ? smoothing * least.liquid.conductance / mean.volume : 0.0;
    double weight = gravity * (mass + liquid_mass);
    if constexpr (has_gas) {
        evening[node].gas = {least.gas.spread, least.gas.spread * least.gas.push};
        weight += gravity * gas.momentum[node].mass;
    }
    NodeVector &solid = velocity[node], &liquid = liquid_of(fluid_velocity[node]), &through = liquid_of(flux[node]);
    const NodeVector outwards{sums.edge_x, sums.edge_y}, stress = force[node];
    const auto flow = [&](const NodeVector& pushed, const NodeVector& gas_pushed, double stretch) {
        if constexpr (has_gas) {
            const NodeVector& start = fluid_velocity[node].gas;
            for (PhaseAnswer& answer : answers) {
                answer.gas.choke({start.x + answer.gas.response * gas_pushed.x - solid.x,
                                  start.y + answer.gas.response * gas_pushed.y - solid.y},
                                 0.5 * grid.cell_size / (dt * stretch));
                answer.coupled += answer.gas.moved * answer.gas.drag;
            }
        }
        const NodeVector total =
            axes.turned({stress.x - edge_pressure * outwards.x, stress.y - weight - edge_pressure * outwards.y});
        const NodeVector push_along = axes.turned(pushed);
        NodeVector solid_along = axes.turned(solid), liquid_along = axes.turned(liquid), through_along;
        [[maybe_unused]] const NodeVector gas_push_along = axes.turned(gas_pushed);
        [[maybe_unused]] NodeVector gas_along, gas_through_along;
        if constexpr (has_gas) gas_along = axes.turned(fluid_velocity[node].gas);
        const auto move = [&](double NodeVector::*c, const PhaseAnswer& answer) {
            const auto& [drag, moved, conductance] = answer.liquid;
            const double start = solid_along.*c, liquid_start = liquid_along.*c;
            const double alone = liquid_start + response * push_along.*c;
            double whole = mass * start + liquid_mass * liquid_start + dt * total.*c;
            [[maybe_unused]] double gas_alone = 0;
            if constexpr (has_gas) {
                const double gas_start = gas_along.*c;
                gas_alone = gas_start + answer.gas.response * gas_push_along.*c;
                whole += gas.momentum[node].mass * gas_start - answer.gas.moved * gas_alone;
            }
            solid_along.*c = (whole - moved * alone) / answer.coupled;
            liquid_along.*c = (alone + drag * solid_along.*c) / (1 + drag);
            through_along.*c = liquid_mass / mean.volume * (liquid_along.*c - solid_along.*c) - evened * push_along.*c;
            if constexpr (has_gas) {
                gas_along.*c = (gas_alone + answer.gas.drag * solid_along.*c) / (1 + answer.gas.drag);
                gas_through_along.*c =
                    answer.gas.density * (gas_along.*c - solid_along.*c) - least.gas.evened * gas_push_along.*c;
            }
        };
        move(&NodeVector::x, answers.front());
        move(&NodeVector::y, answers.back());
        solid = axes.turned_back(solid_along);
        liquid = axes.turned_back(liquid_along);
        through = axes.turned_back(through_along);
        if constexpr (has_gas) {
            fluid_velocity[node].gas = axes.turned_back(gas_along);
            flux[node].gas = axes.turned_back(gas_through_along);
        }
        if (!surroundings.empty()) {
            const NodeVector down =
                axes.product(axes.each([&](double anisotropy) { return lambda / (1 - anisotropy); }), {0, 1});
            const double aside = down.x / down.y;
            const double more = falls_more(node, down.y, pushed.y + aside * pushed.x, liquid.y - solid.y);
            through = {through.x - aside * more, through.y - more};
        }
        if (!rubs_ || contact_at_[node] < 0) return;
        rub(node, dt,
            {answer_to_impulse(axes, answers, {1, 0}), answer_to_impulse(axes, answers, {0, 1}),
             liquid_mass / mean.volume, push, least.gas.density, least.gas.push});
    };
    const NodeVector inner{sums.push_x - push * outwards.x, sums.push_y - push * outwards.y};
    NodeVector gas_inner{}, gas_outwards{};
    if constexpr (has_gas) {
        const NodeGradients& gas_sums = gas.gradients[node];
        gas_outwards = {gas_sums.edge_x, gas_sums.edge_y};
        gas_inner = {gas_sums.push_x - least.gas.push * gas_outwards.x,
                     gas_sums.push_y - least.gas.push * gas_outwards.y};
    }
    if (!is_at_edge(node)) {
        flow(inner, gas_inner, 1);
        returned[node] = dot(through, outwards);
        if constexpr (has_gas) gas.returned[node] = dot(flux[node].gas, gas_outwards);
        return;
    }
    GroundEdge edge = edge_at(node);
    const double edge_head = gravity * liquid_density * (height_of(node) + edge.height);
    if (immersed) {
        flow({sums.push_x - edge_head * outwards.x, sums.push_y - edge_head * outwards.y}, {}, 1);
        part.seepage += dt * dot(through, outwards);
        return;
    }
    NodeVector pushed = edge.stretched(inner);
    const NodeVector gas_pushed = edge.stretched(gas_inner);
    if (edge.is_blind) {  // pushed as the next node into the ground
        const NodeVector drive = drive_at(into_ground(node, outwards));
        pushed = {mean.volume * drive.x, mean.volume * drive.y};
        edge.more = 0;
    }
    flow(pushed, gas_pushed, 1 + edge.more);
    through = edge.stretched(through);
    returned[node] = dot(through, outwards);
    if constexpr (has_gas) {
        flux[node].gas = edge.stretched(flux[node].gas);
        gas.returned[node] = dot(flux[node].gas, gas_outwards);
    }
    if (!(edge.distance > 0)) return;
    const auto driven =
        of_each(answers, [&](const PhaseAnswer& answer) { return answer.liquid.conductance / mean.volume - evened; });
    const double carried = returned[node] - axes.driven_out(driven, edge, pushed, outwards);
    const double edge_lambda = mean.edge_lambda(mass);
    const auto edge_conductance = axes.each(
        [&](double anisotropy) { return answer_of_liquid(node, dt, edge_lambda / (1 - anisotropy)).conductance; });
    const double drawn = axes.along(edge_conductance, edge.normal) * edge.length * (edge_head - push) / edge.distance;
    capacity[node] = drawn - carried;
    if constexpr (has_gas) breathe(axes, node, dt, edge, answers, gas_pushed, flux[node].gas, part);
}

/// Of what the edge can take, what rain offers; all where water comes out.
template <bool has_gas, bool exchanges>
double GridMixture<has_gas, exchanges>::wetted_share(size_t node) const {
    const double offered = falls_on(node, facing_up(node));
    if (capacity[node] > offered) return offered / capacity[node];
    return offered > 0 || capacity[node] < 0 ? 1.0 : 0.0;
}

/// From the edge to the middle of a node's gas, whose potential is the node's, m.
template <bool has_gas, bool exchanges>
double GridMixture<has_gas, exchanges>::gas_distance(size_t node, const GroundEdge& edge) const {
    const NodeVector sum{gas.gradients[node].edge_x, gas.gradients[node].edge_y};
    return edge.distance_to(gas.means[node].volume, sum, means[node].volume);
}

/// The atmosphere draws gas in or out by the difference of psi over the distance to the edge, besides what the gas's momentum carries. k_rg on the way is
/// the mean of the node's and the edge's: there it is less, as the suction is, by the share of what the edge can take that rain offers, and none
/// where that is all. The difference is that of the step's end, psi rising by R T / M times the gain's share of the gas: where drag is weak the edge
/// fills within a step, and by the start's would fill beyond the atmosphere's pressure. The gain is that from the ground, too: a steady flow through the
/// edge changes no psi, whatever the step.
template <bool has_gas, bool exchanges>
template <class Axes>
void GridMixture<has_gas, exchanges>::breathe(const Axes& axes, size_t node, double dt, const GroundEdge& edge,
                                              const PhaseAnswers<Axes>& answers, const NodeVector& pushed,
                                              const NodeVector& through, PartSums& part) {
    const GasAnswer& least = answers.back().gas;
    if (!(least.density > 0)) return;
    const double volume = gas.means[node].volume, content = volume / means[node].volume;
    const double wetted = wetted_share(node);
    const auto driven = of_each(
        answers, [&](const PhaseAnswer& answer) { return dt * answer.gas.moved / volume / volume - least.evened; });
    const auto outer_conductance = of_each(answers, [&](const PhaseAnswer& answer) {
        const double drag = answer.gas.drag;
        return dt * answer.gas.moved / volume * (1 + drag) / (1 + drag / (1 - 0.5 * wetted));
    });
    const NodeVector outwards{gradients[node].edge_x, gradients[node].edge_y};
    const double carried = dot(through, outwards) - axes.driven_out(driven, edge, pushed, outwards);
    const double edge_push = gravity * (height_of(node) + edge.height);
    const double opening = axes.along(outer_conductance, edge.normal) * edge.length / gas_distance(node, edge);
    const double filling = dt * content * opening * gas.specific / gas.means[node].mass;
    const double drawn = content * (opening * (edge_push - least.push) - carried);
    const double inflow = (drawn - filling * gas.returned[node]) / (1 + filling);
    gas.returned[node] += inflow;
    part.escaped -= dt * inflow;
}

template struct GridMixture<false>;
template struct GridMixture<true>;
template struct GridMixture<true, true>;

}  // namespace talus
