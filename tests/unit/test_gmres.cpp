#include "linear/gmres.hpp"

#include <Eigen/LU>

#include <doctest/doctest.h>

#include <cmath>

using namespace talus;

namespace {

// Unsymmetric and well conditioned.
Eigen::MatrixXd some_matrix(Eigen::Index size) {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(size, size) * 3;
    for (Eigen::Index i = 0; i < size; ++i) {
        for (Eigen::Index j = 0; j < size; ++j)
            matrix(i, j) += std::sin(static_cast<double>(3 * i + 7 * j)) / static_cast<double>(size);
    }
    return matrix;
}

}  // namespace

TEST_CASE("GMRES solves to the reduction asked for, and needs no more products than there are unknowns") {
    const Eigen::MatrixXd matrix = some_matrix(20);
    const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(20, -1, 2);
    int products = 0;
    const auto map = [&](const Eigen::VectorXd& x, Eigen::VectorXd& result) {
        ++products;
        result = matrix * x;
    };
    for (const double reduction : {1e-1, 1e-4, 1e-10}) {
        const Eigen::VectorXd x = gmres(map, right, reduction, 100);
        CHECK((right - matrix * x).norm() <= 1.001 * reduction * right.norm());
    }
    products = 0;
    gmres(map, right, 0, 100);
    CHECK(products <= 20);
}

TEST_CASE("GMRES ends where its basis holds the answer") {
    const Eigen::VectorXd right = Eigen::VectorXd::Constant(5, 2.0);
    const auto identity = [](const Eigen::VectorXd& x, Eigen::VectorXd& result) { result = x; };
    CHECK((gmres(identity, right, 1e-12, 100) - right).norm() < 1e-14);
    CHECK(gmres(identity, Eigen::VectorXd::Zero(5), 1e-12, 100).norm() == 0);
}
