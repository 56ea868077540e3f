// The stress of a block of points under a step's strain.
#pragma once

#include "background/grid.hpp"
#include "materials/solid/mohr_coulomb.hpp"
#include "materials/solid/strength.hpp"
#include "motion/explicit/transfer.hpp"
#include "points/free_points.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace talus {

/// Of a soil that does not yield, beside others that do.
inline constexpr MohrCoulomb boundless{std::numeric_limits<double>::infinity(), 0, 1, 0,
                                       std::numeric_limits<double>::infinity()};

/// How a soil deforms, yields and flows. Its strength falls in proportion to the slip on a shear band, sqrt(3) times the plastic shear
/// strain times the cell's size: the band is as wide as the cells allow, and what it dissipates does not depend on them
/// (Pietruszczak & Mroz, Int. J. Numer. Methods Eng. 17, 1981).
struct ExplicitSoil {
    Elasticity elastic{};
    bool yields = false;
    MohrCoulomb strength = boundless;  ///< without slip
    double residual_cohesion = 0;      ///< Pa, after softening_slip
    double residual_sin_friction = 0;  ///< -, likewise
    double softening_slip = 0;         ///< m; 0: it does not soften
    double friction_rise = 0;          ///< of sin phi at a boundless rate of shear; 0: it does not depend on the rate
    double inertial_root = 0;          ///< sqrt(Pa) s: I / I_0 times the root of the pressure, over the rate of shear
};

/// Share of what the softening of a soil that softens takes, 0 to 1.
inline double share_lost(const ExplicitSoil& soil, double plastic_strain, double cell_size) {
    return std::min(band_slip(plastic_strain, cell_size) / soil.softening_slip, 1.0);
}

// The arrays that these take never overlap, which __restrict tells the compiler, so that the loops are vectorised.

/// What the law of each point of a block says, at the point's slip.
struct MaterialBlock {
    BlockValues lame, shear;                                                           // Pa
    BlockValues cohesion, sin_friction, cos_friction, sin_dilation, tensile_strength;  // as in MohrCoulomb
    [[nodiscard]] MohrCoulomb at(size_t k) const {
        return {cohesion[k], sin_friction[k], cos_friction[k], sin_dilation[k], tensile_strength[k]};
    }
    std::array<int64_t, block_size> unfinished;  // whether a stress needs more than the return to the main plane
};

void set_elasticity(const std::vector<ExplicitSoil>& soils, const FreePoints& points, size_t first, size_t count,
                    MaterialBlock& block);
void set_strength(const std::vector<ExplicitSoil>& soils, const FreePoints& points, size_t first, size_t count,
                  double cell_size, MaterialBlock& block);

/// sin phi grows by rise / (1 + I_0 / I), I = d |rate of shear| / sqrt(p / rho_s) at the elastic stress (Jop, Forterre & Pouliquen, Nature
/// 441, 2006: where stress and rate have the same axes, the ratio mu of shear to normal stress in shear is sin phi). What cohesion adds to the
/// strength, c cos phi, stays; so does that of ground in tension.
void add_inertial_friction(const std::vector<ExplicitSoil>& soils, const FreePoints& points, size_t first, size_t count,
                           const GradientBlock& gradient, MaterialBlock& block);

/// Hooke's law on the stress turned by the step's rotation (Hughes & Winget 1980), and the change of volume, in dt (s); `gradient` is that
/// of the velocity that the points came with, where they have come to.
void strain_elastically(FreePoints& points, size_t first, size_t count, double dt, const GradientBlock& gradient,
                        const MaterialBlock& block);

/// Returns stresses that violate Mohr-Coulomb to its surface.
void return_stresses(FreePoints& points, size_t first, size_t count, MaterialBlock& block);

}  // namespace talus
