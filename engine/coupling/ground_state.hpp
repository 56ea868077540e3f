// Everything that changes in time: what a failed step puts back.
#pragma once

#include "flow/integrator.hpp"
#include "points/free_points.hpp"
#include "points/points.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace talus {

/// What the flow was seen doing at the last substep, so that a change is told once.
struct FlowWatch {
    bool is_saturated = false;  ///< no pore holds air
    bool is_ponding = false;    ///< water stands on the surface or runs off
    bool is_seeping = false;    ///< water comes out of the surface
    double time = 0;            ///< s
    double air = 0;             ///< m3 of pores without water
    double gain = 0;            ///< m3/s net inflow
};

/// How a motion comes to rest.
struct RestWatch {
    double peak_energy = 0;   ///< J, kinetic, since the motion began
    double moved_last = 0;    ///< s, when the kinetic energy was last above the share of it that counts as rest
    double window_start = 0;  ///< s
    std::vector<double> window_position;  ///< of the points then, by their numbers, x, y, m
};

/// Points that were taken out at an end of the background.
struct AbsorbedPoints {
    std::vector<int32_t> number;
    std::vector<double> position;  ///< where they left, x, y, m
    std::vector<double> volume;    ///< m3 per metre of thickness
    double energy = 0;             ///< that they took along, J
};

/// What changes while ground moves.
struct MovingState {
    FreePoints points;
    AbsorbedPoints absorbed;
    RestWatch rest_watch;
    bool has_come_to_end = false;  ///< of the background
};

struct GroundState {
    double time = 0;                        ///< s
    std::vector<double> node_position;      ///< nodes x dimension, m
    std::vector<double> displacement;       ///< nodes x dimension, m; empty: rigid
    std::vector<double> velocity;           ///< nodes x dimension, m/s, mean over the last step; empty: rigid
    Points points;                          ///< empty: dynamic
    std::optional<MovingState> moving;      ///< of a dynamic ground, in a state that was saved
    FlowState flow;                         ///< empty: dry
    std::vector<double> pore_volume;        ///< per portion, m3: what the ground has
    std::vector<double> flow_pore_volume;   ///< per portion, m3: what the flow last took for it
    std::vector<double> pore_volume_rate;   ///< per portion, m3/s, over the last exchange: the next one's prediction
    std::vector<double> pore_stress_rate;   ///< per portion, Pa/s, likewise
    std::vector<double> displacement_rate;  ///< nodes x dimension, m/s, likewise
    double exchange_step = 0;           ///< s, what the next exchange between flow and motion would take; 0: unknown
    double given_up_exchange = 0;       ///< s, length of the one given up last, until one as long is agreed on
    bool settles_jointly = false;       ///< flow and skeleton, where the skeleton alone found no equilibrium last
    bool settles_jointly_soon = false;  ///< the two, in the last exchange agreed on, within few steps
    bool goes_on_jointly = false;   ///< the two, in the last exchange agreed on, near where the one before let expect
    bool equilibrium_lost = false;  ///< the skeleton stands as it was when it failed
    bool rests = false;             ///< it failed, moved and came to rest
    bool lies_still = false;        ///< and found no way back to equilibrium
    FlowWatch watch;
    bool rain_is_out = false;
};

}  // namespace talus
