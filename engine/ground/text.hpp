// Numbers in messages, independent of the locale.
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace talus {

[[nodiscard]] inline std::string number_text(double value) {
    std::array<char, 32> buffer{};
    const auto end =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::general, 7).ptr;
    return {buffer.data(), end};
}

[[nodiscard]] inline std::string place_text(double x, double y) {
    return "(" + number_text(x) + ", " + number_text(y) + ") m";
}

}  // namespace talus
