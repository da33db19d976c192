#include "engine/scene/json_document.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/scene/json_syntax.h"
#include "engine/scene/text_reader.h"

namespace sahl {
namespace {

// Tells how far the parser has read.
struct CountingIterator {
    // NOLINTBEGIN(readability-identifier-naming): the standard's names
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;
    // NOLINTEND(readability-identifier-naming)

    const char* at;
    const char** reached;

    reference operator*() const { return *at; }
    CountingIterator& operator++() {
        *reached = ++at;
        return *this;
    }
    CountingIterator operator++(int) {
        CountingIterator old = *this;
        ++*this;
        return old;
    }
    bool operator==(const CountingIterator& other) const { return at == other.at; }
    bool operator!=(const CountingIterator& other) const { return at != other.at; }
};

}  // namespace

// Receives the parser's events. A container's values wait on a stack until it closes; then they go to
// the document's lists side by side.
class JsonTreeBuilder {
public:
    explicit JsonTreeBuilder(JsonDocument& document) : document_(document), reached_(document.text_.data()) {}

    void build() {
        const std::string& text = document_.text_;
        const CountingIterator first{text.data(), &reached_};
        const CountingIterator last{text.data() + text.size(), &reached_};
        nlohmann::json::sax_parse(first, last, this, nlohmann::json::input_format_t::json, true, true);
        document_.root_ = values_.at(0);
    }

    // What nlohmann::json::sax_parse calls; false would end the parsing.
    bool null() { return add(JsonKind::null, 0); }
    bool boolean(bool value) { return add(JsonKind::boolean, value ? 1 : 0); }
    bool number_integer(std::int64_t value) { return add_number(static_cast<double>(value)); }
    bool number_unsigned(std::uint64_t value) { return add_number(static_cast<double>(value)); }
    bool number_float(double value, const std::string&) { return add_number(value); }
    bool binary(const std::vector<std::uint8_t>&) { return false; }

    bool string(std::string& value) {
        values_.push_back({JsonKind::text, token_start(), 0, keep(value), 0});
        return finish_token(JsonAfter::value);
    }

    bool key(std::string& value) {
        const std::uint32_t start = token_start();
        keys_.push_back({document_.texts_[keep(value)], start});
        return finish_token(JsonAfter::key);
    }

    bool start_object(std::size_t) { return open(true); }
    bool start_array(std::size_t) { return open(false); }

    bool end_array() {
        const Frame frame = frames_.back();
        auto& elements = document_.elements_;
        const auto first = values_.begin() + static_cast<std::ptrdiff_t>(frame.first_value);
        const auto start = static_cast<std::uint32_t>(elements.size());
        elements.insert(elements.end(), first, values_.end());
        return close(JsonKind::array, start);
    }

    bool end_object() {
        const Frame frame = frames_.back();
        const std::size_t count = values_.size() - frame.first_value;
        const std::size_t first_key = keys_.size() - count;
        auto& members = document_.members_;
        const auto start = static_cast<std::uint32_t>(members.size());
        for (std::size_t i = 0; i < count; ++i) {
            const Key& key = keys_[first_key + i];
            members.push_back({key.text, key.offset, values_[frame.first_value + i]});
        }
        keys_.resize(first_key);
        refuse_twins(std::span(members).subspan(start));
        return close(JsonKind::object, start);
    }

    template <typename Exception>
    bool parse_error(std::size_t, const std::string&, const Exception&) {
        const JsonSyntaxError error = explain_json_error(document_.text_, cursor_, after_,
                                                         frames_.empty()            ? JsonInside::file
                                                         : frames_.back().is_object ? JsonInside::object
                                                                                    : JsonInside::array);
        throw SceneError(document_.place(error.offset), error.message);
    }

private:
    struct Frame {
        bool is_object;
        std::uint32_t offset;
        std::size_t first_value;
    };
    struct Key {
        std::string_view text;
        std::uint32_t offset;
    };

