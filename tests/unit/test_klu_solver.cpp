// The sparse direct solver: bits that depend on the matrix alone, and matrices that need pivots.
#include "linear/klu_solver.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace talus;

namespace {

SparseMatrix chain(int32_t size, double diagonal, double beside) {
    std::vector<std::array<int32_t, 2>> pairs;
    for (int32_t i = 0; i + 1 < size; ++i) pairs.push_back({i, i + 1});
    SparseMatrix matrix = symmetric_pattern(size, pairs);
    for (int32_t i = 0; i < size; ++i) matrix.value[static_cast<size_t>(matrix.place(i, i))] = diagonal * (1 + 0.1 * i);
    for (const auto& [i, j] : pairs) {
        matrix.value[static_cast<size_t>(matrix.place(i, j))] = beside;
        matrix.value[static_cast<size_t>(matrix.place(j, i))] = 0.7 * beside;
    }
    return matrix;
}

std::vector<double> right_hand_side(int32_t size) {
    std::vector<double> b;
    for (int32_t i = 0; i < size; ++i) b.push_back(std::sin(1.0 + i));
    return b;
}

double largest_residual(const SparseMatrix& matrix, const std::vector<double>& x, const std::vector<double>& b) {
    std::vector<double> residual = b;
    for (size_t j = 0; j < x.size(); ++j)
        for (auto k = static_cast<size_t>(matrix.column_start[j]); k < static_cast<size_t>(matrix.column_start[j + 1]);
             ++k)
            residual[static_cast<size_t>(matrix.row[k])] -= matrix.value[k] * x[j];
    double largest = 0;
    for (const double r : residual) largest = std::max(largest, std::abs(r));
    return largest;
}

}  // namespace

TEST_CASE("a solve has the same bits whatever was factorised before") {
    constexpr int32_t size = 12;
    const SparseMatrix matrix = chain(size, 2, -1), steep = chain(size, 1e9, -3), hollow = chain(size, 0, 1);
    SparseMatrix broken = matrix;  // not finite
    broken.value[3] = std::numeric_limits<double>::quiet_NaN();
    KluSolver fresh(matrix);
    REQUIRE(fresh.factorise(matrix));
    std::vector<double> expected = right_hand_side(size);
    fresh.solve(matrix, expected);
    CHECK(largest_residual(matrix, expected, right_hand_side(size)) < 1e-14);

    KluSolver used(steep);
    for (const SparseMatrix* before : std::vector<const SparseMatrix*>{&steep, &hollow, &broken, &matrix}) {
        (void)used.factorise(*before);
        REQUIRE(used.factorise(matrix));
        std::vector<double> found = right_hand_side(size);
        used.solve(matrix, found);
        CHECK(found == expected);
    }
}

TEST_CASE("a matrix whose diagonal gives no pivots is solved with others") {
    constexpr int32_t size = 12;  // even: with an odd one the chain is singular
    const SparseMatrix hollow = chain(size, 0, 1);
    KluSolver solver(hollow);
    REQUIRE(solver.factorise(hollow));
    std::vector<double> x = right_hand_side(size);
    solver.solve(hollow, x);
    CHECK(largest_residual(hollow, x, right_hand_side(size)) < 1e-12);
}

TEST_CASE("singular matrices and such that are not finite are not factorised") {
    SparseMatrix matrix = chain(5, 0, 1);
    KluSolver solver(matrix);
    CHECK_FALSE(solver.factorise(matrix));
    matrix = chain(5, 2, 1);
    for (const int32_t i : {1, 2, 3}) matrix.value[static_cast<size_t>(matrix.place(i, 2))] = 0;
    CHECK_FALSE(solver.factorise(matrix));
    matrix = chain(5, 2, 1);
    matrix.value[0] = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(solver.factorise(matrix));
    CHECK(solver.factorise(chain(5, 2, 1)));
}
