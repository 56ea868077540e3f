// Which of many places is nearest to one: for sampling material points.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace talus {

class NearestPlace {
public:
    /// Of places x, y in m, one after the other; found within `reach` (m). The places are copied.
    NearestPlace(std::span<const double> places, double reach);

    /// The number of the nearest place within reach of x, y; -1 where there is none. Of equally near ones the first.
    [[nodiscard]] int32_t find(double x, double y) const;

    /// Calls use(number, x, y) for all places within reach of x, y, and for some beyond; always in the same order.
    template <class Use>
    void visit_around(double x, double y, const Use& use) const {
        if (!std::isfinite(x) || !std::isfinite(y)) return;
        const int64_t row = bin(y), column = bin(x);
        for (int64_t near = row - 1; near <= row + 1; ++near) {
            const auto is_before = [](const Entry& entry, const std::array<int64_t, 2>& at) {
                return std::tie(entry.row, entry.column) < std::tie(at[0], at[1]);
            };
            auto entry = std::lower_bound(entries_.begin(), entries_.end(), std::array{near, column - 1}, is_before);
            for (; entry != entries_.end() && entry->row == near && entry->column <= column + 1; ++entry)
                use(entry->number, entry->x, entry->y);
        }
    }

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
