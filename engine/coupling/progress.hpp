// How a host follows a step and ends it.
#pragma once

#include <functional>

namespace talus {

/// Called within a step with the fraction of it that is done; true ends the step.
using Cancelled = std::function<bool(double fraction)>;

}  // namespace talus
