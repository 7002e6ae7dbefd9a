// Contracts. PSYGEN_ASSERT(condition, "message") aborts the program when a caller violates a
// contract; it is checked unless NDEBUG is defined. PSYGEN_CHECK is checked in every build. Not
// error handling: a failure for outside reasons is a core::Error. Any thread.
#pragma once

#include <cstdio>
#include <cstdlib>

namespace psygen::core {
// Prints file, line, message and condition on stderr and aborts. For the macros below.
[[noreturn]] inline void assertion_failed(const char* file, int line, const char* condition,
                                          const char* sentence) {
  std::fprintf(stderr, "%s:%d: contract broken: %s (%s)\n", file, line, sentence, condition);
  std::abort();
}
}  // namespace psygen::core

#define PSYGEN_CHECK(condition, sentence) \
  ((condition) ? (void)0                  \
               : ::psygen::core::assertion_failed(__FILE__, __LINE__, #condition, sentence))
#ifdef NDEBUG
#define PSYGEN_ASSERT(condition, sentence) ((void)sizeof(condition))
#else
#define PSYGEN_ASSERT(condition, sentence) PSYGEN_CHECK(condition, sentence)
#endif
