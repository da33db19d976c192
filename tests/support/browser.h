// Pages as a browser makes them: Chromium without a window.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "tests/support/temporary_folder.h"

namespace sahl::tests {

struct BrowserOptions {
    int width = 1200;
    bool dark = false;
    std::string script{};  ///< runs when the page's own have run
};

struct BrowsedPage {
    std::string dom;       ///< in the end, as HTML
    std::string messages;  ///< of the console, and what went wrong: errors, failed loads; none: empty
    /// document.documentElement.dataset, for `script` to leave things in.
    std::string data(const std::string& name) const;
};

bool has_browser();

/// Opens `html` as a file, lets its scripts run and reads what became of it.
BrowsedPage browse(const std::string& html, const BrowserOptions& options = {});

}  // namespace sahl::tests
