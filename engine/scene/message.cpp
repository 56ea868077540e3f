#include "scene/message.hpp"

#include "scene/fields.hpp"

#include <capnp/dynamic.h>
#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace talus {
namespace {

using capnp::DynamicEnum;
using capnp::DynamicList;
using capnp::DynamicStruct;
using capnp::DynamicValue;
using Numbers = capnp::List<double>;
using Integers = capnp::List<int32_t>;
using Places = capnp::List<Numbers>;

constexpr uint32_t longest_list = 10000;  // entries of a list of structs: a few bytes of a message may claim many

class Reader {
public:
    Reader(DynamicStruct::Reader message, std::string path) : message(message), path(std::move(path)) {}

    template <typename Value>
    void operator()(const char* name, Value& value) {
        read(message.get(name), value, join(name));
    }

    void positive(const char* name, double& value) {
        value = message.get(name).as<double>();
        if (std::isnan(value)) value = 0;
    }

    template <typename Enumeration>
    void optional(const char* name, bool& has, Enumeration& value) {
        const int32_t number = enumerant(message.get(name).as<DynamicEnum>(), join(name));
        has = number > 0;
        if (has) value = static_cast<Enumeration>(number - 1);
    }

    template <typename Kind, typename... Values>
    void one_of(Kind& kind, std::initializer_list<const char*> names, Values&... values) {
        const auto chosen = message.which();
        const char* const* name = names.begin();
        int32_t number = 0;
        const auto read_if_chosen = [&](auto& value) {
            KJ_IF_MAYBE (field, chosen) {
                if (field->getProto().getName() == *name) {
                    kind = static_cast<Kind>(number);
                    (*this)(*name, value);
                }
            }
            ++name;
            ++number;
        };
        (read_if_chosen(values), ...);
    }

private:
    static void read(const DynamicValue::Reader& from, double& to, const std::string&) { to = from.as<double>(); }
    static void read(const DynamicValue::Reader& from, int32_t& to, const std::string&) { to = from.as<int32_t>(); }
    static void read(const DynamicValue::Reader& from, bool& to, const std::string&) { to = from.as<bool>(); }

    static void read(const DynamicValue::Reader& from, std::string& to, const std::string&) {
        const auto text = from.as<capnp::Text>();
        to.assign(text.begin(), text.size());
    }

    template <typename Enumeration>
    requires std::is_enum_v<Enumeration>
    static void read(const DynamicValue::Reader& from, Enumeration& to, const std::string& path) {
        to = static_cast<Enumeration>(enumerant(from.as<DynamicEnum>(), path));
    }

    static void read(const DynamicValue::Reader& from, std::vector<double>& to, const std::string&) {
        read_array(from.as<Numbers>(), to);
    }

    static void read(const DynamicValue::Reader& from, std::vector<int32_t>& to, const std::string&) {
        read_array(from.as<Integers>(), to);
    }

    static void read(const DynamicValue::Reader& from, Place& to, const std::string& path) {
        to = place(from.as<Numbers>(), path);
    }

    static void read(const DynamicValue::Reader& from, std::vector<Place>& to, const std::string& path) {
        to.clear();
        for (const auto pair : from.as<Places>())
            to.push_back(place(pair, path + "[" + std::to_string(to.size()) + "]"));
    }

    static void read(const DynamicValue::Reader& from, Series& to, const std::string& path) {
        Reader reader(from.as<DynamicStruct>(), path);
        fields(reader, to);
        if (to.time.empty() && to.value.size() == 1) to.time = {0};
    }

    static void read(const DynamicValue::Reader& from, Conductivity& to, const std::string& path) {
        Reader reader(from.as<DynamicStruct>(), path);
        fields(reader, to);
        if (to.across == 0) to.across = to.along;
    }

    template <typename Struct>
    requires std::is_class_v<Struct>
    static void read(const DynamicValue::Reader& from, Struct& to, const std::string& path) {
        Reader reader(from.as<DynamicStruct>(), path);
        fields(reader, to);
    }

    template <typename Struct>
    static void read(const DynamicValue::Reader& from, std::vector<Struct>& to, const std::string& path) {
        const auto list = from.as<DynamicList>();
        if (list.size() > longest_list) {
            throw Error(Status::invalid_scene, path + ": has " + std::to_string(list.size()) + " entries; at most " +
                                                   std::to_string(longest_list) + " are allowed");
        }
        to.assign(list.size(), {});
        for (uint32_t i = 0; i < list.size(); ++i) read(list[i], to[i], path + "[" + std::to_string(i) + "]");
    }

