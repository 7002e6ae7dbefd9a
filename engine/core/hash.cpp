#include "engine/core/hash.hpp"

#include <xxhash.h>

namespace psygen::core {

std::uint64_t hash_bytes(std::span<const std::byte> bytes, std::uint64_t seed) {
  return XXH3_64bits_withSeed(bytes.data(), bytes.size(), seed);
}

}  // namespace psygen::core
