#include "motion/skeleton.hpp"

#include <Eigen/LU>

#include <limits>

namespace talus {

namespace {

using Eigen::Map;
using Eigen::Matrix2d;
using Eigen::Matrix4d;
using Eigen::Vector4d;

/// Adds the nodal forces of one cell's stresses (points x 4, Pa): the transpose of strain_increment().
template <class Shape>
void add_cell_force(const CellKinematics& kinematics, const Points& points, std::span<const double> stress,
                    int32_t cell, std::span<double> force) {
    const auto stencil = kinematics.stencil(cell);
    const auto first = static_cast<size_t>(points.cell_start[static_cast<size_t>(cell)]);
    typename Shape::Gradients nodal{};
    double pressure = 0;  // integral of the mean stress
    for (size_t i = 0; i < Shape::points; ++i) {
        const double volume = points.volume[first + i];
        const Map<const Vector4d> s(stress.data() + 4 * (first + i));
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
    shear_strength_.assign(strength.begin(), strength.end());
    for (size_t p = 0; p < strength_.size(); ++p) {
        const Solid& solid = solids_[static_cast<size_t>(points_.soil[p])];
        if (solid.model == SolidModel::elastic) continue;
        strength_[p] = mohr_coulomb(strength[p], solid.dilation_angle, solid.tensile_strength);
    }
}

/// Calls `use(point, stress)` for the points of a block, with the stress that each would have if it did not yield.
template <class Use>
void Skeleton::for_each_trial(std::span<const double> increment, const CellBlock& block, const Use& use) const {
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
                use(p, trial);
            }
        }
    });
}

/// Adds the nodal forces that balance stresses (points x 4, Pa) in a block.
void Skeleton::add_force(std::span<const double> stress, const CellBlock& block, std::span<double> force) const {
    with_shape(block.nodes, [&](auto shape) {
        for (const int32_t c : block.cells) add_cell_force<decltype(shape)>(kinematics_, points_, stress, c, force);
    });
}

int32_t Skeleton::respond(std::span<const double> increment, std::span<double> force) {
    int32_t yielding = 0;
    const auto stress_of = [&](size_t p) { return Map<Vector4d>(points_.skeleton_stress.data() + 4 * p); };
    for (const CellBlock& block : kinematics_.blocks()) {
        if (is_elastic(block.soil)) {
            for_each_trial(increment, block, [&](size_t p, const Vector4d& trial) { stress_of(p) = trial; });
        } else {
            const Elasticity& elastic = elasticity_[static_cast<size_t>(block.soil)];
            for_each_trial(increment, block, [&](size_t p, const Vector4d& trial) {
                points_.plastic_strain[p] = accepted_.plastic_strain[p];
                stress_of(p) = trial;
                yields_[p] = is_admissible(strength_[p], trial) ? 0 : 1;
                if (yields_[p] == 0) return;
                Matrix4d tangent;
                const PlasticReturn plastic = return_to_yield_surface(elastic, strength_[p], trial, &tangent);
                Map<Matrix4d>(tangent_.data() + 16 * p) = tangent;
                points_.plastic_strain[p] += plastic.plastic_shear_strain;
                stress_of(p) = plastic.stress;
                ++yielding;
            });
        }
        add_force(points_.skeleton_stress, block, force);
    }
    return yielding;
}

void Skeleton::linearise_strength(std::span<const double> increment) {
    constexpr double share = 1e-6;  // of the trial stress, to which the returned one is linear in the cohesion
    constexpr double turn = 1e-4;   // degrees
    strength_slope_.assign(8 * yields_.size(), 0.0);
    for (const CellBlock& block : kinematics_.blocks()) {
        if (is_elastic(block.soil)) continue;
        const Elasticity& elastic = elasticity_[static_cast<size_t>(block.soil)];
        const Solid& solid = solids_[static_cast<size_t>(block.soil)];
        for_each_trial(increment, block, [&](size_t p, const Vector4d& trial) {
            if (yields_[p] == 0) return;
            const auto slope = [&](double cohesion, double friction_angle) -> Vector4d {
                const ShearStrength more{shear_strength_[p].cohesion + cohesion,
                                         shear_strength_[p].friction_angle + friction_angle};
                const MohrCoulomb stronger = mohr_coulomb(more, solid.dilation_angle, solid.tensile_strength);
                const Vector4d stress = return_stress(elastic, stronger, trial, nullptr).stress;
                return (stress - Map<const Vector4d>(points_.skeleton_stress.data() + 4 * p)) /
                       (cohesion + friction_angle);
            };
            Map<Vector4d>(strength_slope_.data() + 8 * p) = slope(share * trial.cwiseAbs().maxCoeff(), 0);
            Map<Vector4d>(strength_slope_.data() + 8 * p + 4) = slope(0, turn);
        });
    }
}

void Skeleton::add_strength_force(std::span<const ShearStrength> strength, std::span<double> force) {
    stress_change_.assign(4 * yields_.size(), 0.0);
    for (size_t p = 0; p < shear_strength_.size(); ++p) {
        const double* slope = strength_slope_.data() + 8 * p;
        const double cohesion = strength[p].cohesion - shear_strength_[p].cohesion;
        const double friction_angle = strength[p].friction_angle - shear_strength_[p].friction_angle;
        for (size_t k = 0; k < 4; ++k) stress_change_[4 * p + k] = cohesion * slope[k] + friction_angle * slope[4 + k];
    }
    for (const CellBlock& block : kinematics_.blocks())
        if (!is_elastic(block.soil)) add_force(stress_change_, block, force);
}

void Skeleton::respond_elastically(std::span<const double> increment, std::span<double> force) {
    for (const CellBlock& block : kinematics_.blocks()) {
        for_each_trial(increment, block, [&](size_t p, const Vector4d& trial) {
            Map<Vector4d>(points_.skeleton_stress.data() + 4 * p) = trial;
        });
        add_force(points_.skeleton_stress, block, force);
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
                // What a turn w strains linearly, w^2 / 2, may be far more than stiff ground bears: there it is plastic, and the balance stands.
                const Vector4d balanced = turned(moved, rotation, 1);
                moved = is_admissible(strength_[p], trial) ? trial : balanced;
                points_.mobilised_strength[p] = mobilised_strength(strength_[p], moved);
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
