// GMRES without restarts for equations whose matrix is known by its products alone. Source: Saad & Schultz, SIAM J. Sci. Stat.
// Comput. 7 (1986).
#pragma once

#include <Eigen/Core>

#include <functional>

namespace talus {

using LinearMap = std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& result)>;

/// x with |right - map(x)| <= reduction |right| in the 2-norm, or as good as `most_products` products of the map allow.
Eigen::VectorXd gmres(const LinearMap& map, const Eigen::VectorXd& right, double reduction, int most_products);

}  // namespace talus
