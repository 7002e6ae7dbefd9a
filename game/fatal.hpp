// How the program ends where memory or threads run out and nobody can go on: one sentence, exit
// code
// 1. With the program's own operator new, which notes how much was wanted. What other exceptions
// mean for a thread, an abort, they keep.
#pragma once

namespace psygen::game {

// For exceptions that end in std::terminate: in threads, and in libraries. Call first in main.
void say_why_at_terminate();

// To be called while an exception is handled: says what it was, without taking memory. Always
// kFailed.
int say_what_was_thrown();

}  // namespace psygen::game
