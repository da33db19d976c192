#include "engine/batch/image_record.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#include "engine/batch/job_record.h"

namespace sahl {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t most_metadata = std::uint64_t{16} << 20U;
constexpr const char* cut_short = "it is cut short";
constexpr const char* no_image = "it is no image of its format";

/// Bytes of a file at any place; false behind its end.
class FileBytes {
public:
    explicit FileBytes(const fs::path& path)
        : file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
        struct stat status {};
        if (file_ < 0 || ::fstat(file_, &status) != 0) {
            problem_ = errno == ENOENT ? "it is not there" : std::strerror(errno);
        } else if (!S_ISREG(status.st_mode)) {
            problem_ = "it is no regular file";
        } else {
            size_ = static_cast<std::uint64_t>(status.st_size);
        }
    }
    ~FileBytes() {
        if (file_ >= 0) ::close(file_);
    }
    FileBytes(const FileBytes&) = delete;
    FileBytes& operator=(const FileBytes&) = delete;

    const std::string& problem() const { return problem_; }
    std::uint64_t size() const { return size_; }

    bool read(std::uint64_t offset, void* bytes, std::uint64_t count) {
        if (offset > size_ || count > size_ - offset) return false;
        // Headers are many small reads: a window saves their system calls.
        if (offset < start_ || offset + count > start_ + window_.size()) {
            window_.resize(std::max<std::uint64_t>(count, std::min<std::uint64_t>(16384, size_ - offset)));
            start_ = offset;
            if (::pread(file_, window_.data(), window_.size(), static_cast<off_t>(offset)) !=
                static_cast<ssize_t>(window_.size())) {
                window_.clear();
                return false;
            }
        }
        std::memcpy(bytes, window_.data() + (offset - start_), count);
        return true;
    }
    bool read_text(std::uint64_t offset, std::uint64_t count, std::string& text) {
        if (count > most_metadata) return false;
        text.resize(count);
        return read(offset, text.data(), count);
    }

private:
    int file_;
    std::uint64_t size_ = 0;
    std::uint64_t start_ = 0;
    std::vector<char> window_;
    std::string problem_;
};

std::uint32_t big_endian(const std::array<unsigned char, 4>& bytes) {
    return std::uint32_t{bytes[0]} << 24U | std::uint32_t{bytes[1]} << 16U | std::uint32_t{bytes[2]} << 8U |
           bytes[3];
}

/// PNG (ISO/IEC 15948): chunks of length, type, data and checksum; texts are before the pixels, IEND is last.
StoredRecord read_png(FileBytes& file) {
    constexpr std::string_view signature = "\x89PNG\r\n\x1a\n";
    constexpr std::string_view end = std::string_view("\0\0\0\0IEND\xae\x42\x60\x82", 12);
    std::string text;
    if (!file.read_text(0, signature.size(), text) || text != signature) return {{}, no_image};
    if (file.size() < 20 || !file.read_text(file.size() - end.size(), end.size(), text) || text != end)
        return {{}, cut_short};
    StoredRecord stored;
    for (std::uint64_t at = signature.size();;) {
        std::array<unsigned char, 4> length{};
        std::string type;
        if (!file.read(at, length.data(), 4) || !file.read_text(at + 4, 4, type)) return {{}, cut_short};
        if (type == "IDAT" || type == "IEND") return stored;
        const std::uint64_t bytes = big_endian(length);
        if (type == "tEXt") {
            if (!file.read_text(at + 8, bytes, text)) return {{}, cut_short};
            const std::size_t zero = text.find('\0');
            if (zero != std::string::npos && text.substr(0, zero) == record_name)
                stored.record = text.substr(zero + 1);
        }
        at += 12 + bytes;
    }
}

std::int32_t little_endian(std::string_view bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value |= std::uint32_t{static_cast<unsigned char>(bytes[i])} << (8U * static_cast<unsigned>(i));
    return static_cast<std::int32_t>(value);
}

/// Rows of a block, by the compression's number (OpenEXR's file layout).
int rows_of_block(unsigned char compression) {
    constexpr std::array<int, 10> rows{1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
    return compression < rows.size() ? rows[compression] : 0;
}

bool read_zero_ended(FileBytes& file, std::uint64_t& at, std::string& text) {
    text.clear();
    for (char c = 0; file.read(at, &c, 1) && text.size() < 256; text += c) {
        ++at;
        if (c == '\0') return true;
    }
    return false;
}

/// A scan line EXR file: attributes, then the offset of each block of rows, 0 while it is not written.
StoredRecord read_exr(FileBytes& file) {
    constexpr std::string_view magic = "\x76\x2f\x31\x01";
    std::string text;
    if (!file.read_text(0, 4, text) || text != magic) return {{}, no_image};
    StoredRecord stored;
    std::uint64_t at = 8;
    std::int64_t rows = 0;
    int block_rows = 0;
    for (std::string name, type;;) {
        if (!read_zero_ended(file, at, name)) return {{}, cut_short};
        if (name.empty()) break;
        if (!read_zero_ended(file, at, type) || !file.read_text(at, 4, text)) return {{}, cut_short};
        const auto bytes = static_cast<std::uint32_t>(little_endian(text));
        at += 4;
        const bool wanted = name == "dataWindow" || name == "compression" || name == record_name;
        if (wanted && !file.read_text(at, bytes, text)) return {{}, cut_short};
        if (name == record_name) stored.record = text;
        if (name == "dataWindow" && bytes == 16)
            rows = std::int64_t{little_endian(text.substr(12))} - little_endian(text.substr(4)) + 1;
        if (name == "compression" && bytes == 1)
            block_rows = rows_of_block(static_cast<unsigned char>(text[0]));
        at += bytes;
    }
    if (rows < 1 || block_rows < 1) return {{}, no_image};
    const std::int64_t blocks = (rows + block_rows - 1) / block_rows;
    std::uint64_t last = 0;
    for (std::int64_t i = 0; i < blocks; ++i, at += 8) {
        std::string low;
        std::string high;
        if (!file.read_text(at, 4, low) || !file.read_text(at + 4, 4, high)) return {{}, cut_short};
        const std::uint64_t offset = static_cast<std::uint32_t>(little_endian(low)) |
                                     std::uint64_t{static_cast<std::uint32_t>(little_endian(high))} << 32U;
        if (offset == 0) return {{}, cut_short};
        last = std::max(last, offset);
    }
    // The block's number and size, then its bytes.
    if (!file.read_text(last + 4, 4, text)) return {{}, cut_short};
    if (last + 8 + static_cast<std::uint32_t>(little_endian(text)) > file.size()) return {{}, cut_short};
    return stored;
}

std::string extension_of(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

}  // namespace

bool keeps_record(const fs::path& path) {
    const std::string extension = extension_of(path);
    return extension == ".exr" || extension == ".png";
}

StoredRecord read_image_record(const fs::path& path) {
    FileBytes file(path);
    if (!file.problem().empty()) return {{}, file.problem()};
    return extension_of(path) == ".exr" ? read_exr(file) : read_png(file);
}

}  // namespace sahl
