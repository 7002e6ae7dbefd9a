#include "engine/core/hash.hpp"

#include <gtest/gtest.h>
#if defined(__x86_64__)
#include <cpuid.h>
#include <immintrin.h>
#endif

#include <array>
#include <set>
#include <span>
#include <vector>

namespace psygen::core {
namespace {

TEST(Hash, Mix64IsTheFinaliserOfSplitMix64) {
  // The reference generator seeded with 0 and with 1234567 (first output each).
  EXPECT_EQ(mix64(0), 0xE220A8397B1DCDAFull);
  EXPECT_EQ(mix64(1234567), 6457827717110365317ull);
}

#if defined(__x86_64__)
// True if upper halves of vector registers are in use.
bool uses_upper_halves() {
  unsigned low = 0, high = 0;
  __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(1));
  return (low & 4U) != 0;
}

__attribute__((target("avx"))) void zero_upper_halves() {
  _mm256_zeroupper();
}

void use_upper_halves() {
  __asm__ volatile("vpcmpeqd %%xmm0, %%xmm0, %%xmm0\n\tvinsertf128 $1, %%xmm0, %%ymm0, %%ymm0" ::
                       : "xmm0");
}

TEST(Hash, LeavesNoUpperHalvesOfRegistersInUse) {
  unsigned a = 0, b = 0, c = 0, d = 0;
  const bool has_xgetbv_1 = __get_cpuid_count(0xD, 1, &a, &b, &c, &d) != 0 && (a & 4U) != 0;
  if (!has_xgetbv_1 || __builtin_cpu_supports("avx") == 0) return;
  const std::vector<std::byte> bytes(4096);
  use_upper_halves();
  const bool tells_use = uses_upper_halves();
  zero_upper_halves();
  const bool tells_rest = !uses_upper_halves();
  if (!tells_use || !tells_rest) return;  // some processors always report use
  static_cast<void>(hash_bytes(bytes));
  EXPECT_FALSE(uses_upper_halves());
}
#endif

TEST(Hash, StreamsOfDifferentBlocksIndicesAndPurposesDiffer) {
  std::set<std::uint64_t> seen;
  for (std::int32_t x : {-1, 0, 1}) {
    for (std::int32_t z : {-1, 0, 1}) {
      for (std::uint32_t index = 0; index < 10; ++index) {
        for (const Purpose purpose : {Purpose::kPosition, Purpose::kSeed}) {
          seen.insert(RandomStream(7, x, z, index, purpose).next_u64());
        }
      }
    }
  }
  EXPECT_EQ(seen.size(), 9u * 10u * 2u);
}

TEST(Hash, IntegersCoverTheirRangeAndNothingElse) {
  RandomStream random(1, 2, 3, 4, Purpose::kParameters);
  std::array<int, 3> count{};
  for (int i = 0; i < 3000; ++i) {
    const std::int64_t v = random.next_integer(3, 5);
    ASSERT_GE(v, 3);
    ASSERT_LE(v, 5);
    ++count[static_cast<std::size_t>(v - 3)];
  }
  for (const int c : count)
    EXPECT_NEAR(c, 1000, 150);
}

TEST(Hash, RealsAreUniform) {
  RandomStream random(1, 0, 0, 0, Purpose::kPosition);
  double sum = 0;
  for (int i = 0; i < 10000; ++i) {
    const double v = random.next_real(-2.0, 4.0);
    ASSERT_GE(v, -2.0);
    ASSERT_LT(v, 4.0);
    sum += v;
  }
  EXPECT_NEAR(sum / 10000, 1.0, 0.06);
}

TEST(Hash, BytesAndSeedBothMatter) {
  std::array<std::byte, 9> bytes{};
  const std::uint64_t zero = hash_bytes(bytes);
  EXPECT_NE(hash_bytes(bytes, 1), zero);
  bytes[8] = std::byte{1};
  EXPECT_NE(hash_bytes(bytes), zero);
}

}  // namespace
}  // namespace psygen::core
