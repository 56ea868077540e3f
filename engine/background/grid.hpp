// The Cartesian background of large motion: quadratic B-splines, one node at the middle of every cell.
//
// A point in a cell sees the nodes of that cell and of the eight around it. A wall lies on an edge between two cells, so that
// the nodes on both its sides mirror each other and a velocity that is zero on the wall is represented exactly.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace talus {

/// Nodes are numbered row by row from the lower left one.
struct Grid {
    double cell_size = 1;            ///< m
    std::array<double, 2> corner{};  ///< lower left corner of the lower left cell, m
    std::array<int32_t, 2> cells{};  ///< along x, along y

    [[nodiscard]] size_t nodes() const { return static_cast<size_t>(cells[0]) * static_cast<size_t>(cells[1]); }
    /// Column or row of the cell that a coordinate (m, not below the corner) lies in.
    [[nodiscard]] int32_t cell_of(double coordinate, size_t axis) const {
        return static_cast<int32_t>((coordinate - corner[axis]) * (1 / cell_size));
    }
};

/// Points are handled in blocks, so that what is done to each of them alone is vectorised.
inline constexpr size_t block_size = 32;

using BlockValues = std::array<double, block_size>;

/// The quadratic B-splines of a block of points, along each axis: N, and dN/dx in 1/m, of the three nodes from the lower left one.
struct SplineBlock {
    std::array<BlockValues, 3> value_x, value_y, slope_x, slope_y;
    BlockValues offset_x, offset_y;         ///< of the point from the middle node, in cells
    std::array<int32_t, block_size> first;  ///< number of the lower left node

    /// Of `count` points. Each lies at least one cell inside the grid's edge.
    void find(const Grid& grid, const double* x, const double* y, size_t count);
};

inline void SplineBlock::find(const Grid& grid, const double* x, const double* y, size_t count) {
    const double per_metre = 1 / grid.cell_size;
    const int32_t stride = grid.cells[0];
    const auto along = [per_metre](double place, std::array<BlockValues, 3>& value, std::array<BlockValues, 3>& slope,
                                   BlockValues& offset, size_t k) {
        const auto cell = static_cast<int32_t>(place);
        const double from_middle = place - static_cast<double>(cell) - 0.5;
        const double before = 0.5 - from_middle, after = 0.5 + from_middle;
        value[0][k] = 0.5 * before * before;
        value[1][k] = 0.75 - from_middle * from_middle;
        value[2][k] = 0.5 * after * after;
        slope[0][k] = -before * per_metre;
        slope[1][k] = -2 * from_middle * per_metre;
        slope[2][k] = after * per_metre;
        offset[k] = from_middle;
        return cell;
    };
    for (size_t k = 0; k < count; ++k) {
        const int32_t column = along((x[k] - grid.corner[0]) * per_metre, value_x, slope_x, offset_x, k);
        const int32_t row = along((y[k] - grid.corner[1]) * per_metre, value_y, slope_y, offset_y, k);
        first[k] = (row - 1) * stride + column - 1;
    }
}

}  // namespace talus
