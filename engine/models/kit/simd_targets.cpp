#include "engine/models/kit/simd_targets.hpp"

#include <hwy/targets.h>

#include <algorithm>
#include <cstdint>

#include "engine/core/assert.hpp"

namespace psygen::models {
namespace {

struct Target {
  std::int64_t bit;
  std::string_view name;
};

std::string_view name_of(std::int64_t bit) {
  switch (bit) {
    case HWY_AVX3:
      return "avx512";
    case HWY_AVX2:
      return "avx2";
    case HWY_SSE4:
      return "sse4";
    case HWY_SCALAR:
    case HWY_EMU128:
      return "scalar";
    default:
      return hwy::TargetName(bit);
  }
}

// Returns the sets that the CPU supports, determined before any pinning. Highway lists the best
// first. Its list of supported sets lacks the fallback, which runs on any CPU.
const std::vector<Target>& available() {
  static const std::vector<Target> targets = [] {
    constexpr std::int64_t kFallback = HWY_TARGETS & (HWY_SCALAR | HWY_EMU128);
    std::vector<Target> found;
    for (const std::int64_t bit : hwy::SupportedAndGeneratedTargets()) {
      if (bit != kFallback) found.push_back({bit, name_of(bit)});
    }
    if (kFallback != 0) found.push_back({kFallback, name_of(kFallback)});
    return found;
  }();
  return targets;
}

}  // namespace

std::vector<std::string_view> simd_targets() {
  std::vector<std::string_view> names;
  for (const Target& target : available())
    names.push_back(target.name);
  return names;
}

void pin_simd_target(std::string_view name) {
  const std::vector<Target>& targets = available();
  const auto found = std::find_if(targets.begin(), targets.end(),
                                  [&](const Target& target) { return target.name == name; });
  PSYGEN_CHECK(found != targets.end(), "the instruction set is one of simd_targets()");
  hwy::SetSupportedTargetsForTest(found->bit);
}

void unpin_simd_target() {
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace psygen::models
