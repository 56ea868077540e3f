// The macro step of a dynamic ground: its material points carried through a host's step by their momentum.
#pragma once

#include "coupling/motion_report.hpp"
#include "coupling/progress.hpp"
#include "ground/mesh.hpp"
#include "motion/explicit/explicit_motion.hpp"
#include "points/points.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace talus {

class DynamicGround {
public:
    /// Cuts the points out of the mesh; they take their stress from the mesh's points, where these have one. Throws Error(invalid_scene)
    /// where a wall is not a straight side along an axis.
    DynamicGround(const Scene& scene, const Mesh& mesh, const Points& mesh_points, int32_t threads);

    /// Carries the points from one time to another, s. False when `cancelled` said so. Throws Error(not_converged) where the motion
    /// comes to no number, the ground is pressed to less than its grains or it spreads beyond all bounds. In both cases the caller puts the points back.
    bool advance(double from, double until, const Cancelled& cancelled);

    /// As they were, to the last bit.
    void restore(const FreePoints& points) { motion_.points() = points; }

    [[nodiscard]] const FreePoints& points() const { return motion_.points(); }
    [[nodiscard]] double cell_size() const { return motion_.grid().cell_size; }
    [[nodiscard]] MotionReport report() const;

    /// Where each point lay at the start, by its number: x, y, m.
    [[nodiscard]] const std::vector<double>& start_position() const { return start_position_; }
    /// Share of the shear strength in use by each point, by its number, 0 to 1.
    [[nodiscard]] std::vector<double> mobilised_strength() const;

private:
    void look(double time);
    void check_pores(double time) const;

    std::vector<ExplicitSoil> soils_;
    ExplicitMotion motion_;
    std::vector<double> grain_density_;  // per soil, kg/m3
    std::vector<double> start_position_;
    double start_energy_ = 0;   // J
    int64_t substeps_ = 0;      // of the last advance
    double peak_velocity_ = 0;  // m/s, likewise
};

}  // namespace talus
