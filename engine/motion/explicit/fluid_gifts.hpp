// What points add to the nodes' sums of their fluids.
#pragma once

#include "motion/explicit/transfer.hpp"

namespace talus {

/// With the splines' slope along x and along y, and with their value.
struct FluidGift {
    Quad along_x = Quad::Zero(), along_y = Quad::Zero(), value = Quad::Zero();
};
using FluidGiftBlock = std::array<FluidGift, block_size>;

/// `gradients`: four numbers a node.
inline void scatter_gradients(const Grid& grid, size_t count, const SplineBlock& spline, const FluidGiftBlock& gift,
                              double* gradients) {
    NodePatch<Quad, true> patch(gradients, grid, spline.first[0]);
    for (size_t k = 0; k < count; ++k) {
        patch.move_to(spline.first[k]);
        for (size_t j = 0; j < 3; ++j) {
            const Quad by_slope = spline.value_y[j][k] * gift[k].along_x,
                       by_value = spline.slope_y[j][k] * gift[k].along_y;
            for (size_t i = 0; i < 3; ++i)
                patch.node[j][i] += spline.slope_x[i][k] * by_slope + spline.value_x[i][k] * by_value;
        }
    }
}

/// `means`: four numbers a node.
inline void scatter_means(const Grid& grid, size_t count, const SplineBlock& spline, const FluidGiftBlock& gift,
                          double* means) {
    NodePatch<Quad, true> patch(means, grid, spline.first[0]);
    for (size_t k = 0; k < count; ++k) {
        patch.move_to(spline.first[k]);
        for (size_t j = 0; j < 3; ++j) {
            const Quad row = spline.value_y[j][k] * gift[k].value;
            for (size_t i = 0; i < 3; ++i) patch.node[j][i] += spline.value_x[i][k] * row;
        }
    }
}

}  // namespace talus
