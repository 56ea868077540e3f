#include "motion/stability.hpp"

#include <Eigen/SparseCholesky>

namespace talus {

namespace {

using Eigen::Matrix2d;
using Eigen::Matrix4d;
using Eigen::Vector4d;

/// What a stress does, to second order, on a displacement gradient L (xx, xy, yx, yy), with Jaumann's rate of the Cauchy stress:
/// s : (L^T L) of the turned forces, less 2 s : (e e) of the turned stress, plus (s : e) tr e of the changed volume.
double work_of(const Matrix2d& stress, const Vector4d& gradient) {
    Matrix2d l;
    l << gradient[0], gradient[1], gradient[2], gradient[3];
    const Matrix2d strain = (l + l.transpose()) / 2;
    return (stress * l.transpose() * l).trace() - 2 * (stress * strain * strain).trace() +
           (stress * strain).trace() * strain.trace();
}

/// Its symmetric matrix.
Matrix4d form_of(const Matrix2d& stress) {
    Matrix4d form;
    for (Eigen::Index i = 0; i < 4; ++i) {
        for (Eigen::Index j = 0; j < 4; ++j) {
            const Vector4d a = Vector4d::Unit(i), b = Vector4d::Unit(j);
            form(i, j) = (work_of(stress, a + b) - work_of(stress, a) - work_of(stress, b)) / 2;
        }
    }
    return form;
}

template <class Shape>
void add_cell(const CellKinematics& kinematics, const Points& points, std::span<const double> pore_stress,
              std::span<const int32_t> number, int32_t cell, SparseMatrix& matrix) {
    constexpr auto size = static_cast<Eigen::Index>(2 * Shape::nodes);
    const auto first = static_cast<size_t>(points.cell_start[static_cast<size_t>(cell)]);
    Eigen::Matrix<double, size, size> local = Eigen::Matrix<double, size, size>::Zero();
    for (size_t i = 0; i < Shape::points; ++i) {
        const double* const s = points.skeleton_stress.data() + 4 * (first + i);
        Matrix2d stress;
        stress << s[0] - pore_stress[first + i], s[3], s[3], s[1] - pore_stress[first + i];
        const auto g = kinematics.gradient<Shape>(cell, i);
        Eigen::Matrix<double, 4, size> gradient = Eigen::Matrix<double, 4, size>::Zero();
        for (size_t a = 0; a < Shape::nodes; ++a) {
            const auto column = static_cast<Eigen::Index>(2 * a);
            for (Eigen::Index k = 0; k < 2; ++k)
                gradient(k, column) = gradient(2 + k, column + 1) = g[a][static_cast<size_t>(k)];
        }
        local += points.volume[first + i] * gradient.transpose() * form_of(stress) * gradient;
    }
    const auto nodes = kinematics.stencil(cell);
    const auto equation = [&](Eigen::Index k) {
        return number[2 * static_cast<size_t>(nodes[static_cast<size_t>(k / 2)]) + static_cast<size_t>(k % 2)];
    };
    for (Eigen::Index j = 0; j < size; ++j) {
        for (Eigen::Index i = 0; i < size; ++i) {
            if (equation(i) < 0 || equation(j) < 0) continue;
            matrix.value[static_cast<size_t>(matrix.place(equation(i), equation(j)))] += local(i, j);
        }
    }
}

}  // namespace

bool is_stable(const CellKinematics& kinematics, const Points& points, std::span<const double> pore_stress,
               std::span<const int32_t> number, SparseMatrix stiffness) {
    for_each_block(kinematics.blocks(), [&](auto shape, const CellBlock& block) {
        using Shape = decltype(shape);
        if constexpr (Shape::dimension == 2) {
            for (const int32_t c : block.cells) add_cell<Shape>(kinematics, points, pore_stress, number, c, stiffness);
        }
    });
    using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int32_t>;
    const Eigen::Map<const Matrix> matrix(stiffness.size(), stiffness.size(),
                                          static_cast<Eigen::Index>(stiffness.row.size()),
                                          stiffness.column_start.data(), stiffness.row.data(), stiffness.value.data());
    const Eigen::SimplicialLDLT<Matrix> factors(matrix);
    return factors.info() == Eigen::Success && factors.vectorD().minCoeff() > 0;
}

}  // namespace talus
