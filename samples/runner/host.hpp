// The C API with the manners of C++: handles that release themselves, failures as exceptions.
#pragma once

#include <talus/talus.h>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace runner {

using Json = nlohmann::ordered_json;

/// A call of Talus that failed, with its own text.
class Failure : public std::runtime_error {
public:
    Failure(talus_status status, const std::string& message) : std::runtime_error(message), status(status) {}
    talus_status status;
};

/// Throws Failure for a status below 0, and returns the others.
talus_status check(talus_status status);

struct Release {
    void operator()(talus_scene* scene) const { talus_scene_release(scene); }
    void operator()(talus_engine* engine) const { talus_engine_destroy(engine); }
};
using Scene = std::unique_ptr<talus_scene, Release>;
using Engine = std::unique_ptr<talus_engine, Release>;

[[nodiscard]] Scene load_scene(const std::string& path);
[[nodiscard]] Engine create_engine(const Scene& scene, const talus_options& options);
[[nodiscard]] Json describe(const Engine& engine);
[[nodiscard]] talus_field view(const Engine& engine, const std::string& field);

}  // namespace runner
