// When no equilibrium exists: the evidence, gathered while the ground creeps in pseudo-time (iterations.cpp).
//
// Where a balance exists, the surplus of the loads' power over the power that the stresses take falls towards zero as the ground
// approaches it. In a mechanism the stresses stay, and the surplus with them, however far the ground moves. Collapse is taken as
// proved when all of these hold:
//   - the ground has moved farther than the whole loads would move it if it did not yield: farther than any settling in which
//     the stresses can still build up from nothing;
//   - over the second half of that motion its direction persisted;
//   - and the surplus fell by less than a tenth over it, so that a balance, by the secant, would lie more than five times
//     farther still.
#pragma once

#include "motion/cell_kinematics.hpp"

#include <array>
#include <span>
#include <vector>

namespace talus {

struct CollapseEvidence {
    double displacement = 0;          ///< largest increment in pseudo-time, m
    double elastic_displacement = 0;  ///< largest displacement under the whole loads without yield, m
    double surplus = 0;               ///< (power of the loads - power of the stresses) / power of the loads, -
    double earlier_surplus = 0;       ///< when the displacement was half as large
    double persistence = 0;           ///< least cosine between the directions of successive steps since then
    std::array<double, 2>
        place{};  ///< centroid of what moves at half the largest velocity or more, m; x is 0 in a column
    std::array<double, 2> shear_place{};  ///< point of the largest shear rate, m
};

class CollapseWatch {
public:
    explicit CollapseWatch(double elastic_displacement) { evidence_.elastic_displacement = elastic_displacement; }

    /// After a step in pseudo-time: largest displacement so far (m), surplus, cosine with the last step. True when proved.
    bool add(double displacement, double surplus, double cosine);

    [[nodiscard]] CollapseEvidence evidence() const { return evidence_; }

private:
    struct Entry {
        double displacement, surplus, cosine;
    };
    std::vector<Entry> history_;
    CollapseEvidence evidence_;
};

/// Sets the places of the mechanism with this velocity (nodes x dimension, any unit).
void locate_mechanism(const CellKinematics& kinematics, const Points& points, std::span<const double> velocity,
                      CollapseEvidence& evidence);

}  // namespace talus
