#include "engine/core/child_process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>

#include "engine/core/error.h"

namespace sahl {
namespace {

constexpr int unfinished = 1;  // the exit status of work that threw

[[noreturn]] void fail(const char* what) {
    throw Error(ExitCode::memory, std::string("no second process can be started (") + what + ": " +
                                      std::strerror(errno) +
                                      "); end other programs or raise the limit on "
                                      "processes (ulimit -u)");
}

[[noreturn]] void be_child(const std::function<void(PipeEnd)>& work, int out) {
    // Signals end this process, whatever the parent does about them, and so does the parent's end.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    sigset_t none;
    sigemptyset(&none);
    pthread_sigmask(SIG_SETMASK, &none, nullptr);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGALRM}) std::signal(signal, SIG_DFL);
    std::signal(SIGPIPE, SIG_IGN);
    const rlimit no_core_file{0, 0};
    setrlimit(RLIMIT_CORE, &no_core_file);
    const int nothing = open("/dev/null", O_RDWR);
    for (const int file : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, file);
    try {
        work(PipeEnd(out));
        _exit(0);  // no exit handlers: they are the parent's
    } catch (...) {
        _exit(unfinished);
    }
}

std::string cause_of(int status) {
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return "";
    if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGALRM))
        return "takes more time than it should";
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) return "was killed, perhaps for want of memory";
    if (WIFSIGNALED(status)) return std::string("crashes (") + strsignal(WTERMSIG(status)) + ")";
    return "crashes";
}

/// The child while it runs; killed unless it was waited for.
class Child {
public:
    explicit Child(pid_t id) : id_(id) {}
    ~Child() {
        if (id_ < 0) return;
        kill(id_, SIGKILL);
        wait();
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// Its status for waitpid's macros.
    int wait() {
        int status = 0;
        while (waitpid(id_, &status, 0) < 0 && errno == EINTR) {
        }
        id_ = -1;
        return status;
    }

private:
    pid_t id_;
};

/// A file descriptor that closes.
struct OwnedFile {
    int file;
    explicit OwnedFile(int descriptor) : file(descriptor) {}
    ~OwnedFile() { close(file); }
    OwnedFile(const OwnedFile&) = delete;
    OwnedFile& operator=(const OwnedFile&) = delete;
};

/// Bytes of address space, program and libraries included.
std::size_t address_space() {
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace

bool PipeEnd::write(std::span<const std::byte> bytes) const {
    while (!bytes.empty()) {
        const ssize_t count = ::write(file_, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
    return true;
}

bool PipeEnd::read(std::span<std::byte> bytes) const {
    while (!bytes.empty()) {
        const ssize_t count = ::read(file_, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
    return true;
}

std::string run_in_child(const std::function<void(PipeEnd)>& work,
                         const std::function<void(PipeEnd)>& receive) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) fail("pipe");
    const pid_t id = fork();
    if (id == 0) {
        close(ends[0]);  // a write that nobody reads must fail
        be_child(work, ends[1]);
    }
    close(ends[1]);  // or the end of what the child writes would never come
    if (id < 0) {
        close(ends[0]);
        fail("fork");
    }
    Child child(id);
    {
        const OwnedFile in(ends[0]);
        receive(PipeEnd(in.file));
    }  // closed: a child that still writes ends
    return cause_of(child.wait());
}

void limit_process(std::size_t bytes, std::size_t seconds) {
    rlimit memory{};
    getrlimit(RLIMIT_AS, &memory);
    memory.rlim_cur = std::min<rlim_t>(memory.rlim_max, address_space() + bytes);
    setrlimit(RLIMIT_AS, &memory);
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    rlimit time{};
    getrlimit(RLIMIT_CPU, &time);
    // The kernel counts whole seconds.
    time.rlim_cur = std::min<rlim_t>(
        time.rlim_max, static_cast<rlim_t>(used.ru_utime.tv_sec + used.ru_stime.tv_sec + 2) + seconds);
    setrlimit(RLIMIT_CPU, &time);
    // Who waits for a lock takes no processor time. Busy machines need longer for the same work.
    alarm(static_cast<unsigned>(3 * seconds + 8));
}

}  // namespace sahl
