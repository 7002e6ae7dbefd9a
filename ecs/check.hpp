// Contracts of the library. PSYGEN_ECS_ASSERT(condition, "message") aborts the program when a
// caller violates a contract; it is checked unless NDEBUG is defined. `give_up` reports exceeded
// limits, in every build. Not error handling: nothing here returns to the caller. Safe from any
// thread.
#pragma once

#include <string_view>

namespace psygen::ecs::detail {

// Prints "ecs: " and the message on stderr and aborts.
[[noreturn]] void give_up(std::string_view sentence);
// Prints file, line, condition and message on stderr and aborts. Called by PSYGEN_ECS_ASSERT only.
[[noreturn]] void assertion_failed(const char* file, int line, const char* condition,
                                   std::string_view sentence);

}  // namespace psygen::ecs::detail

#ifdef NDEBUG
#define PSYGEN_ECS_ASSERT(condition, sentence) ((void)sizeof(condition))
#else
#define PSYGEN_ECS_ASSERT(condition, sentence) \
  ((condition)                                 \
       ? (void)0                               \
       : ::psygen::ecs::detail::assertion_failed(__FILE__, __LINE__, #condition, sentence))
#endif
