// The 32-bit hash of mix32.hpp for SIMD lanes, vectors of consecutive integers, and the octahedral
// normals of packing.hpp. Kernels include it after foreach_target.h and before their own namespace,
// once per instruction set; hence the unusual include guard.
#if defined(PSYGEN_MODELS_MIX32_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PSYGEN_MODELS_MIX32_INL
#undef PSYGEN_MODELS_MIX32_INL
#else
#define PSYGEN_MODELS_MIX32_INL
#endif

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// models::mix32() of every lane.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V mix32(D d, V h) {
  h = hn::Mul(hn::Xor(h, hn::ShiftRight<16>(h)), hn::Set(d, 0x7FEB352DU));
  h = hn::Mul(hn::Xor(h, hn::ShiftRight<15>(h)), hn::Set(d, 0x846CA68BU));
  return hn::Xor(h, hn::ShiftRight<16>(h));
}

// The integers first, first + 1, … in order of the lanes. hn::Iota() of a run-time value is slower:
// it writes every lane to memory and stalls when it reads the vector back.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V counting_from(D d, std::uint32_t first) {
  return hn::Add(hn::Iota(d, 0), hn::Set(d, first));
}

// The two stored components of octahedral normals.
template <class V>
struct OctahedralPair {
  V x, z;
};
// Folds directions with y < 0 outwards. Requires |x| + |y| + |z| = `one`; the pair is in the same
// unit and not yet rounded.
template <class D, class V = hn::Vec<D>>
HWY_INLINE OctahedralPair<V> fold_octahedral(D d, V x, V y, V z, float one) {
  const V folded_x = hn::CopySign(hn::Sub(hn::Set(d, one), hn::Abs(z)), x);
  const V folded_z = hn::CopySign(hn::Sub(hn::Set(d, one), hn::Abs(x)), z);
  const auto below = hn::Lt(y, hn::Zero(d));
  return {hn::IfThenElse(below, folded_x, x), hn::IfThenElse(below, folded_z, z)};
}

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
