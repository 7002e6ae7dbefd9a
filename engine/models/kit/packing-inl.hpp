// Octahedral normals (packing.hpp) for SIMD lanes. Kernels include it after foreach_target.h and
// before their own namespace, once per instruction set; hence the unusual include guard.
#if defined(PSYGEN_MODELS_PACKING_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PSYGEN_MODELS_PACKING_INL
#undef PSYGEN_MODELS_PACKING_INL
#else
#define PSYGEN_MODELS_PACKING_INL
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

// The two stored components of octahedral normals.
template <class V>
struct OctahedralPair {
  V x, z;
};
// Folds directions with y < 0 outwards. Requires |x| + |y| + |z| = `one`; the pair is in the same
// unit and not yet rounded.
template <class D, class V = hwy::HWY_NAMESPACE::Vec<D>>
HWY_INLINE OctahedralPair<V> fold_octahedral(D d, V x, V y, V z, float one) {
  namespace hn = hwy::HWY_NAMESPACE;
  const V folded_x = hn::CopySign(hn::Sub(hn::Set(d, one), hn::Abs(z)), x);
  const V folded_z = hn::CopySign(hn::Sub(hn::Set(d, one), hn::Abs(x)), z);
  const auto below = hn::Lt(y, hn::Zero(d));
  return {hn::IfThenElse(below, folded_x, x), hn::IfThenElse(below, folded_z, z)};
}

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
