// A file system of its own for a test to fill, to make read-only or noexec.
#pragma once

#include <sys/mount.h>

#include <cstddef>
#include <fstream>
#include <string>

#include "tests/support/temporary_folder.h"

namespace sahl::tests {

/// A tmpfs in a new folder. Mounting takes root: without it mounted() is false and the test skips.
class SmallDisk {
public:
    explicit SmallDisk(std::size_t bytes, unsigned long flags = 0) {
        const std::string size = "size=" + std::to_string(bytes);
        mounted_ = ::mount("tmpfs", folder_.path().c_str(), "tmpfs", flags, size.c_str()) == 0;
    }
    ~SmallDisk() {
        if (mounted_) ::umount2(folder_.path().c_str(), MNT_DETACH);
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;

    bool mounted() const { return mounted_; }
    const std::filesystem::path& path() const { return folder_.path(); }
    std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
    std::size_t entries() const { return folder_.entries(); }

    void make_read_only() const {
        ::mount(nullptr, folder_.path().c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr);
    }

    /// Fills it with a file `filler` until `left` bytes are free, in whole pages.
    void fill(std::size_t left = 0) const {
        const std::filesystem::path filler = path() / "filler";
        {
            std::ofstream file(filler, std::ios::binary);
            const std::string page(page_size, 'x');
            while (file.write(page.data(), page_size).flush()) {
            }
        }
        const std::size_t size = std::filesystem::file_size(filler) / page_size * page_size;
        std::filesystem::resize_file(filler, size - std::min(size, left / page_size * page_size));
    }

private:
    static constexpr std::size_t page_size = 4096;
    TemporaryFolder folder_;
    bool mounted_ = false;
};

}  // namespace sahl::tests
