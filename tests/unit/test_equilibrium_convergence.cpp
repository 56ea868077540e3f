// A manufactured solution on distorted meshes: second order, and no locking when the skeleton keeps its volume.
#include "verification/skeleton_cases.hpp"

#include <doctest/doctest.h>

#include <string>

using namespace talus;
using namespace talus::test;

TEST_CASE("equilibrium: the displacement converges with order 2, and does not lock when the volume is kept") {
    for (const CellKind kind : {CellKind::quads, CellKind::triangles}) {
        const double soft = displacement_error(kind, 32, 0.3);
        for (const double poisson_ratio : {0.3, 0.4999}) {
            const double coarse = displacement_error(kind, 16, poisson_ratio),
                         fine = displacement_error(kind, 32, poisson_ratio);
            MESSAGE(std::string(kind == CellKind::quads ? "quads" : "triangles"), ", Poisson ratio ", poisson_ratio,
                    ": errors ", coarse, ", ", fine, ", order ", std::log2(coarse / fine));
            CHECK(std::log2(coarse / fine) > 1.9);
            CHECK(fine < 2 * soft);
        }
    }
}
