// Where JSON text is not JSON. Cap'n Proto's codec stops at the same places, but does not say where they are.
#pragma once

#include <string>
#include <string_view>

namespace talus {

/// The first error with its line and column, or nothing. Text nested more than 50 deep is an error.
[[nodiscard]] std::string json_syntax_error(std::string_view text);

/// The same JSON with the characters themselves in place of their \u escapes, for text without errors: Cap'n Proto 0.9 takes
/// the hexadecimal digits a to f for 0 to 5 (capnp/compat/json.c++, consumeEscape).
[[nodiscard]] std::string without_unicode_escapes(std::string_view text);

}  // namespace talus
