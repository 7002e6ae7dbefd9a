// Contracts of the library. PSYGEN_ECS_ASSERT(condition, "sentence") ends the program when a caller
// broke one; it is checked when NDEBUG is not defined. `give_up` is for limits, in every build.
#pragma once

#include <string_view>

namespace psygen::ecs::detail {

// Prints one sentence on stderr and aborts.
[[noreturn]] void give_up(std::string_view sentence);
[[noreturn]] void contract_broken(const char* file, int line, const char* condition,
                                  std::string_view sentence);

}  // namespace psygen::ecs::detail

#ifdef NDEBUG
#define PSYGEN_ECS_ASSERT(condition, sentence) ((void)sizeof(condition))
#else
#define PSYGEN_ECS_ASSERT(condition, sentence) \
  ((condition) ? (void)0                       \
               : ::psygen::ecs::detail::contract_broken(__FILE__, __LINE__, #condition, sentence))
#endif
