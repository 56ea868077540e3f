// Sparse direct solver: KLU of SuiteSparse (LGPL) on a fixed pattern. Ordered once, factorised on the diagonal's pivots, and with
// pivots of its own a matrix for which these are bad; so its bits follow from the matrix alone, not from those before it. Source: Davis & Palamadai Natarajan, ACM TOMS 37 (2010).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace talus {

/// A square matrix in compressed columns; the rows of a column increase.
struct SparseMatrix {
    std::vector<int32_t> column_start;  ///< size + 1
    std::vector<int32_t> row;
    std::vector<double> value;

    [[nodiscard]] int32_t size() const { return static_cast<int32_t>(column_start.size()) - 1; }
    /// Place of entry (i, j) in `value`. The entry must be in the pattern.
    [[nodiscard]] int32_t place(int32_t i, int32_t j) const;
};

/// The matrix with entries (i, j) and (j, i) for each pair given, and the diagonal; values are zero.
SparseMatrix symmetric_pattern(int32_t size, std::span<const std::array<int32_t, 2>> pairs);

class KluSolver {
public:
    /// Orders the pattern of `matrix`.
    explicit KluSolver(const SparseMatrix& matrix);
    ~KluSolver();
    KluSolver(const KluSolver&) = delete;
    KluSolver& operator=(const KluSolver&) = delete;

    /// Factorises. False when the matrix is singular to working precision or not finite.
    bool factorise(const SparseMatrix& matrix);

    /// Replaces b by A^-1 b. Needs a successful factorise().
    void solve(const SparseMatrix& matrix, std::span<double> b);

private:
    struct Handles;
    std::unique_ptr<Handles> handles_;
};

}  // namespace talus
