#include "motion/explicit/explicit_mixture.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

/// The volumetric strain of the points becomes the nodes' mean of it.
void smooth_dilation(size_t count, const BlockValues& __restrict mean, GradientBlock& __restrict gradient) {
    for (size_t k = 0; k < count; ++k) {
        const double missing = 0.5 * (mean[k] - gradient.xx[k] - gradient.yy[k]);
        gradient.xx[k] += missing;
        gradient.yy[k] += missing;
    }
}

void add_apparent_cohesion(const std::vector<ExplicitHydraulics>& hydraulics, const FreePoints& points, size_t first,
                           size_t count, const BlockValues& __restrict suction,
                           const BlockValues& __restrict effective_saturation, MaterialBlock& __restrict material) {
    for (size_t k = 0; k < count; ++k) {
        const ExplicitHydraulics& soil = hydraulics[static_cast<size_t>(points.soil[first + k])];
        const double weight = soil.weighs_suction ? effective_saturation[k] : 1.0;
        material.cohesion[k] += soil.suction_tangent * weight * suction[k];
    }
}

/// What a point adds to the nodes' sums: with the splines' slope along x and along y, and with their value.
struct LiquidGift {
    Quad along_x = Quad::Zero(), along_y = Quad::Zero(), value = Quad::Zero();
};
using LiquidGiftBlock = std::array<LiquidGift, block_size>;

void fill_gifts(size_t count, const double* y, const double* volume, const double* mass, double unit_weight,
                const BlockValues& pressure, const BlockValues& permeability, const BlockValues& resistance,
                LiquidGiftBlock& gift) {
    for (size_t k = 0; k < count; ++k) {
        const double whole = pressure[k] + unit_weight * y[k];
        const double push = volume[k] * whole;
        gift[k].along_x[0] = gift[k].along_y[1] = push;
        gift[k].along_x[2] = gift[k].along_y[3] = volume[k];
        gift[k].value[0] = mass[k] * whole;
        gift[k].value[1] = mass[k] * permeability[k];
        gift[k].value[2] = volume[k];
        gift[k].value[3] = mass[k] * resistance[k];
    }
}

void scatter_gradients(const Grid& grid, size_t count, const SplineBlock& spline, const LiquidGiftBlock& gift,
                       std::vector<NodeGradients>& gradients) {
    NodePatch<Quad, true> patch(&gradients.data()->push_x, grid, spline.first[0]);
    for (size_t k = 0; k < count; ++k) {
        patch.move_to(spline.first[k]);
        for (size_t j = 0; j < 3; ++j) {
            const Quad by_slope = spline.value_y[j][k] * gift[k].along_x,
                       by_value = spline.slope_y[j][k] * gift[k].along_y;
            for (size_t i = 0; i < 3; ++i)
                patch.node[j][i] += spline.slope_x[i][k] * by_slope + spline.value_x[i][k] * by_value;
        }
    }
}

void scatter_means(const Grid& grid, size_t count, const SplineBlock& spline, const LiquidGiftBlock& gift,
                   std::vector<NodeMeans>& means) {
    NodePatch<Quad, true> patch(&means.data()->push, grid, spline.first[0]);
    for (size_t k = 0; k < count; ++k) {
        patch.move_to(spline.first[k]);
        for (size_t j = 0; j < 3; ++j) {
            const Quad row = spline.value_y[j][k] * gift[k].value;
            for (size_t i = 0; i < 3; ++i) patch.node[j][i] += spline.value_x[i][k] * row;
        }
    }
}

}  // namespace

