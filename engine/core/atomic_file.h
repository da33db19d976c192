// Output files that are either whole or not there.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace sahl {

/// Throws Error(output) if `path` can be seen beforehand not to be writable: it is a folder, or its
/// folder neither exists nor can be made, or may not be written to. Changes nothing.
void check_output_file(const std::filesystem::path& path);

/// True if `path` exists and is neither a regular file nor a folder, such as /dev/null or a FIFO.
bool is_special_file(const std::filesystem::path& path);

/// Makes `bytes` the content of file `path`. They are written to `.NAME.part-PID` beside it, synced
/// and renamed, so that whoever opens `path` finds the old content or the new, and after a failure
/// the old. Missing folders are made; a symbolic link stays and the file it leads to is replaced; a
/// replaced file keeps its permissions, a new one has `mode` less the umask; a special file is written
/// to directly. Temporary files that killed writers of `path` left are removed, unless the folder is not to
/// be searched for them. Throws Error(output) naming `path`, the cause and the remedy; the temporary file is
/// gone then. A process that wants the error instead of the signal when it meets its file size limit or a
/// pipe without a reader ignores SIGXFSZ and SIGPIPE.
enum class Stale { remove, leave };
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes, mode_t mode = 0666,
                Stale stale = Stale::remove);

/// The same with several pieces, one behind the other.
void write_file(const std::filesystem::path& path, std::span<const std::span<const std::byte>> pieces,
                mode_t mode = 0666, Stale stale = Stale::remove);

/// Removes `temporary` if it is a temporary file of write_file whose writer is dead.
void remove_if_stale(const std::filesystem::path& temporary);

/// Removes all of those in `folder` whose names begin with `prefix`.
void remove_stale_files(const std::filesystem::path& folder, std::string_view prefix = ".");

}  // namespace sahl
