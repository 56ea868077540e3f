// Structs that may grow. Each begins with its size as the host's header has it: the library copies what both sides know, and
// takes a larger one only if the part that it does not know is zero.
#pragma once

#include "error.hpp"
#include "talus/talus.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace talus::capi {

/// The size that a host's struct says; throws invalid_argument when it cannot be one.
template <class Struct>
size_t struct_size(const Struct* given, const char* init) {
    constexpr int32_t largest = 4096;
    const int32_t size = given->struct_size;
    if (size < static_cast<int32_t>(2 * sizeof(int32_t)) || size > largest) {
        throw Error(Status::invalid_argument,
                    "struct_size is " + std::to_string(size) + ": begin the struct with " + init);
    }
    return static_cast<size_t>(size);
}

/// A host's struct, with zeros for what an older header does not have.
template <class Struct>
Struct read_struct(const Struct* given, const char* init) {
    const size_t size = struct_size(given, init);
    const char* bytes = reinterpret_cast<const char*>(given);
    const auto is_zero = [](char byte) { return byte == 0; };
    if (size > sizeof(Struct) && !std::all_of(bytes + sizeof(Struct), bytes + size, is_zero)) {
        throw Error(Status::invalid_argument, std::string("a struct begun with a newer ") + init +
                                                  " asks for something that this version of Talus does not have");
    }
    Struct copy{};
    std::memcpy(&copy, given, std::min(size, sizeof(Struct)));
    return copy;
}

/// Fills a host's struct as far as its header knows it, and zeroes what this library does not know.
template <class Struct>
void write_struct(const Struct& value, Struct* out, const char* init) {
    const size_t size = struct_size(out, init);
    const size_t known = std::min(size, sizeof(Struct));
    constexpr size_t head = sizeof(int32_t);
    char* bytes = reinterpret_cast<char*>(out);
    std::memcpy(bytes + head, reinterpret_cast<const char*>(&value) + head, known - head);
    std::fill(bytes + known, bytes + size, char{0});
}

}  // namespace talus::capi
