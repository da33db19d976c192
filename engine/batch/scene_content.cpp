#include "engine/batch/scene_content.h"

#include <sha1.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "engine/scene/json_document.h"
#include "engine/scene/scene_format.h"
#include "engine/scene/text_reader.h"

namespace sahl {
namespace {

namespace fs = std::filesystem;

using Json = nlohmann::ordered_json;
using Texts = std::map<std::string, std::string, std::less<>>;

constexpr std::size_t most_parts = 300;     // of a file; beyond, only its sections are told apart
constexpr std::size_t most_files = 10'000;  // as many as the loader reads
constexpr const char* missing = "missing";

/// A place where a file names another.
struct Reference {
    std::string uri;  ///< or "$" and the name of a parameter
    Texts set;        ///< of the other's parameters, in the same form
};

/// What is known of one file, whatever the parameters.
struct FileSummary {
    std::string bytes_hash;
    std::string content_hash;
    std::vector<std::pair<std::string, std::string>> parts;
    std::vector<Reference> references;
    Texts text_parameters;  ///< with their defaults
};

/// SHA-1 of what is added.
class Hasher {
public:
    Hasher() { SHA1Init(&sha_); }
    template <class T>
    void add(const T& value) {
        add_bytes(&value, sizeof(value));
    }
    void add(std::string_view text) {
        add(text.size());
        add_bytes(text.data(), text.size());
    }
    void add_bytes(const void* bytes, std::size_t count) {
        SHA1Update(&sha_, static_cast<const std::uint8_t*>(bytes), count);
    }
    std::string digest() {
        std::array<std::uint8_t, SHA1_DIGEST_LENGTH> bytes{};
        SHA1Final(bytes.data(), &sha_);
        return fmt::format("{:02X}", fmt::join(bytes, ""));
    }

private:
    SHA1_CTX sha_{};
};

void add_value(Hasher& hasher, const JsonDocument& document, const JsonValue& value) {
    hasher.add(value.kind);
    switch (value.kind) {
        case JsonKind::null:
            break;
        case JsonKind::boolean:
        case JsonKind::number:
            hasher.add(value.number);
            break;
        case JsonKind::text:
            hasher.add(document.text(value));
            break;
        case JsonKind::array:
            hasher.add(value.count);
            for (const JsonValue& element : document.elements(value)) add_value(hasher, document, element);
            break;
        case JsonKind::object:
            hasher.add(value.count);
            for (const JsonMember& member : document.members(value)) {
                hasher.add(member.key);
                add_value(hasher, document, member.value);
            }
            break;
    }
}

std::string short_hash(const JsonDocument& document, const JsonValue& value) {
    Hasher hasher;
    add_value(hasher, document, value);
    return hasher.digest().substr(0, 8);
}

/// Names for what is changed are wanted, and a name for each of a million triangles is not.
void add_parts(const JsonDocument& document, const std::string& name, const JsonValue& value, int depth,
               std::vector<std::pair<std::string, std::string>>& parts) {
    const bool is_object = value.kind == JsonKind::object;
    const bool is_list = value.kind == JsonKind::array && value.count > 0 &&
                         document.elements(value).front().kind == JsonKind::object;
    if (depth == 0 || !(is_object || is_list) || parts.size() + value.count > most_parts) {
        parts.emplace_back(name, short_hash(document, value));
        return;
    }
    if (is_object) {
        for (const JsonMember& member : document.members(value))
            add_parts(document, fmt::format("{}.{}", name, member.key), member.value, depth - 1, parts);
        return;
    }
    std::size_t index = 0;
    for (const JsonValue& element : document.elements(value))
        add_parts(document, fmt::format("{}[{}]", name, index++), element, depth - 1, parts);
}

bool is_description(std::string_view key) { return key == "$schema" || key == "description"; }

void find_references(const JsonDocument& document, const JsonValue& value,
                     std::vector<Reference>& references) {
    if (value.kind == JsonKind::array) {
        for (const JsonValue& element : document.elements(value))
            find_references(document, element, references);
    }
    if (value.kind != JsonKind::object) return;
    Reference reference;
    for (const JsonMember& member : document.members(value)) {
        if (member.key == "uri" && member.value.kind == JsonKind::text)
            reference.uri = document.text(member.value);
        if (member.key == "set" && member.value.kind == JsonKind::object) {
            for (const JsonMember& set : document.members(member.value))
                if (set.value.kind == JsonKind::text)
                    reference.set[std::string(set.key)] = document.text(set.value);
        }
        find_references(document, member.value, references);
    }
    if (!reference.uri.empty()) references.push_back(std::move(reference));
}

void read_text_parameters(const JsonDocument& document, const JsonValue& parameters, Texts& texts) {
    if (parameters.kind != JsonKind::object) return;
    for (const JsonMember& parameter : document.members(parameters)) {
        if (parameter.value.kind != JsonKind::object) continue;
        for (const JsonMember& member : document.members(parameter.value))
            if (member.key == "default" && member.value.kind == JsonKind::text)
                texts[std::string(parameter.key)] = document.text(member.value);
    }
}

void summarize_json(const fs::path& path, std::string text, FileSummary& summary) {
    const JsonDocument document(path.string(), std::move(text));
    if (document.root().kind != JsonKind::object) return;
    Hasher hasher;
    for (const JsonMember& member : document.members(document.root())) {
        if (is_description(member.key)) continue;
        hasher.add(member.key);
        add_value(hasher, document, member.value);
        add_parts(document, std::string(member.key), member.value, 2, summary.parts);
        if (member.key == "parameters") read_text_parameters(document, member.value, summary.text_parameters);
    }
    summary.content_hash = hasher.digest();
    find_references(document, document.root(), summary.references);
}

FileSummary summarize(const fs::path& path) {
    FileSummary summary{missing, missing, {}, {}, {}};
    std::string bytes;
    try {
        bytes = read_scene_file(path);
    } catch (const Error&) {
        return summary;  // the loader will say what is wrong
    }
    summary.bytes_hash = content_hash(bytes);
    summary.content_hash = summary.bytes_hash;
    if (scene_format(path) != SceneFormat::json) return summary;
    try {
        summarize_json(path, std::move(bytes), summary);
    } catch (const Error&) {
        summary.parts.clear();
    }
    return summary;
}

std::string resolve(const std::string& text, const Texts& parameters) {
    if (!text.starts_with('$')) return text;
    const auto found = parameters.find(std::string_view(text).substr(1));
    return found == parameters.end() ? text : found->second;
}

}  // namespace

struct SceneContents::Impl {
    std::map<fs::path, FileSummary> files;
    std::map<std::string, SceneContent> scenes;  ///< by path and parameters that name files

