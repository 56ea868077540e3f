#include "runner/atomic_file.hpp"

#include <fstream>
#include <stdexcept>
#include <system_error>

namespace runner {

void write_file(const std::filesystem::path& path, std::string_view content) {
    std::filesystem::path beside = path;
    beside += ".part";
    std::ofstream file(beside, std::ios::binary | std::ios::trunc);
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
    file.close();
    if (!file) {
        std::error_code ignored;
        std::filesystem::remove(beside, ignored);
        throw std::runtime_error("cannot write " + path.string());
    }
    std::filesystem::rename(beside, path);
}

}  // namespace runner
