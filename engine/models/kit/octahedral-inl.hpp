// Octahedral normals in lanes (packing.hpp). Included once per instruction set, by kernels between
// foreach_target.h and their own namespaces; hence its include guard.
#if defined(PSYGEN_MODELS_OCTAHEDRAL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PSYGEN_MODELS_OCTAHEDRAL_INL
#undef PSYGEN_MODELS_OCTAHEDRAL_INL
#else
#define PSYGEN_MODELS_OCTAHEDRAL_INL
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

// The pair of a direction whose |x| + |y| + |z| is `one`: what points down is folded outwards. The
// pair is in the same unit, and rounded by whoever packs it.
template <class V>
struct OctahedralPair {
  V x, z;
};
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
