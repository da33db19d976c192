#include "engine/batch/job_record.h"

#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/device/embedded_kernels.h"
#include "engine/device/kernel_source.h"
#include "engine/scene/write_text.h"

namespace sahl {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_reasons = 3;
constexpr std::string_view hash_mark = "\"hash\":\"";

std::string dump(const Json& json) {
    // Paths may be no UTF-8, which JSON has to be.
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

const char* name_of(PixelType type) {
    constexpr const char* names[] = {"uint8", "uint16", "half", "float"};
    return names[static_cast<std::size_t>(type)];
}

std::string camera_text(const BatchJob& job) {
    if (!job.view) return job.camera;
    const Camera& view = *job.view;
    return fmt::format("eye {} look_at {} up {} fov {}", decimals(view.eye, ","), decimals(view.look_at, ","),
                       decimals(view.up, ","), decimal(view.fov_y));
}

Json settings_of(const BatchJob& job, const OutputSettings& encoding, bool has_aovs) {
    const ImageSettings& settings = job.settings;
    Json json;
    if (settings.size) json["size"] = fmt::format("{}x{}", settings.size->width, settings.size->height);
    if (settings.depth) json["depth"] = *settings.depth;
    json["spp"] = settings.spp.value_or(1);
    json["seed"] = settings.seed.value_or(0);
    if (const std::string camera = camera_text(job); !camera.empty()) json["camera"] = camera;
    if (has_aovs) {
        std::string names;
        for (const Aov aov : *settings.aovs)
            names += (names.empty() ? "" : ",") + std::string(aov_name(aov).name);
        json["aov"] = names;
    }
    if (encoding.pixel_type) json["pixel_type"] = name_of(*encoding.pixel_type);
    if (encoding.transfer) json["transfer"] = *encoding.transfer == Transfer::srgb ? "srgb" : "linear";
    if (encoding.rounding) json["rounding"] = *encoding.rounding == Rounding::round ? "round" : "floor";
    if (encoding.exposure != 0) json["exposure"] = decimal(encoding.exposure);
    if (encoding.compression) json["compression"] = *encoding.compression;
    return json;
}

std::string shown(const Json& value) { return value.is_string() ? value.get<std::string>() : dump(value); }

/// "NAME changed from A to B" for each member that differs.
void compare_values(const Json& old, const Json& current, std::vector<std::string>& reasons) {
    for (const auto& [name, value] : current.items()) {
        if (!old.contains(name)) {
            reasons.push_back(fmt::format("{} is now {}", name, shown(value)));
        } else if (old[name] != value) {
            reasons.push_back(fmt::format("{} changed from {} to {}", name, shown(old[name]), shown(value)));
        }
    }
    for (const auto& [name, value] : old.items())
        if (!current.contains(name)) reasons.push_back(fmt::format("{} was {}", name, shown(value)));
}

/// The scene's own parts bear no file's name.
bool is_part_of(std::string_view part, std::string_view file, bool is_main) {
    const std::size_t colon = part.find(": ");
    return is_main ? colon == std::string_view::npos : part.substr(0, colon) == file;
}

void compare_parts(const Json& old, const Json& current, const std::string& file, bool is_main,
                   std::vector<std::string>& reasons) {
    const std::size_t before = reasons.size();
    const std::string prefix = is_main ? file + ": " : "";
    for (const auto& [part, hash] : current.items()) {
        if (!is_part_of(part, file, is_main)) continue;
        if (!old.contains(part))
            reasons.push_back(fmt::format("{}{} is new", prefix, part));
        else if (old[part] != hash)
            reasons.push_back(fmt::format("{}{} changed", prefix, part));
    }
    for (const auto& [part, hash] : old.items())
        if (is_part_of(part, file, is_main) && !current.contains(part))
            reasons.push_back(fmt::format("{}{} is gone", prefix, part));
    if (reasons.size() == before) reasons.push_back(file + " changed");
}

void compare_files(const Json& old, const Json& current, std::vector<std::string>& reasons) {
    const Json& old_files = old["files"];
    const Json& files = current["files"];
    bool is_main = true;
    for (const auto& [file, hash] : files.items()) {
        if (!old_files.contains(file))
            reasons.push_back(file + " is new");
        else if (hash == "missing")
            reasons.push_back(file + " is gone");
        else if (old_files[file] != hash)
            compare_parts(old["parts"], current["parts"], file, is_main, reasons);
        is_main = false;
    }
    for (const auto& [file, hash] : old_files.items())
        if (!files.contains(file)) reasons.push_back(file + " is no longer used");
}

Json parse_record(const std::string& record) {
    Json json = Json::parse(record, nullptr, false);
    for (const char* key : {"hash", "engine", "kernels", "settings", "parameters", "files", "parts"})
        if (!json.is_object() || !json.contains(key)) return {};
    return json;
}

}  // namespace

EngineIdentity engine_identity() {
    std::vector<std::string> names;
    for (const EmbeddedKernel& kernel : embedded_kernels())
        if (kernel.name.ends_with(".cl")) names.emplace_back(kernel.name);
    return {SAHL_VERSION, content_hash(expand_files(names).text)};
}

std::string make_record(const BatchJob& job, const OutputSettings& encoding, bool has_aovs,
                        const SceneContent& content, const EngineIdentity& engine) {
    Json record;
    record["engine"] = engine.version;
    record["kernels"] = engine.kernels.substr(0, 16);
    record["settings"] = settings_of(job, encoding, has_aovs);
    record["parameters"] = Json::object();
    for (const auto& [name, text] : job.parameters) record["parameters"][name] = text;
    record["files"] = Json::object();
    for (const ContentFile& file : content.files) record["files"][file.name] = file.content_hash;
    std::string text = dump(record);
    const std::string hash = content_hash(text);
    text.pop_back();  // the brace
    return fmt::format("{},{}{}\",\"parts\":{}}}", text, hash_mark, hash, content.parts);
}

std::string hash_of_record(const std::string& record) {
    // Inside a text the quotes would be escaped; the records of thousands of images are not to be parsed.
    const std::size_t mark = record.find(hash_mark);
    if (mark == std::string::npos) return "";
    const std::size_t start = mark + hash_mark.size();
    return record.substr(start, record.find('"', start) - start);
}

std::string difference_of_records(const std::string& old, const std::string& current) try {
    const Json before = parse_record(old);
    const Json now = parse_record(current);
    if (!before.is_object()) return "it has no record of where it came from";
    if (before["hash"] == now["hash"]) return "";
    std::vector<std::string> reasons;
    if (before["engine"] != now["engine"])
        reasons.push_back(
            fmt::format("Sahl changed from {} to {}", shown(before["engine"]), shown(now["engine"])));
    if (before["kernels"] != now["kernels"]) reasons.emplace_back("the kernels changed");
    compare_values(before["settings"], now["settings"], reasons);
    compare_values(before["parameters"], now["parameters"], reasons);
    compare_files(before, now, reasons);
    const std::size_t more = reasons.size() > most_reasons ? reasons.size() - most_reasons : 0;
    reasons.resize(reasons.size() - more);
    std::string text = fmt::format("{}", fmt::join(reasons, ", "));
    if (more > 0) text += fmt::format(" and {} more", more);
    return text;
} catch (const Json::exception&) {
    return "its record is damaged";
}

}  // namespace sahl
