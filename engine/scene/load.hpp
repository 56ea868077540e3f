// A scene from any source of a host's, read and checked.
#pragma once

#include "scene/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace talus {

/// An entry of a scene in the host's memory: numbers or integers, the other one being nullptr.
struct HostArray {
    std::string entry;                  ///< path in the schema's names, "ground.mesh.position", "surface.zones[0].rate"
    const double* numbers = nullptr;    ///< count values; of a profile x, y of each place
    const int32_t* integers = nullptr;  ///< count values
    size_t count = 0;
};

/// Text, its missing arrays taken from the host's, which are copied. Throws Error(invalid_scene) with all problems of the
/// scene, Error(invalid_argument) when an array is not one of the scene's or the text has it too.
[[nodiscard]] Scene load_json(std::string_view text, std::span<const HostArray> arrays);

/// A flat Cap'n Proto message. Throws Error(invalid_scene).
[[nodiscard]] Scene load_bytes(std::span<const std::byte> bytes);

/// Either of them, told by its content; a mesh file is sought in the scene file's folder. Throws Error(io) besides.
[[nodiscard]] Scene load_file(const std::string& path);

}  // namespace talus
