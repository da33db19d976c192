// PNG files by libpng itself: OpenImageIO, which uses it too, comes with 260 libraries that most renders do
// not need.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/film/file_encoder.h"

namespace sahl {

/// `file`, which outlives the encoder, grows. None: `error` says why. Metadata are tEXt chunks, or iTXt where
/// a text is not ASCII.
/// Source: W3C 2003, "Portable Network Graphics (PNG) Specification (Second Edition)".
std::unique_ptr<FileEncoder> encode_png(const FileLayout& layout, std::vector<unsigned char>& file,
                                        std::string& error);

}  // namespace sahl
