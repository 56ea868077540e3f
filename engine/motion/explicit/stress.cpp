#include "motion/explicit/stress.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

/// Returns the block's stresses to Mohr-Coulomb's main plane, s1 and s3 in the plane of motion and s2 across it, which is where nearly
/// all yielding stresses come to lie (see materials/solid/mohr_coulomb.hpp for the return). True: the others are marked unfinished.
bool return_to_main_plane(FreePoints& points, size_t first, size_t count, MaterialBlock& __restrict block) {
    double* __restrict xx = points[stress_xx] + first;
    double* __restrict yy = points[stress_yy] + first;
    double* __restrict zz = points[stress_zz] + first;
    double* __restrict xy = points[stress_xy] + first;
    double* __restrict plastic = points[plastic_shear_strain] + first;
    int64_t unfinished = 0;
    for (size_t k = 0; k < count; ++k) {
        const double lame = block.lame[k], shear = block.shear[k];
        const double friction = block.sin_friction[k], dilation = block.sin_dilation[k];
        const double centre = 0.5 * (xx[k] + yy[k]), half = 0.5 * (xx[k] - yy[k]);
        const double radius = std::sqrt(half * half + xy[k] * xy[k]);
        const double across = zz[k];
        const double largest = std::max(centre + radius, across), smallest = std::min(centre - radius, across);
        const double strength = 2 * block.cohesion[k] * block.cos_friction[k];
        const double excess = (1 + friction) * largest - (1 - friction) * smallest - strength;
        const double multiplier =
            std::max(excess, 0.0) / (4 * (lame * friction * dilation + shear * (1 + friction * dilation)));
        const double new_centre = centre - multiplier * 2 * (lame + shear) * dilation;
        const double new_radius = radius - multiplier * 2 * shear;
        const double new_across = across - multiplier * 2 * lame * dilation;
        // No short cuts, which would keep the loop from being vectorised.
        const bool in_order = (std::abs(across - centre) <= radius) &
                              (std::abs(new_across - new_centre) <= new_radius) &
                              (new_centre + new_radius <= block.tensile_strength[k]);
        const bool yields = (excess > 0) | (largest > block.tensile_strength[k]);
        const int64_t left = yields & !in_order ? 1 : 0;
        block.unfinished[k] = left;
        unfinished |= left;
        const double share = yields & in_order ? 1.0 : 0.0;
        const double scale = 1 + share * (new_radius / std::max(radius, 1e-300) - 1);
        const double middle = centre + share * (new_centre - centre);
        xx[k] = middle + scale * half;
        yy[k] = middle - scale * half;
        zz[k] = across + share * (new_across - across);
        xy[k] = scale * xy[k];
        // sqrt(2/3 e:e) of the flow (1 + sin psi, 0, sin psi - 1)
        plastic[k] += share * multiplier * std::sqrt((12 + 4 * dilation * dilation) / 9);
    }
    return unfinished != 0;
}

/// The stresses that do not lie on the main plane: those on edges, at the apex and in tension.
void return_unfinished(FreePoints& points, size_t first, size_t count, const MaterialBlock& __restrict block) {
    for (size_t k = 0; k < count; ++k) {
        if (block.unfinished[k] == 0) continue;
        const size_t p = first + k;
        const MohrCoulomb material = block.at(k);
        const PlasticReturn result = return_to_yield_surface(
            {block.lame[k], block.shear[k]}, material,
            {points[stress_xx][p], points[stress_yy][p], points[stress_zz][p], points[stress_xy][p]}, nullptr);
        points[stress_xx][p] = result.stress[0];
        points[stress_yy][p] = result.stress[1];
        points[stress_zz][p] = result.stress[2];
        points[stress_xy][p] = result.stress[3];
        points[plastic_shear_strain][p] += result.plastic_shear_strain;
    }
}

/// sqrt(2 e:e) of the deviatoric strain rate e, 1/s.
double rate_of_shear(const GradientBlock& gradient, size_t k) {
    const double third = (gradient.xx[k] + gradient.yy[k]) / 3, shear = gradient.xy[k] + gradient.yx[k];
    const double xx = gradient.xx[k] - third, yy = gradient.yy[k] - third;
    return std::sqrt(2 * (xx * xx + yy * yy + third * third) + shear * shear);
}

double mean_pressure(const FreePoints& points, size_t p) {
    return -(points[stress_xx][p] + points[stress_yy][p] + points[stress_zz][p]) / 3;
}

}  // namespace

void set_elasticity(const std::vector<ExplicitSoil>& soils, const FreePoints& points, size_t first, size_t count,
                    MaterialBlock& __restrict block) {
    for (size_t k = 0; k < count; ++k) {
        const Elasticity& elastic = soils[static_cast<size_t>(points.soil[first + k])].elastic;
        block.lame[k] = elastic.lame;
        block.shear[k] = elastic.shear;
    }
}

