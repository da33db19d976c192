#include "engine/scene/scene_json_parameters.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "engine/scene/scene_json_values.h"
#include "engine/scene/text_reader.h"

namespace sahl {
namespace {

constexpr std::array<std::string_view, 6> type_names = {"number", "integer", "vector",
                                                        "color",  "boolean", "text"};

ParameterValue read_value(const JsonReader& reader, const Parameter& parameter, const JsonValue& value,
                          std::string_view what) {
    switch (parameter.type) {
        case ParameterType::number:
            return reader.number(value, what, parameter.range);
        case ParameterType::integer:
            return reader.integer(value, what, parameter.range);
        case ParameterType::vector:
            return reader.vector(value, what);
        case ParameterType::color:
            return reader.color(value, what);
        case ParameterType::boolean:
            return reader.boolean(value, what);
        case ParameterType::text:
            break;
    }
    return std::string(reader.text(value, what));
}

// [A-Za-z_][A-Za-z0-9_]*, whatever the locale.
bool is_parameter_name(std::string_view name) {
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
    return !name.empty() && letter(name[0]) &&
           std::all_of(name.begin(), name.end(), [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}

Parameter read_parameter(const JsonReader& reader, const JsonMember& member) {
    if (!is_parameter_name(member.key)) {
        throw SceneError(reader.document().place(member),
                         fmt::format("{} cannot name a parameter; use letters, digits and _, and no digit "
                                     "first",
                                     in_quotes(member.key)));
    }
    const JsonObject object(reader, member.value, "parameter", {"type", "default"},
                            {"min", "max", "description"});
    Parameter parameter;
    parameter.name = member.key;
    parameter.place = reader.document().place(member);
    parameter.type = static_cast<ParameterType>(
        reader.choice(object.at("type"), "type", "types of parameters", type_names));
    if (const JsonValue* text = object.find("description")) {
        if (text->kind != JsonKind::text) reader.fail_type(*text, "description", "a string");
    }
    for (const std::string_view key : {"min", "max"}) {
        const JsonValue* value = object.find(key);
        if (value == nullptr) continue;
        if (!is_numeric(parameter.type)) {
            reader.fail(*value, fmt::format("'{}' is for numbers and integers; remove it", key));
        }
        const double end = parameter.type == ParameterType::integer ? reader.integer(*value, key)
                                                                    : reader.number(*value, key);
        (key == "min" ? parameter.range.low : parameter.range.high) = end;
    }
    if (parameter.range.low > parameter.range.high) {
        reader.fail(object.at(object.find("max") != nullptr ? "max" : "min"),
                    "'max' is less than 'min'; exchange them");
    }
    parameter.value = read_value(reader, parameter, object.at("default"), "default");
    return parameter;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t first = std::min(text.find_first_not_of(' '), text.size());
    return text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

std::optional<double> parse_number(std::string_view text) {
    text = trimmed(text);
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = error == std::errc() && end == text.data() + text.size();
    return whole && any_number.contains(value) ? std::optional(value) : std::nullopt;
}

std::optional<glm::dvec3> parse_vector(std::string_view text) {
    glm::dvec3 v;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t comma = text.find(',');
        if ((comma == std::string_view::npos) != (axis == 2)) return std::nullopt;
        const std::optional<double> number = parse_number(text.substr(0, comma));
        if (!number) return std::nullopt;
        v[axis] = *number;
        if (axis < 2) text.remove_prefix(comma + 1);
    }
    return v;
}

// None: no value of this type and range.
std::optional<ParameterValue> parse_value(const Parameter& parameter, std::string_view text) {
    switch (parameter.type) {
        case ParameterType::number:
        case ParameterType::integer: {
            const std::optional<double> number = parse_number(text);
            if (!number || !parameter.range.contains(*number)) return std::nullopt;
            if (parameter.type == ParameterType::integer && std::floor(*number) != *number)
                return std::nullopt;
            return *number;
        }
        case ParameterType::vector:
            if (const auto v = parse_vector(text)) return *v;
            return std::nullopt;
        case ParameterType::color: {
            const std::optional<double> grey = parse_number(text);
            const std::optional<glm::dvec3> c = grey ? glm::dvec3(*grey) : parse_vector(text);
            if (!c || c->r < 0 || c->g < 0 || c->b < 0) return std::nullopt;
            return *c;
        }
        case ParameterType::boolean:
            if (text == "true" || text == "false") return text == "true";
            return std::nullopt;
        case ParameterType::text:
            break;
    }
    return std::string(text);
}

// "an integer from 1 to 9", "a vector, such as 1,0,0".
std::string allowed_values(const Parameter& parameter) {
    const Range& range = parameter.range;
    std::string text(parameter_type_form(parameter.type));
    const bool low = range.low != any_number.low;
    const bool high = range.high != any_number.high;
    if (low && high) text += fmt::format(" from {} to {}", number_text(range.low), number_text(range.high));
    if (low && !high) text += fmt::format(" of at least {}", number_text(range.low));
    if (high && !low) text += fmt::format(" of at most {}", number_text(range.high));
    if (parameter.type == ParameterType::vector) text += ", such as 1,0,0";
    if (parameter.type == ParameterType::color) text += ", such as 1,0.5,0 or 0.5, nowhere negative";
    return text;
}

Parameter* find_parameter(std::vector<Parameter>& parameters, std::string_view name) {
    const auto found = std::find_if(parameters.begin(), parameters.end(),
                                    [&](const Parameter& p) { return p.name == name; });
    return found == parameters.end() ? nullptr : &*found;
}

std::string no_parameter(const std::vector<Parameter>& parameters, std::string_view file,
                         std::string_view name) {
    const std::vector<std::string_view> names = parameter_names(parameters);
    if (names.empty()) return fmt::format("{} has no parameters", file);
    return fmt::format("{} has no parameter {}{}", file, in_quotes(name),
                       suggest(name, "its parameters", names));
}

}  // namespace

std::string_view parameter_type_form(ParameterType type) {
    constexpr std::array<std::string_view, 6> forms = {"a number", "an integer",    "a vector",
                                                       "a colour", "true or false", "a text"};
    return forms[static_cast<std::size_t>(type)];
}

std::vector<std::string_view> parameter_names(const std::vector<Parameter>& parameters) {
    std::vector<std::string_view> names;
    names.reserve(parameters.size());
    for (const Parameter& p : parameters) names.push_back(p.name);
    return names;
}

std::vector<Parameter> read_parameters(const JsonDocument& document, const JsonValue& object) {
    const JsonReader reader(document, nullptr);
    std::vector<Parameter> parameters;
    for (const JsonMember& member : reader.members(object, "parameters")) {
        parameters.push_back(read_parameter(reader, member));
    }
    return parameters;
}

void set_parameters(std::vector<Parameter>& parameters, std::string_view file,
                    const std::vector<std::pair<std::string, std::string>>& values) {
    for (const auto& [name, text] : values) {
        Parameter* parameter = find_parameter(parameters, name);
        if (parameter == nullptr) {
            throw Error(ExitCode::usage,
                        fmt::format("--set {}={}: {}", name, text, no_parameter(parameters, file, name)));
        }
        std::optional<ParameterValue> value = parse_value(*parameter, text);
        if (!value) {
            throw Error(ExitCode::usage,
                        fmt::format("--set {}={}: the parameter {} of {} is {}; found {}", name, text,
                                    in_quotes(name), file, allowed_values(*parameter), in_quotes(text)));
        }
        parameter->value = std::move(*value);
    }
}

void set_parameters(std::vector<Parameter>& parameters, std::string_view file, const JsonReader& reader,
                    const JsonValue& object) {
    for (const JsonMember& member : reader.members(object, "set")) {
        Parameter* parameter = find_parameter(parameters, member.key);
        if (parameter == nullptr) {
            throw SceneError(reader.document().place(member), no_parameter(parameters, file, member.key));
        }
        parameter->value = read_value(reader, *parameter, member.value, member.key);
    }
}

void check_parameters_used(const std::vector<Parameter>& parameters) {
    for (const Parameter& p : parameters) {
        if (!p.used) {
            throw SceneError(p.place, fmt::format("the parameter {} is never used; write \"${}\" where its "
                                                  "value belongs, or remove it",
                                                  in_quotes(p.name), p.name));
        }
    }
}

}  // namespace sahl
