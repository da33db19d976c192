#include "engine/core/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstdio>

#include "engine/core/error.h"
#include "tests/host/film/output_files.h"
#include "tests/support/temporary_folder.h"

namespace fs = std::filesystem;

namespace sahl {
namespace {

using tests::TemporaryFolder;
using tests::film::content_of;
using tests::film::NoPrivileges;
using tests::film::put;

void write(const fs::path& path, const std::string& content) {
    write_file(path, std::as_bytes(std::span(content)));
}

/// The message of the Error(output) that `action` throws.
template <typename Action>
std::string output_error(Action action) {
    try {
        action();
    } catch (const Error& error) {
        CHECK(error.code() == ExitCode::output);
        return error.what();
    }
    return "no error";
}

/// Lets no file grow beyond `bytes`, without the signal, while it lives.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) {
        ::getrlimit(RLIMIT_FSIZE, &old_);
        const rlimit limit{bytes, old_.rlim_max};
        handler_ = std::signal(SIGXFSZ, SIG_IGN);
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &old_);
        std::signal(SIGXFSZ, handler_);
    }

private:
    rlimit old_{};
    void (*handler_)(int) = nullptr;
};

}  // namespace

TEST_CASE("output file: written whole, replaced whole, nothing beside it", "[output]") {
    const TemporaryFolder folder;
    const fs::path path = folder / "picture ä 光.bin";
    write(path, "first");
    CHECK(content_of(path) == "first");
    write(path, "second, longer");
    CHECK(content_of(path) == "second, longer");
    write(path, "");
    CHECK(content_of(path).empty());
    CHECK(folder.entries() == 1);
}

TEST_CASE("output file: a reader keeps the old content, a replaced file its permissions", "[output]") {
    const TemporaryFolder folder;
    write(folder / "a", "old");
    ::chmod((folder / "a").c_str(), 0640);
    std::ifstream reader(folder / "a");
    write(folder / "a", "new");
    std::string seen;
    reader >> seen;
    CHECK(seen == "old");
    CHECK(content_of(folder / "a") == "new");
    CHECK(fs::status(folder / "a").permissions() == fs::perms(0640));
}

TEST_CASE("output file: folders are made", "[output]") {
    const TemporaryFolder folder;
    const fs::path path = folder / "a/b c/d.bin";
    check_output_file(path);
    CHECK(folder.entries() == 0);
    write(path, "x");
    CHECK(content_of(path) == "x");
}

TEST_CASE("output file: a name of 255 bytes", "[output]") {
    const TemporaryFolder folder;
    write(folder / std::string(255, 'n'), "x");
    CHECK(content_of(folder / std::string(255, 'n')) == "x");
    const std::string message = output_error([&] { write(folder / std::string(256, 'n'), "x"); });
    CHECK_THAT(message, Catch::Contains("too long") && Catch::Contains("shorter name"));
    CHECK(folder.entries() == 1);
}

TEST_CASE("output file: symbolic links stay and what they lead to is replaced", "[output]") {
    const TemporaryFolder folder;
    fs::create_directory(folder / "far");
    put(folder / "far/target", "old");
    fs::create_symlink("far/target", folder / "one");
    fs::create_symlink("one", folder / "two");
    fs::create_symlink("far/none", folder / "dangling");
    write(folder / "two", "new");
    CHECK(fs::is_symlink(folder / "two"));
    CHECK(fs::is_symlink(folder / "one"));
    CHECK_FALSE(fs::is_symlink(folder / "far/target"));
    CHECK(content_of(folder / "far/target") == "new");
    write(folder / "dangling", "made");
    CHECK(fs::is_symlink(folder / "dangling"));
    CHECK(content_of(folder / "far/none") == "made");

    fs::create_symlink("loop", folder / "loop");
    CHECK_THAT(output_error([&] { write(folder / "loop", "x"); }), Catch::Contains("symbolic links"));
    CHECK_THAT(output_error([&] { check_output_file(folder / "loop"); }), Catch::Contains("symbolic links"));
}

