// Material points that move through a Cartesian background. Structure of arrays; a field that the scene's physics does not name
// stays empty.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace talus {

/// Tensors are tension positive.
enum PointField : size_t {
    position_x,  ///< m
    position_y,
    velocity_x,  ///< of the solid, m/s
    velocity_y,
    affine_xx,  ///< velocity's own gradient about the point, which the transfer keeps (Jiang et al. 2015), 1/s
    affine_xy,
    affine_yx,
    affine_yy,
    stress_xx,  ///< net (or effective) stress, Pa
    stress_yy,
    stress_zz,
    stress_xy,
    point_volume,  ///< m3 per metre of thickness
    solid_mass,    ///< kg per metre of thickness
    plastic_shear_strain,
    dry_fields,               ///< so many has a dry ground
    water_mass = dry_fields,  ///< of the liquid, kg per metre of thickness
    water_due,                ///< that flows to the point in the step to come, kg
    liquid_velocity_x,        ///< m/s
    liquid_velocity_y,
    liquid_affine_xx,  ///< as the solid's, 1/s
    liquid_affine_xy,
    liquid_affine_yx,
    liquid_affine_yy,
    wet_fields,             ///< so many has a ground whose gas is at rest
    gas_mass = wet_fields,  ///< kg per metre of thickness
    gas_due,                ///< as the water's
    gas_velocity_x,         ///< m/s
    gas_velocity_y,
    gas_affine_xx,  ///< as the solid's, 1/s
    gas_affine_xy,
    gas_affine_yx,
    gas_affine_yy,
    gas_fields,                ///< so many has a ground whose gas moves
    vapour_mass = gas_fields,  ///< of the gas's mass, kg per metre of thickness
    vapour_due,                ///< as the water's
    dissolved_mass,            ///< air, of the liquid's mass, kg per metre of thickness
    dissolved_due,             ///< as the water's
    point_fields               ///< so many has a ground whose fluids exchange water and air
};

struct FreePoints {
    size_t count = 0;
    std::array<std::vector<double>, point_fields> field;
    std::vector<int32_t> soil;    ///< index into Scene::soils
    std::vector<int32_t> number;  ///< the point's own, kept when points are arranged anew
    std::vector<int32_t> quiet;   ///< substeps for which it has been slow; empty: not counted

    /// So many points with the first of the fields, all zero.
    void assign(size_t points, size_t fields);

    double* operator[](PointField name) { return field[name].data(); }
    const double* operator[](PointField name) const { return field[name].data(); }

    /// The least value of a field; 0 where there is no point.
    [[nodiscard]] double least(PointField name) const;

    /// Bytes that one point holds.
    [[nodiscard]] size_t bytes_a_point() const;

    /// Puts the points into the given order, the one now at order[k] to k; one that it leaves out is none any more.
    void arrange(const std::vector<int32_t>& order);

private:
    std::vector<double> old_values_;
    std::vector<int32_t> old_numbers_;
};

}  // namespace talus
