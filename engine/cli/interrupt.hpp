// Signals as values: Ctrl+C, SIGTERM and a closed terminal set a flag that requests an orderly end.
#pragma once

#include <atomic>

namespace psygen::cli {

// Installs handlers for SIGINT, SIGTERM and, unless it is ignored, SIGHUP; the flag becomes true
// after the first signal. A second SIGINT or SIGTERM ends the program at once.
const std::atomic<bool>& stop_at_interrupt();

}  // namespace psygen::cli
