// Ctrl+C and SIGTERM as a flag: the first one asks for an orderly end, a second one ends the
// program.
#pragma once

#include <atomic>

namespace psygen::game {

// Installs the handlers; true once a signal came.
const std::atomic<bool>& stop_at_interrupt();

}  // namespace psygen::game
