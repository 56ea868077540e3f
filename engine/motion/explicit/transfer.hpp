// Between a block of points and the nodes of the Cartesian background.
//
// Nodes are handled as registers of two or four numbers; points of one cell follow each other, so that its nodes stay in registers.
#pragma once

#include "background/grid.hpp"
#include "motion/explicit/grid_motion.hpp"
#include "points/free_points.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace talus {

using Single = Eigen::Array<double, 1, 1>;
using Pair = Eigen::Array2d;
using Quad = Eigen::Array4d;

/// The nine nodes that a point sees, held while points of the same cell follow each other.
template <class Value, bool writes>
class NodePatch {
public:
    using Number = std::conditional_t<writes, double, const double>;

    NodePatch(Number* values, const Grid& grid, int32_t first)
        : values_(values), stride_(static_cast<size_t>(grid.cells[0])), first_(first) {
        get();
    }
    ~NodePatch() { put(); }
    NodePatch(const NodePatch&) = delete;
    NodePatch& operator=(const NodePatch&) = delete;

    void move_to(int32_t first) {
        if (first == first_) return;
        put();
        first_ = first;
        get();
    }

    Value node[3][3];

private:
    auto map(size_t j, size_t i) {
        return Eigen::Map<std::conditional_t<writes, Value, const Value>>(
            values_ + Value::SizeAtCompileTime * (static_cast<size_t>(first_) + j * stride_ + i));
    }
    void get() {
        for (size_t j = 0; j < 3; ++j)
            for (size_t i = 0; i < 3; ++i) node[j][i] = map(j, i);
    }
    void put() {
        if constexpr (writes) {
            for (size_t j = 0; j < 3; ++j)
                for (size_t i = 0; i < 3; ++i) map(j, i) = node[j][i];
        }
    }

    Number* values_;
    size_t stride_;
    int32_t first_;
};

/// Weights of the nine nodes of a point whose products are the slopes of the splines, along x, along y, along x, along y.
struct SlopeWeights {
    Quad of_column[3], of_row[3];

    SlopeWeights(const SplineBlock& spline, size_t k) {
        for (size_t i = 0; i < 3; ++i) {
            const double slope_x = spline.slope_x[i][k], value_x = spline.value_x[i][k];
            const double slope_y = spline.slope_y[i][k], value_y = spline.value_y[i][k];
            of_column[i] = Quad(slope_x, value_x, slope_x, value_x);
            of_row[i] = Quad(value_y, slope_y, value_y, slope_y);
        }
    }
};

/// Gradient of a velocity at points, d v_x / d x, d v_x / d y, ..., 1/s.
struct GradientBlock {
    BlockValues xx, xy, yx, yy;
};

inline void gather_gradient(const Grid& grid, const std::vector<NodeVector>& velocity, size_t count,
                            const SplineBlock& spline, GradientBlock& gradient) {
    NodePatch<Pair, false> patch(&velocity.data()->x, grid, spline.first[0]);
    for (size_t k = 0; k < count; ++k) {
        patch.move_to(spline.first[k]);
        Pair along_x = Pair::Zero(), along_y = Pair::Zero();
        for (size_t j = 0; j < 3; ++j) {
            const Pair &v0 = patch.node[j][0], &v1 = patch.node[j][1], &v2 = patch.node[j][2];
            along_x += spline.value_y[j][k] *
                       (spline.slope_x[0][k] * v0 + spline.slope_x[1][k] * v1 + spline.slope_x[2][k] * v2);
            along_y += spline.slope_y[j][k] *
                       (spline.value_x[0][k] * v0 + spline.value_x[1][k] * v1 + spline.value_x[2][k] * v2);
        }
        gradient.xx[k] = along_x[0];
        gradient.yx[k] = along_x[1];
        gradient.xy[k] = along_y[0];
        gradient.yy[k] = along_y[1];
    }
}

