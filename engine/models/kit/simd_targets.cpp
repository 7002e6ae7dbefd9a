#include "engine/models/kit/simd_targets.hpp"

#include <hwy/targets.h>

#include <algorithm>
#include <cstdint>

#include "engine/core/assert.hpp"

namespace psygen::models {
namespace {

std::string_view name_of(std::int64_t bit) {
  switch (bit) {
    case HWY_AVX3:
      return "avx512";
    case HWY_AVX2:
      return "avx2";
    case HWY_SSE4:
      return "sse4";
    case HWY_NEON:
      return "neon";
    case HWY_SCALAR:
    case HWY_EMU128:
      return "scalar";
    default:
      return hwy::TargetName(bit);
  }
}

// Returns the sets that the CPU supports, determined before any pinning. Highway lists the best
// first. Its list of supported sets lacks the fallback, which runs on any CPU.
const std::vector<std::int64_t>& available() {
  static const std::vector<std::int64_t> targets = [] {
    constexpr std::int64_t kFallback = HWY_TARGETS & (HWY_SCALAR | HWY_EMU128);
    std::vector<std::int64_t> found = hwy::SupportedAndGeneratedTargets();
    std::erase(found, kFallback);
    if (kFallback != 0) found.push_back(kFallback);
    return found;
  }();
  return targets;
}

}  // namespace

std::vector<std::string_view> simd_targets() {
  std::vector<std::string_view> names;
  for (const std::int64_t target : available())
    names.push_back(name_of(target));
  return names;
}

void pin_simd_target(std::string_view name) {
  const auto found = std::ranges::find(available(), name, name_of);
  PSYGEN_CHECK(found != available().end(), "the instruction set is one of simd_targets()");
  hwy::SetSupportedTargetsForTest(*found);
}

void unpin_simd_target() {
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace psygen::models
