// Linear interpolation of a row of coarse samples at finer samples between them. Only kernels of
// the terrain include it, once per instruction set; hence the unusual include guard.
#if defined(PSYGEN_MODELS_TERRAIN_SPREAD_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PSYGEN_MODELS_TERRAIN_SPREAD_INL
#undef PSYGEN_MODELS_TERRAIN_SPREAD_INL
#else
#define PSYGEN_MODELS_TERRAIN_SPREAD_INL
#endif

#include <cstddef>
#include <cstdint>

#include "engine/models/kit/vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

// Fine sample i lies at `phase` + i · `step`, coarse sample k at k · `spacing`. A weight depends
// only on the remainder of its place by `spacing`, so rows with another start give the same bits.
template <std::size_t kLongest>
class Spread {
 public:
  static constexpr std::size_t kRow = kLongest + 16;

  // Prepares `count` fine samples, at most kLongest.
  Spread(std::size_t count, std::size_t phase, std::size_t step, std::size_t spacing)
      : dense_(step <= spacing) {
    const FloatTag d;
    const IntTag di;
    const auto real = [](std::size_t value) { return set(static_cast<float>(value)); };
    const float scale = 1.0F / static_cast<float>(spacing);
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
      // The padding repeats the last sample.
      const Float fine = hn::Min(hn::Add(hn::Iota(d, 0), real(i)), real(count - 1));
      const Float place = hn::Add(real(phase), hn::Mul(fine, real(step)));
      const Float at = hn::Floor(hn::Mul(hn::Add(place, set(0.5F)), set(scale)));
      const auto number = hn::ConvertTo(di, at);
      const std::int32_t first = hn::GetLane(number);
      first_[i / hn::Lanes(d)] = static_cast<std::size_t>(first);
      hn::Store(hn::Sub(number, hn::Set(di, first)), di, slot_ + i);
      hn::Store(hn::Mul(hn::Sub(place, hn::Mul(at, real(spacing))), set(scale)), d, weight_ + i);
    }
  }

  // Fine samples i, i + 1, … of a row. `coarse` may be read 16 samples beyond the row's last. i is
  // a multiple of the lanes.
  HWY_INLINE Float at(const float* coarse, std::size_t i) const {
    const FloatTag d;
    const float* const from = coarse + first_[i / hn::Lanes(d)];
    Float left, right;
    if (HWY_LIKELY(dense_)) {
      const auto slots = hn::IndicesFromVec(d, hn::Load(IntTag(), slot_ + i));
      left = hn::TableLookupLanes(hn::LoadU(d, from), slots);
      right = hn::TableLookupLanes(hn::LoadU(d, from + 1), slots);
    } else {
      const auto slots = hn::Load(IntTag(), slot_ + i);
      left = hn::GatherIndex(d, from, slots);
      right = hn::GatherIndex(d, from + 1, slots);
    }
    return hn::Add(left, hn::Mul(hn::Load(d, weight_ + i), hn::Sub(right, left)));
  }

 private:
  bool dense_;  // in a vector, fine sample k is at most k coarse samples from the first
  std::size_t first_[kRow];
  HWY_ALIGN std::int32_t slot_[kRow];
  HWY_ALIGN float weight_[kRow];
};

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