template <Filling filling>
ExplicitMixture<filling>::ExplicitMixture(double cell_size, const Walls& walls, double gravity,
                                          std::vector<ExplicitSoil> soils, std::vector<ExplicitHydraulics> hydraulics,
                                          std::vector<SaturationTable> tables, const ExplicitWater& water,
                                          FreePoints points, int32_t threads)
    : soils_(std::move(soils)),
      hydraulics_(std::move(hydraulics)),
      tables_(std::move(tables)),
      water_(water),
      points_(std::move(points)),
      arrangement_(threads) {
    for (const ExplicitSoil& soil : soils_) yields_ = yields_ || soil.yields;
    nodes_.grid.cell_size = cell_size;
    nodes_.walls = walls;
    nodes_.gravity = gravity;
    nodes_.liquid_density = water.density;
    nodes_.least_mass = points_.least(solid_mass);
    restart();
}

template <Filling filling>
void ExplicitMixture<filling>::restart() {
    nodes_.start_grid();
    restarted_ = true;
    arrange_points();
    std::fill(nodes_.returned.begin(), nodes_.returned.end(), 0.0);
    nodes_.rained = nodes_.run_off = nodes_.seepage = 0;
    arrangement_.for_each_strip([this](Strip strip) { give(strip); });
    nodes_.begin_step();
}

template <Filling filling>
bool ExplicitMixture<filling>::step(double dt, bool is_last) {
    arrangement_.for_each_strip([&](Strip strip) { stress_and_forces(strip, dt); });
    restarted_ = false;
    nodes_.end_step(dt);
    const double drift = dt * nodes_.speed / nodes_.grid.cell_size;
    if (!arrangement_.bears(drift)) return false;
    if (arrangement_.is_outgrown(drift)) arrange_points();
    arrangement_.drift(drift);
    arrangement_.for_each_strip([&](Strip strip) {
        if (is_last) {
            move_and_give<true>(strip, dt);
        } else {
            move_and_give<false>(strip, dt);
        }
    });
    nodes_.begin_step();
    if (!is_last) return true;
    arrangement_.for_each_strip([this](Strip strip) { owe_water(strip); });
    if (filling == Filling::unsaturated) find_wave_speed();
    return true;
}

/// Points pass water on to others around the same nodes, until all have the nodes' head. `mass`: where it goes.
template <Filling filling>
void ExplicitMixture<filling>::even_out(size_t first, size_t count, const SplineBlock& spline, double dt,
                                        PointField mass) {
    WaterBlock water;
    VelocityBlock evening;
    find_water(first, count, water);
    gather_values(nodes_.grid, nodes_.evening, count, spline, evening);
    const double unit_weight = nodes_.gravity * water_.density;
    for (size_t k = 0; k < count; ++k) {
        const double head = water.pressure[k] + unit_weight * points_[position_y][first + k];
        points_[mass][first + k] += dt * points_[solid_mass][first + k] * (evening.y[k] - evening.x[k] * head);
    }
}

/// What the flow of the last step brings to the points: they get it with the strain of the same time, in the next step.
template <Filling filling>
void ExplicitMixture<filling>::owe_water(Strip strip) {
    SplineBlock spline;
    VelocityBlock rates;
    for (size_t first = strip.first; first < strip.last; first += block_size) {
        const size_t count = std::min(block_size, strip.last - first);
        spline.find(nodes_.grid, points_[position_x] + first, points_[position_y] + first, count);
        gather_values(nodes_.grid, nodes_.rates, count, spline, rates);
        for (size_t k = 0; k < count; ++k)
            points_[water_due][first + k] += nodes_.flow_time * points_[solid_mass][first + k] * rates.y[k];
    }
}

template <Filling filling>
void ExplicitMixture<filling>::find_water(size_t first, size_t count, WaterBlock& water) const {
    for (size_t k = 0; k < count; ++k) {
        const size_t p = first + k;
        const auto soil = static_cast<size_t>(points_.soil[p]);
        const double filled = share_filled(p);
        water.resistance[k] = 1 / hydraulics_[soil].mobility;
        if constexpr (filling == Filling::saturated) {
            water.pressure[k] = water_.bulk_modulus * (filled - 1);
            water.permeability[k] = 1;
        } else {
            const SaturationTable& table = tables_[soil];
            const SaturationTable::State state = table.at(filled);
            const double excess = std::max(filled / table.maximum() - 1, 0.0);
            water.pressure[k] = state.pressure + water_.bulk_modulus * excess;
            water.permeability[k] = state.permeability;
            water.suction[k] = -state.pressure;
            water.effective_saturation[k] = std::clamp(table.effective(filled), 0.0, 1.0);
        }
    }
}

