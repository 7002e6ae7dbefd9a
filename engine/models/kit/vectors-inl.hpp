// Vectors of kernels: at most 16 numbers. Kernels include it once per instruction set; hence the
// unusual include guard.
#if defined(PSYGEN_MODELS_VECTORS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PSYGEN_MODELS_VECTORS_INL
#undef PSYGEN_MODELS_VECTORS_INL
#else
#define PSYGEN_MODELS_VECTORS_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

// At most this many numbers.
namespace hn = hwy::HWY_NAMESPACE;
constexpr std::size_t kMaxLanes = 16;
using FloatTag = hn::CappedTag<float, kMaxLanes>;
using IntTag = hn::RebindToSigned<FloatTag>;
using UintTag = hn::RebindToUnsigned<FloatTag>;
using Float = hn::Vec<FloatTag>;
using Int = hn::Vec<IntTag>;

// `value` in every lane.
HWY_INLINE Float set(float value) {
  return hn::Set(FloatTag(), value);
}
HWY_INLINE Float load(const float* from) {
  return hn::LoadU(FloatTag(), from);
}
HWY_INLINE void store(Float value, float* to) {
  hn::StoreU(value, FloatTag(), to);
}
HWY_INLINE std::size_t lanes() {
  return hn::Lanes(FloatTag());
}
// The first n lanes of rows of callers, which end with their last sample.
HWY_INLINE Float load_few(const float* from, std::size_t n) {
  if (n == lanes()) return load(from);
  HWY_ALIGN float few[kMaxLanes] = {};
  std::copy_n(from, n, few);
  return hn::Load(FloatTag(), few);
}
template <class D, class V, class T>
HWY_INLINE void store_few(V value, D d, T* to, std::size_t n) {
  if (n == lanes()) return hn::StoreU(value, d, to);
  HWY_ALIGN T few[kMaxLanes];
  hn::Store(value, d, few);
  std::copy_n(few, n, to);
}

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
