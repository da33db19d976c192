// A file that is encoded while its image is still rendered.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/film/film.h"
#include "engine/film/image_io.h"

namespace sahl {

/// Whether files of this format can be: PNG, whose metadata come last. Throws as check_output_format.
bool can_encode_early(const std::filesystem::path& path);

/// Encodes, in a thread of its own, what is finished of a film. Where it ends without write(), nothing is
/// written.
class EarlyEncoder {
public:
    /// The file `path` of the image that `film` becomes with `samples` a pixel; can_encode_early has to be
    /// true of it. `film` outlives this. Throws as check_output_format.
    EarlyEncoder(const Film& film, int samples, const std::filesystem::path& path,
                 const OutputSettings& settings);
    ~EarlyEncoder();
    EarlyEncoder(const EarlyEncoder&) = delete;
    EarlyEncoder& operator=(const EarlyEncoder&) = delete;

    /// Nothing is added to the first `rows` rows any more. Throws what has failed by now.
    void set_finished(int rows);

    /// Once all rows are finished: writes the file, byte for byte as write_image would with `metadata`
    /// instead of that of the settings. Throws as write_image.
    void write(const std::vector<std::pair<std::string, std::string>>& metadata);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace sahl
