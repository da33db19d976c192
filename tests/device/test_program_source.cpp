#include <catch2/catch.hpp>

#include "engine/device/kernel_source.h"
#include "tests/device/test_device_support.h"

namespace sahl::tests {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++found;
    return found;
}

}  // namespace

TEST_CASE("kernel sources are in the library") {
    const KernelSource source = expand_files({"device_types.h"});
    CHECK(source.text.rfind("#line 1 \"kernels/device_types.h\"\n", 0) == 0);
    CHECK(contains(source.text, "} CameraConstants;"));
    CHECK(source.files.count("kernels/device_types.h") == 1);
}

TEST_CASE("includes are expanded once, with the lines of their files") {
    const TemporaryFolder folder;
    const ScopedVariable variable("SAHL_KERNEL_DIR", folder.path().string());
    write_file(folder.path() / "a.h", "#ifndef A\n#define A\n#include \"kernels/b.h\"\nint a;\n#endif\n");
    write_file(folder.path() / "b.h", "#ifndef B\nint b;\n#endif\n");
    write_file(folder.path() / "m.cl",
               "#include \"kernels/a.h\"\n  #  include \"kernels/b.h\"  // again\nint m;\n");
    const KernelSource source = expand_files({"m.cl", "b.h"});
    CHECK(source.text ==
          "#line 1 \"kernels/m.cl\"\n#line 1 \"kernels/a.h\"\n#ifndef A\n#define A\n#line 1 "
          "\"kernels/b.h\"\n#ifndef B\nint b;\n#endif\n"
          "#line 4 \"kernels/a.h\"\nint a;\n#endif\n#line 2 \"kernels/m.cl\"\n#line 3 \"kernels/m.cl\"\nint "
          "m;\n");
    CHECK(source.files.size() == 3);
}

TEST_CASE("files without an include guard are put in each time") {
    const TemporaryFolder folder;
    const ScopedVariable variable("SAHL_KERNEL_DIR", folder.path().string());
    write_file(folder.path() / "body.h", "// For one type.\n#include \"kernels/leaf.h\"\nTYPE x;\n");
    write_file(folder.path() / "leaf.h", "#ifndef LEAF\n#define LEAF\nint leaf;\n#endif\n");
    write_file(folder.path() / "m.cl",
               "#define TYPE int\n#include \"kernels/body.h\"\n#undef TYPE\n#define TYPE float\n"
               "#include \"kernels/body.h\"\n");
    const KernelSource source = expand_files({"m.cl"});
    CHECK(count(source.text, "TYPE x;") == 2);
    CHECK(count(source.text, "int leaf;") == 1);
}

TEST_CASE("an include below a conditional does not use up the file") {
    const TemporaryFolder folder;
    const ScopedVariable variable("SAHL_KERNEL_DIR", folder.path().string());
    write_file(folder.path() / "leaf.h", "#ifndef LEAF\n#define LEAF\nint leaf;\n#endif\n");
    write_file(folder.path() / "fast.h",
               "#ifndef FAST\n#define FAST\n#include \"kernels/leaf.h\"\nint fast;\n#endif\n");
    write_file(folder.path() / "m.cl",
               "#if 0\n#include \"kernels/fast.h\"\n#endif\n#include \"kernels/leaf.h\"\n"
               "#if 1\n#endif\n#include \"kernels/fast.h\"\n#include \"kernels/fast.h\"\n");
    const KernelSource source = expand_files({"m.cl"});
    CHECK(count(source.text, "int leaf;") == 2);
    CHECK(count(source.text, "int fast;") == 2);
}

TEST_CASE("files that include each other end") {
    const TemporaryFolder folder;
    const ScopedVariable variable("SAHL_KERNEL_DIR", folder.path().string());
    write_file(folder.path() / "a.h",
               "#ifndef A\n#define A\n#ifdef X\n#include \"kernels/b.h\"\n#endif\n#endif\n");
    write_file(folder.path() / "b.h",
               "#ifndef B\n#define B\n#ifdef X\n#include \"kernels/a.h\"\n#endif\n#endif\n");
    CHECK(count(expand_files({"a.h"}).text, "#ifndef B") == 1);
}

TEST_CASE("a missing kernel file is an error with its place") {
    const std::string text = "int x;\n#include \"kernels/missing.h\"\n";
    std::string message = error_of(ExitCode::device, [&] { expand_text(text); });
    CHECK(contains(message, "kernels/missing.h"));
    CHECK(contains(message, "text.cl:2"));
    const TemporaryFolder folder;
    const ScopedVariable variable("SAHL_KERNEL_DIR", folder.path().string());
    message = error_of(ExitCode::device, [&] { expand_text(text); });
    CHECK(contains(message, (folder.path() / "missing.h").string()));
    CHECK(contains(message, "SAHL_KERNEL_DIR"));
    message = error_of(ExitCode::device, [] { expand_text("#include \"other/x.h\"\n"); });
    CHECK(contains(message, "text.cl:1"));
}

TEST_CASE("build logs get excerpts, also for lines that are not there") {
    const KernelSource source = expand_text("one\ntwo\nthree\n");
    CHECK(annotate_build_log("error: text.cl:3:2: bad", source) ==
          "error: text.cl:3:2: bad\n     2 | two\n     3 | three\n       |  ^\n");
    CHECK(contains(annotate_build_log("text.cl:99:1: bad", source), "bad\n"));
    CHECK(contains(annotate_build_log("text.cl:1:999: bad", source), "     1 | one\n"));
    CHECK(annotate_build_log("other.cl:1:1: bad", source) == "other.cl:1:1: bad\n");
}

}  // namespace sahl::tests
