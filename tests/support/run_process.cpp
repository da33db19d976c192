#include "tests/support/run_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <fstream>
#include <string>
#include <system_error>
#include <thread>

namespace sahl::tests {

namespace {

void check(int error, const char* what) {
    if (error != 0) throw std::system_error(error, std::generic_category(), what);
}

/// Both ends close at destruction and are not inherited (posix_spawn's dup2 makes the copies that are).
struct Pipe {
    int read_end = -1;
    int write_end = -1;

    Pipe() {
        std::array<int, 2> ends{};
        if (pipe2(ends.data(), O_CLOEXEC) != 0) check(errno, "pipe2");
        read_end = ends[0];
        write_end = ends[1];
    }
    ~Pipe() {
        close_end(read_end);
        close_end(write_end);
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;

    static void close_end(int& end) {
        if (end >= 0) close(end);
        end = -1;
    }
};

std::vector<std::string> child_environment(const ProcessOptions& options) {
    std::vector<std::string> variables;
    for (char** entry = environ; *entry != nullptr; ++entry) {
        const std::string variable = *entry;
        if (!options.environment.contains(variable.substr(0, variable.find('='))))
            variables.push_back(variable);
    }
    for (const auto& [name, value] : options.environment) {
        if (value) variables.push_back(name + "=" + *value);
    }
    return variables;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> result;
    result.reserve(texts.size() + 1);
    for (std::string& text : texts) result.push_back(text.data());
    result.push_back(nullptr);
    return result;
}

pid_t spawn(std::vector<std::string> command, const ProcessOptions& options, const Pipe& out,
            const Pipe& err) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    if (options.standard_output.empty()) {
        posix_spawn_file_actions_adddup2(&actions, out.write_end, 1);
    } else {
        posix_spawn_file_actions_addopen(&actions, 1, options.standard_output.c_str(), O_WRONLY | O_CREAT,
                                         0600);
    }
    posix_spawn_file_actions_adddup2(&actions, err.write_end, 2);
    if (!options.working_directory.empty()) {
        posix_spawn_file_actions_addchdir_np(&actions, options.working_directory.c_str());
    }

    // The child starts with the default SIGPIPE, whatever this process has chosen.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGPIPE);
    posix_spawnattr_setsigdefault(&attributes, &signals);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);

    std::vector<std::string> variables = child_environment(options);
    pid_t child = -1;
    const int error = posix_spawn(&child, command.front().c_str(), &actions, &attributes,
                                  pointers(command).data(), pointers(variables).data());
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    check(error, command.front().c_str());
    return child;
}

/// Reads what is there into `text`; closes the end at the end of file.
void drain(int& end, std::string& text) {
    std::array<char, 4096> bytes{};
    const ssize_t count = read(end, bytes.data(), bytes.size());
    if (count > 0) {
        text.append(bytes.data(), static_cast<std::size_t>(count));
    } else if (count == 0) {
        Pipe::close_end(end);
    }
}

}  // namespace

struct Process::Impl {
    Pipe out;
    Pipe err;
    pid_t child = -1;
    std::chrono::steady_clock::time_point deadline;
    ProcessResult result;

    /// Takes in what the process has written; waits for something, for a second after it was killed.
    /// False when there is nothing more to come.
    bool read_some() {
        if (out.read_end < 0 && err.read_end < 0) return false;
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
            deadline - std::chrono::steady_clock::now());
        if (left.count() <= 0 && !result.timed_out) {
            result.timed_out = true;
            kill(child, SIGKILL);
        }
        // poll() passes over closed ends (-1).
        std::array<pollfd, 2> ends{pollfd{out.read_end, POLLIN, 0}, pollfd{err.read_end, POLLIN, 0}};
        const int timeout = result.timed_out ? 1000 : static_cast<int>(left.count()) + 1;
        if (poll(ends.data(), ends.size(), timeout) <= 0) {
            // Killed, and still nobody closes the pipes: a grandchild holds them.
            return !result.timed_out;
        }
        if (ends[0].revents != 0) drain(out.read_end, result.out);
        if (ends[1].revents != 0) drain(err.read_end, result.err);
        return true;
    }

    void wait() {
        int status = 0;
        rusage usage{};
        while (wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
        }
        result.peak_bytes = static_cast<std::size_t>(usage.ru_maxrss) * 1024;
        child = -1;
        result.status = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    }
};

Process::Process(const std::vector<std::string>& command, const ProcessOptions& options)
    : impl_(std::make_unique<Impl>()) {
    if (options.broken_pipe) Pipe::close_end(impl_->out.read_end);
    impl_->child = spawn(command, options, impl_->out, impl_->err);
    impl_->deadline = std::chrono::steady_clock::now() + options.timeout;
    Pipe::close_end(impl_->out.write_end);
    Pipe::close_end(impl_->err.write_end);
}

Process::~Process() {
    if (impl_->child < 0) return;
    kill(impl_->child, SIGKILL);
    impl_->wait();
}

pid_t Process::id() const { return impl_->child; }

void Process::send_signal(int number) const { kill(impl_->child, number); }

bool Process::wait_for_output() {
    while (impl_->result.out.find('\n') == std::string::npos) {
        if (!impl_->read_some()) return false;
    }
    return true;
}

ProcessResult Process::finish() {
    while (impl_->read_some()) {
    }
    impl_->wait();
    return std::move(impl_->result);
}

std::vector<pid_t> children_of(pid_t parent) {
    std::vector<pid_t> children;
    const std::string id = std::to_string(parent);
    std::ifstream file("/proc/" + id + "/task/" + id + "/children");
    for (pid_t child = 0; file >> child;) children.push_back(child);
    return children;
}

bool comes_true(const std::function<bool()>& condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!condition() && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return condition();
}

ProcessResult run_process(const std::vector<std::string>& command, const ProcessOptions& options) {
    return Process(command, options).finish();
}

}  // namespace sahl::tests
