// Ends the program with one sentence and exit code 1 where memory or threads run out. Replaces
// operator new, to note the size that was refused. Other exceptions still abort.
#pragma once

namespace psygen::cli {

// For exceptions that end in std::terminate: in threads, and in libraries. Call first in main.
void say_why_at_terminate();

// To be called while an exception is handled: says what it was, without taking memory. Always
// kFailed.
int say_what_was_thrown();

}  // namespace psygen::cli
