#include "engine/core/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "engine/core/error.h"

namespace sahl {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view part_mark = ".part-";

[[noreturn]] void fail(const fs::path& path, int cause) {
    const char* remedy = "choose another output path";
    switch (cause) {
        case ENOSPC:
        case EDQUOT:
            remedy = "free some space or write to another disk";
            break;
        case EFBIG:
            remedy = "raise the file size limit (ulimit -f) or write a smaller image";
            break;
        case EACCES:
        case EPERM:
        case EROFS:
            remedy = "choose a folder that you may write to";
            break;
        case EISDIR:
            remedy = "add a file name";
            break;
        case ENOTDIR:
            remedy = "a part of the path is a file; choose another folder";
            break;
        case ENAMETOOLONG:
            remedy = "choose a shorter name";
            break;
        default:
            break;
    }
    throw Error(ExitCode::output, "cannot write '" + path.string() +
                                      "': " + std::generic_category().message(cause) + "; " + remedy);
}

class Descriptor {
public:
    explicit Descriptor(int value) : value_(value) {}
    ~Descriptor() { close(); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return value_; }
    /// 0, or the cause of a failure.
    int close() {
        const int result = value_ >= 0 && ::close(value_) != 0 && errno != EINTR ? errno : 0;
        value_ = -1;
        return result;
    }

private:
    int value_;
};

/// A new file `PREFIX` + process id, locked: whoever finds one whose lock is free knows that its writer
/// is dead. (Process ids would not tell: they are used again, and containers share folders.)
/// Removed at the end unless it has been renamed.
class Temporary {
public:
    /// `path` is for messages.
    Temporary(const std::string& prefix, mode_t mode, const fs::path& path) {
        for (int attempt = 0; file_ < 0; ++attempt) {
            path_ = prefix + std::to_string(::getpid()) + (attempt == 0 ? "" : "-" + std::to_string(attempt));
            file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
            // A process of the same number in another container has it, or took it for a dead one's.
            const bool taken = file_ < 0 ? errno == EEXIST : !lock();
            if (taken && attempt < 100) continue;
            if (file_ < 0) fail(path, errno);
        }
    }
    ~Temporary() {
        if (!renamed_) ::unlink(path_.c_str());
        if (file_ >= 0) ::close(file_);
    }
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;

    int get() const { return file_; }
    /// 0, or the cause of a failure. The file stays locked until then: nobody takes it for a dead one's.
    int rename_to(const fs::path& target) {
        renamed_ = ::rename(path_.c_str(), target.c_str()) == 0;
        return renamed_ ? 0 : errno;
    }

private:
    /// False, and no file, when another process removes it just now. Some file systems have no locks:
    /// nothing is removed there.
    bool lock() {
        struct stat status {};
        const bool busy = ::flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
        if (!busy && ::fstat(file_, &status) == 0 && status.st_nlink > 0) return true;
        ::close(file_);
        file_ = -1;
        return false;
    }

    fs::path path_;
    int file_ = -1;
    bool renamed_ = false;
};

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : "."; }

/// Where `path` leads when all symbolic links at its end are followed; nothing need exist there.
fs::path follow_links(fs::path path) {
    const fs::path start = path;
    for (int links = 0; fs::is_symlink(fs::symlink_status(path)); ++links) {
        if (links == 40) fail(start, ELOOP);  // as many as Linux follows
        const fs::path target = fs::read_symlink(path);
        path = target.is_absolute() ? target : path.parent_path() / target;
    }
    return path;
}

void write_all(int file, std::span<const std::byte> bytes, const fs::path& path) {
    constexpr std::size_t most = std::size_t{1} << 30;  // Linux writes at most 2 GB at once
    while (!bytes.empty()) {
        const ssize_t written = ::write(file, bytes.data(), std::min(bytes.size(), most));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(path, errno);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
}

using Pieces = std::span<const std::span<const std::byte>>;

void write_special(const fs::path& path, Pieces pieces) {
    Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY));
    if (file.get() < 0) fail(path, errno);
    for (const auto& bytes : pieces) write_all(file.get(), bytes, path);
    if (const int cause = file.close(); cause != 0) fail(path, cause);
}

/// A folder's entries reach the disk by syncing the folder; some file systems cannot (EINVAL).
void sync_folder(const fs::path& folder, const fs::path& path) {
    const Descriptor file(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (file.get() < 0 && errno == EACCES) return;  // writable, not readable
    if (file.get() < 0 || (::fsync(file.get()) != 0 && errno != EINVAL)) fail(path, errno);
}

}  // namespace

void remove_if_stale(const fs::path& temporary) {
    const std::string name = temporary.filename().string();
    const std::size_t mark = name.rfind(part_mark);
    if (!name.starts_with('.') || mark == std::string::npos ||
        name.find_first_not_of("0123456789-", mark + part_mark.size()) != std::string::npos)
        return;
    const Descriptor file(::open(temporary.c_str(), O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    struct stat status {};
    if (file.get() < 0 || ::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) return;
    if (::flock(file.get(), LOCK_EX | LOCK_NB) == 0) ::unlink(temporary.c_str());
}

void remove_stale_files(const fs::path& folder, std::string_view prefix) {
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        if (entry->path().filename().string().starts_with(prefix)) remove_if_stale(entry->path());
    }
}

bool is_special_file(const fs::path& path) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

void check_output_file(const fs::path& path) try {
    if (path.empty()) fail(path, ENOENT);
    if (is_special_file(path)) return;
    std::error_code cause;
    if (fs::is_directory(fs::status(path, cause)) || !path.has_filename()) fail(path, EISDIR);
    fs::path folder = folder_of(follow_links(path));
    while (!fs::exists(fs::status(folder, cause))) {
        // A broken component, such as a file where a folder should be, shows at its parent.
        const fs::path parent = folder_of(folder);
        if (parent == folder) fail(path, ENOENT);
        folder = parent;
    }
    if (!fs::is_directory(folder)) fail(path, ENOTDIR);
    if (::faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) != 0) fail(path, errno);
} catch (const fs::filesystem_error& error) {
    fail(path, error.code().value());
}

void write_file(const fs::path& path, std::span<const std::byte> bytes, mode_t mode, Stale stale) {
    write_file(path, Pieces(&bytes, 1), mode, stale);
}

void write_file(const fs::path& path, Pieces pieces, mode_t mode, Stale stale) try {
    if (is_special_file(path)) return write_special(path, pieces);
    const fs::path target = follow_links(path);
    if (fs::is_directory(fs::status(target)) || !target.has_filename()) fail(path, EISDIR);
    const fs::path folder = folder_of(target);
    fs::create_directories(folder);

    // A name may have 255 bytes: a long one is cut to leave room for the rest.
    const std::string name = "." + target.filename().string().substr(0, 200) + std::string(part_mark);
    if (stale == Stale::remove) remove_stale_files(folder, name);
    Temporary temporary((folder / name).string(), mode, path);
    for (const auto& bytes : pieces) write_all(temporary.get(), bytes, path);
    struct stat old {};
    if (::stat(target.c_str(), &old) == 0) ::fchmod(temporary.get(), old.st_mode & 0777);
    if (::fsync(temporary.get()) != 0) fail(path, errno);
    if (const int cause = temporary.rename_to(target); cause != 0) fail(path, cause);
    sync_folder(folder, path);
} catch (const fs::filesystem_error& error) {
    fail(path, error.code().value());
}

}  // namespace sahl