    const FileSummary& file(const fs::path& path) {
        const auto found = files.find(path);
        return found != files.end() ? found->second : files.emplace(path, summarize(path)).first->second;
    }

    void add(const fs::path& path, const fs::path& root, const Texts& set, int depth, SceneContent& content,
             Json& parts) {
        const FileSummary& summary = file(path);
        const bool is_first = content.files.empty();
        const std::string name =
            is_first ? path.filename().string() : path.lexically_normal().lexically_relative(root).string();
        const auto same = [&](const ContentFile& known) { return known.name == name; };
        const bool is_new = std::none_of(content.files.begin(), content.files.end(), same);
        if (is_new) {
            content.files.push_back({name, path, summary.bytes_hash, summary.content_hash});
            for (const auto& [part, hash] : summary.parts) parts[is_first ? part : name + ": " + part] = hash;
        }
        if (depth == 0 || content.files.size() > most_files) return;
        Texts parameters = summary.text_parameters;
        for (auto& [parameter, text] : parameters)
            if (const auto found = set.find(parameter); found != set.end()) text = found->second;
        for (const Reference& reference : summary.references) {
            Texts inner;
            for (const auto& [parameter, text] : reference.set) inner[parameter] = resolve(text, parameters);
            const fs::path other = path.parent_path() / resolve(reference.uri, parameters);
            // The same file with the same values again leads to nothing new.
            if (!is_new && inner.empty()) continue;
            add(other, root, inner, depth - 1, content, parts);
        }
    }
};

SceneContents::SceneContents() : impl_(std::make_unique<Impl>()) {}
SceneContents::~SceneContents() = default;

const SceneContent& SceneContents::of(const fs::path& scene,
                                      const std::vector<std::pair<std::string, std::string>>& parameters) {
    const Texts& texts = impl_->file(scene).text_parameters;
    Texts set;
    std::string key = scene.string();
    for (const auto& [name, text] : parameters) {
        if (!texts.contains(name)) continue;
        set[name] = text;
        key += fmt::format("\n{}={}", name, text);
    }
    const auto [found, is_new] = impl_->scenes.try_emplace(std::move(key));
    if (is_new) {
        constexpr int deepest_include = 16;
        Json parts = Json::object();
        impl_->add(scene, scene.parent_path().lexically_normal(), set, deepest_include, found->second, parts);
        found->second.parts = parts.dump(-1, ' ', false, Json::error_handler_t::replace);
    }
    return found->second;
}

std::string content_hash(std::string_view bytes) {
    Hasher hasher;
    hasher.add_bytes(bytes.data(), bytes.size());
    return hasher.digest();
}

bool is_unchanged(const SceneContent& content) {
    return std::all_of(content.files.begin(), content.files.end(), [](const ContentFile& file) {
        try {
            return content_hash(read_scene_file(file.path)) == file.bytes_hash;
        } catch (const Error&) {
            return file.bytes_hash == missing;
        }
    });
}

}  // namespace sahl