/// Forces that balance a stress of the points: -integral of grad N . stress.
inline void scatter_force(const Grid& grid, size_t count, const SplineBlock& spline, const double* volume,
                          const double* xx, const double* yy, const double* xy, std::vector<NodeVector>& force) {
    NodePatch<Pair, true> patch(&force.data()->x, grid, spline.first[0]);
    for (size_t k = 0; k < count; ++k) {
        patch.move_to(spline.first[k]);
        const Pair on_x = -volume[k] * Pair(xx[k], xy[k]), on_y = -volume[k] * Pair(xy[k], yy[k]);
        for (size_t j = 0; j < 3; ++j) {
            const Pair by_slope = spline.value_y[j][k] * on_x, by_value = spline.slope_y[j][k] * on_y;
            for (size_t i = 0; i < 3; ++i)
                patch.node[j][i] += spline.slope_x[i][k] * by_slope + spline.value_x[i][k] * by_value;
        }
    }
}

/// Two components of a field at points.
struct VelocityBlock {
    BlockValues x, y;
};

/// Divergence of a vector field of the nodes at points.
inline void gather_divergence(const Grid& grid, const std::vector<NodeVector>& field, size_t count,
                              const SplineBlock& spline, BlockValues& divergence) {
    NodePatch<Pair, false> patch(&field.data()->x, grid, spline.first[0]);
    for (size_t k = 0; k < count; ++k) {
        patch.move_to(spline.first[k]);
        const SlopeWeights weight(spline, k);
        Pair sum = Pair::Zero();
        for (size_t j = 0; j < 3; ++j) {
            sum += weight.of_row[j].head<2>() * (weight.of_column[0].head<2>() * patch.node[j][0] +
                                                 weight.of_column[1].head<2>() * patch.node[j][1] +
                                                 weight.of_column[2].head<2>() * patch.node[j][2]);
        }
        divergence[k] = sum[0] + sum[1];
    }
}

/// Values of a field of the nodes at points, two components.
inline void gather_values(const Grid& grid, const std::vector<NodeVector>& field, size_t count,
                          const SplineBlock& spline, VelocityBlock& value) {
    NodePatch<Pair, false> patch(&field.data()->x, grid, spline.first[0]);
    for (size_t k = 0; k < count; ++k) {
        patch.move_to(spline.first[k]);
        Pair sum = Pair::Zero();
        for (size_t j = 0; j < 3; ++j) {
            sum += spline.value_y[j][k] *
                   (spline.value_x[0][k] * patch.node[j][0] + spline.value_x[1][k] * patch.node[j][1] +
                    spline.value_x[2][k] * patch.node[j][2]);
        }
        value.x[k] = sum[0];
        value.y[k] = sum[1];
    }
}

/// Two vector fields of the nodes at points: values, and divergences.
inline void gather_pairs(const Grid& grid, const std::vector<NodePairOfVectors>& field, size_t count,
                         const SplineBlock& spline, VelocityBlock& liquid, VelocityBlock& gas) {
    NodePatch<Quad, false> patch(&field.data()->liquid.x, grid, spline.first[0]);
    for (size_t k = 0; k < count; ++k) {
        patch.move_to(spline.first[k]);
        Quad sum = Quad::Zero();
        for (size_t j = 0; j < 3; ++j) {
            sum += spline.value_y[j][k] *
                   (spline.value_x[0][k] * patch.node[j][0] + spline.value_x[1][k] * patch.node[j][1] +
                    spline.value_x[2][k] * patch.node[j][2]);
        }
        liquid.x[k] = sum[0];
        liquid.y[k] = sum[1];
        gas.x[k] = sum[2];
        gas.y[k] = sum[3];
    }
}

