// The nearest of many places.
#include "background/nearest.hpp"

#include <doctest/doctest.h>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace talus;

TEST_CASE("the nearest place is found as by looking at all of them") {
    constexpr double reach = 0.7;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> coordinate(-5, 5);
    std::vector<double> places(2 * 300);
    for (double& value : places) value = coordinate(random);
    const NearestPlace nearest(places, reach);
    int outside = 0;
    for (int tries = 0; tries < 500; ++tries) {
        const double x = 1.2 * coordinate(random), y = 1.2 * coordinate(random);
        int32_t expected = -1;
        double least = reach;
        for (size_t i = 0; i < places.size(); i += 2) {
            const double distance = std::hypot(places[i] - x, places[i + 1] - y);
            if (distance > least) continue;
            least = distance;
            expected = static_cast<int32_t>(i / 2);
        }
        outside += expected < 0 ? 1 : 0;
        CHECK(nearest.find(x, y) == expected);
    }
    CHECK(outside > 50);
    CHECK(outside < 450);
}

TEST_CASE("of equally near places the first is taken, and none is near what is no place") {
    const std::vector<double> places{1, 0, -1, 0, 0, 1};
    const NearestPlace nearest(places, 1);
    CHECK(nearest.find(0, 0) == 0);
    CHECK(nearest.find(-0.1, 0.01) == 1);
    CHECK(nearest.find(3, 0) == -1);
    for (const double absurd : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300})
        CHECK(nearest.find(absurd, 0) == -1);
}
