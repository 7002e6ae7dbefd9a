// Ends the program with an error message and exit code 1 if memory or threads run out. Replaces
// operator new, to record the size of a failed allocation. Other exceptions still abort.
#pragma once

namespace psygen::cli {

// Handles exceptions that end in std::terminate, from threads and libraries. Call first in main.
void install_terminate_handler();

// Reports the exception that is being handled, without allocating. Returns kFailed.
int report_current_exception();

}  // namespace psygen::cli
