#include "engine/batch/folder_state.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/core/atomic_file.h"
#include "engine/core/error.h"
#include "engine/core/hash.h"

namespace sahl {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr mode_t file_mode = 0666;  // less the umask: people who share a folder share its work

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : "."; }

[[noreturn]] void fail(const fs::path& path) {
    throw Error(ExitCode::output,
                fmt::format("cannot write '{}': {}; free some space or choose a folder that you "
                            "may write to",
                            path.string(), std::strerror(errno)));
}

/// The byte that stands for an image; two images of one byte would only wait for each other.
off_t byte_of(const std::string& name) { return static_cast<off_t>(fnv1a(name) >> 2U) + 1; }

enum class Lock { taken, busy, none };

Lock lock(int file, off_t start, off_t length, Claim::Wait wait) {
    struct flock range {};
    range.l_type = F_WRLCK;
    range.l_whence = SEEK_SET;
    range.l_start = start;
    range.l_len = length;
    for (;;) {
        if (::fcntl(file, wait == Claim::Wait::no ? F_OFD_SETLK : F_OFD_SETLKW, &range) == 0)
            return Lock::taken;
        if (errno == EINTR) continue;
        return errno == EAGAIN || errno == EACCES ? Lock::busy : Lock::none;
    }
}

/// Whether the file is still in its folder: whoever found nobody in it may have removed it.
bool is_linked(int file) {
    struct stat status {};
    return ::fstat(file, &status) == 0 && status.st_nlink > 0;
}

std::optional<std::pair<std::string, FolderRecords::Entry>> parse_line(const std::string& line) {
    const Json json = Json::parse(line, nullptr, false);
    if (!json.is_object() || !json.contains("name") || !json.contains("size") || !json.contains("record"))
        return {};
    if (!json["name"].is_string() || !json["size"].is_number_unsigned()) return {};
    return {{json["name"].get<std::string>(), {json["size"].get<std::uint64_t>(), json["record"].dump()}}};
}

void drop_replaced_records(const fs::path& path) {
    std::vector<std::string> lines;
    std::unordered_map<std::string, std::size_t> last;  // line of each name
    std::ifstream file(path, std::ios::binary);
    for (std::string line; std::getline(file, line) && !file.eof(); lines.push_back(std::move(line)))
        if (const auto entry = parse_line(line)) last[entry->first] = lines.size();
    const auto records = static_cast<std::size_t>(
        std::count_if(lines.begin(), lines.end(), [](const std::string& line) { return !line.empty(); }));
    if (records <= 2 * last.size()) return;
    std::vector<std::size_t> kept;
    for (const auto& [name, line] : last) kept.push_back(line);
    std::sort(kept.begin(), kept.end());
    std::string text;
    for (const std::size_t line : kept) text += lines[line] + "\n";
    try {
        write_file(path, std::as_bytes(std::span(text)));
    } catch (const Error&) {
        // It is long, and right.
    }
}

/// Names may be no UTF-8, which JSON has to be.
std::string name_of(const fs::path& image) {
    const std::string quoted =
        Json(image.filename().string()).dump(-1, ' ', false, Json::error_handler_t::replace);
    return Json::parse(quoted).get<std::string>();
}

}  // namespace

void FolderRecords::update() {
    struct stat status {};
    if (::stat(path_.c_str(), &status) != 0) status = {};
    const auto size = static_cast<std::uint64_t>(status.st_size);
    if (status.st_ino != inode_ || size < read_) {  // another file
        entries_.clear();
        read_ = 0;
        inode_ = status.st_ino;
    }
    if (size == read_) return;
    std::ifstream file(path_, std::ios::binary);
    file.seekg(static_cast<std::streamoff>(read_));
    for (std::string line; std::getline(file, line) && !file.eof(); read_ += line.size() + 1)
        if (auto entry = parse_line(line)) entries_[entry->first] = std::move(entry->second);
}

const FolderRecords::Entry* FolderRecords::find(const std::string& name) {
    update();
    const auto found = entries_.find(name_of(name));
    return found == entries_.end() ? nullptr : &found->second;
}

void add_folder_record(const fs::path& image, const std::string& record) {
    const fs::path path = folder_of(image) / FolderRecords::file_name;
    // The line end in front closes a line that somebody was killed in.
    const std::string line = fmt::format("\n{{\"name\":{},\"size\":{},\"record\":{}}}\n",
                                         Json(name_of(image)).dump(), fs::file_size(image), record);
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, file_mode);
    if (file < 0) fail(path);
    const ssize_t written = ::write(file, line.data(), line.size());
    const bool done = written == static_cast<ssize_t>(line.size()) && ::fsync(file) == 0;
    const int cause = written >= 0 && !done && errno == 0 ? ENOSPC : errno;
    ::close(file);
    errno = cause;
    if (!done) fail(path);
}

std::unique_ptr<Claim> Claim::take(const fs::path& image, Wait wait) {
    const fs::path path = folder_of(image) / file_name;
    std::error_code failed;
    fs::create_directories(folder_of(image), failed);
    for (;;) {
        const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, file_mode);
        if (file < 0) fail(path);
        std::unique_ptr<Claim> claim(new Claim(file));
        switch (lock(file, byte_of(image.filename().string()), 1, wait)) {
            case Lock::busy:
                return nullptr;
            case Lock::none:
                return claim;
            case Lock::taken:
                if (is_linked(file)) return claim;
        }
    }
}

Claim::~Claim() { ::close(file_); }

void tidy_folder(const fs::path& folder) {
    const fs::path path = folder / Claim::file_name;
    const int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
    if (file < 0) return;
    // Whoever adds a record has a claim.
    if (lock(file, 0, 0, Claim::Wait::no) == Lock::taken && is_linked(file)) {
        drop_replaced_records(folder / FolderRecords::file_name);
        ::unlink(path.c_str());
    }
    ::close(file);
}

}  // namespace sahl
