#include "engine/scene/json_layout.h"

#include <nlohmann/json.hpp>

namespace sahl {

namespace {

constexpr std::size_t line_width = 100;
constexpr std::size_t indent_step = 2;

}  // namespace

void JsonLayout::add(std::string_view key, JsonLayout value) {
    std::string label = key.empty() ? std::string() : json_string(key) + ": ";
    width_ += label.size() + value.width_ + (parts_.empty() ? 0 : 2);
    if (value.lines_ == Lines::each) width_ = line_width + 1;  // then this one takes several lines, too
    parts_.emplace_back(std::move(label), std::move(value));
}

std::string JsonLayout::text() const {
    std::string out;
    print(out, 0, 0);
    return out;
}

void JsonLayout::print_line(std::string& out) const {
    out += text_;
    if (open_ == 0) return;
    out += open_;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        if (i > 0) out += ", ";
        out += parts_[i].first;
        parts_[i].second.print_line(out);
    }
    out += close_;
}

// `column`: where the value starts.
void JsonLayout::print(std::string& out, std::size_t indent, std::size_t column) const {
    const bool fits = lines_ != Lines::each && column + width_ < line_width;
    if (open_ == 0 || parts_.empty() || fits) return print_line(out);
    const std::size_t inner = indent + indent_step;
    std::size_t position = line_width;
    out += open_;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const auto& [label, value] = parts_[i];
        if (i > 0) out += ',';
        const std::size_t width = label.size() + value.width_ + 1;  // with its comma
        if (lines_ == Lines::full && position + 1 + width <= line_width) {
            out += ' ';
            position += 1 + width;
        } else {
            out += '\n' + std::string(inner, ' ');
            position = inner + width;
        }
        out += label;
        value.print(out, inner, inner + label.size());
    }
    out += '\n' + std::string(indent, ' ') + close_;
}

std::string json_string(std::string_view text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace sahl
