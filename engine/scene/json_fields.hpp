// Whether parsed JSON fits the schema. Cap'n Proto's codec would stop at the first misfit and not say where it is.
#pragma once

#include "scene/problems.hpp"

#include <capnp/compat/json.h>
#include <capnp/schema.h>

namespace talus {

/// Adds every misfit with its path: unknown, repeated and exclusive fields, wrong types, unknown choices, numbers that no
/// double can hold.
void check_json_fields(capnp::JsonValue::Reader value, capnp::StructSchema schema, Problems& problems);

}  // namespace talus
