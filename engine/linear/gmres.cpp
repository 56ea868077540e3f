#include "linear/gmres.hpp"

#include <Eigen/Jacobi>

#include <algorithm>
#include <vector>

namespace talus {

Eigen::VectorXd gmres(const LinearMap& map, const Eigen::VectorXd& right, double reduction, int most_products) {
    const double start = right.norm();
    if (start == 0) return Eigen::VectorXd::Zero(right.size());
    const auto most = std::min<Eigen::Index>(most_products, right.size());
    Eigen::MatrixXd basis(right.size(), most + 1);
    Eigen::MatrixXd triangle = Eigen::MatrixXd::Zero(most + 1, most);
    Eigen::VectorXd remainder = Eigen::VectorXd::Zero(most + 1);
    std::vector<Eigen::JacobiRotation<double>> rotations;
    Eigen::VectorXd x = right;
    Eigen::VectorXd product(right.size());
    basis.col(0) = right / start;
    remainder[0] = start;
    Eigen::Index used = 0;
    while (used < most && std::abs(remainder[used]) > reduction * start) {
        x = basis.col(used);
        map(x, product);
        const double length = product.norm();
        for (Eigen::Index i = 0; i <= used; ++i) {
            triangle(i, used) = basis.col(i).dot(product);
            product -= triangle(i, used) * basis.col(i);
        }
        const double left = product.norm();
        for (Eigen::Index i = 0; i < used; ++i)
            triangle.col(used).applyOnTheLeft(i, i + 1, rotations[static_cast<size_t>(i)].adjoint());
        triangle(used + 1, used) = left;
        Eigen::JacobiRotation<double> rotation;
        rotation.makeGivens(triangle(used, used), triangle(used + 1, used));
        rotations.push_back(rotation);
        triangle.col(used).applyOnTheLeft(used, used + 1, rotation.adjoint());
        remainder.applyOnTheLeft(used, used + 1, rotation.adjoint());
        ++used;
        constexpr double round_off = 1e-14;
        if (!(left > round_off * length)) break;  // the basis holds the answer
        basis.col(used) = product / left;
    }
    const Eigen::VectorXd weight =
        triangle.topLeftCorner(used, used).triangularView<Eigen::Upper>().solve(remainder.head(used));
    return basis.leftCols(used) * weight;
}

}  // namespace talus
