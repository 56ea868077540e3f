// The table of wrong scenes in tests/robustness/wrong_scenes.json. An entry is a sound scene (a sample or one of the table's
// own) with some JSON pointers set or removed, or a text of its own, and what the message must contain.
#include "error.hpp"
#include "scene/read.hpp"
#include "scene/validate.hpp"
#include "unit/scene_files.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

namespace {

using nlohmann::json;

const json& table() {
    static const json parsed = json::parse(file_text("tests/robustness/wrong_scenes.json"));
    return parsed;
}

json sound_scene(const std::string& name) {
    return table()["scenes"].contains(name) ? table()["scenes"][name] : json::parse(sample_text(name));
}

std::string wrong_text(const json& entry) {
    if (entry.contains("text")) return entry["text"];
    json scene = sound_scene(entry["scene"]);
    const json set = entry.value("set", json::object());
    for (const auto& [pointer, value] : set.items()) scene[json::json_pointer(pointer)] = value;
    for (const std::string pointer : entry.value("remove", json::array())) {
        const json::json_pointer at(pointer);
        scene.at(at.parent_pointer()).erase(at.back());
    }
    return scene.dump();
}

/// What reading and validating says, each problem on a line.
std::string message(const std::string& text) {
    try {
        talus::validate(talus::read_json(text));
    } catch (const talus::Error& error) {
        CHECK(error.status == talus::Status::invalid_scene);
        return error.what();
    }
    return "";
}

/// Whether one of the lines begins with the text: the entry's path is at the beginning.
bool has_line(const std::string& lines, const std::string& beginning) {
    return ("\n" + lines).find("\n" + beginning) != std::string::npos;
}

TEST_CASE("the scenes that the wrong ones are made from are sound") {
    for (const auto& [name, scene] : table()["scenes"].items())
        CHECK_MESSAGE(message(scene.dump()).empty(), name, message(scene.dump()));
}

TEST_CASE("each of the wrong scenes gives a message that names the entry") {
    CHECK(table()["wrong"].size() >= 200);
    for (const json& entry : table()["wrong"]) {
        const std::string text = wrong_text(entry);
        const std::string said = message(text);
        const std::string expected = entry["says"];
        const bool names_it =
            entry.contains("text") ? said.find(expected) != std::string::npos : has_line(said, expected);
        CHECK_MESSAGE(names_it, "expected: ", expected, "\nsaid: ", said, "\nof: ", entry.dump());
    }
}

}  // namespace
