// Whether ground in equilibrium stays in it when something nudges it.
#pragma once

#include "linear/klu_solver.hpp"
#include "motion/cell_kinematics.hpp"
#include "points/points.hpp"

#include <span>

namespace talus {

/// Of plane ground without yield, under dead loads: the second variation of its energy is positive for every motion (Hill, J. Mech. Phys.
/// Solids 6, 1958). Beside the elastic stiffness, which is `stiffness`, it has what the stress in the ground does on the motion.
/// `number`: nodes x 2, the equation of each displacement or -1. `pore_stress`: per point, Pa.
bool is_stable(const CellKinematics& kinematics, const Points& points, std::span<const double> pore_stress,
               std::span<const int32_t> number, SparseMatrix stiffness);

}  // namespace talus
