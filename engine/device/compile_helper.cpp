#include "engine/device/compile_helper.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <span>
#include <string_view>

#include "engine/core/child_process.h"
#include "engine/device/pocl_environment.h"
#include "engine/device/pocl_programs.h"

namespace sahl {
namespace {

constexpr std::string_view helper_name = "sahl-compiler";  // in lists of processes too
constexpr int output_file = 3;                             // of the helper: drivers print on others

// Arguments behind the name.
enum : int { of_parent = 1, of_folder, of_device, of_group, of_traversal, of_options, argument_count };

bool write_all(int file, const std::string& text) {
    return PipeEnd(file).write(std::as_bytes(std::span(text)));
}

std::string read_all(int file) {
    std::string text;
    std::array<char, 65536> part{};
    for (;;) {
        const ssize_t got = ::read(file, part.data(), part.size());
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return text;
        text.append(part.data(), static_cast<std::size_t>(got));
    }
}

std::array<std::string, argument_count> arguments_for(const Device& device, const std::string& options) {
    return {std::string(helper_name),
            std::to_string(::getpid()),
            private_temporary_folder().string(),
            std::to_string(device.info().index),
            std::to_string(device.local_size()),
            std::to_string(static_cast<int>(device.traversal())),
            options};
}

/// A file in memory with `text`; -1 if there can be none.
int file_of(const std::string& text) {
    const int file = ::memfd_create("sahl-compile-order", MFD_CLOEXEC);
    if (file < 0) return -1;
    if (write_all(file, text) && ::lseek(file, 0, SEEK_SET) == 0) return file;
    ::close(file);
    return -1;
}

/// The helper's id, for functions that any thread may call at any time; or that there is going to be one.
std::atomic<pid_t> running = 0;
constexpr pid_t starting = -1;

void wait_for(pid_t id, int& status) {
    while (::waitpid(id, &status, 0) < 0 && errno == EINTR) {
    }
}

/// The process's temporary files go with it.
void end(int) { exit_at_once(1); }

}  // namespace

std::unique_ptr<CompileHelper> CompileHelper::start(const Device& device, const std::string& options,
                                                    const std::string& key, const std::string& built) {
    // As a file, which is read when there is time for it: nobody waits for a pipe to be emptied.
    const int order = file_of(key + '\0' + built);
    std::array<int, 2> pipe{};
    if (order < 0 || ::pipe2(pipe.data(), O_CLOEXEC) != 0) {
        ::close(order);
        return nullptr;
    }
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, order, STDIN_FILENO);
    for (const int standard : {STDOUT_FILENO, STDERR_FILENO})
        posix_spawn_file_actions_addopen(&actions, standard, "/dev/null", O_RDWR, 0);
    posix_spawn_file_actions_adddup2(&actions, pipe[1], output_file);
    std::array<std::string, argument_count> arguments = arguments_for(device, options);
    std::array<char*, argument_count + 1> pointers{};
    for (std::size_t i = 0; i < arguments.size(); ++i) pointers[i] = arguments[i].data();
    pid_t id = -1;
    running = starting;
    const int failed = ::posix_spawn(&id, "/proc/self/exe", &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    ::close(order);
    ::close(pipe[1]);
    if (failed != 0) {
        running = 0;
        ::close(pipe[0]);
        return nullptr;
    }
    running = id;
    return std::unique_ptr<CompileHelper>(new CompileHelper(id, pipe[0]));
}

void CompileHelper::kill_running() {
    const timespec moment{0, 1'000'000};
    for (int moments = 0; running == starting && moments < 1000; ++moments) ::nanosleep(&moment, nullptr);
    const pid_t id = running.exchange(0);
    if (id <= 0) return;
    ::kill(id, SIGKILL);
    int status = 0;
    wait_for(id, status);
}

CompileHelper::~CompileHelper() {
    if (id_ < 0) return;
    ::kill(id_, SIGTERM);
    take();
}

std::string CompileHelper::take() {
    const std::string packed = read_all(output_);
    ::close(output_);
    int status = -1;
    running = 0;
    wait_for(id_, status);
    id_ = -1;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? packed : std::string();
}

std::optional<DeviceOptions> take_compile_order(int argc, char** argv) {
    if (argc != argument_count || argv[0] != helper_name) return std::nullopt;
    sigset_t none;  // the other process may hold signals back
    sigemptyset(&none);
    pthread_sigmask(SIG_SETMASK, &none, nullptr);
    // PoCL aborts where it lacks room.
    for (const int signal : {SIGHUP, SIGINT, SIGTERM, SIGABRT}) std::signal(signal, end);
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (std::to_string(::getppid()) != argv[of_parent]) exit_at_once(1);  // gone before it was heard of
    DeviceOptions options;
    options.selector = argv[of_device];
    options.work_group_size = std::strtoul(argv[of_group], nullptr, 10);
    options.traversal = static_cast<Traversal>(std::atoi(argv[of_traversal]));
    options.build_options = argv[of_options];
    ::setenv("TMPDIR", argv[of_folder], 1);
    const std::string order = read_all(STDIN_FILENO);
    const std::string key = order.c_str();
    prepare_pocl(1);
    unpack_compiled(key, order.substr(std::min(key.size() + 1, order.size())));
    return options;
}

void deliver_compiled(const std::optional<std::string>& packed) {
    exit_at_once(packed && write_all(output_file, *packed) ? 0 : 1);
}

}  // namespace sahl
