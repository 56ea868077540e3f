#include "scene/load.hpp"

#include "error.hpp"
#include "scene/host_array.hpp"
#include "scene/read.hpp"
#include "scene/validate.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>

namespace talus {
namespace {

Scene validated(Scene scene) {
    validate(scene);
    return scene;
}

std::string content_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file.is_open() || std::filesystem::is_directory(path)) {
        throw Error(Status::io, "scene file " + path.string() + ": cannot be opened");
    }
    std::string content(std::istreambuf_iterator<char>(file), {});
    if (file.bad()) {
        throw Error(Status::io, "scene file " + path.string() + ": cannot be read");
    }
    return content;
}

/// JSON text begins with a brace after blanks. A flat Cap'n Proto message does not: it begins with a number of segments.
bool is_json(std::string_view content) {
    const size_t first = content.find_first_not_of(" \t\r\n");
    return first != std::string_view::npos && content[first] == '{';
}

}  // namespace

Scene load_json(std::string_view text, std::span<const HostArray> arrays) {
    Scene scene = read_json(text);
    for (const HostArray& array : arrays) set_entry(scene, array);
    return validated(std::move(scene));
}

Scene load_bytes(std::span<const std::byte> bytes) { return validated(read_bytes(bytes)); }

Scene load_file(const std::string& path) {
    const std::filesystem::path file = path;
    const std::string content = content_of(file);
    Scene scene = is_json(content) ? read_json(content) : read_bytes(std::as_bytes(std::span(content)));
    std::string& mesh = scene.ground.mesh.file;
    if (!mesh.empty()) mesh = (file.parent_path() / mesh).string();
    return validated(std::move(scene));
}

}  // namespace talus
