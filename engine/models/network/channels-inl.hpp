// The water, the banks and the beds of channels at vectors of samples. Only the kernel includes it,
// once per instruction set; hence the unusual include guard.
#if defined(PSYGEN_MODELS_NETWORK_CHANNELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PSYGEN_MODELS_NETWORK_CHANNELS_INL
#undef PSYGEN_MODELS_NETWORK_CHANNELS_INL
#else
#define PSYGEN_MODELS_NETWORK_CHANNELS_INL
#endif

#include <cstddef>
#include <cstdint>

#include "engine/models/kit/vectors-inl.hpp"
#include "engine/models/network/kernel.hpp"
#include "engine/models/network/patch.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::network::HWY_NAMESPACE {

using namespace models::HWY_NAMESPACE;  // the vectors

// A smooth step from 0 to 1 of t, 0 … 1.
HWY_INLINE Float smooth(Float t) {
  return hn::Mul(hn::Mul(t, t), hn::Sub(set(3), hn::Mul(set(2), t)));
}

// The position of a vector of samples against a channel.
struct Beside {
  Float t;                     // along the curve, 0 … 1
  Float distance;              // from the middle of the water, m
  Float surface, width, edge;  // edge: distance from the water's edge, < 0 inside
  Float taper;                 // of bed and banks: 0 at a spring … 1
  Float abeam;                 // 1 beside the curve … 0 beyond its ends
  hn::Mask<FloatTag> near;     // within the reach of the banks
};

HWY_INLINE Beside beside(const Curve& c, Float px, Float pz) {
  const FloatTag d;
  Float best = set(1e30F), t = hn::Zero(d);
  for (std::size_t s = 0; s < c.chords; ++s) {
    const Float dx = hn::Sub(px, set(c.px[s])), dz = hn::Sub(pz, set(c.pz[s]));
    const Float ex = set(c.px[s + 1] - c.px[s]), ez = set(c.pz[s + 1] - c.pz[s]);
    const Float along =
        hn::Mul(hn::Add(hn::Mul(dx, ex), hn::Mul(dz, ez)), set(c.inverse_length2[s]));
    const Float f = hn::Min(hn::Max(along, hn::Zero(d)), set(1));
    const Float qx = hn::Sub(dx, hn::Mul(f, ex)), qz = hn::Sub(dz, hn::Mul(f, ez));
    const Float square = hn::Add(hn::Mul(qx, qx), hn::Mul(qz, qz));
    const auto closer = hn::Lt(square, best);
    best = hn::Min(square, best);
    const Float place = hn::Mul(hn::Add(f, set(static_cast<float>(s))), set(1.0F / Curve::kChords));
    t = hn::IfThenElse(closer, place, t);
  }
  const float end_t = static_cast<float>(c.chords) / Curve::kChords;
  t = hn::Min(t, set(end_t));
  // Beyond an end the next curve shapes the ground.
  const auto past = [&](std::size_t p, std::size_t s, float sign) HWY_ATTR {
    const Float dx = hn::Sub(px, set(c.px[p])), dz = hn::Sub(pz, set(c.pz[p]));
    const float ex = c.px[s + 1] - c.px[s], ez = c.pz[s + 1] - c.pz[s];
    const Float dot = hn::Add(hn::Mul(dx, set(sign * ex)), hn::Mul(dz, set(sign * ez)));
    const Float over = hn::Max(dot, hn::Zero(d));
    return hn::Mul(hn::Mul(over, over), set(c.inverse_length2[s]));
  };
  const Float end = hn::IfThenElse(
      hn::Lt(t, set(1e-6F)), past(0, 0, -1),
      hn::IfThenElseZero(hn::Gt(t, set(end_t - 1e-6F)), past(c.chords, c.chords - 1, 1)));
  const Float sine2 = hn::Div(end, hn::Max(best, set(1e-6F)));
  const Float abeam = hn::Max(hn::Sub(set(1), hn::Mul(sine2, set(4))), hn::Zero(d));
  const Float distance = hn::Sqrt(best);
  const Float o = hn::Sub(set(1), t);
  const Float twice = hn::Mul(hn::Add(t, t), set(c.height_m[1] - c.height_m[2]));
  const Float fall = hn::Mul(o, hn::Add(hn::Mul(o, set(c.height_m[0] - c.height_m[2])), twice));
  const Float surface = hn::Max(hn::Add(set(c.height_m[2]), fall), set(c.min_m));
  const Float width = hn::Add(set(c.width0_m), hn::Mul(t, set(c.width1_m - c.width0_m)));
  const Float edge = hn::Sub(distance, hn::Mul(width, set(0.5F)));
  const Float taper = c.head ? smooth(hn::Min(hn::Add(t, t), set(1))) : set(1);
  const auto near = hn::Lt(edge, hn::Add(set(kValleyM), hn::Mul(width, set(kBankWidths))));
  return {t, distance, surface, width, edge, taper, abeam, near};
}

// The vectors of channel_depth_m().
HWY_INLINE Float depth_of(const Beside& b) {
  return hn::Add(set(kBedM), hn::Mul(b.width, set(kBedWidths)));
}