void set_strength(const std::vector<ExplicitSoil>& soils, const FreePoints& points, size_t first, size_t count,
                  double cell_size, MaterialBlock& __restrict block) {
    for (size_t k = 0; k < count; ++k) {
        const ExplicitSoil& soil = soils[static_cast<size_t>(points.soil[first + k])];
        block.cohesion[k] = soil.strength.cohesion;
        block.sin_friction[k] = soil.strength.sin_friction;
        block.cos_friction[k] = soil.strength.cos_friction;
        block.sin_dilation[k] = soil.strength.sin_dilation;
        block.tensile_strength[k] = soil.strength.tensile_strength;
        if (soil.softening_slip <= 0) continue;
        const double lost = share_lost(soil, points[plastic_shear_strain][first + k], cell_size);
        block.cohesion[k] += lost * (soil.residual_cohesion - soil.strength.cohesion);
        block.sin_friction[k] += lost * (soil.residual_sin_friction - soil.strength.sin_friction);
        block.cos_friction[k] = std::sqrt(1 - block.sin_friction[k] * block.sin_friction[k]);
        block.sin_dilation[k] = std::min(block.sin_dilation[k], block.sin_friction[k]);
    }
}

void add_inertial_friction(const std::vector<ExplicitSoil>& soils, const FreePoints& points, size_t first, size_t count,
                           const GradientBlock& __restrict gradient, MaterialBlock& __restrict block) {
    for (size_t k = 0; k < count; ++k) {
        const ExplicitSoil& soil = soils[static_cast<size_t>(points.soil[first + k])];
        const double pressure = mean_pressure(points, first + k);
        if (!(pressure > 0)) continue;
        const double rate = soil.inertial_root * rate_of_shear(gradient, k);
        const double cohesive = block.cohesion[k] * block.cos_friction[k];
        block.sin_friction[k] += soil.friction_rise * rate / (rate + std::sqrt(pressure));
        block.cos_friction[k] = std::sqrt(1 - block.sin_friction[k] * block.sin_friction[k]);
        block.cohesion[k] = cohesive / block.cos_friction[k];
    }
}

void strain_elastically(FreePoints& points, size_t first, size_t count, double dt,
                        const GradientBlock& __restrict gradient, const MaterialBlock& __restrict block) {
    double* __restrict xx = points[stress_xx] + first;
    double* __restrict yy = points[stress_yy] + first;
    double* __restrict zz = points[stress_zz] + first;
    double* __restrict xy = points[stress_xy] + first;
    double* __restrict volume = points[point_volume] + first;
    for (size_t k = 0; k < count; ++k) {
        // The step's deformation is (1 - D)^-1, D = dt dv/dx where the points have come to; dv/dx half-way there is D (1 - D / 2)^-1.
        const double d_xx = dt * gradient.xx[k], d_yy = dt * gradient.yy[k];
        const double d_xy = dt * gradient.xy[k], d_yx = dt * gradient.yx[k];
        const double trace = d_xx + d_yy, determinant = d_xx * d_yy - d_xy * d_yx;
        const double end = 1 - trace + determinant, half_way = 1 - 0.5 * trace + 0.25 * determinant;
        const double both = 1 / (end * half_way), to_middle = both * end;
        const double e_xx = to_middle * (d_xx - 0.5 * determinant), e_yy = to_middle * (d_yy - 0.5 * determinant);
        const double g_xy = to_middle * d_xy, g_yx = to_middle * d_yx;
        const double half_angle = 0.25 * (g_yx - g_xy);
        const double scale = 1 / (1 + half_angle * half_angle);
        const double cosine = (1 - half_angle * half_angle) * scale, sine = 2 * half_angle * scale;
        const double middle = 0.5 * (xx[k] + yy[k]), half = 0.5 * (xx[k] - yy[k]);
        const double cosine_2 = cosine * cosine - sine * sine, sine_2 = 2 * sine * cosine;
        const double turned = half * cosine_2 - xy[k] * sine_2;
        const double pressure = block.lame[k] * (e_xx + e_yy), twice = 2 * block.shear[k];
        xx[k] = middle + turned + pressure + twice * e_xx;
        yy[k] = middle - turned + pressure + twice * e_yy;
        zz[k] += pressure;
        xy[k] = half * sine_2 + xy[k] * cosine_2 + block.shear[k] * (g_xy + g_yx);
        volume[k] *= both * half_way;
    }
}

void return_stresses(FreePoints& points, size_t first, size_t count, MaterialBlock& __restrict block) {
    if (return_to_main_plane(points, first, count, block)) return_unfinished(points, first, count, block);
}

}  // namespace talus
