#include "ecs/check.hpp"

#include <cstdio>
#include <cstdlib>

namespace psygen::ecs::detail {

void give_up(std::string_view sentence) {
  std::fprintf(stderr, "ecs: %.*s\n", static_cast<int>(sentence.size()), sentence.data());
  std::abort();
}

void assertion_failed(const char* file, int line, const char* condition,
                      std::string_view sentence) {
  std::fprintf(stderr, "%s:%d: contract broken: %s (%.*s)\n", file, line, condition,
               static_cast<int>(sentence.size()), sentence.data());
  std::abort();
}

}  // namespace psygen::ecs::detail
