// How large a world may become. Address space is reserved accordingly, and address space is not
// memory: raising these is cheap. A verb that would exceed them ends the program with a message;
// load_snapshot refuses.
#pragma once

#include <cstddef>
#include <cstdint>

namespace psygen::ecs {

struct WorldLimits {
  std::size_t max_entities = std::size_t{1} << 28;        // below 2^32
  std::size_t max_rows_per_table = std::size_t{1} << 26;  // below 2^32; also of a sparse component
  std::size_t max_tables = 2048;  // a column is a mapping, of which systems grant some 65,000
  // The generation of a slot's first entity, at least 1. Near UINT32_MAX, slots retire soon.
  std::uint32_t first_generation = 1;
};

}  // namespace psygen::ecs
