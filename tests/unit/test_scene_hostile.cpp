// Texts and bytes that nobody means well with: an error, never a crash or a foreign exception.
#include "error.hpp"
#include "scene/read.hpp"
#include "scene/scene.capnp.h"
#include "scene/validate.hpp"
#include "unit/scene_files.hpp"

#include <capnp/any.h>
#include <capnp/dynamic.h>
#include <capnp/message.h>
#include <capnp/serialize.h>
#include <doctest/doctest.h>
#include <algorithm>
#include <cstring>
#include <random>

namespace {

using namespace talus;

std::string repeated(const std::string& part, size_t count) {
    std::string text;
    for (size_t i = 0; i < count; ++i) text += part;
    return text;
}

/// What is said on reading and validating; any exception but Error fails the test.
template <typename Read>
std::string said(Read read) {
    try {
        validate(read());
    } catch (const Error& error) {
        CHECK(error.status == Status::invalid_scene);
        return error.what();
    }
    return "";
}

std::string said_of_json(const std::string& text) {
    return said([&] { return read_json(text); });
}

std::string said_of_bytes(std::span<const std::byte> bytes) {
    return said([&] { return read_bytes(bytes); });
}

std::vector<std::byte> flat(capnp::MessageBuilder& message) {
    const auto words = capnp::messageToFlatArray(message);
    const auto bytes = words.asBytes();
    std::vector<std::byte> result(bytes.size());
    std::memcpy(result.data(), bytes.begin(), bytes.size());
    return result;
}

unsigned pointer_of(const char* field) {
    return capnp::Schema::from<schema::Scene>().getFieldByName(field).getProto().getSlot().getOffset();
}

TEST_CASE("deeply nested JSON is refused") {
    CHECK(said_of_json(repeated("[", 100000)).find("no more than 50 nested") != std::string::npos);
    CHECK(said_of_json(repeated("{\"a\":", 100000)).find("no more than 50 nested") != std::string::npos);
    CHECK(said_of_json(repeated("[", 100000) + repeated("]", 100000)).find("no more than 50 nested") !=
          std::string::npos);
    CHECK(said_of_json("{\"soils\": " + repeated("[", 49) + repeated("]", 49) + "}").find("soils[0]") == 0);
}

TEST_CASE("too long JSON is refused") {
    CHECK(said_of_json(std::string((size_t{64} << 20) + 1, ' ')).find("at most 67108864 are allowed") !=
          std::string::npos);
}

TEST_CASE("long texts and names in JSON are refused or shortened in the message") {
    const std::string name(100000, 'x');
    CHECK(said_of_json("{\"" + name + "\": 1}").find("is unknown") != std::string::npos);
    CHECK(said_of_json("{\"gravity\": \"" + name + "\"}").size() < 200);
    CHECK(said_of_json("{\"name\": \"" + name + "\"}").find("name: is a text of 100000 bytes") == 0);
}

TEST_CASE("a hundred problems are said and the rest counted") {
    std::string zones = "{}";
    for (int i = 0; i < 1000; ++i) zones += ", {\"rate\": [-1], \"time\": [0]}";
    const std::string text = said_of_json("{\"surface\": {\"zones\": [" + zones + "]}}");
    CHECK(std::count(text.begin(), text.end(), '\n') == 100);
    CHECK(text.find(" more problems") != std::string::npos);
}

TEST_CASE("texts that are no texts are named") {
    CHECK(said_of_json("{\"name\": \"a\\u0000b\"}").find("expected no control character in a text") !=
          std::string::npos);
    CHECK(said_of_json("{\"name\": \"\\u001f\"}").find("expected no control character in a text") != std::string::npos);
    CHECK(said_of_json("{\"name\": \"a\\tb\"}").find("name: has a control character") == 0);
    CHECK(said_of_json("{\"name\": \"\xff\xfe\"}").find("name: has a control character or is not UTF-8 at byte 0") ==
          0);
    for (const char* lone : {"\\ud800", "\\udc00", "\\ud800\\u0041", "\\ud800 udc00", "\\udc00\\ud800", "\\ud83c\\n"}) {
        CHECK(said_of_json("{\"name\": \"" + std::string(lone) + "\"}").find("expected a pair of surrogates") !=
              std::string::npos);
    }
    CHECK(said_of_json(std::string("{\"name\": \"x\"}\0", 14)).find("expected the end of the text") !=
          std::string::npos);
}

TEST_CASE("JSON with letters changed at random ends in a scene or an error") {
    std::mt19937 random(1);
    const std::string letters = "{}[]\",:.-+eE0123456789 ntfu\\\n\t\x01\xff";
    for (const char* name : {"column", "slope"}) {
        const std::string sound = sample_text(name);
        for (int trial = 0; trial < 1000; ++trial) {
            std::string text = sound;
            for (unsigned change = 0; change <= random() % 4; ++change) {
                const size_t at = random() % text.size();
                switch (random() % 3) {
                    case 0: text[at] = letters[random() % letters.size()]; break;
                    case 1: text.erase(at, random() % 20); break;
                    default: text.insert(at, text.substr(random() % text.size(), random() % 20));
                }
            }
            (void)said_of_json(text);
        }
    }
}

TEST_CASE("bytes that are no message are refused") {
    const std::vector<std::byte> sound = write_bytes(read_json(sample_text("slope")));
    CHECK(said_of_bytes(sound) == "");
    CHECK(said_of_bytes({}).find("are 0; must be a positive multiple of 8") != std::string::npos);
    CHECK(said_of_bytes(std::span(sound).first(13)).find("are 13; must be") != std::string::npos);
    CHECK(said_of_bytes(std::span(sound).first(sound.size() - 8)).find("Cap'n Proto bytes: ") == 0);
    CHECK(said_of_bytes(std::vector(800, std::byte{0xff})).find("Cap'n Proto bytes: ") == 0);
    CHECK(said_of_bytes(std::vector(800, std::byte{0})) != "");
    const std::string text = sample_text("column");
    CHECK(said_of_bytes(std::as_bytes(std::span(text).first(800))) != "");
}

TEST_CASE("bytes need no alignment") {
    const std::vector<std::byte> sound = write_bytes(read_json(sample_text("slope")));
    std::vector<std::byte> shifted(sound.size() + 1);
    std::memcpy(shifted.data() + 1, sound.data(), sound.size());
    CHECK(said_of_bytes(std::span(shifted).subspan(1)) == "");
}

TEST_CASE("bytes changed at random end in a scene or an error") {
    std::mt19937 random(2);
    for (const char* name : {"column", "slope"}) {
        const std::vector<std::byte> sound = write_bytes(read_json(sample_text(name)));
        for (int trial = 0; trial < 2000; ++trial) {
            std::vector<std::byte> bytes = sound;
            for (unsigned change = 0; change <= random() % 6; ++change)
                bytes[random() % bytes.size()] = std::byte(random() % 256);
            (void)said_of_bytes(bytes);
        }
    }
}

TEST_CASE("a few bytes cannot claim a large list") {
    for (const char* list : {"soils", "boundaries", "probes"}) {
        capnp::MallocMessageBuilder message;
        auto root = message.initRoot<capnp::AnyPointer>().initAsAnyStruct(3, 12);
        root.getPointerSection()[pointer_of(list)].initAs<capnp::List<capnp::Void>>(500000000);
        const std::string text = said_of_bytes(flat(message));
        CHECK_MESSAGE(text != "", text);
    }
}

TEST_CASE("places and choices in bytes are checked") {
    capnp::MallocMessageBuilder message;
    auto scene = message.initRoot<schema::Scene>();
    auto probe = scene.initProbes(2)[1];
    scene.getProbes()[0].initPlace(2);
    probe.initPlace(3);
    CHECK(said_of_bytes(flat(message)) == "probes[1].place: has 3 numbers; must be [x, y]");

    capnp::MallocMessageBuilder newer;
    capnp::DynamicStruct::Builder physics = newer.initRoot<schema::Scene>().initPhysics();
    physics.set("stress", capnp::DynamicEnum(capnp::Schema::from<schema::StressMeasure>(), 77));
    CHECK(said_of_bytes(flat(newer)) == "physics.stress: is choice 77, unknown to this version of the schema");
}

}  // namespace
