#include "engine/core/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "engine/core/error.h"

namespace sahl {
namespace {

namespace fs = std::filesystem;

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
    ~Descriptor() {
        if (value_ >= 0) ::close(value_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return value_; }
    int release() { return std::exchange(value_, -1); }

private:
    int value_;
};

/// Removes the temporary file unless it has been renamed.
struct Temporary {
    fs::path path;
    bool renamed = false;
    ~Temporary() {
        if (!renamed) ::unlink(path.c_str());
    }
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

void close_checked(Descriptor& file, const fs::path& path) {
    if (::close(file.release()) != 0 && errno != EINTR) fail(path, errno);
}

void write_special(const fs::path& path, std::span<const std::byte> bytes) {
    Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY));
    if (file.get() < 0) fail(path, errno);
    write_all(file.get(), bytes, path);
    close_checked(file, path);
}

/// A folder's entries reach the disk by syncing the folder; some file systems cannot (EINVAL).
void sync_folder(const fs::path& folder, const fs::path& path) {
    const Descriptor file(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (file.get() < 0 && errno == EACCES) return;  // writable, not readable
    if (file.get() < 0 || (::fsync(file.get()) != 0 && errno != EINVAL)) fail(path, errno);
}

}  // namespace

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

void write_file(const fs::path& path, std::span<const std::byte> bytes) try {
    if (is_special_file(path)) return write_special(path, bytes);
    const fs::path target = follow_links(path);
    if (fs::is_directory(fs::status(target)) || !target.has_filename()) fail(path, EISDIR);
    const fs::path folder = folder_of(target);
    fs::create_directories(folder);

    // A name may have 255 bytes: a long one is cut to leave room for the rest.
    const std::string name = target.filename().string().substr(0, 200);
    Temporary temporary{folder / ("." + name + ".part-" + std::to_string(::getpid()))};
    ::unlink(temporary.path.c_str());  // left by a process of the same number that was killed
    Descriptor file(::open(temporary.path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file.get() < 0) fail(path, errno);
    write_all(file.get(), bytes, path);
    struct stat old {};
    if (::stat(target.c_str(), &old) == 0) ::fchmod(file.get(), old.st_mode & 0777);
    if (::fsync(file.get()) != 0) fail(path, errno);
    close_checked(file, path);
    if (::rename(temporary.path.c_str(), target.c_str()) != 0) fail(path, errno);
    temporary.renamed = true;
    sync_folder(folder, path);
} catch (const fs::filesystem_error& error) {
    fail(path, error.code().value());
}

}  // namespace sahl
