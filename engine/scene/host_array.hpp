// An entry of a scene that comes from the host's memory.
#pragma once

#include "scene/load.hpp"

namespace talus {

/// Copies the host's array into the scene's entry. Throws Error(invalid_argument) when the scene has no such entry, when its
/// values are of the other type, or when it has some already.
void set_entry(Scene& scene, const HostArray& array);

}  // namespace talus