    // Where the token that was just read begins: nothing but separators lies before it.
    std::uint32_t token_start() const {
        return static_cast<std::uint32_t>(skip_json_separators(document_.text_, cursor_));
    }

    bool finish_token(JsonAfter after) {
        cursor_ = static_cast<std::size_t>(reached_ - document_.text_.data());
        after_ = after;
        return true;
    }

    bool add(JsonKind kind, double number) {
        values_.push_back({kind, token_start(), number, 0, 0});
        return finish_token(JsonAfter::value);
    }

    // To see a number's end the parser has to read on.
    bool add_number(double value) {
        add(JsonKind::number, value);
        const std::string_view text = document_.text_;
        cursor_ = std::min(text.find_first_not_of("+-.0123456789eE", values_.back().offset), text.size());
        return true;
    }

    std::uint32_t keep(std::string& text) {
        document_.texts_.push_back(std::move(text));
        return static_cast<std::uint32_t>(document_.texts_.size() - 1);
    }

    bool open(bool is_object) {
        const std::uint32_t start = token_start();
        if (frames_.size() >= static_cast<std::size_t>(deepest_json)) {
            throw SceneError(
                document_.place(start),
                fmt::format("arrays and objects are nested deeper than {}; nest them less", deepest_json));
        }
        frames_.push_back({is_object, start, values_.size()});
        return finish_token(is_object ? JsonAfter::open_object : JsonAfter::open_array);
    }

    bool close(JsonKind kind, std::uint32_t first) {
        const Frame frame = frames_.back();
        frames_.pop_back();
        const auto count = static_cast<std::uint32_t>(values_.size() - frame.first_value);
        values_.resize(frame.first_value);
        values_.push_back({kind, frame.offset, 0, first, count});
        return finish_token(JsonAfter::value);
    }

    void refuse_twins(std::span<const JsonMember> members) const {
        std::vector<const JsonMember*> sorted;
        sorted.reserve(members.size());
        for (const JsonMember& member : members) sorted.push_back(&member);
        std::stable_sort(sorted.begin(), sorted.end(),
                         [](const JsonMember* a, const JsonMember* b) { return a->key < b->key; });
        const auto twin =
            std::adjacent_find(sorted.begin(), sorted.end(),
                               [](const JsonMember* a, const JsonMember* b) { return a->key == b->key; });
        if (twin == sorted.end()) return;
        const JsonMember& second = **std::next(twin);
        throw SceneError(document_.place(second),
                         fmt::format("the key {} is there a second time; the first is on line {}. Keep one "
                                     "of them",
                                     in_quotes(second.key), document_.place(**twin).line));
    }

    JsonDocument& document_;
    const char* reached_;     // behind the last byte that the parser took
    std::size_t cursor_ = 0;  // behind the last token
    JsonAfter after_ = JsonAfter::start;
    std::vector<Frame> frames_;
    std::vector<JsonValue> values_;
    std::vector<Key> keys_;
};

JsonDocument::JsonDocument(std::string name, std::string text)
    : name_(std::move(name)), text_(std::move(text)) {
    if (text_.starts_with("\xef\xbb\xbf")) text_.erase(0, 3);
    find_lines();
    if (const auto error = find_json_bad_byte(text_)) throw SceneError(place(error->offset), error->message);
    JsonTreeBuilder(*this).build();
}

// Lines end in LF, CR LF or CR.
void JsonDocument::find_lines() {
    line_starts_.push_back(0);
    for (std::size_t i = text_.find_first_of("\r\n"); i < text_.size();
         i = text_.find_first_of("\r\n", i + 1)) {
        const bool before_feed = text_[i] == '\r' && i + 1 < text_.size() && text_[i + 1] == '\n';
        if (!before_feed) line_starts_.push_back(static_cast<std::uint32_t>(i + 1));
    }
}

SourceLocation JsonDocument::place(std::size_t offset) const {
    const auto next = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
    const auto line = static_cast<int>(next - line_starts_.begin());
    return {name_, line, static_cast<int>(offset - *std::prev(next)) + 1};
}

}  // namespace sahl