template <Filling filling>
void ExplicitMixture<filling>::stress_and_forces(Strip strip, double dt) {
    SplineBlock spline;
    GradientBlock gradient;
    VelocityBlock rates;
    MaterialBlock material;
    WaterBlock water;
    BlockValues total_xx, total_yy;
    LiquidGiftBlock gift;
    for (size_t first = strip.first; first < strip.last; first += block_size) {
        const size_t count = std::min(block_size, strip.last - first);
        const double* mass = points_[solid_mass] + first;
        spline.find(nodes_.grid, points_[position_x] + first, points_[position_y] + first, count);
        gather_gradient(nodes_.grid, nodes_.velocity, count, spline, gradient);
        gather_values(nodes_.grid, nodes_.rates, count, spline, rates);
        for (size_t k = 0; k < count; ++k) {
            const double due = restarted_ ? points_[water_due][first + k] : nodes_.flow_time * mass[k] * rates.y[k];
            points_[water_mass][first + k] += due;
        }
        smooth_dilation(count, rates.x, gradient);
        set_elasticity(soils_, points_, first, count, material);
        strain_elastically(points_, first, count, dt, gradient, material);
        find_water(first, count, water);
        if (yields_) {
            set_strength(soils_, points_, first, count, nodes_.grid.cell_size, material);
            if constexpr (filling == Filling::unsaturated)
                add_apparent_cohesion(hydraulics_, points_, first, count, water.suction, water.effective_saturation,
                                      material);
            return_stresses(points_, first, count, material);
        }
        for (size_t k = 0; k < count; ++k) {
            const double pore_stress = this->pore_stress(water, k);
            total_xx[k] = points_[stress_xx][first + k] - pore_stress;
            total_yy[k] = points_[stress_yy][first + k] - pore_stress;
        }
        const double* volume = points_[point_volume] + first;
        scatter_force(nodes_.grid, count, spline, volume, total_xx.data(), total_yy.data(), points_[stress_xy] + first,
                      nodes_.force);
        const double* y = points_[position_y] + first;
        fill_gifts(count, y, volume, mass, nodes_.gravity * water_.density, water.pressure, water.permeability,
                   water.resistance, gift);
        scatter_gradients(nodes_.grid, count, spline, gift, nodes_.gradients);
        scatter_means(nodes_.grid, count, spline, gift, nodes_.means);
    }
}

template <Filling filling>
template <bool keeps>
void ExplicitMixture<filling>::move_and_give(Strip strip, double dt) {
    SplineBlock spline;
    VelocityBlock taken, liquid_taken;
    BlockValues dilation, outflow;
    GiftBlock gift, liquid_gift;
    for (size_t first = strip.first; first < strip.last; first += block_size) {
        const size_t count = std::min(block_size, strip.last - first);
        const Grid& grid = nodes_.grid;
        double* x = points_[position_x] + first;
        double* y = points_[position_y] + first;
        spline.find(grid, x, y, count);
        gather_divergence(grid, nodes_.velocity, count, spline, dilation);
        gather_divergence(grid, nodes_.flux, count, spline, outflow);
        take_velocity<keeps>(grid, nodes_.velocity, points_, first, count, spline, points_[solid_mass] + first,
                             velocity_x, affine_xx, gift, taken);
        take_velocity<keeps>(grid, nodes_.liquid_velocity, points_, first, count, spline, points_[water_mass] + first,
                             liquid_velocity_x, liquid_affine_xx, liquid_gift, liquid_taken);
        if (keeps) std::fill_n(points_[water_due] + first, count, 0.0);
        if (filling == Filling::unsaturated) even_out(first, count, spline, dt, keeps ? water_due : water_mass);
        for (size_t k = 0; k < count; ++k) {
            gift[k].own[3] = points_[solid_mass][first + k] * dilation[k];
            liquid_gift[k].own[3] = -points_[point_volume][first + k] * outflow[k];
            x[k] += dt * taken.x[k];
            y[k] += dt * taken.y[k];
        }
        spline.find(grid, x, y, count);
        give_momentum(grid, count, spline, gift, nodes_.momentum);
        give_momentum(grid, count, spline, liquid_gift, nodes_.liquid_momentum);
    }
}

