#include "background/nearest.hpp"

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
    int32_t nearest = -1;
    double least = reach_ * reach_;
    visit_around(x, y, [&](int32_t number, double at_x, double at_y) {
        const double square = (at_x - x) * (at_x - x) + (at_y - y) * (at_y - y);
        const bool is_nearer = square < least || (square == least && (nearest < 0 || number < nearest));
        if (!is_nearer) return;
        least = square;
        nearest = number;
    });
    return nearest;
}

}  // namespace talus
