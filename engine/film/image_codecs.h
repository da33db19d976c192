// The codecs of the image formats, in a library of their own: they are OpenImageIO's, which comes with 260
// other libraries, a fifth of a second's work for the dynamic linker. So they are loaded when they are
// needed: to read images, and to write all but PNG.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "engine/film/file_encoder.h"

namespace sahl {

/// What a file claims to hold.
struct StoredImage {
    int width = 0;
    int height = 0;
    bool is_flat = false;  ///< one colour a pixel, one layer of pixels
    std::vector<std::string> channels{};
    float largest_code = 0;  ///< of integers of 8 or 16 bits; of others 0
};

/// An open image file, whose header has been read.
class FileDecoder {
public:
    virtual ~FileDecoder() = default;
    virtual const StoredImage& image() const = 0;
    /// `count` channels from `first` on, as floats, into the first ones of three of each pixel. False: see
    /// error().
    virtual bool read(int first, int count, float* pixels) = 0;
    virtual std::string error() const = 0;
};

/// What the library offers. Nothing in it throws but what the standard library does: errors are returned, for
/// the engine to throw its own.
struct ImageCodecs {
    /// `file`, which outlives the encoder, grows. None: `error` says why.
    std::unique_ptr<FileEncoder> (*encode)(const FileLayout& layout, std::vector<unsigned char>& file,
                                           std::string& error);
    /// None: `error` says why.
    std::unique_ptr<FileDecoder> (*decode)(const std::string& path, std::string& error);
    /// From now on codecs start no threads, each of which would count as much memory.
    void (*use_one_thread)();
};

/// Loads the library, if nobody has yet. Thread-safe. Throws Error(`code`) if it cannot be loaded.
const ImageCodecs& image_codecs(ExitCode code);

/// The library and the function in it that returns its ImageCodecs: another interface is another name.
constexpr const char* image_codecs_library = "libsahl_image_codecs.so";
constexpr const char* image_codecs_function = "sahl_image_codecs_1";

}  // namespace sahl
