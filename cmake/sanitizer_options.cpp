// Defaults of the sanitizer builds' programs; ASAN_OPTIONS, LSAN_OPTIONS and TSAN_OPTIONS win over them.

extern "C" {

const char* __asan_default_options();
const char* __lsan_default_options();
const char* __tsan_default_options();

// The interceptor misreads the thread-local storage of libraries that are loaded late, as OpenCL
// drivers are: the leak check then crashes.
const char* __asan_default_options() { return "intercept_tls_get_addr=0"; }

const char* __lsan_default_options() {
    return "print_suppressions=0:suppressions='" SAHL_SUPPRESSIONS "/leak_suppressions.txt'";
}

const char* __tsan_default_options() {
    return "suppressions='" SAHL_SUPPRESSIONS "/thread_suppressions.txt'";
}
}