// The water that covers a vector of samples, as a mean over channels. A channel's weight grows
// without bound towards its middle, so there the water is its own, which never rises downstream;
// and it vanishes at its edge, so water that touches other water has no step.
struct Water {
  Float weight, height, flow_x, flow_z, most;
  Int body;
};
HWY_INLINE void add_channel(const Curve& c, const Beside& b, bool flow, Water& w) {
  const FloatTag d;
  const IntTag di;
  const auto wet = hn::Le(b.edge, hn::Zero(d));
  if (hn::AllFalse(d, wet)) return;
  const Float share = hn::Div(hn::Add(b.distance, b.distance), b.width);
  const Float rho = hn::Min(hn::Mul(share, share), set(1)), inside = hn::Sub(set(1), rho);
  // Beyond its ends a curve leaves the water to the next one.
  const Float own = hn::Mul(hn::Max(b.abeam, set(1e-3F)), hn::Mul(inside, inside));
  const Float k = hn::IfThenElseZero(wet, hn::Div(own, hn::Add(rho, set(1e-6F))));
  w.weight = hn::Add(w.weight, k);
  w.height = hn::Add(w.height, hn::Mul(k, b.surface));
  const auto more = hn::Gt(k, w.most);
  w.most = hn::Max(k, w.most);
  w.body = hn::IfThenElse(hn::RebindMask(di, more), hn::Set(di, static_cast<std::int32_t>(c.body)),
                          w.body);
  if (!flow) return;
  // The vectors of middle_speed_m_s(), as a parabola across.
  const Float deep = depth_of(b);
  const Float middle = hn::Div(set(kMiddleSpeed * c.discharge_m3_s), hn::Mul(b.width, deep));
  const Float speed = hn::Mul(hn::Min(middle, set(kFastestM_S)), inside);
  const Float o = hn::Sub(set(1), b.t);
  const Float tx = hn::Add(hn::Mul(o, set(c.turn[0])), hn::Mul(b.t, set(c.turn[2])));
  const Float tz = hn::Add(hn::Mul(o, set(c.turn[1])), hn::Mul(b.t, set(c.turn[3])));
  const Float size = hn::Sqrt(hn::Add(hn::Mul(tx, tx), hn::Mul(tz, tz)));
  const Float scale = hn::Div(hn::Mul(k, speed), hn::Max(size, set(1e-6F)));
  w.flow_x = hn::Add(w.flow_x, hn::Mul(scale, tx));
  w.flow_z = hn::Add(w.flow_z, hn::Mul(scale, tz));
}
// Adds a lake or the sea, where `wet`.
HWY_INLINE void add_still(hn::Mask<FloatTag> wet, Float level, Int body, Water& w) {
  const IntTag di;
  const Float k = hn::IfThenElseZero(wet, set(0.25F));
  w.weight = hn::Add(w.weight, k);
  w.height = hn::Add(w.height, hn::Mul(k, level));
  const auto more = hn::Gt(k, w.most);
  w.most = hn::Max(k, w.most);
  w.body = hn::IfThenElse(hn::RebindMask(di, more), body, w.body);
}

// The ground beside and under a channel: it rises from `height` by `rise`. The valley is lowered to
// that, by the fraction `force`; levees, and the ground under the water, are raised to the height
// by the square of `levee`.
struct Bank {
  Float height, rise, force, levee;
  hn::Mask<FloatTag> dry;  // beside the water, within reach: there the valley is lowered
};
HWY_INLINE Bank bank_of(const Beside& b) {
  const FloatTag d;
  const Float edge = hn::Max(b.edge, hn::Zero(d));
  const Float widths = hn::Mul(b.width, set(kBankWidths));
  const auto fade = [&](float more, Float grown) HWY_ATTR {
    const Float s = hn::Min(hn::Div(edge, hn::Add(set(more), widths)), set(1));
    return hn::Mul(hn::Mul(hn::Sub(set(1), smooth(s)), grown), b.abeam);
  };
  return {hn::Add(b.surface, hn::Mul(set(kBankRiseM), hn::Min(edge, set(1)))),
          hn::Mul(set(kValleySlope), edge), fade(kValleyM, b.taper), fade(kLeveeM, b.taper),
          hn::And(b.near, hn::Gt(b.edge, hn::Zero(d)))};
}
// The bed under the water; 1e30 beside it. Beds of springs fade in.
HWY_INLINE Float bed_of(const Beside& b, Float ground) {
  const FloatTag d;
  const Float share = hn::Div(hn::Add(b.distance, b.distance), b.width);
  const Float deep = depth_of(b);
  const Float bowl = hn::Mul(deep, hn::Sub(set(1), hn::Mul(share, share)));
  const Float bed = hn::Sub(b.surface, bowl);
  const Float middle = hn::Sub(b.surface, deep);
  const Float begun = hn::Add(ground, hn::Mul(hn::Sub(middle, ground), b.taper));
  const Float tapered = hn::IfThenElse(hn::Lt(b.taper, set(1)), hn::Max(bed, begun), bed);
  return hn::IfThenElse(hn::Le(b.edge, hn::Zero(d)), tapered, set(1e30F));
}

// Writes the first n lanes of the water over the ground from index `at` on.
HWY_INLINE void write_water(const Water& w, Float ground, std::size_t at, std::size_t n,
                            const CarvedRows& out) {
  const FloatTag d;
  const IntTag di;
  const Float weight = hn::Max(w.weight, set(1e-20F));
  const Float surface = hn::Div(w.height, weight);
  const auto wet = hn::And(hn::Gt(w.weight, hn::Zero(d)), hn::Gt(surface, ground));
  store_few(hn::IfThenElse(wet, surface, set(kDry)), d, out.water_m + at, n);
  if (out.flow_x != nullptr) {
    store_few(hn::IfThenElseZero(wet, hn::Div(w.flow_x, weight)), d, out.flow_x + at, n);
    store_few(hn::IfThenElseZero(wet, hn::Div(w.flow_z, weight)), d, out.flow_z + at, n);
  }
  if (out.body != nullptr)
    store_few(hn::IfThenElseZero(hn::RebindMask(di, wet), w.body), di,
              reinterpret_cast<std::int32_t*>(out.body) + at, n);
}

}  // namespace psygen::models::network::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
