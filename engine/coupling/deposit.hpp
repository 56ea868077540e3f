// Ground that came to rest, as a fitted mesh takes it over from the material points that moved.
#pragma once

#include "coupling/dynamic.hpp"
#include "ground/mesh.hpp"
#include "scene/scene.hpp"

#include <optional>
#include <vector>

namespace talus {

struct Deposit {
    Mesh mesh;
    // At its nodes
    std::vector<double> displacement;    ///< nodes x 2, m, since the start
    std::vector<double> stress;          ///< nodes x 4, Pa: net (or effective) stress
    std::vector<double> plastic_strain;  ///< equivalent plastic shear strain, -
    std::vector<double> lost_strength;   ///< share of what softening takes, 0 to 1
    std::vector<double> porosity;        ///< -
    std::vector<double> pressure;        ///< Pa; empty: dry
};

/// A section under the points' surface, which has their volume in each column of the grid, with its cells graded as the scene's; and the points' state at
/// its nodes. Nothing where the ground has come to be thinner than a cell of the grid somewhere between its sides.
std::optional<Deposit> find_deposit(const Scene& scene, const DynamicGround& ground);

}  // namespace talus
