// The stress of the material points under a displacement increment, and the nodal forces that it makes.
// The points' stress, strain and plastic strain are a trial state until keep(); revert() goes back bit for bit.
#pragma once

#include "materials/solid/mohr_coulomb.hpp"
#include "motion/cell_kinematics.hpp"
#include "motion/loads.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace talus {

class Skeleton {
public:
    /// `solids`: one a soil. The points' tensors must be sized; their values are the accepted state.
    Skeleton(const CellKinematics& kinematics, Points& points, std::vector<Solid> solids);

    /// The strength that the next responses obey, one a point; may be empty where no soil is mohr_coulomb.
    void set_strength(std::span<const ShearStrength> strength);

    /// Stresses and tangents of the increment (nodes x dimension, m) from the accepted state; adds the nodal forces that
    /// balance them, integral of B^T stress, to `force`. Returns the number of points that yield.
    int32_t respond(std::span<const double> increment, std::span<double> force);

    /// How the stress of the points that yield changes with their strength, at the strain of the last response.
    void linearise_strength(std::span<const double> increment);

    /// Adds to `force` what another strength than the last response's adds to its nodal forces, to first order; after linearise_strength().
    void add_strength_force(std::span<const ShearStrength> strength, std::span<double> force);

    /// The same as respond() for a skeleton that does not yield: the predictor.
    void respond_elastically(std::span<const double> increment, std::span<double> force);

    /// Completes the trial state: strain and mobilised strength.
    void complete(std::span<const double> increment);

    /// The trial state becomes the accepted one, on the same geometry.
    void keep();

    /// The accepted state again, turned by the increment's rotation and strained by its objective strain (Hughes & Winget, Int.
    /// J. Numer. Methods Eng. 15, 1980): what the trial state is on the geometry that the increment leads to. Where that is more than the
    /// ground bears, the trial state, turned.
    void keep_moved(std::span<const double> increment);

    /// Back to the accepted state.
    void revert();

    /// d stress / d strain of a point's last response, Pa.
    [[nodiscard]] Eigen::Matrix4d tangent(size_t point) const {
        return yields_[point] ? Eigen::Matrix4d(Eigen::Map<const Eigen::Matrix4d>(tangent_.data() + 16 * point))
                              : elastic_tangent_[static_cast<size_t>(points_.soil[point])];
    }
    [[nodiscard]] const Eigen::Matrix4d& elastic_tangent(int32_t soil) const {
        return elastic_tangent_[static_cast<size_t>(soil)];
    }
    [[nodiscard]] bool yields(size_t point) const { return yields_[point] != 0; }

    /// Increment of the equivalent plastic shear strain since the accepted state, -.
    [[nodiscard]] double plastic_increment(size_t point) const {
        return points_.plastic_strain[point] - accepted_.plastic_strain[point];
    }

    /// Least local factor of safety of the points' present stress; infinite where no soil is mohr_coulomb.
    [[nodiscard]] double least_factor_of_safety() const;

    /// Largest over smallest Young's modulus of the soils that there are.
    [[nodiscard]] double stiffness_contrast() const;

private:
    struct State {
        std::vector<double> stress, strain, plastic_strain, mobilised_strength;
    };

    bool is_elastic(int32_t soil) const { return solids_[static_cast<size_t>(soil)].model == SolidModel::elastic; }
    template <class Use>
    void for_each_trial(std::span<const double> increment, const CellBlock& block, const Use& use) const;
    void add_force(std::span<const double> stress, const CellBlock& block, std::span<double> force) const;

    const CellKinematics& kinematics_;
    Points& points_;
    std::vector<Solid> solids_;
    std::vector<Elasticity> elasticity_;            // one a soil
    std::vector<Eigen::Matrix4d> elastic_tangent_;  // one a soil
    std::vector<ShearStrength> shear_strength_;     // one a point, as given
    std::vector<MohrCoulomb> strength_;             // one a point
    std::vector<double> tangent_;                   // points x 16, where the point yields
    std::vector<double> strength_slope_;            // points x 8: of the stress by cohesion, by friction angle
    std::vector<double> stress_change_;             // points x 4, Pa
    std::vector<uint8_t> yields_;
    State accepted_;
};

}  // namespace talus
