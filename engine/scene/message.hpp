// Between the plain structs and a Cap'n Proto message of the schema.
#pragma once

#include "error.hpp"
#include "scene/scene.capnp.h"
#include "scene/scene.hpp"

#include <kj/exception.h>

namespace talus {

/// What the message says, with the defaults that depend on other entries filled in.
/// Throws Error(invalid_scene) where the message cannot be a scene: a place without two coordinates, an unknown enumerant.
[[nodiscard]] Scene from_message(schema::Scene::Reader message);

/// Fills an empty message.
void to_message(const Scene& scene, schema::Scene::Builder message);

/// Calls what uses Cap'n Proto, whose exceptions become Error(invalid_scene); `what` begins the message.
template <typename Call>
auto guarded(const char* what, Call call) {
    try {
        return call();
    } catch (const kj::Exception& exception) {
        throw Error(Status::invalid_scene, what + std::string(exception.getDescription().cStr()));
    }
}

}  // namespace talus
