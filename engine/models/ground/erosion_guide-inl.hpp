// The guide of the erosion's kernel: heights and derivatives by cubic splines, and the sediment of
// hollows. Only the kernel includes it, once per instruction set; hence the unusual include guard.
#if defined(PSYGEN_MODELS_GROUND_EROSION_GUIDE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PSYGEN_MODELS_GROUND_EROSION_GUIDE_INL
#undef PSYGEN_MODELS_GROUND_EROSION_GUIDE_INL
#else
#define PSYGEN_MODELS_GROUND_EROSION_GUIDE_INL
#endif

#include <algorithm>
#include <cstddef>

#include "engine/models/ground/erosion_kernel.hpp"
#include "engine/models/kit/vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

// a · b + c, rounded twice on every instruction set.
HWY_INLINE Float mad(Float a, Float b, Float c) {
  return hn::Add(hn::Mul(a, b), c);
}
HWY_INLINE Float square(Float v) {
  return hn::Mul(v, v);
}
HWY_INLINE Float rest(Float v) {
  return hn::Sub(set(1), v);
}
HWY_INLINE Float at_least(Float v, float least) {
  return hn::Max(v, set(least));
}
// A smooth step from 0 at 0 to 1 at 1.
HWY_INLINE Float smooth(Float v) {
  const Float t = hn::Min(at_least(v, 0), set(1));
  return hn::Mul(square(t), hn::Sub(set(3), hn::Add(t, t)));
}
HWY_INLINE Float ramp(const ErosionRamp& r, Float v) {
  return smooth(hn::Mul(hn::Sub(v, set(r.from)), set(r.per)));
}

// Weights of the four lines around a place, for values, first and second derivatives: the uniform
// cubic B-spline.
struct Taps {
  Float value[4], slope[4], bend[4];

  // `t` is the position between the second and the third line, 0 … 1.
  HWY_INLINE Taps(Float t, float per_m) {
    const Float s = rest(t), t2 = square(t), s2 = square(s), m = set(per_m),
                mm = set(per_m * per_m);
    value[0] = hn::Mul(hn::Mul(s2, s), set(1.0F / 6));
    value[1] = middle(t2, t);
    value[2] = middle(s2, s);
    value[3] = hn::Mul(hn::Mul(t2, t), set(1.0F / 6));
    slope[0] = hn::Mul(hn::Mul(set(-0.5F), s2), m);
    slope[1] = hn::Mul(hn::Sub(hn::Mul(set(1.5F), t2), hn::Add(t, t)), m);
    slope[2] = hn::Mul(hn::Sub(hn::Add(s, s), hn::Mul(set(1.5F), s2)), m);
    slope[3] = hn::Mul(hn::Mul(set(0.5F), t2), m);
    bend[0] = hn::Mul(s, mm);
    bend[1] = hn::Mul(mad(set(3), t, set(-2)), mm);
    bend[2] = hn::Mul(mad(set(3), s, set(-2)), mm);
    bend[3] = hn::Mul(t, mm);
  }

 private:
  static HWY_INLINE Float middle(Float v2, Float v) {
    return mad(hn::Mul(v2, v), set(0.5F), hn::Sub(set(2.0F / 3), v2));
  }
};

// The guide at places on one of its lines: along x only.
struct LinePoint {
  Float value, slope, bend, hollow;
};
HWY_INLINE LinePoint point_on(const float* line, const float* hollows, Int first,
                              const Taps& taps) {
  const FloatTag d;
  LinePoint p{set(0), set(0), set(0), set(0)};
  for (std::size_t a = 0; a < 4; ++a) {
    const Float h = hn::GatherIndex(d, line + a, first);
    p.value = mad(h, taps.value[a], p.value);
    p.slope = mad(h, taps.slope[a], p.slope);
    p.bend = mad(h, taps.bend[a], p.bend);
  }
  for (std::size_t a = 0; hollows != nullptr && a < 4; ++a)
    p.hollow = mad(hn::GatherIndex(d, hollows + a, first), taps.value[a], p.hollow);
  return p;
}

// The guide at places: height, slopes and second derivatives, and the sediment that would fill
// hollows, in metres.
struct Guide {
  Float height = set(0), x = set(0), z = set(0);
  Float xx = set(0), xz = set(0), zz = set(0);
  Float hollow = set(0);

  HWY_INLINE Guide() {}  // in the kernel's instruction set (docs/models.md#arithmetic)
  HWY_INLINE void add(const LinePoint& line, const Taps& along_z, std::size_t tap) {
    height = mad(line.value, along_z.value[tap], height);
    z = mad(line.value, along_z.slope[tap], z);
    zz = mad(line.value, along_z.bend[tap], zz);
    x = mad(line.slope, along_z.value[tap], x);
    xz = mad(line.slope, along_z.slope[tap], xz);
    xx = mad(line.bend, along_z.value[tap], xx);
    hollow = mad(line.hollow, along_z.value[tap], hollow);
  }
};

// Values on the lines of the guide, with room for a vector before and behind.
struct Field {
  HWY_ALIGN float padded[kMaxErosionAxis * kMaxErosionAxis + 2 * kMaxLanes];
  float* line(std::size_t z) { return padded + kMaxLanes + z * kMaxErosionAxis; }
  const float* line(std::size_t z) const { return padded + kMaxLanes + z * kMaxErosionAxis; }
};

// The mean of three neighbours with the weights 1 2 1.
HWY_INLINE Float mean(Float before, Float here, Float behind) {
  return mad(set(0.25F), hn::Add(before, behind), hn::Mul(set(0.5F), here));
}

// Blurs a field once along both axes. The outermost lines stay.
void blur(std::size_t columns, std::size_t rows, Field& field, Field& memory) {
  const FloatTag d;
  for (std::size_t z = 0; z < rows; ++z) {
    const float* const from = field.line(z);
    float* const to = memory.line(z);
    for (std::size_t x = 0; x < columns; x += hn::Lanes(d))
      hn::Store(mean(hn::LoadU(d, from + x - 1), hn::Load(d, from + x), hn::LoadU(d, from + x + 1)),
                d, to + x);
    to[0] = from[0];
    to[columns - 1] = from[columns - 1];
  }
  for (std::size_t z = 1; z + 1 < rows; ++z) {
    const float *const above = memory.line(z - 1), *const below = memory.line(z + 1);
    for (std::size_t x = 0; x < columns; x += hn::Lanes(d))
      hn::Store(
          mean(hn::Load(d, above + x), hn::Load(d, memory.line(z) + x), hn::Load(d, below + x)), d,
          field.line(z) + x);
  }
}

// Finds the sediment: a blurred guide lies above the guide in hollows.
void fill_hollows(const ErosionCall& call, Field& hollows, Field& memory) {
  const FloatTag d;
  const std::size_t columns = call.x->lines, rows = call.z->lines;
  for (std::size_t z = 0; z < rows; ++z)
    std::copy_n(call.guide + z * kMaxErosionAxis, columns, hollows.line(z));
  for (int i = 0; i < call.passes; ++i)
    blur(columns, rows, hollows, memory);
  for (std::size_t z = 0; z < rows; ++z) {
    float* const line = hollows.line(z);
    const float* const guide = call.guide + z * kMaxErosionAxis;
    for (std::size_t x = 0; x < columns; x += hn::Lanes(d))
      hn::Store(hn::Sub(hn::Load(d, line + x), hn::LoadU(d, guide + x)), d, line + x);
  }
}

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
