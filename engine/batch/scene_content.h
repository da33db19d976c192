// What a scene is made of, in hashes: its file, the files it includes, and what stands in them.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sahl {

/// SHA-1 as 40 hexadecimal digits: of content that nobody forges, where 160 bits are enough never to meet.
std::string content_hash(std::string_view bytes);

/// A file that a scene is read from.
struct ContentFile {
    std::string name;            ///< relative to the scene's folder
    std::filesystem::path path;  ///< to open it by
    std::string bytes_hash;      ///< of the file as it is; "missing" if there is none
    std::string content_hash;    ///< without comments, layout and descriptions
};

struct SceneContent {
    std::vector<ContentFile> files;  ///< the scene's own first
    /// Places in the files and short hashes of what stands there, such as "materials.red.diffuse"; those
    /// of included files begin with "FILE: ". A JSON object, ready for all the records that it goes into. For
    /// explanations: the files' hashes have it all.
    std::string parts = "{}";
};

/// Reads each file once, however many jobs ask.
class SceneContents {
public:
    SceneContents();
    ~SceneContents();

    /// Of `scene` with parameters as `--set` gives them: they may name files. What is wrong in a file is
    /// the loader's business: it counts by its bytes here.
    const SceneContent& of(const std::filesystem::path& scene,
                           const std::vector<std::pair<std::string, std::string>>& parameters);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Whether the files are, byte for byte, what they were when `content` was taken.
bool is_unchanged(const SceneContent& content);

}  // namespace sahl
