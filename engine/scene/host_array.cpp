#include "scene/host_array.hpp"

#include "error.hpp"
#include "scene/fields.hpp"

#include <charconv>
#include <initializer_list>
#include <iterator>

namespace talus {
namespace {

/// Visits the fields of scene.hpp's structs on the way along an entry's path, "surface.zones[0].rate".
class EntrySetter {
public:
    EntrySetter(const HostArray& array, std::string_view path) : array_(array), path_(path) {}

    void operator()(std::string_view name, auto& value) {
        if (path_.starts_with(name) && is_end_of_name(path_.substr(name.size()))) {
            set(path_.substr(name.size()), value);
        }
    }
    void positive(std::string_view, double) {}
    void optional(std::string_view, bool, auto&) {}
    void one_of(auto& kind, std::initializer_list<const char*> names, auto&... values) {
        size_t index = 0;
        const auto visit = [&](auto& value) {
            if (index == static_cast<size_t>(kind)) {
                (*this)(std::data(names)[index], value);
            }
            ++index;
        };
        (visit(values), ...);
    }

    [[nodiscard]] bool found() const { return found_; }

private:
    static bool is_end_of_name(std::string_view rest) { return rest.empty() || rest[0] == '.' || rest[0] == '['; }

    [[noreturn]] void refuse(const std::string& why) const {
        throw Error(Status::invalid_argument, "array " + array_.entry + ": " + why);
    }

    void check(const auto& values, const void* given, const char* type) {
        if (given == nullptr) refuse(std::string("must be an array of ") + type);
        if (!values.empty()) refuse("the scene's text gives this entry too");
        found_ = true;
    }

    void set(std::string_view rest, std::vector<double>& values) {
        if (!rest.empty()) return;
        check(values, array_.numbers, "float64");
        values.assign(array_.numbers, array_.numbers + array_.count);
    }

    void set(std::string_view rest, std::vector<int32_t>& values) {
        if (!rest.empty()) return;
        check(values, array_.integers, "int32");
        values.assign(array_.integers, array_.integers + array_.count);
    }

    void set(std::string_view rest, std::vector<Place>& places) {
        if (!rest.empty()) return;
        check(places, array_.numbers, "float64");
        if (array_.count % 2 != 0) {
            refuse("count is " + std::to_string(array_.count) + ", which must be even: x, y of each place");
        }
        for (size_t i = 0; i < array_.count; i += 2) places.push_back({array_.numbers[i], array_.numbers[i + 1]});
    }

    template <class Struct>
    requires requires(EntrySetter& setter, Struct& structure) { fields(setter, structure); }
    void set(std::string_view rest, Struct& structure) {
        if (rest.starts_with('.')) descend(rest.substr(1), structure);
    }

    template <class Struct>
    requires requires(EntrySetter& setter, Struct& structure) { fields(setter, structure); }
    void set(std::string_view rest, std::vector<Struct>& list) {
        size_t index = 0;
        const char* end = rest.data() + rest.size();
        const auto parsed = std::from_chars(rest.data() + (rest.empty() ? 0 : 1), end, index);
        const std::string_view after(parsed.ptr, static_cast<size_t>(end - parsed.ptr));
        if (!rest.starts_with('[') || parsed.ec != std::errc() || !after.starts_with("].")) {
            return;
        }
        if (index >= list.size()) {
            refuse("index " + std::to_string(index) + " of a list of " + std::to_string(list.size()));
        }
        descend(after.substr(2), list[index]);
    }

    static void set(std::string_view, auto&) {}  // numbers, texts, flags: not arrays

    void descend(std::string_view path, auto& structure) {
        EntrySetter inner(array_, path);
        fields(inner, structure);
        found_ = found_ || inner.found_;
    }

    const HostArray& array_;
    std::string_view path_;
    bool found_ = false;
};

}  // namespace

void set_entry(Scene& scene, const HostArray& array) {
    EntrySetter setter(array, array.entry);
    fields(setter, scene);
    if (!setter.found())
        throw Error(Status::invalid_argument, "array " + array.entry + ": the scene has no such array");
}

}  // namespace talus
