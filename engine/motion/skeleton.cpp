#include "motion/skeleton.hpp"

#include <Eigen/LU>

#include <limits>

namespace talus {

namespace {

using Eigen::Map;
using Eigen::Matrix2d;
using Eigen::Matrix4d;
using Eigen::Vector4d;

/// Adds the nodal forces of one cell's stresses: the transpose of strain_increment().
template <class Shape>
void add_cell_force(const CellKinematics& kinematics, const Points& points, int32_t cell, std::span<double> force) {
    const auto stencil = kinematics.stencil(cell);
    const auto first = static_cast<size_t>(points.cell_start[static_cast<size_t>(cell)]);
    typename Shape::Gradients nodal{};
    double pressure = 0;  // integral of the mean stress
    for (size_t i = 0; i < Shape::points; ++i) {
        const double volume = points.volume[first + i];
        const Map<const Vector4d> s(points.skeleton_stress.data() + 4 * (first + i));
        const auto g = kinematics.gradient<Shape>(cell, i);
        if constexpr (Shape::dimension == 1) {
            for (size_t a = 0; a < Shape::nodes; ++a) nodal[a][0] += volume * s[1] * g[a][0];
        } else {
            const double mean = (s[0] + s[1] + s[2]) / 3;
            pressure += volume * mean;
            const double xx = volume * (s[0] - mean), yy = volume * (s[1] - mean), xy = volume * s[3];
            for (size_t a = 0; a < Shape::nodes; ++a) {
                nodal[a][0] += xx * g[a][0] + xy * g[a][1];
                nodal[a][1] += xy * g[a][0] + yy * g[a][1];
            }
        }
    }
    for (size_t a = 0; a < Shape::nodes; ++a) {
        for (size_t k = 0; k < Shape::dimension; ++k)
            force[static_cast<size_t>(stencil[a]) * Shape::dimension + k] += nodal[a][k];
    }
    if constexpr (Shape::dimension == 2) {
        const auto b = kinematics.dilatation(cell);
        for (size_t a = 0; a < stencil.size(); ++a) {
            force[2 * static_cast<size_t>(stencil[a])] += pressure * b[2 * a];
            force[2 * static_cast<size_t>(stencil[a]) + 1] += pressure * b[2 * a + 1];
        }
    }
}

Matrix2d plane(const Vector4d& tensor, double shear_factor) {
    Matrix2d matrix;
    matrix << tensor[0], shear_factor * tensor[3], shear_factor * tensor[3], tensor[1];
    return matrix;
}

/// Q tensor Q^T; `shear_factor` is 1 for stress and 1/2 for strain, whose xy entry is the angle.
Vector4d turned(const Vector4d& tensor, const Matrix2d& rotation, double shear_factor) {
    const Matrix2d matrix = rotation * plane(tensor, shear_factor) * rotation.transpose();
    return {matrix(0, 0), matrix(1, 1), tensor[2], matrix(0, 1) / shear_factor};
}

}  // namespace

Skeleton::Skeleton(const CellKinematics& kinematics, Points& points, std::vector<Solid> solids)
    : kinematics_(kinematics), points_(points), solids_(std::move(solids)) {
    for (const Solid& solid : solids_) {
        elasticity_.push_back(elasticity(solid.young_modulus, solid.poisson_ratio));
        elastic_tangent_.push_back(elastic_stiffness(elasticity_.back()));
    }
    const auto count = static_cast<size_t>(points.count);
    yields_.assign(count, 0);
    for (const CellBlock& block : kinematics.blocks()) {
        if (is_elastic(block.soil)) continue;
        strength_.resize(count);
        tangent_.resize(16 * count);
    }
    keep();
}

void Skeleton::set_strength(std::span<const ShearStrength> strength) {
    for (size_t p = 0; p < strength_.size(); ++p) {
        const Solid& solid = solids_[static_cast<size_t>(points_.soil[p])];
        if (solid.model == SolidModel::elastic) continue;
        strength_[p] = mohr_coulomb(strength[p], solid.dilation_angle, solid.tensile_strength);
    }
}

template <class Law>
void Skeleton::respond_with(std::span<const double> increment, std::span<double> force, const CellBlock& block,
                            const Law& law) {
    const Matrix4d& elastic = elastic_tangent(block.soil);
    with_shape(block.nodes, [&](auto shape) {
        using Shape = decltype(shape);
        for (const int32_t c : block.cells) {
            const auto first = static_cast<size_t>(points_.cell_start[static_cast<size_t>(c)]);
            const auto u = gather_increment<Shape>(kinematics_.stencil(c), increment.data());
            const double dilatation = mean_dilatation<Shape>(kinematics_, c, increment.data());
            for (size_t i = 0; i < Shape::points; ++i) {
                const size_t p = first + i;
                const auto gradient = displacement_gradient<Shape>(kinematics_.gradient<Shape>(c, i), u);
                const Vector4d trial = Map<const Vector4d>(accepted_.stress.data() + 4 * p) +
                                       elastic * strain_increment<Shape>(gradient, dilatation);
                Map<Vector4d>(points_.skeleton_stress.data() + 4 * p) = law(p, trial);
            }
            add_cell_force<Shape>(kinematics_, points_, c, force);
        }
    });
}

int32_t Skeleton::respond(std::span<const double> increment, std::span<double> force) {
    int32_t yielding = 0;
    for (const CellBlock& block : kinematics_.blocks()) {
        if (is_elastic(block.soil)) {
            respond_with(increment, force, block, [](size_t, const Vector4d& trial) { return trial; });
            continue;
        }
        const Elasticity& elastic = elasticity_[static_cast<size_t>(block.soil)];
        respond_with(increment, force, block, [&](size_t p, const Vector4d& trial) -> Vector4d {
            points_.plastic_strain[p] = accepted_.plastic_strain[p];
            yields_[p] = is_admissible(strength_[p], trial) ? 0 : 1;
            if (yields_[p] == 0) return trial;
            Matrix4d tangent;
            const PlasticReturn plastic = return_to_yield_surface(elastic, strength_[p], trial, &tangent);
            Map<Matrix4d>(tangent_.data() + 16 * p) = tangent;
            points_.plastic_strain[p] += plastic.plastic_shear_strain;
            ++yielding;
            return plastic.stress;
        });
    }
    return yielding;
}

void Skeleton::respond_elastically(std::span<const double> increment, std::span<double> force) {
    for (const CellBlock& block : kinematics_.blocks()) {
        respond_with(increment, force, block, [](size_t, const Vector4d& trial) { return trial; });
    }
}

void Skeleton::complete(std::span<const double> increment) {
    for_each_block(kinematics_.blocks(), [&](auto shape, const CellBlock& block) {
        using Shape = decltype(shape);
        const bool elastic = is_elastic(block.soil);
        for (const int32_t c : block.cells) {
            const auto first = static_cast<size_t>(points_.cell_start[static_cast<size_t>(c)]);
            const auto u = gather_increment<Shape>(kinematics_.stencil(c), increment.data());
            const double dilatation = mean_dilatation<Shape>(kinematics_, c, increment.data());
            for (size_t i = 0; i < Shape::points; ++i) {
                const size_t p = first + i;
                const auto gradient = displacement_gradient<Shape>(kinematics_.gradient<Shape>(c, i), u);
                Map<Vector4d>(points_.strain.data() + 4 * p) = Map<const Vector4d>(accepted_.strain.data() + 4 * p) +
                                                               strain_increment<Shape>(gradient, dilatation);
                const Map<const Vector4d> stress(points_.skeleton_stress.data() + 4 * p);
                points_.mobilised_strength[p] = elastic ? 0 : mobilised_strength(strength_[p], stress);
            }
        }
    });
}

void Skeleton::keep() {
    accepted_ = {points_.skeleton_stress, points_.strain, points_.plastic_strain, points_.mobilised_strength};
}

void Skeleton::keep_moved(std::span<const double> increment) {
    for_each_block(kinematics_.blocks(), [&](auto shape, const CellBlock& block) {
        using Shape = decltype(shape);
        const bool elastic = is_elastic(block.soil);
        const Matrix4d& stiffness = elastic_tangent(block.soil);
        const Elasticity& moduli = elasticity_[static_cast<size_t>(block.soil)];
        for (const int32_t c : block.cells) {
            const auto first = static_cast<size_t>(points_.cell_start[static_cast<size_t>(c)]);
            const auto u = gather_increment<Shape>(kinematics_.stencil(c), increment.data());
            const double dilatation = mean_dilatation<Shape>(kinematics_, c, increment.data());
            for (size_t i = 0; i < Shape::points; ++i) {
                const size_t p = first + i;
                const Matrix2d g = displacement_gradient<Shape>(kinematics_.gradient<Shape>(c, i), u);
                const Matrix2d middle = g * (Matrix2d::Identity() + g / 2).inverse();  // du/dx at x + u/2
                const Matrix2d half_spin = (middle - middle.transpose()) / 4;
                const Matrix2d rotation =
                    (Matrix2d::Identity() - half_spin).inverse() * (Matrix2d::Identity() + half_spin);
                const Matrix2d difference = middle - g;
                Vector4d strain = strain_increment<Shape>(g, dilatation);
                strain += Vector4d(difference(0, 0), difference(1, 1), 0, difference(0, 1) + difference(1, 0));

                const Vector4d stress = turned(Map<const Vector4d>(accepted_.stress.data() + 4 * p), rotation, 1);
                const Vector4d trial = stress + stiffness * strain;
                Map<Vector4d>(points_.strain.data() + 4 * p) =
                    turned(Map<const Vector4d>(accepted_.strain.data() + 4 * p), rotation, 0.5) + strain;
                Map<Vector4d> moved(points_.skeleton_stress.data() + 4 * p);
                if (elastic) {
                    moved = trial;
                    continue;
                }
                Matrix4d tangent;
                const PlasticReturn plastic = return_stress(moduli, strength_[p], trial, tangent);
                moved = plastic.stress;
                points_.plastic_strain[p] = accepted_.plastic_strain[p] + plastic.plastic_shear_strain;
                points_.mobilised_strength[p] = mobilised_strength(strength_[p], plastic.stress);
            }
        }
    });
    keep();
}

void Skeleton::revert() {
    points_.skeleton_stress = accepted_.stress;
    points_.strain = accepted_.strain;
    points_.plastic_strain = accepted_.plastic_strain;
    points_.mobilised_strength = accepted_.mobilised_strength;
}

double Skeleton::least_factor_of_safety() const {
    double least = std::numeric_limits<double>::infinity();
    for (const CellBlock& block : kinematics_.blocks()) {
        if (is_elastic(block.soil)) continue;
        for (const int32_t c : block.cells) {
            const auto last = static_cast<size_t>(points_.cell_start[static_cast<size_t>(c) + 1]);
            for (auto p = static_cast<size_t>(points_.cell_start[static_cast<size_t>(c)]); p < last; ++p) {
                const Map<const Vector4d> stress(points_.skeleton_stress.data() + 4 * p);
                least = std::min(least, factor_of_safety(strength_[p], stress));
            }
        }
    }
    return least;
}

double Skeleton::stiffness_contrast() const {
    double softest = std::numeric_limits<double>::infinity();
    double stiffest = 0;
    for (const CellBlock& block : kinematics_.blocks()) {
        const double modulus = solids_[static_cast<size_t>(block.soil)].young_modulus;
        softest = std::min(softest, modulus);
        stiffest = std::max(stiffest, modulus);
    }
    return stiffest / softest;
}

}  // namespace talus
