// Stores three vectors interleaved, element by element. Kernels include it after foreach_target.h
// and before their own namespace, once per instruction set; hence the unusual include guard.
#if defined(PSYGEN_MODELS_INTERLEAVE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PSYGEN_MODELS_INTERLEAVE_INL
#undef PSYGEN_MODELS_INTERLEAVE_INL
#else
#define PSYGEN_MODELS_INTERLEAVE_INL
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Element i of vector v goes to place 3 · i + v. Because 3 has an inverse modulo the number of
// lanes, no two elements of one vector go to the same lane. A result costs one permutation per
// vector and two selections, half the time of hn::StoreInterleaved3.
class Interleave3 {
 public:
  // Vectors of at most 16 words.
  using Tag = hn::CappedTag<std::uint32_t, 16>;
  using V = hn::Vec<Tag>;

  // Written out, because GCC compiles implicit constructors for the file's own instruction set, not
  // for the kernel's: at -O0 they would call lanes_of() with another calling convention.
  HWY_INLINE Interleave3()
      : from_a_(lanes_of(0)),
        from_b_(lanes_of(1)),
        from_c_(lanes_of(2)),
        first_(third_of(0)),
        second_(third_of(1)) {}

  // Writes a0 b0 c0 a1 b1 c1 … to `bytes`: 3 · lanes words, at any alignment.
  HWY_INLINE void store(V a, V b, V c, void* bytes) const {
    const Tag d;
    auto* const to = static_cast<std::uint32_t*>(bytes);
    if constexpr (hn::MaxLanes(Tag()) == 1) {
      const std::uint32_t first = hn::GetLane(a), second = hn::GetLane(b), third = hn::GetLane(c);
      std::memcpy(to, &first, sizeof(first));
      std::memcpy(to + 1, &second, sizeof(second));
      std::memcpy(to + 2, &third, sizeof(third));
      return;
    }
    if constexpr (hn::MaxLanes(Tag()) <= 4) return hn::StoreInterleaved3(a, b, c, d, to);
    const V v[3] = {hn::TableLookupLanes(a, from_a_), hn::TableLookupLanes(b, from_b_),
                    hn::TableLookupLanes(c, from_c_)};
    constexpr std::size_t kLanes = hn::MaxLanes(Tag());
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t first = k * kLanes;
      hn::StoreU(hn::IfThenElse(first_, v[first % 3],
                                hn::IfThenElse(second_, v[(first + 1) % 3], v[(first + 2) % 3])),
                 d, to + first);
    }
  }

 private:
  using SignedTag = hn::RebindToSigned<Tag>;
  using Lanes = decltype(hn::IndicesFromVec(Tag(), hn::Zero(SignedTag())));
  using Mask = hn::Mask<Tag>;
  static constexpr std::uint32_t kInverse = 11;  // of 3, modulo 16 and smaller powers of two
  HWY_ALIGN static constexpr std::uint32_t kThirds[16] = {0, 1, 2, 0, 1, 2, 0, 1,
                                                          2, 0, 1, 2, 0, 1, 2, 0};

  // For each lane, the lane of vector `v` whose element goes there.
  static Lanes lanes_of(std::uint32_t v) {
    const Tag d;
    const auto last = static_cast<std::uint32_t>(hn::Lanes(d)) - 1;
    const V lane = hn::Mul(hn::Add(hn::Iota(d, 0), hn::Set(d, 16 - v)), hn::Set(d, kInverse));
    return hn::IndicesFromVec(d, hn::BitCast(SignedTag(), hn::And(lane, hn::Set(d, last))));
  }
  static Mask third_of(std::uint32_t number) {
    return hn::Eq(hn::Load(Tag(), kThirds), hn::Set(Tag(), number));
  }

  const Lanes from_a_, from_b_, from_c_;
  const Mask first_, second_;
};

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
