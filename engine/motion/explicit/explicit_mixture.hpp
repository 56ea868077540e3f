// Explicit motion of material points that hold water: solid and liquid have velocities of their own (physics.md, Eqs 2 to 4 with the
// gas at rest). The solid as in explicit_motion.hpp; see grid_mixture.hpp for what passes between points and nodes.
//
// A point's water is its mass; the pressure follows from it, from the pores' volume and from the soil's retention. The volumetric strain of
// the points is a mean over the nodes' surroundings, so that nearly incompressible water does not lock the ground.
#pragma once

#include "materials/hydraulic/saturation_table.hpp"
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
    double mobility = 0;       ///< of the full soil, kappa / mu = K / (rho_l g), m2/(Pa s)
    double suction_tangent =
        0;  ///< cohesion gained per suction, -, times the effective saturation where `weighs_suction`
    bool weighs_suction = false;
};

/// What of the pore pressure the skeleton does not bear: max(p, 0), or S_e p (physics.md).
enum class PoreStress { net, bishop };

struct ExplicitWater {
    double density = 1000;      ///< kg/m3
    double bulk_modulus = 2e9;  ///< Pa
    PoreStress pore_stress = PoreStress::net;
};

/// Saturated: every pore is full of water at all times. Unsaturated: the gas is at rest at zero pressure.
enum class Filling { saturated, unsaturated };

template <Filling filling>
class ExplicitMixture {
public:
    /// The points' fields up to liquid_affine_yy must be sized. `tables`: one a soil, none where saturated.
    ExplicitMixture(double cell_size, const Walls& walls, double gravity, std::vector<ExplicitSoil> soils,
                    std::vector<ExplicitHydraulics> hydraulics, std::vector<SaturationTable> tables,
                    const ExplicitWater& water, FreePoints points, int32_t threads);

    /// As ExplicitMotion's. The water of the ground is the points' own and what is due to them.
    bool step(double dt, bool is_last);
    void restart();  ///< as ExplicitMotion's; what rained and seeped is counted from here on
    [[nodiscard]] double critical_step() const;
    [[nodiscard]] Energies energies() const;  ///< of both phases; elastic: the skeleton's

    void set_edge_pressure(double pressure) { nodes_.edge_pressure = pressure; }  ///< Pa
    /// Rain from now on: a volume per horizontal area, m/s, at each x (m).
    void set_rain(std::function<double(double x)> rate);
    [[nodiscard]] double rained() const { return nodes_.rained; }    ///< kg, since restart()
    [[nodiscard]] double run_off() const { return nodes_.run_off; }  ///< kg
    void set_immersed(bool immersed) { nodes_.immersed = immersed; }
    [[nodiscard]] double seepage() const { return nodes_.seepage; }  ///< kg

    /// Pore pressure of a point, Pa.
    [[nodiscard]] double pressure(size_t point) const;
    [[nodiscard]] double saturation(size_t point) const;
    /// What the points' stress is short of the total one, Pa.
    [[nodiscard]] double pore_stress(size_t point) const;

    [[nodiscard]] const FreePoints& points() const { return points_; }
    [[nodiscard]] FreePoints& points() { return points_; }
    [[nodiscard]] const Grid& grid() const { return nodes_.grid; }

private:
    struct WaterBlock {
        BlockValues pressure, permeability, resistance, suction, effective_saturation;
    };

    struct PoreStiffness {
        double borne;               // of what the skeleton bears, Pa
        double flow_speed_squared;  // m2/s2, of the liquid through the skeleton
    };
    [[nodiscard]] PoreStiffness pore_stiffness(size_t p, double porosity) const;

    void arrange_points();
    /// Of the pores, by the point's water; above 1 it is pressed together.
    [[nodiscard]] double share_filled(size_t p) const {
        const double grain_density = hydraulics_[static_cast<size_t>(points_.soil[p])].grain_density;
        const double pores = points_[point_volume][p] - points_[solid_mass][p] / grain_density;
        return points_[water_mass][p] / (water_.density * pores);
    }
    [[nodiscard]] double pore_stress(const WaterBlock& water, size_t k) const;
    void find_wave_speed();
    void fall_rain();
    void even_out(size_t first, size_t count, const SplineBlock& spline, double dt, PointField water);
    void owe_water(Strip strip);
    void find_water(size_t first, size_t count, WaterBlock& water) const;
    void stress_and_forces(Strip strip, double dt);
    template <bool keeps>
    void move_and_give(Strip strip, double dt);
    void give(Strip strip);

    std::vector<ExplicitSoil> soils_;
    std::vector<ExplicitHydraulics> hydraulics_;
    std::vector<SaturationTable> tables_;
    ExplicitWater water_;
    FreePoints points_;
    GridMixture nodes_;
    Arrangement arrangement_;
    bool restarted_ = false;  // and the points not yet got what is due
    bool yields_ = false;     // any soil
    std::function<double(double)> rain_;
    double wave_speed_ = 0;  // m/s, the fastest when the points were arranged or looked at, were all pores full
};

extern template class ExplicitMixture<Filling::saturated>;
extern template class ExplicitMixture<Filling::unsaturated>;

}  // namespace talus
