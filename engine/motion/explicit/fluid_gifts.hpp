// What points add to the nodes' sums of their fluids.
#pragma once

#include "motion/explicit/transfer.hpp"

namespace talus {

/// With the splines' slopes along x, along y, along x, along y, and with their value.
struct FluidGift {
    Quad slope = Quad::Zero(), value = Quad::Zero();
};
using FluidGiftBlock = std::array<FluidGift, block_size>;

/// Relative permeabilities where hardly any of a fluid is left, so that nodes may divide by them.
inline constexpr double least_liquid_permeability = 1e-30, least_gas_permeability = 1e-9;

inline void fill_gifts(size_t count, const double* y, const double* volume, const double* mass, double unit_weight,
                       const BlockValues& pressure, const BlockValues& flow_mean, const BlockValues& edge_mean,
                       FluidGiftBlock& gift) {
    for (size_t k = 0; k < count; ++k) {
        const double whole = pressure[k] + unit_weight * y[k];
        const double push = volume[k] * whole;
        gift[k].slope[0] = gift[k].slope[1] = push;
        gift[k].slope[2] = gift[k].slope[3] = volume[k];
        gift[k].value[0] = mass[k] * whole;
        gift[k].value[1] = mass[k] * flow_mean[k];
        gift[k].value[2] = volume[k];
        gift[k].value[3] = mass[k] * edge_mean[k];
    }
}

/// `gradients`: four numbers a node.
inline void scatter_gradients(const Grid& grid, size_t count, const SplineBlock& spline, const FluidGiftBlock& gift,
                              double* gradients) {
    NodePatch<Quad, true> patch(gradients, grid, spline.first[0]);
    for (size_t k = 0; k < count; ++k) {
        patch.move_to(spline.first[k]);
        const SlopeWeights weight(spline, k);
        for (size_t j = 0; j < 3; ++j) {
            const Quad row = weight.of_row[j] * gift[k].slope;
            for (size_t i = 0; i < 3; ++i) patch.node[j][i] += weight.of_column[i] * row;
        }
    }
}

/// What tells nodes how a linear field presses on them: `moments` four numbers a node, `places` two.
inline void scatter_moments(const Grid& grid, size_t count, const SplineBlock& spline, const double* volume,
                            const double* mass, double* moments, double* places) {
    NodePatch<Quad, true> moment(moments, grid, spline.first[0]);
    NodePatch<Pair, true> place(places, grid, spline.first[0]);
    for (size_t k = 0; k < count; ++k) {
        moment.move_to(spline.first[k]);
        place.move_to(spline.first[k]);
        for (size_t j = 0; j < 3; ++j) {
            const double y = (spline.offset_y[k] + 1 - static_cast<double>(j)) * grid.cell_size;
            const double value_y = spline.value_y[j][k], slope_y = spline.slope_y[j][k];
            const Quad row = volume[k] * Quad(value_y, y * slope_y, y * value_y, slope_y);
            const Pair mass_row = mass[k] * Pair(value_y, y * value_y);
            for (size_t i = 0; i < 3; ++i) {
                const double x = (spline.offset_x[k] + 1 - static_cast<double>(i)) * grid.cell_size;
                const double value_x = spline.value_x[i][k], slope_x = spline.slope_x[i][k];
                moment.node[j][i] += row * Quad(x * slope_x, value_x, slope_x, x * value_x);
                place.node[j][i] += mass_row * Pair(x * value_x, value_x);
            }
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
