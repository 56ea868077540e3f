// A scene from JSON text or Cap'n Proto bytes, and back.
//
// JSON names are those of scene.capnp, and unknown ones are refused. Reading checks the form only: validate() checks what
// the scene says. All functions throw Error(invalid_scene); the message names the entries by their path, a line each.
#pragma once

#include "scene/scene.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// UTF-8, at most 64 MiB. Independent of the locale.
[[nodiscard]] Scene read_json(std::string_view text);

/// One flat Cap'n Proto message with the schema's Scene as its root, from any source.
[[nodiscard]] Scene read_bytes(std::span<const std::byte> bytes);

/// Fields with the schema's default are left out.
[[nodiscard]] std::string write_json(const Scene& scene);

[[nodiscard]] std::vector<std::byte> write_bytes(const Scene& scene);

}  // namespace talus
