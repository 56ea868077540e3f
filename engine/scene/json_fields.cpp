#include "scene/json_fields.hpp"

#include <cmath>
#include <limits>
#include <set>

namespace talus {
namespace {

using capnp::JsonValue;

std::string string_of(capnp::Text::Reader text) { return {text.begin(), text.size()}; }

std::string described(JsonValue::Reader value) {
    switch (value.which()) {
        case JsonValue::NULL_: return "null";
        case JsonValue::BOOLEAN: return value.getBoolean() ? "true" : "false";
        case JsonValue::NUMBER: return "the number " + value_text(value.getNumber());
        case JsonValue::STRING: return "the text \"" + string_of(value.getString()).substr(0, 60) + "\"";
        case JsonValue::ARRAY: return "an array";
        case JsonValue::OBJECT: return "an object";
        default: return "not JSON";
    }
}

template <typename List>
std::vector<std::string> names_of(const List& members) {
    std::vector<std::string> names;
    for (const auto member : members) names.push_back(string_of(member.getProto().getName()));
    return names;
}

class Walk {
public:
    explicit Walk(Problems& problems) : problems(problems) {}

    void object(JsonValue::Reader value, capnp::StructSchema schema, const std::string& path) {
        if (!value.isObject()) return misfit(value, path, "an object {...}");
        std::set<std::string> seen;
        std::vector<std::string> choices;
        for (const auto member : value.getObject()) {
            const std::string name = string_of(member.getName());
            const std::string member_path = path.empty() ? name : path + "." + name;
            if (!seen.insert(name).second) problems.add(member_path + ": is given twice");
            KJ_IF_MAYBE (field, schema.findFieldByName(member.getName())) {
                if (field->getProto().getDiscriminantValue() != capnp::schema::Field::NO_DISCRIMINANT)
                    choices.push_back(name);
                check(member.getValue(), field->getType(), member_path);
            } else {
                unknown(member_path, name, names_of(schema.getFields()));
            }
        }
        if (choices.size() > 1) {
            problems.add(path + ": has " + joined(choices, " and ") + "; must have one of " +
                         joined(names_of(schema.getUnionFields())));
        }
    }

private:
    void check(JsonValue::Reader value, capnp::Type type, const std::string& path) {
        switch (type.which()) {
            case capnp::schema::Type::STRUCT: return object(value, type.asStruct(), path);
            case capnp::schema::Type::LIST: return list(value, type.asList(), path);
            case capnp::schema::Type::ENUM: return choice(value, type.asEnum(), path);
            case capnp::schema::Type::FLOAT64: return number(value, path);
            case capnp::schema::Type::INT32: return whole_number(value, path);
            case capnp::schema::Type::BOOL: return value.isBoolean() ? void() : misfit(value, path, "true or false");
            default: return value.isString() ? void() : misfit(value, path, "a text");
        }
    }

    void list(JsonValue::Reader value, capnp::ListSchema type, const std::string& path) {
        if (!value.isArray()) return misfit(value, path, "an array [...]");
        size_t index = 0;
        for (const auto item : value.getArray()) check(item, type.getElementType(), item_path(path, index++));
    }

    void choice(JsonValue::Reader value, capnp::EnumSchema type, const std::string& path) {
        const std::vector<std::string> names = names_of(type.getEnumerants());
        const std::string allowed = "one of " + joined(names);
        if (!value.isString()) return misfit(value, path, allowed);
        if (type.findEnumerantByName(value.getString()) != nullptr) return;
        const std::string near = nearest(string_of(value.getString()), names);
        misfit(value, path, near.empty() ? allowed : allowed + " (did you mean " + near + "?)");
    }

    void number(JsonValue::Reader value, const std::string& path) {
        if (!value.isNumber()) return misfit(value, path, "a number");
        if (!std::isfinite(value.getNumber())) problems.add(path + ": is too large for a number");
    }

    void whole_number(JsonValue::Reader value, const std::string& path) {
        if (!value.isNumber()) return misfit(value, path, "a whole number");
        const double wanted = value.getNumber();
        const bool fits = std::abs(wanted) <= std::numeric_limits<int32_t>::max();
        if (!fits || wanted != std::floor(wanted)) misfit(value, path, "a whole number below 2147483648");
    }

    void misfit(JsonValue::Reader value, const std::string& path, const std::string& allowed) {
        problems.add((path.empty() ? "the scene" : path) + ": is " + described(value) + "; must be " + allowed);
    }

    void unknown(const std::string& path, const std::string& name, const std::vector<std::string>& names) {
        const std::string near = nearest(name, names);
        problems.add(path + ": is unknown; " +
                     (near.empty() ? "known here: " + joined(names) : "did you mean " + near + "?"));
    }

    Problems& problems;
};

}  // namespace

void check_json_fields(JsonValue::Reader value, capnp::StructSchema schema, Problems& problems) {
    Walk(problems).object(value, schema, "");
}

}  // namespace talus
