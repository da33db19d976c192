// The record inside an image file, and whether the file is whole.
#pragma once

#include <filesystem>
#include <string>

namespace sahl {

/// Whether files of this format keep their record in their metadata: EXR and PNG do.
bool keeps_record(const std::filesystem::path& path);

struct StoredRecord {
    std::string record{};   ///< empty: there is none
    std::string problem{};  ///< why the file is no finished image, in words; empty: it is one
};

/// Reads the record of an EXR or PNG file that Sahl wrote, without decoding pixels, and without trusting the
/// file: every length in it is checked. A file that ends too early, or has rows that were never written, is a
/// problem.
StoredRecord read_image_record(const std::filesystem::path& path);

}  // namespace sahl
