#include "engine/core/hash.hpp"

// The library's ordinary functions are built for the oldest processor, nine times slower; the
// dispatching ones give the same values.
#if defined(__x86_64__)
#include <xxh_x86dispatch.h>
#else
#include <xxhash.h>
#endif

namespace psygen::core {

std::uint64_t hash_bytes(std::span<const std::byte> bytes, std::uint64_t seed) {
  return XXH3_64bits_withSeed(bytes.data(), bytes.size(), seed);
}

}  // namespace psygen::core
