// What is wrong with a scene, collected so that all of it is said at once.
#pragma once

#include <array>
#include <charconv>
#include <string>
#include <utility>
#include <vector>

namespace talus {

/// A number in a message, to twelve digits, independent of the locale.
[[nodiscard]] inline std::string value_text(double value) {
    std::array<char, 32> buffer{};
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value + 0.0,  // no "-0"
                                            std::chars_format::general, 12);
    return {buffer.data(), end};
}

[[nodiscard]] inline std::string item_path(const std::string& list, size_t index) {
    return list + "[" + std::to_string(index) + "]";
}

/// Names joined by commas.
[[nodiscard]] std::string joined(const std::vector<std::string>& names, const char* separator = ", ");

/// The name most like a wrong one, where one is near: differing in case, underscores or a few letters. Empty otherwise.
[[nodiscard]] std::string nearest(const std::string& wrong, const std::vector<std::string>& names);

class Problems {
public:
    void add(std::string problem);

    /// At most a hundred, and how many more there are.
    [[nodiscard]] std::vector<std::string> list() const;

private:
    std::vector<std::string> first;
    size_t count = 0;
};

}  // namespace talus