inline void gather_divergences(const Grid& grid, const std::vector<NodePairOfVectors>& field, size_t count,
                               const SplineBlock& spline, BlockValues& liquid, BlockValues& gas) {
    NodePatch<Quad, false> patch(&field.data()->liquid.x, grid, spline.first[0]);
    for (size_t k = 0; k < count; ++k) {
        patch.move_to(spline.first[k]);
        const SlopeWeights weight(spline, k);
        Quad sum = Quad::Zero();
        for (size_t j = 0; j < 3; ++j) {
            sum += weight.of_row[j] * (weight.of_column[0] * patch.node[j][0] + weight.of_column[1] * patch.node[j][1] +
                                       weight.of_column[2] * patch.node[j][2]);
        }
        liquid[k] = sum[0] + sum[1];
        gas[k] = sum[2] + sum[3];
    }
}

/// A number of the points, to the nodes' sums.
inline void scatter_value(const Grid& grid, size_t count, const SplineBlock& spline, const BlockValues& value,
                          std::vector<double>& field) {
    NodePatch<Single, true> patch(field.data(), grid, spline.first[0]);
    for (size_t k = 0; k < count; ++k) {
        patch.move_to(spline.first[k]);
        for (size_t j = 0; j < 3; ++j) {
            for (size_t i = 0; i < 3; ++i)
                patch.node[j][i][0] += spline.value_y[j][k] * value[k] * spline.value_x[i][k];
        }
    }
}

/// Two numbers of the points, likewise.
inline void scatter_values(const Grid& grid, size_t count, const SplineBlock& spline, const VelocityBlock& value,
                           std::vector<NodeVector>& field) {
    NodePatch<Pair, true> patch(&field.data()->x, grid, spline.first[0]);
    for (size_t k = 0; k < count; ++k) {
        patch.move_to(spline.first[k]);
        for (size_t j = 0; j < 3; ++j) {
            const Pair row = spline.value_y[j][k] * Pair(value.x[k], value.y[k]);
            for (size_t i = 0; i < 3; ++i) patch.node[j][i] += spline.value_x[i][k] * row;
        }
    }
}

/// What a point gives to the nodes: momentum, mass and one number more, and the momentum's change along x and y over one cell. Numbers are written alone
/// and read by fours, a block later: sooner, the processor would wait for them.
struct Gift {
    void set(double mass, const Pair& velocity, const Pair& change_x, const Pair& change_y) {
        own.head<2>() = mass * velocity;
        own[2] = mass;
        along_x.head<2>() = mass * change_x;
        along_y.head<2>() = mass * change_y;
    }
    Quad own = Quad::Zero(), along_x = Quad::Zero(), along_y = Quad::Zero();
};
using GiftBlock = std::array<Gift, block_size>;

/// Velocity at a point and its change along x and y over one cell (Jiang et al. 2015, ACM Trans. Graph. 34).
template <class Value>
struct AffineVelocity {
    Value mean = Value::Zero(), along_x = Value::Zero(), along_y = Value::Zero();
};

template <class Value>
[[gnu::always_inline]] inline AffineVelocity<Value> affine_velocity(const NodePatch<Value, false>& patch,
                                                                    const SplineBlock& spline, size_t k) {
    constexpr double inverse_moment = 4;  // of the splines' second moment, in cells
    AffineVelocity<Value> at;
    for (size_t j = 0; j < 3; ++j) {
        const Value v0 = spline.value_x[0][k] * patch.node[j][0], v1 = spline.value_x[1][k] * patch.node[j][1],
                    v2 = spline.value_x[2][k] * patch.node[j][2];
        const Value sum = spline.value_y[j][k] * (v0 + v1 + v2);
        at.mean += sum;
        at.along_x += spline.value_y[j][k] * (v2 - v0);
        if (j == 0) at.along_y -= sum;
        if (j == 2) at.along_y += sum;
    }
    at.along_x = inverse_moment * (at.along_x - spline.offset_x[k] * at.mean);
    at.along_y = inverse_moment * (at.along_y - spline.offset_y[k] * at.mean);
    return at;
}

/// The first of a velocity's two fields and of its affine part's four.
struct VelocityFields {
    PointField velocity, affine;
};

