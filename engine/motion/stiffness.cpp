#include "motion/stiffness.hpp"

#include "error.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace talus {

namespace {

using Eigen::Dynamic;
using Eigen::Matrix;
using Eigen::Matrix4d;

constexpr size_t most_stencil_nodes = 48;  // on which the strain of one cell depends

/// One column of B: the strain (xx, yy, zz, xy) of a unit displacement along x, then along y, with the mean dilatation b.
void strain_columns(const double* g, const double* b, double* along_x, double* along_y) {
    const double x = (b[0] - g[0]) / 3, y = (b[1] - g[1]) / 3;
    along_x[0] = g[0] + x, along_x[1] = x, along_x[2] = x, along_x[3] = g[1];
    along_y[0] = y, along_y[1] = g[1] + y, along_y[2] = y, along_y[3] = g[0];
}

template <class Local>
void scatter(const Local& local, const int32_t* place, double* value) {
    for (Eigen::Index j = 0; j < local.cols(); ++j) {
        for (Eigen::Index i = 0; i < local.rows(); ++i) value[*place++] += local(i, j);
    }
}

}  // namespace

Equations::Equations(std::span<const uint8_t> prescribed) : number(prescribed.size(), -1) {
    for (size_t i = 0; i < prescribed.size(); ++i) {
        if (prescribed[i] != 0) continue;
        number[i] = count();
        freedom.push_back(static_cast<int32_t>(i));
    }
}

Stiffness::Stiffness(const CellKinematics& kinematics, const Equations& equations, int32_t dimension)
    : kinematics_(kinematics) {
    int32_t cells = 0;
    for (const CellBlock& block : kinematics.blocks()) cells += static_cast<int32_t>(block.cells.size());

    const auto numbers_of = [&](int32_t cell) {
        std::vector<int32_t> numbers;
        if (kinematics.stencil(cell).size() > most_stencil_nodes) {
            throw Error(Status::invalid_scene, "ground: the triangles that meet triangle " + std::to_string(cell) +
                                                   " have " + std::to_string(kinematics.stencil(cell).size()) +
                                                   " nodes; at most " + std::to_string(most_stencil_nodes) +
                                                   " are allowed");
        }
        for (const int32_t node : kinematics.stencil(cell)) {
            for (int32_t k = 0; k < dimension; ++k)
                numbers.push_back(equations.number[static_cast<size_t>(node * dimension + k)]);
        }
        return numbers;
    };
    std::vector<std::array<int32_t, 2>> pairs;
    for (int32_t c = 0; c < cells; ++c) {
        const auto numbers = numbers_of(c);
        for (const int32_t i : numbers) {
            for (const int32_t j : numbers) {
                if (i >= 0 && i < j) pairs.push_back({i, j});
            }
        }
    }
    pattern_ = symmetric_pattern(equations.count(), pairs);
    const auto sink = static_cast<int32_t>(pattern_.row.size());
    pattern_.value.push_back(0.0);
    for (int32_t c = 0; c < cells; ++c) {
        const auto numbers = numbers_of(c);
        place_start_.push_back(place_.size());
        for (const int32_t j : numbers) {
            for (const int32_t i : numbers) place_.push_back(i < 0 || j < 0 ? sink : pattern_.place(i, j));
        }
    }
}

void Stiffness::assemble_elastic(const Points& points, const Skeleton& skeleton, SparseMatrix& matrix) const {
    assemble(points, matrix, [&](size_t p) -> const Matrix4d& { return skeleton.elastic_tangent(points.soil[p]); });
}

void Stiffness::assemble_tangent(const Points& points, const Skeleton& skeleton, double viscosity,
                                 SparseMatrix& matrix) const {
    assemble(points, matrix, [&](size_t p) -> Matrix4d {
        return skeleton.tangent(p) + viscosity * skeleton.elastic_tangent(points.soil[p]);
    });
}

