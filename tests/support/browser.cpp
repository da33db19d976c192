#include "tests/support/browser.h"

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "tests/support/run_process.h"

namespace sahl::tests {
namespace {

/// Failed loads do not reach Chromium's log: the page notes them itself.
constexpr const char* watch = R"(<script>
{
    const wrong = [];
    const note = what => { wrong.push(what); document.documentElement.dataset.wrong = wrong.join("; "); };
    addEventListener("error", event => note(event.message ?? "load " + event.target.outerHTML), true);
    addEventListener("unhandledrejection", event => note(String(event.reason)));
    addEventListener("securitypolicyviolation", event => note("policy: " + event.blockedURI));
}
</script>
)";

}  // namespace

bool has_browser() { return run_process({"/usr/bin/env", "sh", "-c", "command -v chromium"}).status == 0; }

BrowsedPage browse(const std::string& html, const BrowserOptions& options) {
    const TemporaryFolder folder;
    const std::size_t head = html.find("<head>") + 6;
    const std::size_t end = html.rfind("</body>");
    std::ofstream(folder / "page.html") << html.substr(0, head) << watch << html.substr(head, end - head)
                                        << "<script>" << options.script << "</script>" << html.substr(end);
    ProcessOptions process;
    process.environment["HOME"] = folder.path().string();
    const ProcessResult result =
        run_process({"/usr/bin/env",
                     "chromium",
                     "--headless=new",
                     "--no-sandbox",
                     "--user-data-dir=" + (folder / "user").string(),
                     "--disable-gpu",
                     "--no-first-run",
                     "--disable-background-networking",
                     "--disable-component-update",
                     "--disable-sync",
                     "--disable-extensions",
                     "--disable-dev-shm-usage",
                     "--hide-scrollbars",
                     "--window-size=" + std::to_string(options.width) + ",900",
                     std::string("--blink-settings=preferredColorScheme=") + (options.dark ? "0" : "1"),
                     "--virtual-time-budget=5000",
                     "--enable-logging=stderr",
                     "--log-level=0",
                     "--dump-dom",
                     "file://" + (folder / "page.html").string()},
                    process);
    if (result.status != 0) throw std::runtime_error("chromium: " + result.err);
    BrowsedPage page{result.out, ""};
    std::istringstream lines(result.err);
    for (std::string line; std::getline(lines, line);) {
        if (line.find(":CONSOLE") != std::string::npos) page.messages += line + "\n";
    }
    page.messages += page.data("wrong");
    return page;
}

std::string BrowsedPage::data(const std::string& name) const {
    const std::size_t end_of_tag = dom.find('>', dom.find("<html"));
    const std::string key = " data-" + name + "=\"";
    const std::size_t at = dom.find(key);
    if (at == dom.npos || at > end_of_tag) return "";
    const std::size_t begin = at + key.size();
    return dom.substr(begin, dom.find('"', begin) - begin);
}

}  // namespace sahl::tests
