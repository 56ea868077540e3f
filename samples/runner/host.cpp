#include "runner/host.hpp"

namespace runner {

talus_status check(talus_status status) {
    if (status < 0) {
        throw Failure(status, talus_last_error());
    }
    return status;
}

Scene load_scene(const std::string& path) {
    talus_scene* scene = nullptr;
    check(talus_scene_from_file(path.c_str(), &scene));
    return Scene(scene);
}

Engine create_engine(const Scene& scene, const talus_options& options) {
    talus_engine* engine = nullptr;
    check(talus_engine_create(scene.get(), &options, &engine));
    return Engine(engine);
}

Json describe(const Engine& engine) {
    const char* json = nullptr;
    check(talus_engine_describe(engine.get(), &json));
    return Json::parse(json);
}

talus_field view(const Engine& engine, const std::string& field) {
    talus_field out = TALUS_FIELD_INIT;
    check(talus_engine_view(engine.get(), field.c_str(), &out));
    return out;
}

}  // namespace runner
