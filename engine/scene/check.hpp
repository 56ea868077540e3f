// The rules' way of saying what is wrong: a place in the scene, and what it should be.
#pragma once

#include "scene/problems.hpp"
#include "scene/scene.capnp.h"
#include "scene/scene.hpp"

#include <capnp/schema.h>
#include <cmath>
#include <map>

namespace talus {

/// An entry of the scene; it knows its path. Entries are named as in the schema.
class Check {
public:
    Check(Problems& problems, std::string path) : problems_(&problems), path_(std::move(path)) {}

    [[nodiscard]] Check at(const std::string& name) const {
        return {*problems_, path_.empty() ? name : path_ + "." + name};
    }
    [[nodiscard]] Check at(const std::string& name, size_t index) const { return at(item_path(name, index)); }
    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] Check item(size_t index) const { return {*problems_, item_path(path_, index)}; }

    /// A text that begins with the entry's value, "= ...", follows the path directly.
    void say(const std::string& text) const { problems_->add(path_ + (text.starts_with("= ") ? " " : ": ") + text); }
    void require(bool holds, const std::string& text) const {
        if (!holds) say(text);
    }

    /// `who` needs the entry.
    void needed(bool given, const std::string& who) const { require(given, "is missing; " + who + " needs it"); }

    /// `who` has no use for the entry: it would silently do nothing.
    void unused(bool given, const std::string& who) const {
        require(!given, "has no effect: " + who + " does not use it");
    }

    /// The entry must be given exactly where `who` uses it.
    void used(bool use, bool given, const std::string& who) const { use ? needed(given, who) : unused(given, who); }

private:
    Problems* problems_;
    std::string path_;
};

/// Whether an entry is given: NaN leaves a number open, and so does 0 where it must be positive.
[[nodiscard]] inline bool given(double value) { return !std::isnan(value); }
[[nodiscard]] inline bool given_positive(double value) { return given(value) && value != 0; }

[[nodiscard]] inline std::string with_unit(double value, const std::string& unit) {
    return unit == "-" ? value_text(value) : value_text(value) + " " + unit;
}

/// The name of a choice as in the schema, `skipped` enumerants of which are none of the struct's.
template <typename SchemaEnumeration, typename Enumeration>
[[nodiscard]] std::string name_of(Enumeration value, unsigned skipped = 0) {
    const auto names = capnp::Schema::from<SchemaEnumeration>().getEnumerants();
    return names[static_cast<unsigned>(value) + skipped].getProto().getName().cStr();
}

// --- rules, a file a part of the scene -------------------------------------------------------------------------------

/// Every number and text on its own, by the limits that the schema gives.
void check_entries(schema::Scene::Reader message, Problems& problems);

void check_soils(const Check& scene_check, const Scene& scene);
void check_ground(const Check& scene_check, const Scene& scene);
void check_boundaries(const Check& scene_check, const Scene& scene);
void check_surface(const Check& scene_check, const Scene& scene);
void check_initial(const Check& scene_check, const Scene& scene);
void check_schedule(const Check& scene_check, const Scene& scene);
void check_probes(const Check& scene_check, const Scene& scene);

// --- rules that several of them share --------------------------------------------------------------------------------

/// Numbers that increase.
void check_increasing(const Check& list, const std::vector<double>& values);

/// A list with one item for each of another one's.
void check_length(const Check& list, size_t length, size_t expected, const std::string& other);

/// Items of a list have names of their own.
template <typename Item>
void check_names(const Check& parent, const std::string& list, const std::vector<Item>& items, bool needed) {
    std::map<std::string, size_t> seen;
    for (size_t i = 0; i < items.size(); ++i) {
        const Check check = parent.at(list, i).at("name");
        if (items[i].name.empty()) {
            check.require(!needed, "is missing");
            continue;
        }
        const auto [first, is_new] = seen.emplace(items[i].name, i);
        check.require(is_new, "'" + items[i].name + "' is also the name of " + parent.at(list, first->second).path());
    }
}

}  // namespace talus