TEST_CASE("output file: what killed writers left is removed, what living ones write is not", "[output]") {
    const TemporaryFolder folder;
    const std::string own = ".a.png.part-" + std::to_string(::getpid());
    for (const char* stale : {".a.png.part-1", ".a.png.part-123456-2"}) put(folder / stale, "half");
    put(folder / own, "half");  // by a process that had our number
    put(folder / ".a.png.part-77", "living");
    const int living = ::open((folder / ".a.png.part-77").c_str(), O_WRONLY | O_CLOEXEC);
    REQUIRE(::flock(living, LOCK_EX | LOCK_NB) == 0);
    for (const char* other : {".b.png.part-1", ".a.png.part-1x", "a.png.part-1", ".a.png"})
        put(folder / other, "mine");
    write(folder / "a.png", "x");
    CHECK(content_of(folder / "a.png") == "x");
    CHECK(folder.entries() == 6);
    CHECK(content_of(folder / ".a.png.part-77") == "living");

    // A process of our number, in a container that has the folder too.
    put(folder / own, "living");
    const int same_number = ::open((folder / own).c_str(), O_WRONLY | O_CLOEXEC);
    REQUIRE(::flock(same_number, LOCK_EX | LOCK_NB) == 0);
    write(folder / "a.png", "y");
    CHECK(content_of(folder / "a.png") == "y");
    CHECK(content_of(folder / own) == "living");
    ::close(living);
    ::close(same_number);
    write(folder / "a.png", "z");
    CHECK(folder.entries() == 5);
}

TEST_CASE("output file: special files are written to, not replaced", "[output]") {
    const TemporaryFolder folder;
    fs::create_symlink("/dev/null", folder / "link.png");
    fs::permissions(folder.path(), fs::perms(0755));
    {
        const NoPrivileges user;  // or a mistake here could replace the machine's /dev/null
        write("/dev/null", "x");
        write(folder / "link.png", "x");
        check_output_file("/dev/null");
    }
    CHECK(fs::is_character_file("/dev/null"));
    CHECK(fs::is_symlink(folder / "link.png"));
    CHECK(is_special_file("/dev/null"));
    CHECK_FALSE(is_special_file(folder.path()));
    CHECK_FALSE(is_special_file(folder / "none"));

    REQUIRE(::mkfifo((folder / "fifo").c_str(), 0600) == 0);
    const int reader = ::open((folder / "fifo").c_str(), O_RDONLY | O_NONBLOCK);
    write(folder / "fifo", "through");
    std::string received(100, ' ');
    const ssize_t count = ::read(reader, received.data(), received.size());
    ::close(reader);
    REQUIRE(count >= 0);
    CHECK(received.substr(0, static_cast<std::size_t>(count)) == "through");
    CHECK(fs::is_fifo(folder / "fifo"));
}

TEST_CASE("output file: a full disk is named and leaves the old file alone", "[output]") {
    const std::string full = output_error([] {
        const NoPrivileges user;
        write("/dev/full", "x");
    });
    CHECK_THAT(full, Catch::Contains("'/dev/full'") && Catch::Contains("No space left") &&
                         Catch::Contains("free some space"));

    const TemporaryFolder folder;
    put(folder / "a", "old");
    std::string message;
    {
        const FileSizeLimit limit(4096);
        message = output_error([&] { write(folder / "a", std::string(100000, 'x')); });
    }
    CHECK_THAT(message, Catch::Contains("too large") && Catch::Contains("ulimit"));
    CHECK(content_of(folder / "a") == "old");
    CHECK(folder.entries() == 1);
}

TEST_CASE("output file: folders as targets, files as folders", "[output]") {
    const TemporaryFolder folder;
    put(folder / "file", "old");
    const auto refused = [](const fs::path& path) {
        const std::string before = output_error([&] { check_output_file(path); });
        const std::string after = output_error([&] { write(path, "x"); });
        CHECK_THAT(before, Catch::Contains(path.string()));
        CHECK_THAT(after, Catch::Contains(path.string()));
        return after;
    };
    CHECK_THAT(refused(folder.path()), Catch::Contains("directory") && Catch::Contains("add a file name"));
    CHECK_THAT(refused(folder / "file/a"), Catch::Contains("choose another folder"));
    CHECK_THAT(refused(folder / "file/b/a"), Catch::Contains("choose another folder"));
    refused(folder / "new/");
    refused("");
    CHECK(content_of(folder / "file") == "old");
    CHECK(folder.entries() == 1);
}

TEST_CASE("output file: a folder without the right to write", "[output]") {
    const TemporaryFolder folder;
    fs::create_directory(folder / "locked");
    put(folder / "locked/a", "old");
    fs::permissions(folder.path(), fs::perms(0755));
    fs::permissions(folder / "locked", fs::perms(0555));
    std::string before, file, deeper;
    {
        const NoPrivileges user;
        before = output_error([&] { check_output_file(folder / "locked/a"); });
        file = output_error([&] { write(folder / "locked/a", "x"); });
        deeper = output_error([&] { write(folder / "locked/new/a", "x"); });
    }
    fs::permissions(folder / "locked", fs::perms(0755));
    for (const std::string& message : {before, file, deeper})
        CHECK_THAT(message, Catch::Contains("Permission denied") && Catch::Contains("that you may write to"));
    CHECK(content_of(folder / "locked/a") == "old");
    CHECK_FALSE(fs::exists(folder / "locked/new"));
}

}  // namespace sahl
