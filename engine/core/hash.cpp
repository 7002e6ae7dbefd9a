#include "engine/core/hash.hpp"

// The ordinary functions of xxHash are built for the oldest processor and are nine times slower
// than the dispatching functions, which return the same values.
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
