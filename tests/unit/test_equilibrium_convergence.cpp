// Manufactured solutions on distorted meshes: second order, and no locking when the skeleton keeps its volume.
#include "unit/motion_cases.hpp"

#include <doctest/doctest.h>

#include <numbers>

using namespace talus;
using namespace talus::test;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double shear_modulus = 4e6;

struct Field {
    std::array<double, 2> displacement, body_force;  // m, N/m3
};

/// The curl of psi = sin^2(pi x) sin^2(pi y): it keeps the volume and rests on the unit square's edge, whatever the Poisson ratio.
Field isochoric(double x, double y) {
    const double c2x = std::cos(2 * pi * x), s2x = std::sin(2 * pi * x), c2y = std::cos(2 * pi * y), s2y = std::sin(2 * pi * y);
    const double sx = (1 - c2x) / 2, sy = (1 - c2y) / 2;
    const double scale = 1e-4;
    const double laplacian_u = pi * s2y * (2 * pi * pi * c2x) + sx * pi * (-4 * pi * pi * s2y);
    const double laplacian_v = -pi * s2x * (2 * pi * pi * c2y) - sy * pi * (-4 * pi * pi * s2x);
    return {{scale * sx * pi * s2y, -scale * sy * pi * s2x},
            {-shear_modulus * scale * laplacian_u, -shear_modulus * scale * laplacian_v}};
}

std::array<double, 2> distorted(double x, double y) {
    const double inside = std::sin(pi * x) * std::sin(pi * y);
    return {x + 0.05 * inside * std::sin(5 * x + 3 * y), y + 0.05 * inside * std::cos(4 * x - 5 * y)};
}

/// Root of the integral of the squared displacement error, over that of the displacement.
double error(CellKind kind, int32_t cells, double poisson_ratio) {
    Mesh mesh = grid_mesh(cells, cells, kind, distorted);
    Points points = unstressed_points(mesh);
    const auto prescribed = constrain(mesh, [](double x, double y) {
        const bool edge = x < 1e-9 || x > 1 - 1e-9 || y < 1e-9 || y > 1 - 1e-9;
        return std::array<bool, 2>{edge, edge};
    });
    Equilibrium equilibrium(mesh, points, {elastic_solid(2 * shear_modulus * (1 + poisson_ratio), poisson_ratio)}, prescribed, 0);
    LoadArrays loads(mesh, points);
    const auto at_points = [&](auto&& use) {  // use(value of each node's N, node, point)
        for (size_t c = 0; c < mesh.cell_soil.size(); ++c) {
            const auto start = static_cast<size_t>(mesh.cell_start[c]);
            with_shape(mesh.cell_start[c + 1] - mesh.cell_start[c], [&](auto shape) {
                using Shape = decltype(shape);
                for (size_t i = 0; i < Shape::points; ++i) {
                    const auto value = Shape::values(Shape::point[i]);
                    for (size_t a = 0; a < Shape::nodes; ++a) {
                        use(value[a], static_cast<size_t>(mesh.cell_nodes[start + a]), static_cast<size_t>(points.cell_start[c]) + i);
                    }
                }
            });
        }
    };
    at_points([&](double value, size_t node, size_t p) {
        const Field field = isochoric(points.position[2 * p], points.position[2 * p + 1]);
        for (size_t k = 0; k < 2; ++k) loads.force[2 * node + k] += value * points.volume[p] * field.body_force[k];
    });
    CHECK(equilibrium.solve(loads.view()).status == EquilibriumStatus::converged);

    std::vector<double> found(points.position.size(), 0.0);
    at_points([&](double value, size_t node, size_t p) {
        for (size_t k = 0; k < 2; ++k) found[2 * p + k] += value * equilibrium.increment()[2 * node + k];
    });
    double squared = 0, reference = 0;
    for (size_t p = 0; p < points.volume.size(); ++p) {
        const Field field = isochoric(points.position[2 * p], points.position[2 * p + 1]);
        for (size_t k = 0; k < 2; ++k) {
            squared += points.volume[p] * std::pow(found[2 * p + k] - field.displacement[k], 2);
            reference += points.volume[p] * std::pow(field.displacement[k], 2);
        }
    }
    return std::sqrt(squared / reference);
}

}  // namespace

TEST_CASE("equilibrium: the displacement converges with order 2, and does not lock when the volume is kept") {
    for (const CellKind kind : {CellKind::quads, CellKind::triangles}) {
        const double soft = error(kind, 32, 0.3);
        for (const double poisson_ratio : {0.3, 0.4999}) {
            const double coarse = error(kind, 16, poisson_ratio), fine = error(kind, 32, poisson_ratio);
            MESSAGE(std::string(kind == CellKind::quads ? "quads" : "triangles"), ", Poisson ratio ", poisson_ratio, ": errors ", coarse, ", ", fine,
                    ", order ", std::log2(coarse / fine));
            CHECK(std::log2(coarse / fine) > 1.9);
            CHECK(fine < 2 * soft);
        }
    }
}
