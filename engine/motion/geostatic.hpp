// The stress of the ground before anything happens to it. Displacement and strain count from there.
#pragma once

#include "motion/equilibrium.hpp"

namespace talus {

/// Gravity turned on elastically from no stress, then equilibrium with the soils' strength. The stress is accepted where the
/// outcome is converged; otherwise the trial one stands and says where the ground gives way.
EquilibriumOutcome turn_on_gravity(Equilibrium& equilibrium, const Loads& loads);

/// The same without the soils' strength: the stress may be more than they bear.
EquilibriumOutcome turn_on_gravity_elastically(Equilibrium& equilibrium, const Loads& loads);

/// Equilibrium with the soils' strength from the stress that there is, all loads at once. The stress is accepted where the outcome is converged: the
/// ground takes it where it lies. After so many steps of creep it is given up.
EquilibriumOutcome settle_in_place(Equilibrium& equilibrium, const Loads& loads, int32_t most_creep_steps);

/// Vertical stress from the weight above each point, horizontal skeleton stress `k0` times the vertical one; in no equilibrium. `gravity` in
/// m/s2.
void put_k0_stress(const Mesh& mesh, Points& points, const Loads& loads, double gravity, double k0);

/// The same, then equilibrium with the soils' strength, as in turn_on_gravity().
EquilibriumOutcome set_k0_stress(Equilibrium& equilibrium, const Mesh& mesh, Points& points, const Loads& loads,
                                 double gravity, double k0);

}  // namespace talus
