// Scenes: read, checked, and shared by counting references.
#include "handles.hpp"
#include "structs.hpp"

#include <cstring>
#include <span>

namespace talus::capi {
namespace {

talus_status create(Scene scene, talus_scene** out) {
    auto handle = std::make_unique<talus_scene>();
    handle->scene = std::make_shared<const Scene>(std::move(scene));
    handle->magic = scene_magic;
    *out = handle.release();
    return TALUS_OK;
}

std::string_view text_of(const char* text, int64_t length) {
    require(text, "text");
    return {text, length < 0 ? std::strlen(text) : static_cast<size_t>(length)};
}

HostArray checked(const talus_array* given) {
    const talus_array array = read_struct(given, "TALUS_ARRAY_INIT");
    require(array.entry, "array.entry");
    require_count(array.count, "array.count", 1);
    require(array.data, "array.data");
    if (array.type != TALUS_FLOAT64 && array.type != TALUS_INT32) {
        throw Error(Status::invalid_argument, std::string("array ") + array.entry + ": type is " +
                                                  std::to_string(array.type) +
                                                  ", which must be TALUS_FLOAT64 or TALUS_INT32");
    }
    HostArray host{array.entry, nullptr, nullptr, static_cast<size_t>(array.count)};
    if (array.type == TALUS_FLOAT64) {
        host.numbers = static_cast<const double*>(array.data);
    } else {
        host.integers = static_cast<const int32_t*>(array.data);
    }
    return host;
}

std::vector<HostArray> checked(int32_t count, const talus_array* arrays) {
    require_count(count, "array_count", 0);
    if (count > 0) {
        require(arrays, "arrays");
    }
    std::vector<HostArray> checked_arrays;
    const char* next = reinterpret_cast<const char*>(arrays);
    for (int32_t i = 0; i < count; ++i) {
        const auto* array = reinterpret_cast<const talus_array*>(next);
        checked_arrays.push_back(checked(array));
        next += array->struct_size;  // as the host's header has it, which may be another than ours
    }
    return checked_arrays;
}

}  // namespace
}  // namespace talus::capi

using namespace talus;
using namespace talus::capi;

talus_status talus_scene_from_json(const char* text, int64_t length, talus_scene** out) {
    return talus_scene_from_json_with_arrays(text, length, 0, nullptr, out);
}

talus_status talus_scene_from_bytes(const void* bytes, int64_t length, talus_scene** out) {
    return guarded([&] {
        require(out, "out");
        *out = nullptr;
        require(bytes, "bytes");
        require_count(length, "length", 1);
        return create(load_bytes({static_cast<const std::byte*>(bytes), static_cast<size_t>(length)}), out);
    });
}

talus_status talus_scene_from_file(const char* path, talus_scene** out) {
    return guarded([&] {
        require(out, "out");
        *out = nullptr;
        require(path, "path");
        return create(load_file(path), out);
    });
}

talus_status talus_scene_from_json_with_arrays(const char* text, int64_t length, int32_t array_count,
                                               const talus_array* arrays, talus_scene** out) {
    return guarded([&] {
        require(out, "out");
        *out = nullptr;
        return create(load_json(text_of(text, length), checked(array_count, arrays)), out);
    });
}

talus_status talus_scene_retain(talus_scene* scene) {
    return guarded([&] {
        require_scene(scene);
        scene->references.fetch_add(1, std::memory_order_relaxed);
        return talus_status{TALUS_OK};
    });
}

talus_status talus_scene_release(talus_scene* scene) {
    return guarded([&] {
        require_scene(scene);
        if (scene->references.fetch_sub(1, std::memory_order_acq_rel) == 1) {
            scene->magic = 0;
            delete scene;
        }
        return talus_status{TALUS_OK};
    });
}
