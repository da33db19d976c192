// A JSON text as a tree in which every value and every key knows its place in the file.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.h"

namespace sahl {

enum class JsonKind : std::uint8_t { null, boolean, number, text, array, object };

/// A value; the document holds what does not fit.
struct JsonValue {
    JsonKind kind = JsonKind::null;
    std::uint32_t offset = 0;  ///< of its first byte in the document
    double number = 0;         ///< 0 or 1 of a boolean
    std::uint32_t first = 0;   ///< of its elements, members or text in the document's lists
    std::uint32_t count = 0;   ///< of its elements or members
};

struct JsonMember {
    std::string_view key;
    std::uint32_t key_offset = 0;
    JsonValue value;
};

/// Containers in containers, the outermost included.
constexpr int deepest_json = 100;

class JsonDocument {
public:
    /// Parses JSON with // and /* */ comments in UTF-8; a byte order mark is skipped and has no column.
    /// `name` is the file in messages. Throws SceneError at its place for what is no such text, for a
    /// key that an object has twice, for numbers beyond double's range and containers nested deeper
    /// than `deepest_json`.
    JsonDocument(std::string name, std::string text);

    JsonDocument(const JsonDocument&) = delete;
    JsonDocument& operator=(const JsonDocument&) = delete;

    const std::string& name() const { return name_; }
    const JsonValue& root() const { return root_; }

    /// Of an array.
    std::span<const JsonValue> elements(const JsonValue& array) const {
        return {elements_.data() + array.first, array.count};
    }
    /// Of an object, in the order of the file.
    std::span<const JsonMember> members(const JsonValue& object) const {
        return {members_.data() + object.first, object.count};
    }
    /// Of a text, without its quotes and escapes.
    std::string_view text(const JsonValue& text) const { return texts_[text.first]; }

    SourceLocation place(const JsonValue& value) const { return place(value.offset); }
    SourceLocation place(const JsonMember& member) const { return place(member.key_offset); }

private:
    friend class JsonTreeBuilder;
    SourceLocation place(std::size_t offset) const;
    void find_lines();

    std::string name_;
    std::string text_;  // without a byte order mark
    std::vector<std::uint32_t> line_starts_;
    std::vector<JsonValue> elements_;
    std::vector<JsonMember> members_;
    std::deque<std::string> texts_;  // members' keys point into it
    JsonValue root_;
};

}  // namespace sahl
