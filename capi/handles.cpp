#include "handles.hpp"

#include <cstring>

namespace talus::capi {

namespace {

// Read by memcpy: a foreign pointer need not be aligned.
bool has_magic(const void* handle, int64_t magic) noexcept {
    int64_t found = 0;
    std::memcpy(&found, handle, sizeof found);
    return found == magic;
}

void require_handle(const void* handle, int64_t magic, const char* kind) {
    if (handle == nullptr) {
        throw Error(Status::invalid_handle, std::string("the ") + kind + " is NULL");
    }
    if (!has_magic(handle, magic)) {
        throw Error(Status::invalid_handle, std::string("this is not the handle of a living ") + kind);
    }
}

}  // namespace

bool is_engine(const talus_engine* engine) noexcept { return engine != nullptr && has_magic(engine, engine_magic); }

void require_scene(const talus_scene* scene) { require_handle(scene, scene_magic, "scene"); }
void require_engine(const talus_engine* engine) { require_handle(engine, engine_magic, "engine"); }

Busy::Busy(talus_engine& engine) : engine_(engine) {
    if (engine.busy.test_and_set(std::memory_order_acquire)) {
        throw Error(Status::busy, "another call on this engine is running, in another thread or around this callback");
    }
}

}  // namespace talus::capi
