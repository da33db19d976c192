// Runs the Catch2 tests. CATCH_CONFIG_NO_POSIX_SIGNALS: PoCL has signal handlers of its own.
#define CATCH_CONFIG_RUNNER
#define CATCH_CONFIG_NO_POSIX_SIGNALS
#include <catch2/catch.hpp>

#include <cstdlib>

namespace {

// What the environment says wins over what the build knows.
void set_default(const char* name, const char* value) {
    if (*value != '\0') setenv(name, value, 0);
}

}  // namespace

int main(int argc, char* argv[]) {
    set_default("POCL_SIGFPE_HANDLER", "0");
    set_default("SAHL_SOURCE_DIR", SAHL_SOURCE_DIR);
    set_default("SAHL_TEST_DATA", SAHL_TEST_DATA);
#ifdef SAHL_BINARY
    set_default("SAHL_BINARY", SAHL_BINARY);
#endif
    return Catch::Session().run(argc, argv);
}
