// Which of many places is nearest to one: for sampling material points.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace talus {

class NearestPlace {
public:
    /// Of places x, y in m, one after the other; found within `reach` (m). The places are copied.
    NearestPlace(std::span<const double> places, double reach);

    /// The number of the nearest place within reach of x, y; -1 where there is none. Of equally near ones the first.
    [[nodiscard]] int32_t find(double x, double y) const;

private:
    struct Entry {
        int64_t row, column;  // of the bin, as wide as the reach
        int32_t number;
        double x, y;
    };
    [[nodiscard]] int64_t bin(double coordinate) const;

    double reach_;
    std::vector<Entry> entries_;  // row by row, in a row by columns, in a bin by number
};

}  // namespace talus
