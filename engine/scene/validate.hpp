// Whether a scene can be simulated.
#pragma once

#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace talus {

/// All that is wrong with a scene (from a hundred on, how many more), each with the path of the entry, what it is and what is
/// allowed; empty for a sound one. A mesh file is not opened.
[[nodiscard]] std::vector<std::string> problems(const Scene& scene);

/// Throws Error(invalid_scene) with all problems, a line each.
void validate(const Scene& scene);

}  // namespace talus
