#include "engine/film/image_codecs.h"

#include <dlfcn.h>

namespace sahl {
namespace {

struct Loaded {
    const ImageCodecs* codecs = nullptr;
    std::string error{};  ///< why there are none
};

/// From where the program's RUNPATH says, or where other shared libraries are. It stays until the process
/// ends: its libraries have threads and exit handlers.
Loaded load() {
    // What is bound at once, and not as it is called, is bound in all 260 libraries.
    void* const library = dlopen(image_codecs_library, RTLD_LAZY | RTLD_LOCAL | RTLD_NODELETE);
    void* const function = library != nullptr ? dlsym(library, image_codecs_function) : nullptr;
    if (function == nullptr) return {nullptr, dlerror()};
    return {reinterpret_cast<const ImageCodecs* (*)()>(function)(), {}};
}

}  // namespace

const ImageCodecs& image_codecs(ExitCode code) {
    static const Loaded loaded = load();
    if (loaded.codecs != nullptr) return *loaded.codecs;
    throw Error(code, "images can be neither read nor written: " + loaded.error +
                          "; install Sahl again, all of it, and OpenImageIO (Debian: apt-get install "
                          "libopenimageio2.4)");
}

}  // namespace sahl
