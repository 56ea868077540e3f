#include "scene/read.hpp"

#include "scene/json_fields.hpp"
#include "scene/json_syntax.hpp"
#include "scene/message.hpp"

#include <capnp/message.h>
#include <capnp/serialize.h>
#include <cstring>

namespace talus {
namespace {

constexpr size_t longest_text = size_t{64} << 20;  // bytes: the codec needs some thirty times as many

[[noreturn]] void refuse(const std::string& message) { throw Error(Status::invalid_scene, message); }

kj::ArrayPtr<const char> as_array(std::string_view text) { return {text.data(), text.size()}; }

}  // namespace

Scene read_json(std::string_view text) {
    if (text.size() > longest_text) {
        refuse("JSON text of " + std::to_string(text.size()) + " bytes: at most " + std::to_string(longest_text) +
               " are allowed; give large arrays as Cap'n Proto bytes or from memory");
    }
    const std::string syntax_error = json_syntax_error(text);
    if (!syntax_error.empty()) refuse("JSON text: " + syntax_error);

    return guarded("JSON text: ", [&] {
        const capnp::JsonCodec codec;
        capnp::MallocMessageBuilder parsed;
        const auto value = parsed.getRoot<capnp::JsonValue>();
        codec.decodeRaw(as_array(without_unicode_escapes(text)), value);

        Problems problems;
        check_json_fields(value.asReader(), capnp::Schema::from<schema::Scene>(), problems);
        if (const auto list = problems.list(); !list.empty()) refuse(joined(list, "\n"));

        capnp::MallocMessageBuilder message;
        auto root = message.getRoot<schema::Scene>();
        codec.decode(value.asReader(), capnp::DynamicStruct::Builder(root));
        return from_message(root.asReader());
    });
}

Scene read_bytes(std::span<const std::byte> bytes) {
    if (bytes.empty() || bytes.size() % sizeof(capnp::word) != 0) {
        refuse("Cap'n Proto bytes: are " + std::to_string(bytes.size()) + "; must be a positive multiple of 8");
    }
    return guarded("Cap'n Proto bytes: ", [&] {
        auto words = kj::heapArray<capnp::word>(bytes.size() / sizeof(capnp::word));  // aligned, unlike the caller's
        std::memcpy(words.begin(), bytes.data(), bytes.size());
        capnp::ReaderOptions options;
        options.traversalLimitInWords = 2 * words.size() + 65536;  // each entry is read once, but for a few
        capnp::FlatArrayMessageReader message(words, options);
        return from_message(message.getRoot<schema::Scene>());
    });
}

std::string write_json(const Scene& scene) {
    return guarded("scene: ", [&] {
        capnp::MallocMessageBuilder message;
        auto root = message.initRoot<schema::Scene>();
        to_message(scene, root);
        capnp::JsonCodec codec;
        codec.setPrettyPrint(true);
        codec.setHasMode(capnp::HasMode::NON_DEFAULT);
        const kj::String text = codec.encode(root.asReader());
        return std::string(text.begin(), text.size()) + "\n";
    });
}

std::vector<std::byte> write_bytes(const Scene& scene) {
    return guarded("scene: ", [&] {
        capnp::MallocMessageBuilder message;
        to_message(scene, message.initRoot<schema::Scene>());
        const kj::Array<capnp::word> words = capnp::messageToFlatArray(message);
        std::vector<std::byte> bytes(words.size() * sizeof(capnp::word));
        std::memcpy(bytes.data(), words.begin(), bytes.size());
        return bytes;
    });
}

}  // namespace talus
