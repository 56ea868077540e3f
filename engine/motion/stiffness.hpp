// The stiffness matrix of the free degrees of freedom, on a fixed pattern whose places are found once.
#pragma once

#include "linear/klu_solver.hpp"
#include "motion/cell_kinematics.hpp"
#include "motion/skeleton.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace talus {

/// Numbers of the equations: one a free degree of freedom.
struct Equations {
    std::vector<int32_t> number;   ///< nodes x dimension; -1 where prescribed
    std::vector<int32_t> freedom;  ///< of each equation: its index into nodes x dimension

    /// `prescribed`: nodes x dimension, non-zero where the displacement increment is given.
    explicit Equations(std::span<const uint8_t> prescribed);
    [[nodiscard]] int32_t count() const { return static_cast<int32_t>(freedom.size()); }
};

class Stiffness {
public:
    Stiffness(const CellKinematics& kinematics, const Equations& equations, int32_t dimension);

    /// A matrix with this pattern. Its value has one entry more than the pattern, where prescribed rows and columns go.
    [[nodiscard]] SparseMatrix matrix() const { return pattern_; }

    void assemble_elastic(const Points& points, const Skeleton& skeleton, SparseMatrix& matrix) const;

    /// The consistent tangent, and the elastic stiffness times `viscosity` added to it.
    void assemble_tangent(const Points& points, const Skeleton& skeleton, double viscosity, SparseMatrix& matrix) const;

private:
    template <class Moduli>
    void assemble(const Points& points, SparseMatrix& matrix, const Moduli& moduli) const;
    template <class Moduli>
    void add_line(const Points& points, int32_t cell, const Moduli& moduli, double* value) const;
    template <class Moduli>
    void add_quad(const Points& points, int32_t cell, const Moduli& moduli, double* value) const;
    template <class Moduli>
    void add_triangle(const Points& points, int32_t cell, const Moduli& moduli, double* value) const;

    const CellKinematics& kinematics_;
    SparseMatrix pattern_;
    std::vector<size_t> place_start_;  // one a cell
    std::vector<int32_t> place_;       // of each cell's matrix, column by column
};

}  // namespace talus
