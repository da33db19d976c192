// What a fuzz target does with its input.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

#include "engine/core/error.h"
#include "tests/support/sound_scene.h"

namespace sahl::tests {

/// Loads a scene with `load`: it must be sound, or refused with a scene error; all else ends the program.
template <class Load>
void fuzz_loader(Load load) {
    std::string wrong;
    try {
        wrong = flaw_of(load());
    } catch (const Error& error) {
        if (error.code() != ExitCode::scene) wrong = error.what();
    }
    if (wrong.empty()) return;
    std::fputs(wrong.c_str(), stderr);
    std::abort();
}

}  // namespace sahl::tests
