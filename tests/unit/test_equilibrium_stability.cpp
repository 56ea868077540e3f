// Whether ground in equilibrium stays in it.
#include "unit/motion_cases.hpp"

#include <doctest/doctest.h>

using namespace talus;
using namespace talus::test;

TEST_CASE("ground that may shear alone is stable up to a stress difference of twice its shear modulus") {
    constexpr double young_modulus = 1e7, poisson_ratio = 0.3;
    constexpr double limit = young_modulus / (1 + poisson_ratio);
    for (const double share : {0.99, 1.01}) {
        for (const CellKind kind : {CellKind::quads, CellKind::triangles}) {
            Mesh mesh = grid_mesh(1, 1, kind, [](double x, double y) { return std::array<double, 2>{x, y}; });
            Points points = unstressed_points(mesh);
            const std::vector<uint8_t> prescribed = constrain(mesh, [](double, double y) {
                return std::array<bool, 2>{y < 0.5, true};
            });
            const Equilibrium equilibrium(mesh, points, {mohr_coulomb_solid(young_modulus, poisson_ratio)}, prescribed,
                                          9.81);
            const LoadArrays loads(mesh, points);
            for (size_t p = 0; p < static_cast<size_t>(points.count); ++p)
                points.skeleton_stress[4 * p + 1] = -share * limit;
            CHECK(equilibrium.is_stable(loads.view()) == (share < 1));
            for (size_t p = 0; p < static_cast<size_t>(points.count); ++p)
                points.skeleton_stress[4 * p] = points.skeleton_stress[4 * p + 2] = -10 * limit;
            CHECK(equilibrium.is_stable(loads.view()));  // pressed along the layers it resists more
        }
    }
}
