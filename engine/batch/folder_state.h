// What a batch keeps in each folder of images: the records of those whose format has no room for them, and
// the locks by which several processes share the work.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

namespace sahl {

/// The records of a folder's images, in `.sahl-batch.json`: a JSON object a line, each {"name", "size",
/// "record"}; the last of a name counts. Lines are only ever added, but by tidy_folder: whoever is killed
/// there leaves a line without an end, which does not count.
class FolderRecords {
public:
    struct Entry {
        std::uint64_t size = 0;  ///< of the file, bytes
        std::string record;
    };

    explicit FolderRecords(const std::filesystem::path& folder) : path_(folder / file_name) {}
    /// Reads what is new first; lines that are none are passed over. Until the next call.
    const Entry* find(const std::string& name);

    static constexpr const char* file_name = ".sahl-batch.json";

private:
    void update();

    std::filesystem::path path_;
    std::uint64_t inode_ = 0;
    std::uint64_t read_ = 0;  ///< bytes of the file, whole lines
    std::map<std::string, Entry> entries_{};
};

/// Adds the record of a finished image to those of its folder, and syncs it.
/// Throws Error(output) if that fails.
void add_folder_record(const std::filesystem::path& image, const std::string& record);

/// The right to make an image: no other process has it until this object, or its process, is gone. A lock on
/// one byte of `.sahl-batch.lock` in the image's folder (an open file description's, fcntl(2)).
class Claim {
public:
    enum class Wait { no, until_free };

    /// The claim, or nothing while another process has it. Makes the folder. Where the file system has no
    /// locks everything is free. Throws Error(output) when the lock file cannot be made.
    static std::unique_ptr<Claim> take(const std::filesystem::path& image, Wait wait);
    ~Claim();
    Claim(const Claim&) = delete;
    Claim& operator=(const Claim&) = delete;

    static constexpr const char* file_name = ".sahl-batch.lock";

private:
    explicit Claim(int file) : file_(file) {}
    int file_;
};

/// If nobody holds a claim in a folder, removes its lock file, and from its records what later lines replace
/// where that is more than the rest.
void tidy_folder(const std::filesystem::path& folder);

}  // namespace sahl
