#include "linear/klu_solver.hpp"

#include "error.hpp"

#include <klu.h>
#include <algorithm>
#include <cassert>

namespace talus {

int32_t SparseMatrix::place(int32_t i, int32_t j) const {
    const auto first = row.begin() + column_start[static_cast<size_t>(j)];
    const auto last = row.begin() + column_start[static_cast<size_t>(j) + 1];
    const auto found = std::lower_bound(first, last, i);
    assert(found != last && *found == i);
    return static_cast<int32_t>(found - row.begin());
}

SparseMatrix symmetric_pattern(int32_t size, std::span<const std::array<int32_t, 2>> pairs) {
    std::vector<std::array<int32_t, 2>> entries;  // column, row
    entries.reserve(2 * pairs.size() + static_cast<size_t>(size));
    for (const auto& [i, j] : pairs) {
        entries.push_back({i, j});
        entries.push_back({j, i});
    }
    for (int32_t i = 0; i < size; ++i) entries.push_back({i, i});
    std::sort(entries.begin(), entries.end());
    entries.erase(std::unique(entries.begin(), entries.end()), entries.end());

    SparseMatrix matrix;
    matrix.column_start.assign(static_cast<size_t>(size) + 1, 0);
    matrix.row.reserve(entries.size());
    for (const auto& [column, row] : entries) {
        ++matrix.column_start[static_cast<size_t>(column) + 1];
        matrix.row.push_back(row);
    }
    for (size_t j = 0; j < static_cast<size_t>(size); ++j) matrix.column_start[j + 1] += matrix.column_start[j];
    matrix.value.assign(entries.size(), 0.0);
    return matrix;
}

// KLU reads the pattern through non-const pointers but does not write to it.
struct KluSolver::Handles {
    klu_common common{};
    klu_symbolic* symbolic = nullptr;
    klu_numeric* diagonal = nullptr;  // factors on the diagonal's pivots
    klu_numeric* own = nullptr;       // of the last matrix for which these were bad; empty: they were good

    Handles() { klu_defaults(&common); }
    ~Handles() {
        klu_free_numeric(&own, &common);
        klu_free_numeric(&diagonal, &common);
        klu_free_symbolic(&symbolic, &common);
    }
    Handles(const Handles&) = delete;
    Handles& operator=(const Handles&) = delete;
};

namespace {
int* pattern(const std::vector<int32_t>& numbers) { return const_cast<int*>(numbers.data()); }
double* values(const SparseMatrix& matrix) { return const_cast<double*>(matrix.value.data()); }
}  // namespace

KluSolver::KluSolver(const SparseMatrix& matrix) : handles_(std::make_unique<Handles>()) {
    auto& [common, symbolic, diagonal, own] = *handles_;
    int* const start = pattern(matrix.column_start);
    int* const row = pattern(matrix.row);
    symbolic = klu_analyze(matrix.size(), start, row, &common);
    std::vector<double> dominant(matrix.row.size(), -1.0);
    for (int32_t j = 0; j < matrix.size(); ++j) {
        const int32_t entries =
            matrix.column_start[static_cast<size_t>(j) + 1] - matrix.column_start[static_cast<size_t>(j)];
        dominant[static_cast<size_t>(matrix.place(j, j))] = entries;
    }
    if (symbolic != nullptr) diagonal = klu_factor(start, row, dominant.data(), symbolic, &common);
    if (diagonal == nullptr) throw Error(Status::out_of_memory, "KLU could not order the matrix");
}

KluSolver::~KluSolver() = default;

bool KluSolver::factorise(const SparseMatrix& matrix) {
    auto& [common, symbolic, diagonal, own] = *handles_;
    int* const start = pattern(matrix.column_start);
    int* const row = pattern(matrix.row);
    constexpr double worst_reciprocal_condition = 1e-14;
    klu_free_numeric(&own, &common);
    const bool done = klu_refactor(start, row, values(matrix), symbolic, diagonal, &common) != 0;
    if (done && klu_rcond(symbolic, diagonal, &common) != 0 && common.rcond > worst_reciprocal_condition) return true;
    own = klu_factor(start, row, values(matrix), symbolic, &common);
    if (own == nullptr) return false;
    return klu_rcond(symbolic, own, &common) != 0 && common.rcond > 0;
}

void KluSolver::solve(const SparseMatrix& matrix, std::span<double> b) {
    auto& [common, symbolic, diagonal, own] = *handles_;
    assert(static_cast<int32_t>(b.size()) == matrix.size());
    klu_solve(symbolic, own != nullptr ? own : diagonal, matrix.size(), 1, b.data(), &common);
}

}  // namespace talus
