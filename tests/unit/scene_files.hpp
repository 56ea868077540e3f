// The samples' scenes, for tests.
#pragma once

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

inline std::string file_text(const std::string& path) {
    std::ifstream file(std::string(TALUS_SOURCE_DIR) + "/" + path, std::ios::binary);
    if (!file) throw std::runtime_error("cannot read " + path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

inline std::string sample_text(const std::string& name) { return file_text("samples/scenes/" + name + ".json"); }
