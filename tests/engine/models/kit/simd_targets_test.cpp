#include "engine/models/kit/simd_targets.hpp"

#include <gmock/gmock.h>
#include <hwy/targets.h>

#include <set>

namespace psygen::models {
namespace {

TEST(SimdTargets, AreNamedOnceAndEndWithScalar) {
  const auto targets = simd_targets();
  EXPECT_EQ(targets.back(), "scalar");
  EXPECT_EQ(std::set(targets.begin(), targets.end()).size(), targets.size());
#if defined(__x86_64__)
  EXPECT_THAT(targets, testing::IsSubsetOf({"avx512", "avx2", "sse4", "scalar"}));
#endif
}

TEST(SimdTargets, StayTheSameWhileOneIsPinned) {
  const auto targets = simd_targets();
  pin_simd_target("scalar");
  EXPECT_EQ(simd_targets(), targets);
  unpin_simd_target();
  EXPECT_EQ(simd_targets(), targets);
}

TEST(SimdTargets, ArePinnedAndUnpinned) {
  const std::int64_t best = hwy::SupportedTargets();
  std::set<std::int64_t> pinned;
  for (const std::string_view name : simd_targets()) {
    pin_simd_target(name);
    pinned.insert(hwy::SupportedTargets());
  }
  EXPECT_EQ(pinned.size(), simd_targets().size()) << "each name pins another set";
  unpin_simd_target();
  EXPECT_EQ(hwy::SupportedTargets(), best);
}

TEST(SimdTargetsDeathTest, RejectUnknownNames) {
  EXPECT_DEATH(pin_simd_target("mmx"), "simd_targets");
}

}  // namespace
}  // namespace psygen::models
