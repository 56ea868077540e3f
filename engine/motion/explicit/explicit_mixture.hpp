// Explicit motion of material points that hold water, or water and gas: solid, liquid and gas have velocities of their own (physics.md,
// Eqs 2 to 4), or the gas is at rest. The solid as in explicit_motion.hpp; see grid_mixture.hpp for what passes between points and nodes.
//
// A point's fluids are their masses; the pressures follow from them, from the pores' volume and from the soil's retention. The volumetric strain of
// the points is a mean over the nodes' surroundings, so that nearly incompressible water does not lock the ground.
#pragma once

#include "materials/hydraulic/fluid_exchange.hpp"
#include "materials/hydraulic/saturation_table.hpp"
#include "materials/hydraulic/shared_pores.hpp"
#include "materials/solid/strength.hpp"
#include "motion/explicit/arrangement.hpp"
#include "motion/explicit/explicit_motion.hpp"
#include "motion/explicit/grid_mixture.hpp"
#include "motion/explicit/stress.hpp"
#include "motion/explicit/transfer.hpp"
#include "points/free_points.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace talus {

/// How a soil holds and conducts water. A retention is left out in ground that stays full.
struct ExplicitHydraulics {
    double grain_density = 0;  ///< kg/m3
    double mobility = 0;       ///< of the full soil, kappa / mu = K / (rho_l g), K as mean_conductivity(), m2/(Pa s)
    double suction_tangent =
        0;  ///< cohesion gained per suction, -, times the effective saturation where `weighs_suction`
    bool weighs_suction = false;
    double gas_mobility = 0;  ///< of the dry soil, kappa / mu_g, m2/(Pa s); three phases only
    double residual_water =
        0;  ///< that does not flow, kg per kg of solid: what fills the pores at the start to the residual saturation
    /// Kozeny's and Carman's n^3 / (1 - n)^2 at the scene's porosity, where K grows with it; 0: it does not.
    double initial_conductance = 0;
    Strength strength{};      ///< read where it is exponential, in place of suction_tangent
    NodeVector anisotropy{};  ///< as anisotropy_of(); none: it conducts alike in all directions
};

/// What of the pore pressures the skeleton does not bear: max(p_l, p_g), or S_e p_l + (1 - S_e) p_g (physics.md).
enum class PoreStress { net, bishop };

struct ExplicitWater {
    double density = 1000;      ///< kg/m3
    double bulk_modulus = 2e9;  ///< Pa
    PoreStress pore_stress = PoreStress::net;
};

/// Ideal and isothermal. The defaults: air at 20 degrees.
struct ExplicitGas {
    double density = 1.2041;     ///< at the atmosphere's pressure, kg/m3
    double atmosphere = 101325;  ///< Pa, absolute
};

/// Vapour and dissolved air, always in equilibrium with water and air. The defaults: at 20 degrees.
struct ExplicitExchange {
    FluidExchange fluids{};
    double vapour_diffusivity = 2.4e-5;  ///< in air, m2/s
    double air_diffusivity = 2e-9;       ///< in water, m2/s
    double humidity = 1;                 ///< of the atmosphere, relative
};

/// Saturated: every pore is full of water at all times. Unsaturated: the gas is at rest at zero pressure. Three phases: it moves. Exchange: it moves,
/// water evaporates into it and air dissolves in the water.
enum class Filling { saturated, unsaturated, three_phase, exchange };

template <Filling filling>
class ExplicitMixture {
public:
    /// The points' fields up to liquid_affine_yy must be sized, with three phases those up to gas_affine_yy, with exchange all. `tables`: one a soil,
    /// none where saturated. Rest speed: as ExplicitMotion's, of solid and liquid; held points keep their water. Not where gas moves.
    ExplicitMixture(double cell_size, const Walls& walls, double gravity, std::vector<ExplicitSoil> soils,
                    std::vector<ExplicitHydraulics> hydraulics, std::vector<SaturationTable> tables,
                    const ExplicitWater& water, FreePoints points, int32_t threads, const ExplicitGas& gas = {},
                    const ExplicitExchange& exchange = {}, double rest_speed = 0);

    /// As ExplicitMotion's. The water of the ground is the points' own and what is due to them.
    bool step(double dt, bool is_last);
    void restart();  ///< as ExplicitMotion's; what rained and seeped is counted from here on
    void keep(const std::vector<int32_t>& staying);  ///< likewise; what is due to the others is gone with them
    [[nodiscard]] double critical_step() const;
    [[nodiscard]] Energies energies() const;  ///< of all phases; elastic: the skeleton's

