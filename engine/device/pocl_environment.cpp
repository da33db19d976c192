#include "engine/device/pocl_environment.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <string>

#include "engine/core/error.h"
#include "engine/device/compile_helper.h"
#include "engine/device/device.h"

namespace sahl {
namespace {

namespace fs = std::filesystem;

constexpr const char* folder_prefix = "sahl-pocl-";
constexpr const char* lock_name = "lock";
constexpr const char* kernels_name = "kernels";
constexpr std::uintmax_t least_free = std::uintmax_t{32} << 20;  // bytes; PoCL aborts on a full disk

// The compiler writes up to 2 MB into one file.
constexpr std::uintmax_t largest_file = std::uintmax_t{8} << 20;

std::uintmax_t free_bytes(const struct statvfs& space) {
    return std::uintmax_t{space.f_bavail} * space.f_frsize;
}

/// The private folder's path while there is one, for functions that any thread may call at any time.
std::atomic<const char*> folder_in_use = nullptr;

[[noreturn]] void refuse(const fs::path& folder, const std::string& reason) {
    throw Error(
        ExitCode::device,
        fmt::format("{}: {}; PoCL compiles kernels into a folder below it: set TMPDIR to a folder that "
                    "can be written, that allows executable files and has {} MiB free",
                    folder.string(), reason, least_free >> 20));
}

/// A folder of this process while the lock on its file `lock` is held. The kernel gives the lock
/// back when the process dies, however it dies, so a folder whose lock is free belongs to no one.
/// (Process ids would not tell: they are used again, and containers may share a /tmp.)
class PrivateFolder {
public:
    explicit PrivateFolder(const fs::path& parent) : owner_(getpid()) {
        // Another process that tidies up may take a folder before its lock is: then once more.
        for (int attempt = 0; attempt < 8 && lock_ < 0; ++attempt) make(parent);
        if (lock_ < 0) refuse(parent, "a new folder cannot be kept there");
        try {
            check_space();
            check_executable();
        } catch (...) {
            remove();
            throw;
        }
    }
    ~PrivateFolder() { remove(); }
    PrivateFolder(const PrivateFolder&) = delete;
    PrivateFolder& operator=(const PrivateFolder&) = delete;

    const fs::path& path() const { return path_; }

private:
    void make(const fs::path& parent) {
        std::string name = (parent / fmt::format("{}{}-XXXXXX", folder_prefix, owner_)).string();
        if (mkdtemp(name.data()) == nullptr) refuse(parent, std::strerror(errno));  // mode 0700
        path_ = name;
        const int file = open((path_ / lock_name).c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
        if (file >= 0 && flock(file, LOCK_EX | LOCK_NB) == 0 && fs::exists(path_ / lock_name)) {
            lock_ = file;
            return;
        }
        if (file >= 0) close(file);
    }

    void check_space() const {
        struct statvfs space {};
        if (statvfs(path_.c_str(), &space) != 0) refuse(path_.parent_path(), std::strerror(errno));
        const std::uintmax_t free = free_bytes(space);
        if (free < least_free) refuse(path_.parent_path(), fmt::format("only {} KiB are free", free >> 10));
    }

    void check_executable() const {
        const char byte = 0;
        if (::write(lock_, &byte, 1) != 1) refuse(path_.parent_path(), std::strerror(errno));
        void* code = mmap(nullptr, 1, PROT_READ | PROT_EXEC, MAP_PRIVATE, lock_, 0);
        if (code == MAP_FAILED) refuse(path_.parent_path(), "it is mounted noexec");
        munmap(code, 1);
    }

    void remove() {
        if (getpid() != owner_) return;  // a fork's exit is not ours
        folder_in_use = nullptr;
        std::error_code ignored;
        fs::remove_all(path_, ignored);
        if (lock_ >= 0) close(lock_);
    }

    pid_t owner_;
    fs::path path_;
    int lock_ = -1;
};

/// Removes the folders that processes of this user left behind when they were killed.
void remove_stale_folders(const fs::path& parent) {
    std::error_code error;
    for (fs::directory_iterator entry(parent, error), end; !error && entry != end; entry.increment(error)) {
        const fs::path folder = entry->path();
        if (folder.filename().string().rfind(folder_prefix, 0) != 0) continue;
        struct stat status {};
        if (lstat(folder.c_str(), &status) != 0 || !S_ISDIR(status.st_mode) || status.st_uid != geteuid())
            continue;
        // Its process may have died before it made the lock; one that lives takes another folder then.
        const int file = open((folder / lock_name).c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600);
        if (file < 0) continue;
        std::error_code ignored;
        if (flock(file, LOCK_EX | LOCK_NB) == 0) fs::remove_all(folder, ignored);
        close(file);
    }
}

fs::path temporary_folder() {
    std::error_code error;
    const fs::path folder = fs::temp_directory_path(error);
    if (!error) return fs::absolute(folder);
    const char* set = std::getenv("TMPDIR");
    refuse(set != nullptr ? set : "/tmp", error.message());
}

const PrivateFolder& private_folder() {
    static const PrivateFolder folder(temporary_folder());
    return folder;
}

/// LLVM ends the process when it cannot write a file.
void check_file_size_limit() {
    rlimit limit{};
    if (getrlimit(RLIMIT_FSIZE, &limit) != 0 || limit.rlim_cur >= largest_file) return;
    throw Error(ExitCode::device,
                fmt::format("the limit of {} KiB a file is too low: PoCL's compiler needs {} MiB; raise it "
                            "(ulimit -f)",
                            limit.rlim_cur >> 10, largest_file >> 20));
}

}  // namespace

void prepare_pocl(int threads) {
    static std::once_flag once;
    std::call_once(once, [threads] {
        check_file_size_limit();
        remove_stale_folders(temporary_folder());
        folder_in_use = private_folder().path().c_str();
        ::mkdir(pocl_folder().c_str(), 0700);
        setenv("POCL_CACHE_DIR", pocl_folder().c_str(), 1);
        if (threads > 0) setenv("POCL_MAX_PTHREAD_COUNT", std::to_string(threads).c_str(), 1);
    });
}

const fs::path& pocl_folder() {
    static const fs::path folder = private_folder().path() / kernels_name;
    return folder;
}

const fs::path& private_temporary_folder() { return private_folder().path(); }

bool driver_lacks_room() {
    const char* folder = folder_in_use;
    struct statvfs space {};
    return folder != nullptr && (statvfs(folder, &space) != 0 || free_bytes(space) < largest_file);
}

void exit_at_once(int status) {
    CompileHelper::kill_running();
    const char* folder = folder_in_use;
    if (folder == nullptr) _exit(status);
    const std::array<char, 4> digits{static_cast<char>('0' + status / 100),
                                     static_cast<char>('0' + status / 10 % 10),
                                     static_cast<char>('0' + status % 10), '\0'};
    // While a compiler works in the folder it cannot be removed, and PoCL aborts when its folder goes.
    // Another program in this process's place ends all threads at one moment.
    execl("/bin/sh", "sh", "-c", "/bin/rm -rf -- \"$0\"; exit \"$1\"", folder, digits.data(), nullptr);
    _exit(status);  // the next process removes the folder
}

std::size_t count_compiled_kernels() {
    std::size_t count = 0;
    std::error_code error;
    for (fs::recursive_directory_iterator entry(pocl_folder(), error), end; !error && entry != end;
         entry.increment(error)) {
        if (entry->path().extension() == ".so") ++count;
    }
    return count;
}

}  // namespace sahl