inline void keep_velocity(const AffineVelocity<Pair>& at, double per_metre, FreePoints& points, size_t p,
                          VelocityFields fields) {
    points.field[fields.velocity][p] = at.mean[0];
    points.field[fields.velocity + 1][p] = at.mean[1];
    points.field[fields.affine][p] = per_metre * at.along_x[0];
    points.field[fields.affine + 1][p] = per_metre * at.along_y[0];
    points.field[fields.affine + 2][p] = per_metre * at.along_x[1];
    points.field[fields.affine + 3][p] = per_metre * at.along_y[1];
}

/// Takes velocity and its affine part from the nodes, as the gift that the points will give back. The points themselves keep it where `keeps`.
template <bool keeps>
void take_velocity(const Grid& grid, const std::vector<NodeVector>& velocity, FreePoints& points, size_t first,
                   size_t count, const SplineBlock& spline, const double* mass, VelocityFields fields, GiftBlock& gift,
                   VelocityBlock& taken) {
    const double per_metre = 1 / grid.cell_size;
    NodePatch<Pair, false> patch(&velocity.data()->x, grid, spline.first[0]);
    for (size_t k = 0; k < count; ++k) {
        patch.move_to(spline.first[k]);
        const AffineVelocity<Pair> at = affine_velocity(patch, spline, k);
        gift[k].set(mass[k], at.mean, at.along_x, at.along_y);
        taken.x[k] = at.mean[0];
        taken.y[k] = at.mean[1];
        if constexpr (keeps) keep_velocity(at, per_metre, points, first + k, fields);
    }
}

/// The same of two fluids at once.
template <bool keeps>
void take_velocities(const Grid& grid, const std::vector<NodePairOfVectors>& velocity, FreePoints& points, size_t first,
                     size_t count, const SplineBlock& spline, const std::array<const double*, 2>& mass,
                     const std::array<VelocityFields, 2>& fields, const std::array<GiftBlock*, 2>& gift) {
    const double per_metre = 1 / grid.cell_size;
    NodePatch<Quad, false> patch(&velocity.data()->liquid.x, grid, spline.first[0]);
    for (size_t k = 0; k < count; ++k) {
        patch.move_to(spline.first[k]);
        const AffineVelocity<Quad> both = affine_velocity(patch, spline, k);
        const std::array<AffineVelocity<Pair>, 2> at{
            AffineVelocity<Pair>{both.mean.head<2>(), both.along_x.head<2>(), both.along_y.head<2>()},
            AffineVelocity<Pair>{both.mean.tail<2>(), both.along_x.tail<2>(), both.along_y.tail<2>()}};
        for (size_t fluid = 0; fluid < 2; ++fluid) {
            (*gift[fluid])[k].set(mass[fluid][k], at[fluid].mean, at[fluid].along_x, at[fluid].along_y);
            if constexpr (keeps) keep_velocity(at[fluid], per_metre, points, first + k, fields[fluid]);
        }
    }
}

/// Gives mass and momentum, the affine part's too, to the nodes about the points' places.
inline void give_momentum(const Grid& grid, size_t count, const SplineBlock& spline, const GiftBlock& gift,
                          std::vector<NodeMomentum>& momentum) {
    NodePatch<Quad, true> patch(&momentum.data()->x, grid, spline.first[0]);
    for (size_t k = 0; k < count; ++k) {
        patch.move_to(spline.first[k]);
        const Quad &along_x = gift[k].along_x, &along_y = gift[k].along_y;
        // the momentum at the middle node of the lowest row, and its change from node to node
        Quad middle = gift[k].own - spline.offset_x[k] * along_x - (spline.offset_y[k] + 1) * along_y;
        for (size_t j = 0; j < 3; ++j) {
            const Quad share = spline.value_y[j][k] * middle, change = spline.value_y[j][k] * along_x;
            patch.node[j][0] += spline.value_x[0][k] * (share - change);
            patch.node[j][1] += spline.value_x[1][k] * share;
            patch.node[j][2] += spline.value_x[2][k] * (share + change);
            middle += along_y;
        }
    }
}

}  // namespace talus