    void set_edge_pressure(double pressure) { nodes_.edge_pressure = pressure; }  ///< Pa
    /// Rain from now on: a volume per horizontal area, m/s, at each x (m).
    void set_rain(std::function<double(double x)> rate);
    [[nodiscard]] double rained() const { return nodes_.rained; }    ///< kg, since restart()
    [[nodiscard]] double run_off() const { return nodes_.run_off; }  ///< kg
    void set_immersed(bool immersed) { nodes_.immersed = immersed; }
    [[nodiscard]] double seepage() const { return nodes_.seepage; }  ///< kg

    /// kg, since restart(); with exchange of air alone, that of the water too.
    [[nodiscard]] double gas_escaped() const { return nodes_.gas.escaped; }
    [[nodiscard]] double evaporated() const { return nodes_.solutes.evaporated; }  ///< through the surface, kg

    /// Pressure of a point's water, Pa.
    [[nodiscard]] double pressure(size_t point) const;
    [[nodiscard]] double gas_pressure(size_t point) const;  ///< Pa; 0: at rest
    [[nodiscard]] double saturation(size_t point) const;
    [[nodiscard]] double relative_humidity(size_t point) const;  ///< with exchange alone
    [[nodiscard]] double dissolved_air(size_t point) const;      ///< kg per m3 of water; likewise
    /// What a point's stress may come to, at its slip and its suction.
    [[nodiscard]] MohrCoulomb strength(size_t point) const;
    /// What the points' stress is short of the total one, Pa.
    [[nodiscard]] double pore_stress(size_t point) const;

    [[nodiscard]] const FreePoints& points() const { return points_; }
    [[nodiscard]] FreePoints& points() { return points_; }
    [[nodiscard]] const Grid& grid() const { return nodes_.grid; }
    [[nodiscard]] const Walls& walls() const { return nodes_.walls; }

private:
    static constexpr bool exchanges = filling == Filling::exchange;
    static constexpr bool has_gas = filling == Filling::three_phase || exchanges;

    struct FluidBlock {
        BlockValues pressure, permeability, resistance, suction, effective_saturation;               // of the water
        BlockValues mobility, edge_mobility, gas_pressure, gas_potential, gas_mobility, gas_volume;  // where gas moves
        BlockValues saturation, vapour, dissolved;  // where fluids exchange them: -, kg per metre of thickness
    };

    struct PoreStiffness {
        double borne;               // of what the skeleton bears, Pa
        double flow_speed_squared;  // m2/s2, of the liquid through the skeleton
    };
    [[nodiscard]] PoreStiffness pore_stiffness(size_t p, double porosity) const;

    void arrange_points();
    void take_arrangement();
    void start_anew();
    /// Of the pores, by the point's water; above 1 it is pressed together.
    [[nodiscard]] double share_filled(size_t p) const {
        const double grain_density = hydraulics_[static_cast<size_t>(points_.soil[p])].grain_density;
        const double pores = points_[point_volume][p] - points_[solid_mass][p] / grain_density;
        return points_[water_mass][p] / (water_.density * pores);
    }
    [[nodiscard]] double pore_stress(const FluidBlock& fluids, size_t k) const;
    void find_wave_speed();
    void fall_rain();
    template <bool keeps>
    void even_out(size_t first, size_t count, const SplineBlock& spline, double dt, FluidBlock& fluids,
                  BlockValues& missing);
    void owe_water(Strip strip);
    void gather_rates(size_t count, const SplineBlock& spline, VelocityBlock& rates, VelocityBlock& gas_rates) const;
    void find_fluids(size_t first, size_t count, FluidBlock& fluids) const;
    [[nodiscard]] double conductance_factor(size_t p) const;
    void follow_porosity(size_t first, size_t count, FluidBlock& fluids) const;
    void tell_bedding(size_t first, size_t count, const SplineBlock& spline, const FluidBlock& fluids);
    void find_strength(size_t first, size_t count, const FluidBlock& fluids, MaterialBlock& material) const;
    void find_pores(size_t first, size_t count, BlockValues& pores) const;
    void find_gas_weights(size_t first, size_t count, BlockValues& weight) const;
    void share_pores(size_t first, size_t count, FluidBlock& fluids) const;
    void find_potential(size_t first, size_t count, FluidBlock& fluids) const;
    void keep_fluids(size_t first, size_t count, const FluidBlock& fluids);
    void set_exchange(const ExplicitExchange& exchange);
    void find_partitions(size_t first, size_t count, FluidBlock& fluids) const;
    [[nodiscard]] Partition partition_of(size_t p) const;
    void settle(size_t first, size_t count, const FluidBlock& fluids);
    void push_solutes(size_t first, size_t count, const SplineBlock& spline, const FluidBlock& fluids);
    void add_solutes(size_t first, size_t count, const SplineBlock& spline, PointField dissolved, PointField vapour);
    void take_solutes(size_t first, size_t count, const SplineBlock& spline);
    void even_out_solutes(size_t first, size_t count, const SplineBlock& spline, double dt, const FluidBlock& fluids,
                          PointField dissolved, PointField vapour);
    void give_solutes(size_t first, size_t count, const SplineBlock& spline, const BlockValues& dissolved_outflow,
                      const BlockValues& vapour_outflow);
    void add_water(size_t first, size_t count, const BlockValues& gain, double* missing);
    void take_water(size_t first, size_t count, const VelocityBlock& rates);
    void take_gas(size_t first, size_t count, const VelocityBlock& rates);
    void push_gas(size_t first, size_t count, const SplineBlock& spline, const FluidBlock& fluids);
    void give_gas(size_t first, size_t count, const SplineBlock& spline, const GiftBlock& gift);
    template <class Returned>
    void forget_left_nodes(std::vector<Returned>& returned) const;
    void move_gas_nodes(const Grid& old);
    void stress_and_forces(Strip strip, double dt);
    template <bool keeps>
    void move_and_give(Strip strip, double dt);
    void give(Strip strip);

