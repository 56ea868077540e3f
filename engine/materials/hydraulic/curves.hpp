// The retention and permeability curves themselves, exact; the flow reads them through HydraulicTable.
#pragma once

#include "materials/hydraulic/parameters.hpp"

namespace talus {

/// S(suction) for suction >= 0 in Pa; maximum_saturation for suction < 0.
double saturation(const Retention& retention, double suction);

/// S_e(suction) = (S - residual) / (maximum - residual), between 0 and 1.
double effective_saturation(const Retention& retention, double suction);

/// k_r(suction), between 0 and 1; 1 for suction <= 0.
double relative_permeability(const Hydraulics& hydraulics, double suction);

/// k_rg(suction) of the gas, between 0 and 1; 0 for suction <= 0. Mualem's integral over the retention, taken from its dry end, times
/// (1 - S_e)^1/2: van Genuchten (Parker, Lenhard & Kuppusamy 1987), Brooks & Corey; the others have Corey's (1954) curve.
double gas_permeability(const Retention& retention, double suction);

/// n^3 / (1 - n)^2 of a porosity n, by which K grows (Kozeny 1927, Carman 1937).
double kozeny_carman(double porosity);

/// The suction in Pa over which the retention bends: 1/alpha, or the first positive suction of a table.
double suction_scale(const Retention& retention);

}  // namespace talus
