// Files that are there whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

namespace runner {

/// Writes a file beside its place and moves it there. Throws std::runtime_error naming the file when that fails.
void write_file(const std::filesystem::path& path, std::string_view content);

}  // namespace runner
