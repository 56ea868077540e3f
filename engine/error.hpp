// The one exception of the engine. It never leaves the C API, whose guard turns it into a status code and a message.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace talus {

/// Values are those of talus_status in talus.h and are frozen.
enum class Status : int32_t {
    ok = 0,
    cancelled = 1,    ///< the host asked to stop; the step was undone
    out_of_rain = 2,  ///< the step went past the end of the rain series; it was done with the last rate held
    outside = 3,      ///< some places lie outside the ground; their values are NaN
    ended_early = 4,  ///< the step was done up to where ground began to move or came to rest
    invalid_handle = -1,
    invalid_argument = -2,
    invalid_scene = -3,
    unknown_field = -4,
    not_converged = -5,  ///< the solver stopped; says nothing about the slope
    out_of_memory = -6,
    io = -7,
    internal = -8,
    busy = -9,  ///< another call on the engine is running
};

class Error : public std::runtime_error {
public:
    Error(Status status, const std::string& message) : std::runtime_error(message), status(status) {}
    Status status;
};

}  // namespace talus