template <class Moduli>
void Stiffness::assemble(const Points& points, SparseMatrix& matrix, const Moduli& moduli) const {
    std::fill(matrix.value.begin(), matrix.value.end(), 0.0);
    double* const value = matrix.value.data();
    for (const CellBlock& block : kinematics_.blocks()) {
        if (block.nodes == 2) {
            for (const int32_t c : block.cells) add_line(points, c, moduli, value);
        } else if (block.nodes == 3) {
            for (const int32_t c : block.cells) add_triangle(points, c, moduli, value);
        } else {
            for (const int32_t c : block.cells) add_quad(points, c, moduli, value);
        }
    }
}

template <class Moduli>
void Stiffness::add_line(const Points& points, int32_t cell, const Moduli& moduli, double* value) const {
    const auto first = static_cast<size_t>(points.cell_start[static_cast<size_t>(cell)]);
    Eigen::Matrix2d local = Eigen::Matrix2d::Zero();
    for (size_t i = 0; i < Line2::points; ++i) {
        const auto g = kinematics_.gradient<Line2>(cell, i);
        const Eigen::Vector2d b(g[0][0], g[1][0]);
        local += points.volume[first + i] * moduli(first + i)(1, 1) * b * b.transpose();
    }
    scatter(local, place_.data() + place_start_[static_cast<size_t>(cell)], value);
}

template <class Moduli>
void Stiffness::add_quad(const Points& points, int32_t cell, const Moduli& moduli, double* value) const {
    const auto first = static_cast<size_t>(points.cell_start[static_cast<size_t>(cell)]);
    const auto dilatation = kinematics_.dilatation(cell);
    Matrix<double, 8, 8> local = Matrix<double, 8, 8>::Zero();
    Matrix<double, 4, 8> b;
    for (size_t i = 0; i < Quad4::points; ++i) {
        const auto g = kinematics_.gradient<Quad4>(cell, i);
        for (size_t a = 0; a < Quad4::nodes; ++a) {
            strain_columns(g[a].data(), dilatation.data() + 2 * a, b.data() + 8 * a, b.data() + 8 * a + 4);
        }
        const Matrix<double, 4, 8> stress = points.volume[first + i] * moduli(first + i) * b;
        local += b.transpose().lazyProduct(stress);
    }
    scatter(local, place_.data() + place_start_[static_cast<size_t>(cell)], value);
}

template <class Moduli>
void Stiffness::add_triangle(const Points& points, int32_t cell, const Moduli& moduli, double* value) const {
    constexpr auto most_columns = static_cast<int>(2 * most_stencil_nodes);
    const auto first = static_cast<size_t>(points.cell_start[static_cast<size_t>(cell)]);
    const auto dilatation = kinematics_.dilatation(cell);
    const auto g = kinematics_.gradient<Tri3>(cell, 0);
    using StrainMatrix = Matrix<double, 4, Dynamic, Eigen::ColMajor, 4, most_columns>;
    StrainMatrix b(4, static_cast<Eigen::Index>(dilatation.size()));
    constexpr std::array<double, 2> none = {0, 0};
    for (size_t a = 0; 2 * a < dilatation.size(); ++a) {
        const double* const own = a < Tri3::nodes ? g[a].data() : none.data();
        strain_columns(own, dilatation.data() + 2 * a, b.data() + 8 * a, b.data() + 8 * a + 4);
    }
    Matrix4d sum = Matrix4d::Zero();  // the three points strain alike
    for (size_t i = 0; i < Tri3::points; ++i) sum += points.volume[first + i] * moduli(first + i);
    const StrainMatrix stress = sum * b;
    const int32_t* place = place_.data() + place_start_[static_cast<size_t>(cell)];
    for (Eigen::Index j = 0; j < b.cols(); ++j) {
        for (Eigen::Index i = 0; i < b.cols(); ++i) value[*place++] += b.col(i).dot(stress.col(j));
    }
}

}  // namespace talus
