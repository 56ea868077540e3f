// Which cell a place lies in: for probes and for sampling points and rasters.
#pragma once

#include "ground/mesh.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace talus {

struct CellPlace {
    int32_t cell = -1;                ///< -1: outside the ground
    std::array<double, 2> natural{};  ///< of the cell's shape (background/shape.hpp); in a column only the first
};

/// Bins of about a cell's size over the mesh. The mesh must outlive the locator; where its nodes move, make a new one.
class Locator {
public:
    explicit Locator(const Mesh& mesh);

    /// The cell at x, y (m); in a column x is not looked at. On an edge it is one of the two, always the same. A place
    /// outside the boundary by less than 1e-9 of the mesh's extent counts as on it, so its natural coordinates may lie
    /// a little outside the shape.
    [[nodiscard]] CellPlace locate(double x, double y) const;

private:
    struct Box {
        std::array<double, 2> low;
        std::array<double, 2> high;
    };
    [[nodiscard]] Box cell_box(int32_t cell) const;
    [[nodiscard]] int32_t bin_index(double at, size_t axis) const;
    void fill_bins();
    template <class Visit>
    void visit_bins(const Box& box, Visit visit) const;

    const Mesh* mesh_;
    Box bounds_{};
    double tolerance_ = 0;  ///< m
    std::array<double, 2> bins_per_metre_{};
    std::array<int32_t, 2> bins_{1, 1};
    std::vector<int32_t> bin_start_;  ///< bins + 1 offsets into bin_cells_
    std::vector<int32_t> bin_cells_;  ///< cells whose box touches the bin, by number
};

}  // namespace talus
