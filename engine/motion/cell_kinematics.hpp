// How the motion of the nodes strains the material points, on the accepted geometry.
//
// Linear cells lock when the skeleton keeps its volume, so that the dilatation of a point is replaced by a mean one:
//     strain = deviator(B u) + 1/3 (b . u) identity,
// with b . u the mean dilatation of the cell in quads (B-bar; Hughes, Int. J. Numer. Methods Eng. 15, 1980), and in triangles
// the mean over the cell's nodes of their patches' mean dilatation (after Bonet & Burton, Commun. Numer. Methods Eng. 14, 1998).
// A column strains in yy alone and needs no such mean.
#pragma once

#include "background/shape.hpp"
#include "ground/mesh.hpp"
#include "points/points.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace talus {

/// Cells of one shape and one soil: what one compiled loop runs over.
struct CellBlock {
    int32_t nodes;  ///< of a cell: 2, 3 or 4
    int32_t soil;
    std::vector<int32_t> cells;
};

class CellKinematics {
public:
    CellKinematics(const Mesh& mesh, const Points& points);

    /// Takes over the places of the mesh's nodes and the points' volumes.
    void update(const Mesh& mesh, const Points& points);

    [[nodiscard]] const std::vector<CellBlock>& blocks() const { return blocks_; }

    /// dN/dx of a cell's nodes at its i-th point: nodes x dimension, 1/m.
    template <class Shape>
    [[nodiscard]] typename Shape::Gradients gradient(int32_t cell, size_t i) const {
        constexpr size_t size = Shape::nodes * Shape::dimension;
        typename Shape::Gradients rows;
        std::memcpy(&rows, gradient_.data() + gradient_start_[static_cast<size_t>(cell)] + i * size,
                    size * sizeof(double));
        return rows;
    }

    /// Nodes on which the strain of a cell depends; the cell's own nodes come first.
    [[nodiscard]] std::span<const int32_t> stencil(int32_t cell) const {
        const auto c = static_cast<size_t>(cell);
        return {stencil_.data() + stencil_start_[c], stencil_start_[c + 1] - stencil_start_[c]};
    }

    /// b of the mean dilatation: stencil nodes x 2, 1/m. Not defined in columns.
    [[nodiscard]] std::span<const double> dilatation(int32_t cell) const {
        const auto c = static_cast<size_t>(cell);
        return {dilatation_.data() + 2 * stencil_start_[c], 2 * (stencil_start_[c + 1] - stencil_start_[c])};
    }

private:
    template <class Shape>
    void update_gradients(const Mesh& mesh, const CellBlock& block);
    void update_quad_dilatation(const Points& points, const CellBlock& block);
    void update_triangle_dilatation(const Mesh& mesh, const Points& points);
    void build_patches(const Mesh& mesh);
    void build_stencils(const Mesh& mesh);

    std::vector<CellBlock> blocks_;
    std::vector<size_t> gradient_start_;  // one a cell
    std::vector<double> gradient_;
    std::vector<size_t> stencil_start_;  // cells + 1
    std::vector<int32_t> stencil_;
    std::vector<double> dilatation_;

    // Patches of triangles. A corner is one node of one triangle, 3 cell-wise.
    struct Patches {
        std::vector<int32_t> triangles;    // cells that are triangles
        std::vector<size_t> start;         // nodes + 1 offsets into `node`
        std::vector<int32_t> node;         // the nodes of each node's patch
        std::vector<double> dilatation;    // b of the patch's mean dilatation, x 2
        std::vector<double> volume;        // one a node
        std::vector<int32_t> corner_slot;  // triangles x 3 corners x 3 nodes: place of the node in the corner's patch
        std::vector<int32_t>
            stencil_slot;  // for each triangle, corner and node of its patch: place in the cell's stencil
    } patches_;
};

/// Displacement increments of a cell's nodes, m.
template <class Shape>
typename Shape::Gradients gather_increment(std::span<const int32_t> stencil, const double* increment) {
    typename Shape::Gradients u;
    for (size_t a = 0; a < Shape::nodes; ++a) {
        for (size_t k = 0; k < Shape::dimension; ++k) {
            u[a][k] = increment[static_cast<size_t>(stencil[a]) * Shape::dimension + k];
        }
    }
    return u;
}

/// b . u: the cell's mean dilatation; zero in columns, which have none.
template <class Shape>
double mean_dilatation(const CellKinematics& kinematics, int32_t cell, const double* increment) {
    double sum = 0;
    if constexpr (Shape::dimension == 2) {
        const auto stencil = kinematics.stencil(cell);
        const auto b = kinematics.dilatation(cell);
        for (size_t a = 0; a < stencil.size(); ++a) {
            const double* const u = increment + 2 * static_cast<size_t>(stencil[a]);
            sum += b[2 * a] * u[0] + b[2 * a + 1] * u[1];
        }
    }
    return sum;
}

/// du/dx at a point: row k is the gradient of component k. A column has the yy entry alone.
template <class Shape>
Eigen::Matrix2d displacement_gradient(const typename Shape::Gradients& g, const typename Shape::Gradients& u) {
    Eigen::Matrix2d gradient = Eigen::Matrix2d::Zero();
    if constexpr (Shape::dimension == 1) {
        for (size_t a = 0; a < Shape::nodes; ++a) gradient(1, 1) += u[a][0] * g[a][0];
    } else {
        for (size_t a = 0; a < Shape::nodes; ++a) {
            gradient(0, 0) += u[a][0] * g[a][0];
            gradient(0, 1) += u[a][0] * g[a][1];
            gradient(1, 0) += u[a][1] * g[a][0];
            gradient(1, 1) += u[a][1] * g[a][1];
        }
    }
    return gradient;
}

/// (xx, yy, zz, xy) of a displacement gradient whose dilatation is replaced by the cell's mean one.
template <class Shape>
Eigen::Vector4d strain_increment(const Eigen::Matrix2d& gradient, double mean_dilatation) {
    if constexpr (Shape::dimension == 1) return {0, gradient(1, 1), 0, 0};
    const double third = (mean_dilatation - gradient(0, 0) - gradient(1, 1)) / 3;
    return {gradient(0, 0) + third, gradient(1, 1) + third, third, gradient(0, 1) + gradient(1, 0)};
}

/// Calls `use` with each block and its shape.
template <class Use>
void for_each_block(const std::vector<CellBlock>& blocks, Use&& use) {
    for (const CellBlock& block : blocks) with_shape(block.nodes, [&](auto shape) { use(shape, block); });
}

}  // namespace talus
