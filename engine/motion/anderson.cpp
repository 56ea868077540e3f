#include "motion/anderson.hpp"

#include <Eigen/Cholesky>

#include <algorithm>

namespace talus {

Anderson::Anderson(size_t size) {
    const auto n = static_cast<Eigen::Index>(size);
    moved_.resize(n, depth);
    changed_.resize(n, depth);
    products_.resize(depth, depth);
    last_plain_.resize(n);
    last_taken_.resize(n);
}

void Anderson::restart() {
    used_ = next_ = 0;
    has_last_ = false;
}

void Anderson::accelerate(std::span<double> step) {
    Eigen::Map<Eigen::VectorXd> g(step.data(), static_cast<Eigen::Index>(step.size()));
    if (has_last_) {
        changed_.col(next_) = g - last_plain_;
        moved_.col(next_) = last_taken_;
        used_ = std::min(used_ + 1, depth);
        for (Eigen::Index i = 0; i < used_; ++i) {
            products_(i, next_) = products_(next_, i) = changed_.col(i).dot(changed_.col(next_));
        }
        next_ = (next_ + 1) % depth;
    }
    last_plain_ = g;
    has_last_ = true;
    if (used_ > 0) {
        // Normal equations of min |g - changed * weight|, scaled to a unit diagonal; the ridge keeps nearly parallel columns apart.
        constexpr double ridge = 1e-12;
        using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, depth, depth>;
        using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, depth, 1>;
        const SmallVector scale = products_.diagonal().head(used_).cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
        Small normal = scale.asDiagonal() * products_.topLeftCorner(used_, used_) * scale.asDiagonal();
        normal.diagonal().array() += ridge;
        SmallVector weight = scale.cwiseProduct(changed_.leftCols(used_).transpose() * g);
        weight = scale.cwiseProduct(normal.ldlt().solve(weight));
        g.noalias() -= moved_.leftCols(used_) * weight;
        g.noalias() -= changed_.leftCols(used_) * weight;
    }
    last_taken_ = g;
}

}  // namespace talus
