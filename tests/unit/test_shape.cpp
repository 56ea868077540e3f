#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "background/shape.hpp"

using namespace talus;

namespace {

/// Cells that are neither small, straight nor at the origin.
constexpr NodePlaces<Line2> line = {{{3}, {5.5}}};
constexpr NodePlaces<Tri3> triangle = {{{10, 3}, {14, 4}, {11, 9}}};
constexpr NodePlaces<Quad4> quad = {{{10, 3}, {14, 4}, {15, 9}, {9, 6}}};

template <class Use>
void for_each_shape(Use use) {
    use(Line2{}, line);
    use(Tri3{}, triangle);
    use(Quad4{}, quad);
}

/// Places on which linear fields are tried: the quadrature points and the centre.
template <class Shape>
std::vector<typename Shape::Natural> places() {
    std::vector<typename Shape::Natural> all(Shape::point.begin(), Shape::point.end());
    all.push_back(Shape::centre);
    return all;
}

}  // namespace

TEST_CASE("shape functions sum to one and their gradients to zero") {
    for_each_shape([](auto shape, const auto& node) {
        using Shape = decltype(shape);
        for (const auto& at : places<Shape>()) {
            const Mapped<Shape> mapped = map_shape<Shape>(node, at);
            double sum = 0;
            std::array<double, Shape::dimension> gradient{};
            for (size_t i = 0; i < Shape::nodes; ++i) {
                CHECK(mapped.value[i] > 0);
                sum += mapped.value[i];
                for (size_t k = 0; k < Shape::dimension; ++k) gradient[k] += mapped.gradient[i][k];
            }
            CHECK(sum == doctest::Approx(1).epsilon(1e-15));
            for (const double component : gradient) CHECK(std::abs(component) < 1e-15);
        }
    });
}

TEST_CASE("linear fields have exact values and gradients on distorted cells") {
    for_each_shape([](auto shape, const auto& node) {
        using Shape = decltype(shape);
        const std::array<double, 2> slope = {0.7, -1.3};
        const auto field = [&](const auto& place) {
            double value = 4;
            for (size_t k = 0; k < Shape::dimension; ++k) value += slope[k] * place[k];
            return value;
        };
        for (const auto& at : places<Shape>()) {
            const Mapped<Shape> mapped = map_shape<Shape>(node, at);
            double value = 0;
            std::array<double, Shape::dimension> gradient{};
            for (size_t i = 0; i < Shape::nodes; ++i) {
                value += mapped.value[i] * field(node[i]);
                for (size_t k = 0; k < Shape::dimension; ++k) gradient[k] += mapped.gradient[i][k] * field(node[i]);
            }
            CHECK(value == doctest::Approx(field(place_in_cell<Shape>(node, at))).epsilon(1e-14));
            for (size_t k = 0; k < Shape::dimension; ++k)
                CHECK(gradient[k] == doctest::Approx(slope[k]).epsilon(1e-13));
        }
    });
}

TEST_CASE("natural gradients are the derivatives of the values") {
    for_each_shape([](auto shape, const auto&) {
        using Shape = decltype(shape);
        constexpr double step = 1e-6;
        for (const auto& at : places<Shape>()) {
            const auto gradient = Shape::gradients(at);
            for (size_t k = 0; k < Shape::dimension; ++k) {
                auto before = at, after = at;
                before[k] -= step;
                after[k] += step;
                for (size_t i = 0; i < Shape::nodes; ++i) {
                    const double slope = (Shape::values(after)[i] - Shape::values(before)[i]) / (2 * step);
                    CHECK(gradient[i][k] == doctest::Approx(slope).epsilon(1e-8));
                }
            }
        }
    });
}

TEST_CASE("quadrature gives length and area, and is exact as far as it says") {
    const auto integral = [](auto shape, const auto& node, auto function) {
        using Shape = decltype(shape);
        double sum = 0;
        for (size_t q = 0; q < Shape::points; ++q) {
            sum += Shape::weight[q] * map_shape<Shape>(node, Shape::point[q]).determinant *
                   function(place_in_cell<Shape>(node, Shape::point[q]));
        }
        return sum;
    };
    const auto one = [](const auto&) { return 1.; };
    CHECK(integral(Line2{}, line, one) == doctest::Approx(2.5).epsilon(1e-15));
    CHECK(integral(Tri3{}, triangle, one) == doctest::Approx(11.5).epsilon(1e-15));
    CHECK(integral(Quad4{}, quad, one) == doctest::Approx(20).epsilon(1e-15));

    CHECK(integral(Line2{}, line, [](const auto& at) { return std::pow(at[0], 3); }) ==
          doctest::Approx((std::pow(5.5, 4) - std::pow(3., 4)) / 4).epsilon(1e-14));
    const NodePlaces<Tri3> unit_triangle = {{{0, 0}, {1, 0}, {0, 1}}};
    CHECK(integral(Tri3{}, unit_triangle, [](const auto& at) { return at[0] * at[1]; }) ==
          doctest::Approx(1. / 24).epsilon(1e-14));
    CHECK(integral(Tri3{}, unit_triangle, [](const auto& at) { return at[1] * at[1]; }) ==
          doctest::Approx(1. / 12).epsilon(1e-14));
    const NodePlaces<Quad4> unit_square = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    CHECK(integral(Quad4{}, unit_square, [](const auto& at) { return std::pow(at[0] * at[1], 3); }) ==
          doctest::Approx(1. / 16).epsilon(1e-14));
}

TEST_CASE("a cell's nodes are gathered by number, and shapes are told by it") {
    const std::vector<double> position = {0, 0, 1, 0, 1, 1, 0, 1};
    const std::vector<int32_t> nodes = {2, 3, 1};
    CHECK(gather_places<Tri3>(position.data(), nodes.data()) == NodePlaces<Tri3>{{{1, 1}, {0, 1}, {1, 0}}});
    for (int32_t count = 2; count <= 4; ++count) {
        CHECK(with_shape(count, [](auto shape) { return shape.nodes; }) == static_cast<size_t>(count));
    }
}

static_assert(map_shape<Quad4>(quad, Quad4::centre).determinant > 0, "shapes work at compile time");
