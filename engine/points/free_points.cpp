#include "points/free_points.hpp"

#include <algorithm>
#include <numeric>

namespace talus {
namespace {

template <class Value>
void arrange_field(std::vector<Value>& field, std::vector<Value>& old, const std::vector<int32_t>& order) {
    if (field.empty()) return;
    old.swap(field);
    field.resize(order.size());
    for (size_t k = 0; k < order.size(); ++k) field[k] = old[static_cast<size_t>(order[k])];
}

}  // namespace

void FreePoints::assign(size_t points, size_t fields) {
    count = points;
    for (size_t f = 0; f < fields; ++f) field[f].assign(points, 0.0);
    soil.assign(points, 0);
    number.resize(points);
    std::iota(number.begin(), number.end(), 0);
}

double FreePoints::least(PointField name) const {
    return count > 0 ? *std::min_element(field[name].begin(), field[name].end()) : 0;
}

size_t FreePoints::bytes_a_point() const {
    size_t bytes = sizeof(int32_t) * ((soil.empty() ? 0 : 1) + (number.empty() ? 0 : 1) + (quiet.empty() ? 0 : 1));
    for (const auto& values : field) bytes += values.empty() ? 0 : sizeof(double);
    return bytes;
}

void FreePoints::arrange(const std::vector<int32_t>& order) {
    for (auto& values : field) arrange_field(values, old_values_, order);
    arrange_field(soil, old_numbers_, order);
    arrange_field(number, old_numbers_, order);
    arrange_field(quiet, old_numbers_, order);
    count = order.size();
}

}  // namespace talus