/// The momenta of points that have velocities of their own, at the start, when no water flows yet.
template <Filling filling>
void ExplicitMixture<filling>::give(Strip strip) {
    SplineBlock spline;
    GiftBlock gift;
    const double size = nodes_.grid.cell_size;
    const auto give_phase = [&](size_t first, size_t count, PointField mass, PointField v, PointField a, double share,
                                std::vector<NodeMomentum>& momentum) {
        for (size_t k = 0; k < count; ++k) {
            const size_t p = first + k;
            const auto field = [&](size_t name) { return points_.field[name][p]; };
            gift[k].set(field(mass), {field(v), field(v + 1)}, {size * field(a), size * field(a + 2)},
                        {size * field(a + 1), size * field(a + 3)});
            gift[k].own[3] = share * field(mass) * (field(a) + field(a + 3));
        }
        give_momentum(nodes_.grid, count, spline, gift, momentum);
    };
    for (size_t first = strip.first; first < strip.last; first += block_size) {
        const size_t count = std::min(block_size, strip.last - first);
        spline.find(nodes_.grid, points_[position_x] + first, points_[position_y] + first, count);
        give_phase(first, count, solid_mass, velocity_x, affine_xx, 1, nodes_.momentum);
        give_phase(first, count, water_mass, liquid_velocity_x, liquid_affine_xx, 0, nodes_.liquid_momentum);
    }
}

template <Filling filling>
void ExplicitMixture<filling>::arrange_points() {
    const Grid old = nodes_.grid;
    std::vector<double> returned(nodes_.returned.size(), 0.0);  // none from nodes that points have left
    nodes_.for_each_node([&](size_t i) { returned[i] = nodes_.returned[i]; });
    nodes_.returned = std::move(returned);
    const double before = nodes_.total_returned();
    if (arrangement_.arrange(points_, nodes_.grid)) {
        for (auto* field : {&nodes_.velocity, &nodes_.liquid_velocity, &nodes_.flux, &nodes_.rates, &nodes_.evening})
            move_nodes(*field, old, nodes_.grid);
        move_nodes(nodes_.returned, old, nodes_.grid);
        nodes_.resize();
    }
    nodes_.spans = arrangement_.spans();
    nodes_.seepage += nodes_.flow_time * (before - nodes_.total_returned());
    fall_rain();
    find_wave_speed();
}

template <Filling filling>
void ExplicitMixture<filling>::set_rain(std::function<double(double)> rate) {
    rain_ = std::move(rate);
    fall_rain();
}

/// Onto the grid's columns that hold ground.
template <Filling filling>
void ExplicitMixture<filling>::fall_rain() {
    nodes_.rain.clear();
    if (!rain_) return;
    const Grid& grid = nodes_.grid;
    nodes_.rain.assign(static_cast<size_t>(grid.cells[0]), 0.0);
    for (size_t p = 0; p < points_.count; ++p) {
        const int32_t column = grid.cell_of(points_[position_x][p], 0);
        nodes_.rain[static_cast<size_t>(column)] =
            water_.density * rain_(grid.corner[0] + (column + 0.5) * grid.cell_size);
    }
}

