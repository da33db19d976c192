#include "cli/batch_process.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string_view>

#include <fmt/format.h>

#include "cli/batch_order.h"

namespace sahl::cli {

namespace {

[[noreturn]] void fail(const char* what) {
    throw Error(ExitCode::memory,
                fmt::format("no worker can be started ({}: {}); end other programs or raise the "
                            "limit on processes (ulimit -u)",
                            what, std::strerror(errno)));
}

std::array<int, 2> make_sockets() {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) fail("socketpair");
    return ends;
}

constexpr const char* worker_name = "sahl-worker";  // in lists of processes too

/// Async-signal-safe: other threads may have been in the midst of anything.
[[noreturn]] void become_worker(pid_t supervisor, int log, char** arguments) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != supervisor) _exit(0);  // gone before it was heard of
    ::dup2(::open("/dev/null", O_RDONLY | O_CLOEXEC), STDIN_FILENO);
    ::dup2(log, STDOUT_FILENO);
    ::dup2(log, STDERR_FILENO);
    const rlimit no_core_file{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core_file);
    // When the machine runs out of memory it is this process that goes, not the one that can say so.
    const int score = ::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
    const bool scored = ::write(score, "1000", 4) == 4;
    static_cast<void>(scored);  // where that is not allowed, chance decides
    ::execv("/proc/self/exe", arguments);
    constexpr std::string_view message = "sahl: error: /proc/self/exe cannot be started; mount /proc\n";
    static_cast<void>(::write(STDERR_FILENO, message.data(), message.size()) < 0);
    _exit(127);
}

}  // namespace

WorkerProcess::WorkerProcess(const WorkerSettings& settings) : socket_(-1), log_(-1) {
    const std::array<int, 2> ends = make_sockets();
    // Never full, never blocking, gone with the processes; appending, for it is emptied in between.
    log_ = ::memfd_create("sahl-worker-log", MFD_CLOEXEC);
    if (log_ < 0 || ::fcntl(log_, F_SETFL, O_APPEND) != 0) fail("memfd_create");
    const pid_t supervisor = ::getpid();
    const int inherited = ::dup(ends[1]);  // without close-on-exec
    std::string name = worker_name;
    std::string socket = std::to_string(inherited);
    std::array<char*, 3> arguments{name.data(), socket.data(), nullptr};
    id_ = ::fork();
    if (id_ == 0) become_worker(supervisor, log_, arguments.data());
    ::close(inherited);
    ::close(ends[1]);
    socket_.reset(ends[0]);
    if (id_ < 0) fail("fork");
    socket_.send(message_of(settings));
}

WorkerProcess::~WorkerProcess() {
    if (id_ >= 0) {
        kill();
        wait();
    }
    ::close(socket_.file());
    ::close(log_);
}

std::string WorkerProcess::take_log() {
    std::string text;
    std::array<char, 4096> bytes{};
    for (ssize_t count = 0;
         (count = ::pread(log_, bytes.data(), bytes.size(), static_cast<off_t>(text.size()))) > 0;)
        text.append(bytes.data(), static_cast<std::size_t>(count));
    if (!text.empty() && ::ftruncate(log_, 0) != 0) return text;  // it comes once more then
    return text;
}

void WorkerProcess::kill() { ::kill(id_, SIGKILL); }

std::string WorkerProcess::wait() {
    int status = 0;
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = -1;
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) return "was killed, perhaps for want of memory";
    if (WIFSIGNALED(status)) return fmt::format("crashed ({})", strsignal(WTERMSIG(status)));
    return fmt::format("ended with status {}", WEXITSTATUS(status));
}

std::optional<int> worker_socket(int argc, char** argv) {
    if (argc != 2 || argv[0] != std::string_view(worker_name)) return std::nullopt;
    const int socket = std::stoi(argv[1]);
    ::fcntl(socket, F_SETFD, FD_CLOEXEC);  // a compiler that it starts may live longer
    ::prctl(PR_SET_NAME, worker_name);
    return socket;
}

}  // namespace sahl::cli
