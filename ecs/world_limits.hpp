// Limits of a world's size. They reserve address space, not memory, so raising them is cheap. A
// verb that would exceed a limit ends the program with a message; load_snapshot rejects the
// snapshot instead.
#pragma once

#include <cstddef>
#include <cstdint>

namespace psygen::ecs {

// Given to World's constructor and fixed for its life.
struct WorldLimits {
  std::size_t max_entities = std::size_t{1} << 28;        // below 2^32
  std::size_t max_rows_per_table = std::size_t{1} << 26;  // below 2^32; also per sparse component
  std::size_t max_tables = 2048;  // a column is a mapping; systems grant some 65,000
  // The generation of a slot's first entity, at least 1. With a value near UINT32_MAX, slots retire
  // soon.
  std::uint32_t first_generation = 1;
};

}  // namespace psygen::ecs
