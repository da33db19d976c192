// OpenCL drivers that end the process instead of returning an error.
#pragma once

namespace sahl::cli {

/// PoCL aborts and its compiler exits when the disk of their folder is full. From now on this is a
/// message and exit status 4. An abort for any other reason stays one. Call when a Device is open: with
/// the drivers LLVM's own handlers come in.
void take_driver_failures();

/// The message is an event of the `--json` stream too.
void report_driver_failure_as_event();

/// The program ends by itself now.
void expect_end();

}  // namespace sahl::cli
