#include "background/nearest.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace talus {

NearestPlace::NearestPlace(std::span<const double> places, double reach) : reach_(reach) {
    entries_.reserve(places.size() / 2);
    for (size_t i = 0; i + 1 < places.size(); i += 2)
        entries_.push_back({bin(places[i + 1]), bin(places[i]), static_cast<int32_t>(i / 2), places[i], places[i + 1]});
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
        return std::tie(a.row, a.column, a.number) < std::tie(b.row, b.column, b.number);
    });
}

int64_t NearestPlace::bin(double coordinate) const {
    constexpr double farthest = 1e18;  // what an integer holds
    return static_cast<int64_t>(std::clamp(std::floor(coordinate / reach_), -farthest, farthest));
}

int32_t NearestPlace::find(double x, double y) const {
    if (!std::isfinite(x) || !std::isfinite(y)) return -1;
    const int64_t row = bin(y), column = bin(x);
    int32_t nearest = -1;
    double least = reach_ * reach_;
    for (int64_t near = row - 1; near <= row + 1; ++near) {
        const auto is_before = [](const Entry& entry, const std::array<int64_t, 2>& at) {
            return std::tie(entry.row, entry.column) < std::tie(at[0], at[1]);
        };
        auto entry = std::lower_bound(entries_.begin(), entries_.end(), std::array{near, column - 1}, is_before);
        for (; entry != entries_.end() && entry->row == near && entry->column <= column + 1; ++entry) {
            const double square = (entry->x - x) * (entry->x - x) + (entry->y - y) * (entry->y - y);
            const bool is_nearer = square < least || (square == least && (nearest < 0 || entry->number < nearest));
            if (!is_nearer) continue;
            least = square;
            nearest = entry->number;
        }
    }
    return nearest;
}

}  // namespace talus
