// Acceleration of a fixed-point iteration u <- u + step(u): the next step is the one that cancels best, in the least-squares
// sense, what the last steps say of how step(u) changes with u. Source: Anderson, J. ACM 12 (1965); Walker & Ni, SIAM J. Numer.
// Anal. 49 (2011), type II.
#pragma once

#include <Eigen/Core>

#include <span>

namespace talus {

class Anderson {
public:
    explicit Anderson(size_t size);

    /// Forgets the steps so far.
    void restart();

    /// Replaces the plain step of the present iterate by the accelerated one, which the caller must take in full.
    void accelerate(std::span<double> step);

private:
    static constexpr Eigen::Index depth = 16;

    Eigen::Index used_ = 0, next_ = 0;
    bool has_last_ = false;
    Eigen::MatrixXd moved_;     // size x depth: steps taken
    Eigen::MatrixXd changed_;   // size x depth: how the plain step changed over each of them
    Eigen::MatrixXd products_;  // changed^T changed
    Eigen::VectorXd last_plain_, last_taken_;
};

}  // namespace talus
