#include "scene/check.hpp"

#include <capnp/dynamic.h>
#include <string_view>

namespace talus {
namespace {

using capnp::DynamicStruct;
using capnp::DynamicValue;
using Numbers = capnp::List<double>;
using Field = capnp::StructSchema::Field;

constexpr uint64_t limits_annotation = 0xe0ee2b2f8ea4d7b7;  // scene.capnp
constexpr size_t longest_text = 1000;

schema::Limits::Reader limits_of(Field field) {
    for (const auto annotation : field.getProto().getAnnotations()) {
        if (annotation.getId() == limits_annotation) return annotation.getValue().getStruct().getAs<schema::Limits>();
    }
    return {};
}

bool allowed(double value, schema::Limits::Reader limits) {
    return (value >= limits.getLow() && value <= limits.getHigh()) || (limits.getOrZero() && value == 0);
}

std::string allowed_text(schema::Limits::Reader limits) {
    const std::string unit = limits.getUnit();
    const std::string zero = limits.getOrZero() ? "0 or " : "";
    if (std::isinf(limits.getHigh())) return zero + "at least " + with_unit(limits.getLow(), unit);
    return zero + "between " + value_text(limits.getLow()) + " and " + with_unit(limits.getHigh(), unit);
}

/// The units in which the value would be allowed.
std::string suggestion(double value, schema::Limits::Reader limits) {
    std::vector<std::string> units;
    for (const auto slip : limits.getSlips()) {
        if (allowed(value * slip.getFactor(), limits)) units.emplace_back(slip.getUnit());
    }
    return units.empty() ? "" : " (did you mean " + joined(units, " or ") + "?)";
}

/// The first place where a text is not UTF-8 or has a control character; its size where there is none.
size_t first_bad_letter(std::string_view text) {
    size_t at = 0;
    while (at < text.size()) {
        const auto lead = static_cast<unsigned char>(text[at]);
        const size_t length = lead < 0x80 ? 1 : lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
        const bool lead_fits = lead >= 0x20 && lead != 0x7f && (lead < 0x80 || (lead >= 0xc2 && lead <= 0xf4));
        if (!lead_fits || at + length > text.size()) return at;
        for (size_t k = 1; k < length; ++k) {
            if ((static_cast<unsigned char>(text[at + k]) & 0xc0) != 0x80) return at;
        }
        at += length;
    }
    return at;
}

class Walk {
public:
    explicit Walk(Problems& problems) : problems(problems) {}

    void entries(DynamicStruct::Reader message, const std::string& path) {
        for (const auto field : message.getSchema().getFields()) {
            if (!message.has(field)) continue;  // an absent text, list or struct, or the other choices of a union
            entry(message, field, (path.empty() ? "" : path + ".") + field.getProto().getName().cStr());
        }
    }

private:
    void entry(DynamicStruct::Reader message, Field field, const std::string& path) {
        const DynamicValue::Reader value = message.get(field);
        switch (field.getType().which()) {
            case capnp::schema::Type::STRUCT: return entries(value.as<DynamicStruct>(), path);
            case capnp::schema::Type::FLOAT64:
                return number(value.as<double>(), limits_of(field), path, is_open(field));
            case capnp::schema::Type::INT32: return number(value.as<int32_t>(), limits_of(field), path, false);
            case capnp::schema::Type::TEXT: return text(value.as<capnp::Text>(), path);
            case capnp::schema::Type::LIST: return list(value.as<capnp::DynamicList>(), field, path);
            default: return;
        }
    }

    void list(capnp::DynamicList::Reader items, Field field, const std::string& path) {
        const capnp::Type type = items.getSchema().getElementType();
        if (type.isFloat64()) return numbers(items.as<Numbers>(), limits_of(field), path);
        for (uint32_t i = 0; i < items.size(); ++i) {
            if (type.isStruct()) entries(items[i].as<DynamicStruct>(), item_path(path, i));
            if (type.isList()) numbers(items[i].as<Numbers>(), limits_of(field), item_path(path, i));
        }
    }

    void numbers(Numbers::Reader values, schema::Limits::Reader limits, const std::string& path) {
        for (uint32_t i = 0; i < values.size(); ++i) {
            if (!std::isfinite(values[i]) || !allowed(values[i], limits))
                number(values[i], limits, item_path(path, i), false);
        }
    }

    void number(double value, schema::Limits::Reader limits, const std::string& path, bool open) {
        if (std::isnan(value) && open) return;
        if (std::isnan(value)) return problems.add(path + ": is not a number");
        if (allowed(value, limits)) return;
        problems.add(path + " = " + with_unit(value, limits.getUnit()) + ": must be " + allowed_text(limits) +
                     suggestion(value, limits));
    }

    void text(std::string_view letters, const std::string& path) {
        if (letters.size() > longest_text) {
            problems.add(path + ": is a text of " + std::to_string(letters.size()) + " bytes; at most " +
                         std::to_string(longest_text) + " are allowed");
        } else if (first_bad_letter(letters) < letters.size()) {
            problems.add(path + ": has a control character or is not UTF-8 at byte " +
                         std::to_string(first_bad_letter(letters)));
        }
    }

    void text(capnp::Text::Reader letters, const std::string& path) {
        text(std::string_view(letters.begin(), letters.size()), path);
    }

    static bool is_open(Field field) { return std::isnan(field.getProto().getSlot().getDefaultValue().getFloat64()); }

    Problems& problems;
};

}  // namespace

void check_entries(schema::Scene::Reader message, Problems& problems) { Walk(problems).entries(message, ""); }

}  // namespace talus
