#include "engine/scene/scene_json_values.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/core/nearest.h"
#include "engine/scene/text_reader.h"

namespace sahl {
namespace {

constexpr double largest_integer = 9007199254740992.0;  // 2^53
constexpr std::string_view vector_form = "a vector ([x, y, z])";
constexpr std::string_view color_form = "a colour ([r, g, b] or one number)";

std::string describe(const JsonDocument& document, const JsonValue& value) {
    switch (value.kind) {
        case JsonKind::null:
            return "null";
        case JsonKind::boolean:
            return value.number != 0 ? "true" : "false";
        case JsonKind::number:
            return fmt::format("the number {}", value.number);
        case JsonKind::text:
            return fmt::format("the string {}", in_quotes(document.text(value)));
        case JsonKind::array:
            return fmt::format("an array of {} value{}", value.count, value.count == 1 ? "" : "s");
        case JsonKind::object:
            break;
    }
    return "an object";
}

}  // namespace

std::string suggest(std::string_view name, std::string_view plural, std::span<const std::string_view> names) {
    const std::string hint = did_you_mean(name, names);
    if (!hint.empty()) return hint;
    if (names.empty())
        return plural.starts_with("its ") ? "; there are none" : fmt::format("; there are no {}", plural);
    std::string longer;  // 'radius' is the end of 'base_radius'
    for (const std::string_view known : names) {
        if (name.empty() || !known.ends_with(fmt::format("_{}", name))) continue;
        longer += fmt::format("{}'{}'", longer.empty() ? "" : " or ", known);
    }
    if (!longer.empty()) return fmt::format("; did you mean {}?", longer);
    constexpr std::size_t most = 24;
    const bool all = names.size() <= most;
    return fmt::format("; {} are {}{}", plural, join_names(names.first(std::min(most, names.size()))),
                       all ? "" : ", …");
}

void JsonReader::fail(const JsonValue& value, const std::string& message) const {
    throw SceneError(place(value), message);
}

void JsonReader::fail_type(const JsonValue& value, std::string_view what, std::string_view expected) const {
    const Parameter* p = parameters_ == nullptr ? nullptr : parameter(value);
    const std::string found = p != nullptr ? fmt::format("the parameter {}, which is {}", in_quotes(p->name),
                                                         parameter_type_form(p->type))
                                           : describe(document_, value);
    fail(value, fmt::format("{}: expected {}, found {}", what, expected, found));
}

const Parameter* JsonReader::parameter(const JsonValue& value) const {
    if (value.kind != JsonKind::text) return nullptr;
    std::string_view name = document_.text(value);
    if (!name.starts_with('$')) return nullptr;
    name.remove_prefix(1);
    if (parameters_ == nullptr) {
        fail(value, fmt::format("{} refers to a parameter; here only plain values are allowed",
                                in_quotes(document_.text(value))));
    }
    const auto found = std::find_if(parameters_->begin(), parameters_->end(),
                                    [&](const Parameter& p) { return p.name == name; });
    if (found == parameters_->end()) {
        const std::vector<std::string_view> names = parameter_names(*parameters_);
        fail(value, fmt::format("there is no parameter {}{}", in_quotes(name),
                                names.empty() ? "; this file declares none"
                                              : suggest(name, "parameters of this file", names)));
    }
    found->used = true;
    return &*found;
}

double JsonReader::check(double number, const JsonValue& value, std::string_view what, Range range) const {
    // The message is put together only when it is thrown: a scene has millions of numbers.
    if (!range.contains(number)) check_range(number, range, in_quotes(what), place(value));
    return number;
}

bool JsonReader::is_number(const JsonValue& value) const {
    if (value.kind == JsonKind::number) return true;
    const Parameter* p = parameter(value);
    return p != nullptr && is_numeric(p->type);
}

double JsonReader::number(const JsonValue& value, std::string_view what, Range range) const {
    if (value.kind == JsonKind::number) return check(value.number, value, what, range);
    const Parameter* p = parameter(value);
    if (p == nullptr || !is_numeric(p->type)) fail_type(value, what, "a number");
    return check(std::get<double>(p->value), value, what, range);
}

double JsonReader::integer(const JsonValue& value, std::string_view what, Range range) const {
    double number = value.number;
    if (value.kind != JsonKind::number) {
        const Parameter* p = parameter(value);
        if (p == nullptr || p->type != ParameterType::integer) fail_type(value, what, "an integer");
        number = std::get<double>(p->value);
    }
    if (std::floor(number) != number || std::abs(number) > largest_integer) {
        fail_type(value, what, "an integer");
    }
    return check(number, value, what, range);
}

bool JsonReader::boolean(const JsonValue& value, std::string_view what) const {
    if (value.kind == JsonKind::boolean) return value.number != 0;
    const Parameter* p = parameter(value);
    if (p == nullptr || p->type != ParameterType::boolean) fail_type(value, what, "true or false");
    return std::get<bool>(p->value);
}

std::string_view JsonReader::text(const JsonValue& value, std::string_view what) const {
    const Parameter* p = parameter(value);
    if (p == nullptr && value.kind == JsonKind::text) return document_.text(value);
    if (p == nullptr || p->type != ParameterType::text) fail_type(value, what, "a string");
    return std::get<std::string>(p->value);
}

void JsonReader::numbers(const JsonValue& value, std::string_view what, std::string_view expected,
                         std::span<double> result) const {
    if (value.kind != JsonKind::array || value.count != result.size()) fail_type(value, what, expected);
    const std::span<const JsonValue> elements = document_.elements(value);
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = number(elements[i], what);
}

glm::dvec3 JsonReader::vector(const JsonValue& value, std::string_view what, Range range) const {
    const Parameter* p = parameter(value);
    if (p != nullptr) {
        if (p->type != ParameterType::vector) fail_type(value, what, vector_form);
        const glm::dvec3 v = std::get<glm::dvec3>(p->value);
        for (int axis = 0; axis < 3; ++axis) check(v[axis], value, what, range);
        return v;
    }
    if (value.kind != JsonKind::array || value.count != 3) fail_type(value, what, vector_form);
    const std::span<const JsonValue> elements = document_.elements(value);
    glm::dvec3 v;
    for (int axis = 0; axis < 3; ++axis)
        v[axis] = number(elements[static_cast<std::size_t>(axis)], what, range);
    return v;
}

glm::dvec3 JsonReader::direction(const JsonValue& value, std::string_view what) const {
    const glm::dvec3 v = vector(value, what);
    if (glm::length(v) < min_length) {
        fail(value, fmt::format("{} is zero; give it a direction", in_quotes(what)));
    }
    return v;
}

glm::dvec3 JsonReader::color(const JsonValue& value, std::string_view what) const {
    if (is_number(value)) return glm::dvec3(number(value, what, not_negative));
    const Parameter* p = parameter(value);
    if (p != nullptr) {
        if (p->type != ParameterType::color) fail_type(value, what, color_form);
        return std::get<glm::dvec3>(p->value);
    }
    if (value.kind != JsonKind::array || value.count != 3) fail_type(value, what, color_form);
    return vector(value, what, not_negative);
}

std::span<const JsonValue> JsonReader::array(const JsonValue& value, std::string_view what,
                                             std::string_view expected) const {
    if (value.kind != JsonKind::array) fail_type(value, what, expected);
    return document_.elements(value);
}

std::span<const JsonMember> JsonReader::members(const JsonValue& value, std::string_view what) const {
    if (value.kind != JsonKind::object) fail_type(value, what, "an object");
    return document_.members(value);
}

std::size_t JsonReader::choice(const JsonValue& value, std::string_view what, std::string_view plural,
                               std::span<const std::string_view> names) const {
    const std::string_view name = text(value, what);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
        fail(value, fmt::format("unknown {} {}{}", what, in_quotes(name), suggest(name, plural, names)));
    }
    return static_cast<std::size_t>(found - names.begin());
}

