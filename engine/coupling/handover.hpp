// What a ground of a mesh hands over to the material points that move on.
#pragma once

#include "ground/mesh.hpp"
#include "motion/explicit/explicit_mixture.hpp"
#include "motion/explicit/explicit_motion.hpp"
#include "points/points.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace talus {

/// What a ground of a mesh hands over to its material points.
struct Handover {
    std::span<const double> pressure{};       ///< at the nodes, Pa; empty: dry
    std::span<const double> displacement{};   ///< of the nodes since the start, m; empty: none
    std::vector<double> soil_mass{};          ///< of each soil, kg per metre of thickness; empty: as its density says
    double water = 0;                         ///< m3 per metre of thickness; 0: as the pressures say
    double time = 0;                          ///< when, s
    std::span<const double> lost_strength{};  ///< of the mesh's points, share of what softening takes; empty: none
};

using Mixture = ExplicitMixture<Filling::unsaturated>;
using ThreePhases = ExplicitMixture<Filling::three_phase>;
using Exchange = ExplicitMixture<Filling::exchange>;
using Motion = std::variant<ExplicitMotion, Mixture, ThreePhases, Exchange>;

std::vector<ExplicitSoil> explicit_soils(const Scene& scene);

/// Cuts the points out of the mesh, and composes their motion of what the scene's physics names. They take their stress from the mesh's points, where these
/// have one, and what is handed over. Throws Error(invalid_scene) where a wall is not a straight side along an axis.
Motion make_motion(const Scene& scene, const Mesh& mesh, const Points& mesh_points, const Handover& handover,
                   int32_t threads);

/// From positions, x, y by the points' numbers, to where they lay before the mesh's nodes moved, m.
void subtract_displacement(const Mesh& mesh, std::span<const double> displacement, const FreePoints& points,
                           std::vector<double>& position);

}  // namespace talus
