# Writes OUTPUT, a C++ source with the table behind engine/device/embedded_kernels.h.
# Usage: cmake -DOUTPUT=<file> -P embed_kernels.cmake <kernel file>…
# Bytes as numbers: string literals have length limits and escapes.

set(arrays "")
set(table "")
set(is_file FALSE)
set(count 0)
math(EXPR last "${CMAKE_ARGC} - 1")
foreach(i RANGE ${last})
    set(argument "${CMAKE_ARGV${i}}")
    if(is_file)
        file(READ "${argument}" bytes HEX)
        string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
        get_filename_component(name "${argument}" NAME)
        # The closing 0 is not part of the text; it makes an empty file a valid array.
        string(APPEND arrays "const unsigned char file_${count}[] = {${bytes}0};\n")
        string(APPEND table "    {\"${name}\", text_of(file_${count})},\n")
        math(EXPR count "${count} + 1")
    elseif(argument MATCHES "embed_kernels\\.cmake$")
        set(is_file TRUE)
    endif()
endforeach()

file(WRITE "${OUTPUT}" "// Generated from kernels/ by cmake/embed_kernels.cmake.
#include \"engine/device/embedded_kernels.h\"

#include <array>
#include <cstddef>

namespace sahl {
namespace {

${arrays}
template <std::size_t N>
std::string_view text_of(const unsigned char (&bytes)[N]) {
    return {reinterpret_cast<const char*>(bytes), N - 1};
}

}  // namespace

std::span<const EmbeddedKernel> embedded_kernels() {
    static const std::array<EmbeddedKernel, ${count}> kernels{{
${table}    }};
    return kernels;
}

}  // namespace sahl
")