    static void read_array(auto list, auto& to) {
        to.resize(list.size());
        for (uint32_t i = 0; i < list.size(); ++i) to[i] = list[i];
    }

    static Place place(Numbers::Reader pair, const std::string& path) {
        if (pair.size() == 2) return {pair[0], pair[1]};
        throw Error(Status::invalid_scene, path + ": has " + std::to_string(pair.size()) + " numbers; must be [x, y]");
    }

    static int32_t enumerant(const DynamicEnum& value, const std::string& path) {
        if (value.getRaw() < value.getSchema().getEnumerants().size()) return value.getRaw();
        throw Error(Status::invalid_scene,
                    path + ": is choice " + std::to_string(value.getRaw()) + ", unknown to this version of the schema");
    }

    [[nodiscard]] std::string join(const char* name) const { return path.empty() ? name : path + "." + name; }

    DynamicStruct::Reader message;
    std::string path;
};

/// Entries with the schema's default are not written.
class Writer {
public:
    explicit Writer(DynamicStruct::Builder message) : message(message) {}

    template <typename Value>
    void operator()(const char* name, const Value& value) {
        write(name, value);
    }

    void positive(const char* name, double value) { message.set(name, value == 0 ? unset : value); }

    template <typename Enumeration>
    void optional(const char* name, bool has, Enumeration value) {
        write_enumerant(name, has ? 1 + static_cast<int32_t>(value) : 0);
    }

    template <typename Kind, typename... Values>
    void one_of(Kind kind, std::initializer_list<const char*> names, const Values&... values) {
        int32_t number = 0;
        const auto write_if_chosen = [&](const auto& value) {
            if (number == static_cast<int32_t>(kind)) write(names.begin()[number], value);
            ++number;
        };
        (write_if_chosen(values), ...);
    }

private:
    void write(const char* name, double value) { message.set(name, value); }
    void write(const char* name, int32_t value) { message.set(name, value); }
    void write(const char* name, bool value) { message.set(name, value); }

    void write(const char* name, const std::string& value) {
        if (value.empty()) return;
        auto text = message.init(name, size(value)).as<capnp::Text>();
        std::copy(value.begin(), value.end(), text.begin());
    }

    template <typename Enumeration>
    requires std::is_enum_v<Enumeration>
    void write(const char* name, Enumeration value) { write_enumerant(name, static_cast<int32_t>(value)); }

    void write(const char* name, const std::vector<double>& value) { write_array<Numbers>(name, value); }
    void write(const char* name, const std::vector<int32_t>& value) { write_array<Integers>(name, value); }
    void write(const char* name, const Place& value) { message.set(name, {value[0], value[1]}); }

    void write(const char* name, const std::vector<Place>& value) {
        if (value.empty()) return;
        auto list = message.init(name, size(value)).as<Places>();
        for (uint32_t i = 0; i < list.size(); ++i) list.set(i, {value[i][0], value[i][1]});
    }

    template <typename Struct>
    requires std::is_class_v<Struct>
    void write(const char* name, const Struct& value) {
        Writer writer(message.init(name).template as<DynamicStruct>());
        fields(writer, value);
    }

    void write(const char* name, const Series& value) {
        if (value.time.empty() && value.value.empty()) return;
        Writer writer(message.init(name).template as<DynamicStruct>());
        fields(writer, value);
    }

    template <typename Struct>
    void write(const char* name, const std::vector<Struct>& value) {
        if (value.empty()) return;
        auto list = message.init(name, size(value)).template as<DynamicList>();
        for (uint32_t i = 0; i < list.size(); ++i) {
            Writer writer(list[i].template as<DynamicStruct>());
            fields(writer, value[i]);
        }
    }

    template <typename List, typename Value>
    void write_array(const char* name, const std::vector<Value>& value) {
        if (value.empty()) return;
        auto list = message.init(name, size(value)).template as<List>();
        for (uint32_t i = 0; i < list.size(); ++i) list.set(i, value[i]);
    }

    void write_enumerant(const char* name, int32_t number) {
        const auto field = message.getSchema().getFieldByName(name);
        message.set(field, DynamicEnum(field.getType().asEnum(), static_cast<uint16_t>(number)));
    }

    template <typename Container>
    static uint32_t size(const Container& container) {
        return static_cast<uint32_t>(container.size());
    }

    DynamicStruct::Builder message;
};

}  // namespace

Scene from_message(schema::Scene::Reader message) {
    Scene scene;
    Reader reader(message, "");
    fields(reader, scene);
    return scene;
}

void to_message(const Scene& scene, schema::Scene::Builder message) {
    Writer writer(message);
    fields(writer, scene);
}

}  // namespace talus
