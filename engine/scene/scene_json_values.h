// Typed values of a Sahl scene: numbers, vectors, colours, texts, with parameters put in.
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/scene/json_document.h"
#include "engine/scene/scene_json_parameters.h"
#include "engine/scene/validate.h"

namespace sahl {

/// Reads values. `what` names the value in messages; all errors are SceneError at the value's place.
class JsonReader {
public:
    /// Without `parameters` nothing may refer to one. What is referred to is marked as used there.
    JsonReader(const JsonDocument& document, std::vector<Parameter>* parameters)
        : document_(document), parameters_(parameters) {}

    const JsonDocument& document() const { return document_; }
    SourceLocation place(const JsonValue& value) const { return document_.place(value); }

    double number(const JsonValue& value, std::string_view what, Range range = any_number) const;
    /// A whole number within ±2^53.
    double integer(const JsonValue& value, std::string_view what, Range range = any_number) const;
    bool boolean(const JsonValue& value, std::string_view what) const;
    std::string_view text(const JsonValue& value, std::string_view what) const;
    glm::dvec3 vector(const JsonValue& value, std::string_view what, Range range = any_number) const;
    /// Other than zero.
    glm::dvec3 direction(const JsonValue& value, std::string_view what) const;
    /// Three numbers or one for grey, none negative.
    glm::dvec3 color(const JsonValue& value, std::string_view what) const;
    std::span<const JsonValue> array(const JsonValue& value, std::string_view what,
                                     std::string_view expected) const;
    /// An array of `size` numbers.
    void numbers(const JsonValue& value, std::string_view what, std::string_view expected,
                 std::span<double> result) const;
    std::span<const JsonMember> members(const JsonValue& value, std::string_view what) const;
    /// The index of a text among `names`, which are `plural`.
    std::size_t choice(const JsonValue& value, std::string_view what, std::string_view plural,
                       std::span<const std::string_view> names) const;

    /// Whether the value, or the parameter it refers to, is a single number.
    bool is_number(const JsonValue& value) const;

    [[noreturn]] void fail(const JsonValue& value, const std::string& message) const;
    /// "`what`: expected `expected`, found …"
    [[noreturn]] void fail_type(const JsonValue& value, std::string_view what,
                                std::string_view expected) const;

private:
    const Parameter* parameter(const JsonValue& value) const;
    double check(double number, const JsonValue& value, std::string_view what, Range range) const;

    const JsonDocument& document_;
    std::vector<Parameter>* parameters_;
};

/// An object with a fixed set of keys.
class JsonObject {
public:
    /// Throws SceneError, at its place, for what is no object, a key that is none of these, and a
    /// required one that is missing. `noun` says what the object is.
    JsonObject(const JsonReader& reader, const JsonValue& value, std::string_view noun,
               std::initializer_list<std::string_view> required,
               std::initializer_list<std::string_view> optional = {},
               std::span<const std::string_view> more = {});

    const JsonReader& reader() const { return reader_; }
    const JsonValue& value() const { return value_; }
    SourceLocation place() const { return reader_.place(value_); }
    const JsonValue* find(std::string_view key) const;
    /// A key that is there.
    const JsonValue& at(std::string_view key) const { return *find(key); }

    // The value of a key, or `otherwise` if there is none.
    double number(std::string_view key, double otherwise, Range range = any_number) const;
    bool boolean(std::string_view key, bool otherwise) const;
    glm::dvec3 vector(std::string_view key, glm::dvec3 otherwise, Range range = any_number) const;
    glm::dvec3 direction(std::string_view key, glm::dvec3 otherwise) const;
    glm::dvec3 color(std::string_view key, glm::dvec3 otherwise) const;

private:
    const JsonReader& reader_;
    const JsonValue& value_;
    std::span<const JsonMember> members_;
};

/// Throws SceneError at the key unless it can name a `noun`: it is not empty and begins with no "$",
/// which would make it a parameter's.
void check_name(const JsonReader& reader, const JsonMember& member, std::string_view noun);

/// "; did you mean 'sphere'?", or the names if none is near.
std::string suggest(std::string_view name, std::string_view plural, std::span<const std::string_view> names);

}  // namespace sahl
