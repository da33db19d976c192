// A measurement as a trace for chrome://tracing and ui.perfetto.dev.
#pragma once

#include <string>

#include "engine/profile/summarize.h"

namespace sahl {

/// The Trace Event Format (JSON): a track for each kernel and one for the host, setup and frames; launches of
/// a generation that follow each other are a flow. Times are microseconds from the start.
std::string chrome_trace(const Measurement& measurement);

}  // namespace sahl
