#include "engine/device/program_cache.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <span>
#include <sstream>
#include <string_view>
#include <utility>

#include "engine/core/atomic_file.h"
#include "engine/core/hash.h"

namespace sahl {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view file_extension = ".sahl-program";
constexpr std::size_t most_files = 64;

/// The file is a header, then the key, the kernel names (a line each) and the binary. The key is
/// compared as a whole: equal hashes of different keys cost a rebuild, never a wrong program.
struct Header {
    std::array<char, 8> magic;
    std::uint64_t version;
    std::uint64_t checksum;  ///< of all that follows, the lengths included
    std::uint64_t key_bytes;
    std::uint64_t names_bytes;
    std::uint64_t binary_bytes;
    std::uint64_t tested;  ///< 1: has passed the self-test
};
constexpr std::array<char, 8> file_magic = {'S', 'A', 'H', 'L', 'C', 'O', 'D', 'E'};
constexpr std::uint64_t file_version = 2;
constexpr std::size_t checked_from = offsetof(Header, key_bytes);

fs::path file_of(const fs::path& folder, const std::string& key) {
    return folder / fmt::format("{:016x}{}", fnv1a(key), file_extension);
}

class File {
public:
    explicit File(int descriptor) : descriptor_(descriptor) {}
    ~File() {
        if (descriptor_ >= 0) close(descriptor_);
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    int get() const { return descriptor_; }

private:
    int descriptor_;
};

/// All bytes of a regular file that this user or root wrote: its contents will be run.
std::optional<std::string> read_own_file(const fs::path& path) {
    const File file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    struct stat status {};
    if (file.get() < 0 || fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
    if (status.st_uid != geteuid() && status.st_uid != 0) return std::nullopt;
    std::string bytes(static_cast<std::size_t>(status.st_size), '\0');
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t got = read(file.get(), bytes.data() + done, bytes.size() - done);
        if (got <= 0) return std::nullopt;
        done += static_cast<std::size_t>(got);
    }
    futimens(file.get(), nullptr);  // used now: the last to go
    return bytes;
}

std::optional<CachedProgram> parse(std::string_view file, std::string_view key) {
    Header header{};
    if (file.size() < sizeof(header)) return std::nullopt;
    std::memcpy(&header, file.data(), sizeof(header));
    if (header.magic != file_magic || header.version != file_version) return std::nullopt;
    if (header.checksum != fnv1a(file.substr(checked_from))) return std::nullopt;
    std::string_view rest = file.substr(sizeof(header));
    const auto take = [&](std::uint64_t bytes) -> std::optional<std::string_view> {
        if (bytes > rest.size()) return std::nullopt;
        const std::string_view part = rest.substr(0, bytes);
        rest.remove_prefix(bytes);
        return part;
    };
    const auto stored_key = take(header.key_bytes);
    const auto names = take(header.names_bytes);
    const auto binary = take(header.binary_bytes);
    if (!binary || !names || stored_key != key || !rest.empty() || binary->empty()) return std::nullopt;
    CachedProgram program{std::string(*binary), {}, header.tested == 1};
    std::istringstream lines{std::string(*names)};
    for (std::string name; std::getline(lines, name);) program.kernels.push_back(name);
    return program;
}

std::string serialize(const std::string& key, const CachedProgram& program) {
    std::string names;
    for (const std::string& name : program.kernels) names += name + '\n';
    const std::uint64_t tested = program.tested ? 1 : 0;
    Header header{file_magic, file_version, 0, key.size(), names.size(), program.binary.size(), tested};
    std::string file(sizeof(header), '\0');
    std::memcpy(file.data(), &header, sizeof(header));
    file += key + names + program.binary;
    header.checksum = fnv1a(std::string_view(file).substr(checked_from));
    std::memcpy(file.data(), &header, sizeof(header));
    return file;
}

/// Removes what killed writers left, and the files that were used longest ago.
void prune(const fs::path& folder) {
    std::vector<std::pair<fs::file_time_type, fs::path>> files;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        if (entry->path().filename().string().find(file_extension) == std::string::npos) continue;
        remove_if_stale(entry->path());
        std::error_code gone;
        const fs::file_time_type used = entry->last_write_time(gone);
        if (!gone) files.emplace_back(used, entry->path());
    }
    if (files.size() <= most_files) return;
    std::sort(files.begin(), files.end());
    files.resize(files.size() - most_files);
    for (const auto& [time, path] : files) fs::remove(path, error);
}

}  // namespace

std::optional<fs::path> cache_folder() {
    const auto variable = [](const char* name) -> std::optional<fs::path> {
        const char* value = std::getenv(name);
        if (value == nullptr || *value == '\0') return std::nullopt;
        return fs::path(value);
    };
    if (auto folder = variable("SAHL_CACHE_DIR")) return folder;
    if (const auto folder = variable("XDG_CACHE_HOME")) return *folder / "sahl";
    if (const auto folder = variable("HOME")) return *folder / ".cache" / "sahl";
    return std::nullopt;
}

std::optional<CachedProgram> load_program(const std::string& key) {
    const auto folder = cache_folder();
    if (!folder) return std::nullopt;
    const auto file = read_own_file(file_of(*folder, key));
    return file ? parse(*file, key) : std::nullopt;
}

void store_program(const std::string& key, const CachedProgram& program) noexcept try {
    const auto folder = cache_folder();
    if (!folder) return;
    const std::string file = serialize(key, program);
    constexpr mode_t own = 0600;  // it will be run: nobody else may write it
    write_file(file_of(*folder, key), std::as_bytes(std::span(file)), own);
    prune(*folder);
} catch (...) {
    // A cache that cannot be kept costs time in the next run and nothing in this one.
}

}  // namespace sahl
