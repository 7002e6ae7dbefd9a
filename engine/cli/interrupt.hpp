// Signals as values: Ctrl+C, SIGTERM and a closed terminal set a flag that requests an orderly end.
// Closed pipes and file size limits become errors of the failing write.
#pragma once

#include <atomic>

namespace psygen::cli {

// Installs handlers for SIGINT, SIGTERM and, unless it is ignored, SIGHUP; the flag becomes true
// after the first signal. A second SIGINT or SIGTERM ends the program at once.
const std::atomic<bool>& stop_at_interrupt();

// A pipe without a reader (SIGPIPE) and a file beyond `ulimit -f` (SIGXFSZ) fail the write instead
// of ending the program. Call first in main.
void ignore_write_signals();

}  // namespace psygen::cli
