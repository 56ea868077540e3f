// What a host is told of a ground in motion. Energies and volumes are per metre of thickness.
#pragma once

#include <cstdint>

namespace talus {

struct MotionReport {
    int64_t substeps = 0;             ///< of the last step
    double kinetic_energy = 0;        ///< J, of the points' velocity
    double elastic_energy = 0;        ///< J, of their stress
    double potential_energy = 0;      ///< J, of their weight above y = 0
    double dissipated_energy = 0;     ///< J: what the sum of the three has lost since the start
    double largest_velocity = 0;      ///< m/s, of a point, at the end of the step
    double peak_velocity = 0;         ///< m/s, the largest of a point in the step, looked at every few substeps
    double largest_displacement = 0;  ///< m, of a point, since the start
    double sliding_volume = 0;        ///< m3, of the points displaced by more than a cell's size since the start
    double front_x = 0;  ///< m, of the foremost of these, in the direction that they go on the whole; 0: none did
    double run_out = 0;  ///< m: so far in front of where the foremost of these lay at the start it lies now
};

}  // namespace talus
