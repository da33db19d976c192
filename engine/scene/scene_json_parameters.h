// Named parameters of a Sahl scene: declared with type, default and range, set from outside.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/core/error.h"
#include "engine/scene/json_document.h"
#include "engine/scene/validate.h"

namespace sahl {

class JsonReader;

enum class ParameterType { number, integer, vector, color, boolean, text };

/// A number or an integer is a double, a vector or a colour a dvec3.
using ParameterValue = std::variant<double, glm::dvec3, bool, std::string>;

struct Parameter {
    std::string name;
    ParameterType type = ParameterType::number;
    Range range = any_number;  ///< of numbers and integers
    ParameterValue value = 0.0;
    SourceLocation place{};  ///< of the declaration
    bool used = false;
};

inline bool is_numeric(ParameterType type) {
    return type == ParameterType::number || type == ParameterType::integer;
}

/// "a number", "a colour", …
std::string_view parameter_type_form(ParameterType type);

std::vector<std::string_view> parameter_names(const std::vector<Parameter>& parameters);

/// The declarations, `object` being the value of "parameters", with their defaults.
std::vector<Parameter> read_parameters(const JsonDocument& document, const JsonValue& object);

/// Sets parameters of `file` from texts. Throws Error(usage) for names it does not have and for values
/// of the wrong type or range.
void set_parameters(std::vector<Parameter>& parameters, std::string_view file,
                    const std::vector<std::pair<std::string, std::string>>& values);

/// Sets parameters of `file` from an object of another file. Throws SceneError at its places.
void set_parameters(std::vector<Parameter>& parameters, std::string_view file, const JsonReader& reader,
                    const JsonValue& object);

/// Throws SceneError at the declaration of a parameter that nothing has used.
void check_parameters_used(const std::vector<Parameter>& parameters);

}  // namespace sahl
