// talus run: follows a scene's schedule and writes what happened.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace runner {

struct RunSettings {
    std::string scene;                ///< file
    std::string out;                  ///< folder, made when it is not there
    std::optional<double> tolerance;  ///< instead of the scene's
    std::optional<double> step;       ///< s, instead of the scene's
    int32_t threads = 1;              ///< of a dynamic ground
};

/// Exit status of the program: 0 done, 1 the run failed, 130 cancelled by Ctrl-C. What was done until then is written.
/// Throws Failure when the scene or the engine cannot be had.
int run(const RunSettings& settings);

}  // namespace runner
