#include "engine/device/pocl_programs.h"

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <set>
#include <string_view>

#include "engine/device/pocl_environment.h"

namespace sahl {
namespace {

namespace fs = std::filesystem;

// PoCL has one folder a program, with this file and the shared objects of the kernels below.
constexpr const char* program_file = "program.bc";
constexpr const char* compiled_kernel = ".so";

struct KnownFolders {
    std::mutex mutex;
    std::map<std::string, fs::path> by_key;  ///< relative to PoCL's folder
    std::size_t unpacked = 0;                ///< kernels, since the process began
};

KnownFolders& known() {
    static KnownFolders folders;
    return folders;
}

std::set<fs::path> program_folders() {
    std::set<fs::path> folders;
    std::error_code error;
    for (fs::recursive_directory_iterator entry(pocl_folder(), error), end; !error && entry != end;
         entry.increment(error)) {
        if (entry->path().filename() == program_file) {
            folders.insert(entry->path().parent_path().lexically_relative(pocl_folder()));
        }
    }
    return folders;
}

// Packed: for each file the lengths of its path and contents, 64 bits each, then both.
void append(std::string& packed, const std::string& path, const std::string& contents) {
    const std::uint64_t lengths[2] = {path.size(), contents.size()};
    packed.append(reinterpret_cast<const char*>(lengths), sizeof(lengths));
    packed += path + contents;
}

/// Takes one file off the front of `packed`; false if there is no whole one.
bool take(std::string_view& packed, fs::path& path, std::string_view& contents) {
    std::uint64_t lengths[2];
    if (packed.size() < sizeof(lengths)) return false;
    std::memcpy(lengths, packed.data(), sizeof(lengths));
    packed.remove_prefix(sizeof(lengths));
    if (lengths[0] > packed.size() || lengths[1] > packed.size() - lengths[0]) return false;
    path = packed.substr(0, lengths[0]);
    contents = packed.substr(lengths[0], lengths[1]);
    packed.remove_prefix(lengths[0] + lengths[1]);
    return true;
}

/// Into PoCL's folder, as a whole or not at all: PoCL would run what is cut short.
bool write_file(const fs::path& path, std::string_view contents) {
    const fs::path target = pocl_folder() / path;
    fs::create_directories(target.parent_path());
    std::ofstream file(target, std::ios::binary);
    file.write(contents.data(), static_cast<std::streamsize>(contents.size()));
    if (file.flush()) return true;
    fs::remove(target);
    return false;
}

}  // namespace

bool build_watched(const std::string& key, const std::function<void()>& build) {
    const std::lock_guard lock(known().mutex);
    const std::set<fs::path> before = program_folders();
    build();
    for (const fs::path& folder : program_folders()) {
        if (before.contains(folder)) continue;
        known().by_key[key] = folder;
        return true;
    }
    return false;
}

std::optional<std::string> pack_compiled(const std::string& key) {
    const std::lock_guard lock(known().mutex);
    const auto folder = known().by_key.find(key);
    if (folder == known().by_key.end()) return std::nullopt;
    std::string packed;
    for (const auto& entry : fs::recursive_directory_iterator(pocl_folder() / folder->second)) {
        if (!entry.is_regular_file()) continue;
        std::ifstream file(entry.path(), std::ios::binary);
        const std::string contents(std::istreambuf_iterator<char>(file), {});
        if (!file.is_open() || file.bad()) return std::nullopt;
        append(packed, entry.path().lexically_relative(pocl_folder()).string(), contents);
    }
    return packed;
}

bool unpack_compiled(const std::string& key, const std::string& packed) {
    const std::lock_guard lock(known().mutex);
    std::string_view rest = packed;
    fs::path path;
    std::string_view contents;
    while (!rest.empty()) {
        if (!take(rest, path, contents)) return false;
        if (path.filename() == program_file) known().by_key[key] = path.parent_path();
        if (fs::exists(pocl_folder() / path)) continue;
        if (!write_file(path, contents)) return false;
        if (path.extension() == compiled_kernel) ++known().unpacked;
    }
    return true;
}

std::size_t add_compiled(const std::string& key, const std::string& packed) {
    const std::lock_guard lock(known().mutex);
    std::string_view rest = packed;
    fs::path path;
    std::string_view contents;
    std::size_t added = 0;
    while (!rest.empty() && take(rest, path, contents)) {
        const bool ours = path.string().starts_with(known().by_key.at(key).string() + '/');
        if (!ours || path.extension() != compiled_kernel || fs::exists(pocl_folder() / path)) continue;
        if (write_file(path, contents)) ++added;
    }
    return added;
}

std::size_t count_unpacked_kernels() {
    const std::lock_guard lock(known().mutex);
    return known().unpacked;
}

}  // namespace sahl
