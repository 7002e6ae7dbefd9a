// Signals as values: Ctrl+C, SIGTERM and the end of the terminal as a flag that asks for an orderly
// end, closed pipes and limits of files as errors of the writes that meet them.
#pragma once

#include <atomic>

namespace psygen::cli {

// Installs the handlers of SIGINT, SIGTERM and, unless it is ignored, SIGHUP; true once one came. A
// second SIGINT or SIGTERM ends the program at once.
const std::atomic<bool>& stop_at_interrupt();

// A pipe without a reader (SIGPIPE) and a file beyond `ulimit -f` (SIGXFSZ) do not end
// the program: the write fails. Call first in main.
void ignore_what_write_errors_say();

}  // namespace psygen::cli