    std::vector<ExplicitSoil> soils_;
    std::vector<ExplicitHydraulics> hydraulics_;
    std::vector<double> grain_volume_;  // of each soil, m3/kg
    std::vector<SaturationTable> tables_;
    ExplicitWater water_;
    FreePoints points_;
    ExplicitGas gas_;
    FluidExchange exchange_;
    GridMixture<has_gas, exchanges> nodes_;
    Arrangement arrangement_;
    bool restarted_ = false;            // and the points not yet got what is due
    bool yields_ = false;               // any soil
    bool is_inertial_ = false;          // likewise: whether its friction grows with the rate of shear
    bool gains_exponentially_ = false;  // likewise: whether its strength is exponential
    bool follows_porosity_ = false;     // likewise: whether it conducts by its porosity
    std::function<double(double)> rain_;
    double wave_speed_ = 0;  // m/s, the fastest when the points were arranged or looked at, were all pores full
};

// explicit_solutes.cpp
template <>
void ExplicitMixture<Filling::exchange>::set_exchange(const ExplicitExchange& exchange);
template <>
void ExplicitMixture<Filling::exchange>::find_partitions(size_t first, size_t count, FluidBlock& fluids) const;
template <>
Partition ExplicitMixture<Filling::exchange>::partition_of(size_t p) const;
template <>
double ExplicitMixture<Filling::exchange>::relative_humidity(size_t point) const;
template <>
double ExplicitMixture<Filling::exchange>::dissolved_air(size_t point) const;
template <>
void ExplicitMixture<Filling::exchange>::settle(size_t first, size_t count, const FluidBlock& fluids);
template <>
void ExplicitMixture<Filling::exchange>::push_solutes(size_t first, size_t count, const SplineBlock& spline,
                                                      const FluidBlock& fluids);
template <>
void ExplicitMixture<Filling::exchange>::add_solutes(size_t first, size_t count, const SplineBlock& spline,
                                                     PointField dissolved, PointField vapour);
template <>
void ExplicitMixture<Filling::exchange>::take_solutes(size_t first, size_t count, const SplineBlock& spline);
template <>
void ExplicitMixture<Filling::exchange>::even_out_solutes(size_t first, size_t count, const SplineBlock& spline,
                                                          double dt, const FluidBlock& fluids, PointField dissolved,
                                                          PointField vapour);
template <>
void ExplicitMixture<Filling::exchange>::give_solutes(size_t first, size_t count, const SplineBlock& spline,
                                                      const BlockValues& dissolved_outflow,
                                                      const BlockValues& vapour_outflow);

extern template class ExplicitMixture<Filling::saturated>;
extern template class ExplicitMixture<Filling::unsaturated>;
extern template class ExplicitMixture<Filling::three_phase>;
extern template class ExplicitMixture<Filling::exchange>;

}  // namespace talus