void check_name(const JsonReader& reader, const JsonMember& member, std::string_view noun) {
    if (!member.key.empty() && !member.key.starts_with('$')) return;
    throw SceneError(reader.document().place(member),
                     member.key.empty()
                         ? fmt::format("this {}'s name is empty; give it one", noun)
                         : fmt::format("the name {} of a {} begins with $, as only parameters do where they "
                                       "are used; give it another",
                                       in_quotes(member.key), noun));
}

JsonObject::JsonObject(const JsonReader& reader, const JsonValue& value, std::string_view noun,
                       std::initializer_list<std::string_view> required,
                       std::initializer_list<std::string_view> optional,
                       std::span<const std::string_view> more)
    : reader_(reader), value_(value) {
    if (value.kind != JsonKind::object) reader.fail_type(value, noun, "an object");
    members_ = reader.document().members(value);
    const auto among = [](const auto& names, std::string_view key) {
        return std::find(names.begin(), names.end(), key) != names.end();
    };
    for (const JsonMember& member : members_) {
        if (among(required, member.key) || among(optional, member.key) || among(more, member.key)) continue;
        std::vector<std::string_view> names(required);
        names.insert(names.end(), optional.begin(), optional.end());
        names.insert(names.end(), more.begin(), more.end());
        const bool vowel = std::string_view("aeiou").find(noun[0]) != std::string_view::npos;
        const std::string_view article = vowel ? "an" : "a";
        throw SceneError(reader.document().place(member),
                         fmt::format("unknown key {} of {} {}{}", in_quotes(member.key), article, noun,
                                     suggest(member.key, "its keys", names)));
    }
    for (const std::string_view key : required) {
        if (find(key) == nullptr)
            throw SceneError(place(), fmt::format("this {} has no '{}'; add it", noun, key));
    }
}

const JsonValue* JsonObject::find(std::string_view key) const {
    const auto found =
        std::find_if(members_.begin(), members_.end(), [&](const JsonMember& m) { return m.key == key; });
    return found == members_.end() ? nullptr : &found->value;
}

double JsonObject::number(std::string_view key, double otherwise, Range range) const {
    const JsonValue* value = find(key);
    return value == nullptr ? otherwise : reader_.number(*value, key, range);
}

bool JsonObject::boolean(std::string_view key, bool otherwise) const {
    const JsonValue* value = find(key);
    return value == nullptr ? otherwise : reader_.boolean(*value, key);
}

glm::dvec3 JsonObject::vector(std::string_view key, glm::dvec3 otherwise, Range range) const {
    const JsonValue* value = find(key);
    return value == nullptr ? otherwise : reader_.vector(*value, key, range);
}

glm::dvec3 JsonObject::direction(std::string_view key, glm::dvec3 otherwise) const {
    const JsonValue* value = find(key);
    return value == nullptr ? otherwise : reader_.direction(*value, key);
}

glm::dvec3 JsonObject::color(std::string_view key, glm::dvec3 otherwise) const {
    const JsonValue* value = find(key);
    return value == nullptr ? otherwise : reader_.color(*value, key);
}

}  // namespace sahl