/// Retention may hold water more stiffly than water is. Bishop's stress feels that; flow does as far as drag lets it, which it is slower by:
/// half the step that would just be stable is size^2 n / (2 stiffness lambda).
template <Filling filling>
typename ExplicitMixture<filling>::PoreStiffness ExplicitMixture<filling>::pore_stiffness(size_t p,
                                                                                          double porosity) const {
    const double bulk_modulus = water_.bulk_modulus;
    if constexpr (filling == Filling::saturated) return {bulk_modulus, bulk_modulus / water_.density};
    const auto soil = static_cast<size_t>(points_.soil[p]);
    const SaturationTable& table = tables_[soil];
    const double filled = share_filled(p), stiffness = filled * table.stiffness(filled);
    const bool is_borne = water_.pore_stress == PoreStress::bishop;
    const double borne = is_borne ? std::clamp(table.effective(filled), 0.0, 1.0) * stiffness : 0.0;
    const double mobility = hydraulics_[soil].mobility * table.at(filled).permeability;
    const double creep = 2 * stiffness * mobility / (porosity * nodes_.grid.cell_size);
    return {std::max(bulk_modulus, borne),
            std::max(bulk_modulus / water_.density, std::min(stiffness / water_.density, creep * creep))};
}

/// Of the points as they are: the square root of the sum of the two waves' squares without drag, which bounds both.
template <Filling filling>
void ExplicitMixture<filling>::find_wave_speed() {
    wave_speed_ = 0;
    for (size_t p = 0; p < points_.count; ++p) {
        const auto soil = static_cast<size_t>(points_.soil[p]);
        const double solid_density = points_[solid_mass][p] / points_[point_volume][p];
        const double grains = solid_density / hydraulics_[soil].grain_density;
        const double frame = soils_[soil].elastic.lame + 2 * soils_[soil].elastic.shear;
        const PoreStiffness pores = pore_stiffness(p, 1 - grains);
        const double fluid = pores.borne / (1 - grains);
        const double squares = (frame + grains * grains * fluid) / solid_density + pores.flow_speed_squared;
        wave_speed_ = std::max(wave_speed_, std::sqrt(squares));
    }
}

template <Filling filling>
double ExplicitMixture<filling>::critical_step() const {
    constexpr double share = 1.0;  // stable to 1.4: the bound of the speed is above any wave's
    return share * nodes_.grid.cell_size / (wave_speed_ + nodes_.largest_speed());
}

template <Filling filling>
Energies ExplicitMixture<filling>::energies() const {
    Energies sum = energies_of(points_, soils_, nodes_.gravity);
    for (size_t p = 0; p < points_.count; ++p) {
        const double x = points_[liquid_velocity_x][p], y = points_[liquid_velocity_y][p];
        sum.kinetic += 0.5 * points_[water_mass][p] * (x * x + y * y);
        sum.potential += points_[water_mass][p] * nodes_.gravity * points_[position_y][p];
    }
    return sum;
}

template <Filling filling>
double ExplicitMixture<filling>::pressure(size_t point) const {
    WaterBlock water;
    find_water(point, 1, water);
    return water.pressure[0];
}

template <Filling filling>
double ExplicitMixture<filling>::pore_stress(const WaterBlock& water, size_t k) const {
    const double pressure = water.pressure[k];
    if (filling == Filling::saturated || pressure > 0) return pressure;
    return water_.pore_stress == PoreStress::bishop ? water.effective_saturation[k] * pressure : 0.0;
}

template <Filling filling>
double ExplicitMixture<filling>::pore_stress(size_t point) const {
    WaterBlock water;
    find_water(point, 1, water);
    return pore_stress(water, 0);
}

template <Filling filling>
double ExplicitMixture<filling>::saturation(size_t point) const {
    return std::min(share_filled(point), 1.0);
}

template class ExplicitMixture<Filling::saturated>;
template class ExplicitMixture<Filling::unsaturated>;

}  // namespace talus
