#include "cli/batch_misdeed.h"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <string_view>

#include "engine/core/child_process.h"

namespace sahl::cli {

void misbehave_if_asked(const BatchJob& job) {
    const char* variable = std::getenv("SAHL_FAIL_JOB");
    if (variable == nullptr) return;
    const std::string_view text = variable;
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos) return;
    if (job.outputs.front().string().find(text.substr(colon + 1)) == std::string::npos) return;
    const std::string_view misdeed = text.substr(0, colon);
    if (misdeed == "crash") {
        std::signal(SIGSEGV, SIG_DFL);  // OpenCL drivers have handlers that go on
        std::raise(SIGSEGV);
    }
    while (misdeed == "hang") pause();
    if (misdeed == "memory") {
        constexpr std::size_t piece = std::size_t{16} << 20U;
        limit_process(16 * piece, 3600);  // enough to see it fail, and nothing that the machine would feel
        for (std::vector<std::vector<char>> all;;) std::ranges::fill(all.emplace_back(piece), 'x');
    }
}

}  // namespace sahl::cli
