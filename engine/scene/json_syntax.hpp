// Where JSON text is not JSON. Cap'n Proto's codec stops at the same places, but does not say where they are.
#pragma once

#include <string>
#include <string_view>

namespace talus {

/// The first error with its line and column, or nothing. Text nested more than 50 deep is an error.
[[nodiscard]] std::string json_syntax_error(std::string_view text);

}  // namespace talus
