#include "engine/core/hash.hpp"

// The ordinary functions of xxHash are built for the oldest processor and are nine times slower
// than the dispatching functions, which return the same values.
#if defined(__x86_64__)
#include <immintrin.h>
#include <xxh_x86dispatch.h>
#else
#include <xxhash.h>
#endif

namespace psygen::core {
namespace {

// The AVX-512 code of xxHash 0.8.1 omits vzeroupper, which slows down all later SSE code of the
// thread: simplifying models took 1.6 times as long.
#if defined(__x86_64__)
__attribute__((target("avx"))) void zero_upper_halves() {
  _mm256_zeroupper();
}
const bool kHasAvx = __builtin_cpu_supports("avx") != 0;
#else
void zero_upper_halves() {}
constexpr bool kHasAvx = false;
#endif

}  // namespace

std::uint64_t hash_bytes(std::span<const std::byte> bytes, std::uint64_t seed) {
  const std::uint64_t hash = XXH3_64bits_withSeed(bytes.data(), bytes.size(), seed);
  if (kHasAvx) zero_upper_halves();
  return hash;
}

}  // namespace psygen::core
