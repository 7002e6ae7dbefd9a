// The lanes are vertices of one rock. Values that are looked up through the topology are kept as
// items of four floats, so a look-up is one load. Everything else runs on separate vectors. Faceted
// rocks take one more step, from vertices to the corners of triangles.
#include "engine/models/rock/kernel.hpp"

#include <algorithm>
#include <cstring>

#include "engine/models/kit/scratch.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/models/rock/kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "engine/models/rock/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

constexpr std::size_t kPad = RockTopology::kPad;
using Wide = hn::CappedTag<float, kPad>;
using Narrow = hn::CappedTag<float, 8>;  // for few midpoints
using Small = hn::CappedTag<float, 4>;   // for the last two vertices: their count is 2 + 2 · 4^n

// The mesh of a rock of at most kMax subdivisions.
template <int kMax>
class RockMesher {
 public:
  RockMesher(const RockShape& shape, const RockTopology& topology, int subdivisions)
      : s_(shape),
        topology_(topology),
        subdivisions_(subdivisions),
        vertex_count_(rock_vertices(subdivisions)) {}

  core::Bounds run(std::byte* out) {
    displace();
    if (s_.facet > 0) {
      finish<true>(words_);
      write_facets(out);
    } else {
      finish<false>(out);
    }
    return box();
  }

 private:
  static constexpr std::size_t kVertices = rock_vertices(kMax);

  // ---- Places ----

  void displace() {
    place_corners();
    float amplitude = s_.amplitude;
    for (int n = 1; n <= subdivisions_; ++n) {
      amplitude *= s_.decay;
      const bool have_children = n < subdivisions_;
      const std::size_t end = rock_vertices(n);
      std::size_t v = rock_vertices(n - 1);
      for (; v + hn::Lanes(Narrow()) < end; v += hn::Lanes(Wide()))
        find_midpoints(Wide(), v, amplitude, have_children);
      if (v < end) find_midpoints(Narrow(), v, amplitude, have_children);
    }
    // box() reads whole groups of four.
    for (std::size_t v = vertex_count_; v % 4 != 0; ++v)
      std::memcpy(place_ + 4 * v, place_, 4 * sizeof(float));
  }

  // Random numbers 0 and 1 (`word` is the key), or 2 and 3 (its upper half), of vertices.
  template <class D>
  HWY_INLINE hn::Vec<D> numbers(D d, Uint<D> steps, std::uint64_t word, hn::Vec<D>& second) const {
    const hn::RebindToUnsigned<D> du;
    const auto hash = mix32(du, hn::Add(steps, hn::Set(du, static_cast<std::uint32_t>(word))));
    second = number(d, hn::ShiftRight<16>(hash));
    return number(d, hn::And(hash, hn::Set(du, 0xFFFFU)));
  }
  template <class D>
  HWY_INLINE static hn::Vec<D> number(D d, Uint<D> bits) {
    const auto real = hn::ConvertTo(d, hn::BitCast(hn::RebindToSigned<D>(), bits));
    return hn::Sub(hn::Mul(real, hn::Set(d, 1.0F / 32768.0F)), hn::Set(d, 1.0F));
  }
  template <class D>
  HWY_INLINE static Uint<D> steps(D, std::size_t first) {
    const hn::RebindToUnsigned<D> du;
    return hn::Mul(counting_from(du, static_cast<std::uint32_t>(first + 2)),
                   hn::Set(du, RockRandom::kStep));
  }

  // The corners of the tetrahedron, jittered and turned.
  void place_corners() {
    const Small d;
    constexpr float kCorner = 0.577350269F;
    HWY_ALIGN static constexpr float kX[4] = {kCorner, kCorner, -kCorner, -kCorner};
    HWY_ALIGN static constexpr float kY[4] = {kCorner, -kCorner, kCorner, -kCorner};
    HWY_ALIGN static constexpr float kZ[4] = {kCorner, -kCorner, -kCorner, kCorner};
    for (std::size_t v = 0; v < 4; v += hn::Lanes(d)) {
      Vectors<Small> r;
      r.x = numbers(d, steps(d, v), s_.key, r.y);
      r.z = numbers(d, steps(d, v), s_.key >> 32, r.w);
      hn::StoreU(hn::Mul(hn::Add(r.w, r.y), hn::Set(d, 0.5F)), d, grain_ + v);
      const auto jitter = hn::Set(d, kRockJitter), zero = hn::Zero(d);
      const Vectors<Small> corner{hn::Add(hn::Load(d, kX + v), hn::Mul(r.x, jitter)),
                                  hn::Add(hn::Load(d, kY + v), hn::Mul(r.y, jitter)),
                                  hn::Add(hn::Load(d, kZ + v), hn::Mul(r.z, jitter)), zero};
      const Vectors<Small> p = turned(corner);
      settle(d, v, p, hn::Div(hn::Set(d, 1.0F), hn::Sqrt(dot(p, p))),
             hn::Add(hn::Set(d, 1.0F), hn::Mul(hn::Set(d, s_.amplitude), r.w)), true);
    }
  }
  // Rotated by the quaternion q = (a, w) and scaled by |q|² = a² + w²:
  // v |q|² + 2 w a × v + 2 a × (a × v).
  HWY_INLINE Vectors<Small> turned(const Vectors<Small>& v) const {
    const Small d;
    const float* const q = s_.turn;
    const Vectors<Small> axis{hn::Set(d, q[0]), hn::Set(d, q[1]), hn::Set(d, q[2]), hn::Zero(d)};
    const auto size = hn::Set(d, ((q[0] * q[0] + q[1] * q[1]) + q[2] * q[2]) + q[3] * q[3]);
    const auto w = hn::Set(d, q[3]), two = hn::Set(d, 2.0F);
    const Vectors<Small> a = cross(axis, v), b = cross(axis, a);
    const auto sum = [&](hn::Vec<Small> v0, hn::Vec<Small> a0, hn::Vec<Small> b0) HWY_ATTR {
      return hn::Add(hn::Mul(v0, size), hn::Mul(hn::Add(hn::Mul(w, a0), b0), two));
    };
    return {sum(v.x, a.x, b.x), sum(v.y, a.y, b.y), sum(v.z, a.z, b.z), v.w};
  }

  // Writes whole vectors: vertices beyond the last midpoint of a step have no meaning.
  template <class D>
  HWY_INLINE void find_midpoints(D d, std::size_t first, float amplitude, bool have_children) {
    const Vectors<D> m =
        to_lanes(d, add(load_items(d, unit_, topology_.parents()[0].data() + (first - 4)),
                        load_items(d, unit_, topology_.parents()[1].data() + (first - 4))));
    hn::Vec<D> grain;
    const auto move = numbers(d, steps(d, first), s_.key, grain);
    hn::StoreU(hn::Mul(hn::Add(move, grain), hn::Set(d, 0.5F)), d, grain_ + first);
    settle(d, first, m, hn::Div(hn::Set(d, 1.0F), hn::Sqrt(dot(m, m))),
           hn::Mul(m.w, hn::Add(hn::Set(d, 0.5F), hn::Mul(hn::Set(d, 0.5F * amplitude), move))),
           have_children);
  }

  // Stores vertices in the direction of `m`, whose length is 1 / `unit`, at distance `radius` from
  // the centre. unit_ is for the midpoints of further steps; place_ has metres after layers,
  // stretch and lift.
  template <class D>
  HWY_INLINE void settle(D d, std::size_t v, const Vectors<D>& m, hn::Vec<D> unit,
                         hn::Vec<D> radius, bool have_children) {
    const auto length = hn::Mul(unit, radius);
    Vectors<D> p{hn::Mul(m.x, length), hn::Mul(m.y, length), hn::Mul(m.z, length), radius};
    if (have_children) hn::StoreInterleaved4(p.x, p.y, p.z, p.w, d, unit_ + 4 * v);
    if (s_.ledge > 0) {
      const Vectors<D> axis{hn::Set(d, s_.layer_axis.x), hn::Set(d, s_.layer_axis.y),
                            hn::Set(d, s_.layer_axis.z), radius};
      const auto t = hn::Add(hn::Mul(dot(m, axis), unit), hn::Set(d, s_.layer_phase));
      const auto wave = hn::Abs(hn::Sub(hn::Sub(t, hn::Floor(t)), hn::Set(d, 0.5F)));
      const auto band = hn::Sub(hn::Mul(wave, hn::Set(d, 4.0F)), hn::Set(d, 1.0F));
      const auto factor = hn::Add(hn::Set(d, 1.0F), hn::Mul(hn::Set(d, s_.ledge), band));
      p = {hn::Mul(p.x, factor), hn::Mul(p.y, factor), hn::Mul(p.z, factor), band};
      hn::StoreU(band, d, band_ + v);
    }
    p.x = hn::Mul(p.x, hn::Set(d, s_.stretch.x));
    p.y = hn::Add(hn::Mul(p.y, hn::Set(d, s_.stretch.y)), hn::Set(d, s_.lift));
    p.z = hn::Mul(p.z, hn::Set(d, s_.stretch.z));
    hn::StoreInterleaved4(p.x, p.y, p.z, p.w, d, place_ + 4 * v);
    hn::StoreU(p.x, d, x_ + v);
    hn::StoreU(p.y, d, y_ + v);
    hn::StoreU(p.z, d, z_ + v);
  }

  core::Bounds box() const {
    const Wide d;
    constexpr std::size_t kLanes = hn::MaxLanes(Wide()), kGroup = std::max<std::size_t>(kLanes, 4);
    float low[4], high[4];
    for (std::size_t i = 0; i < kGroup; i += kLanes) {
      auto least = hn::Load(d, place_ + i), most = least;
      for (std::size_t k = kGroup; k < 4 * vertex_count_; k += kGroup) {
        least = hn::Min(least, hn::Load(d, place_ + k + i));
        most = hn::Max(most, hn::Load(d, place_ + k + i));
      }
      store_folded(d, least, low + i, [](auto a, auto b) HWY_ATTR { return hn::Min(a, b); });
      store_folded(d, most, high + i, [](auto a, auto b) HWY_ATTR { return hn::Max(a, b); });
    }
    return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
  }
  // Folds the blocks of a vector to four numbers, or to one on the scalar target.
  template <class D, class Fold>
  HWY_INLINE static void store_folded(D d, hn::Vec<D> v, float* to,
                                      [[maybe_unused]] const Fold& fold) {
#if HWY_TARGET != HWY_SCALAR
    if constexpr (hn::MaxLanes(D()) > 4) {
      const hn::Half<D> half;
      return store_folded(half, fold(hn::LowerHalf(half, v), hn::UpperHalf(half, v)), to, fold);
    }
#endif
    hn::StoreU(v, d, to);
  }

  // ---- Vertices ----

  // Writes all vertices as core::ModelVertex. For facets the normals go to normal_, of length
  // 1 − facet.
  template <bool kFaceted>
  void finish(std::byte* out) {
    std::size_t v = 0;
    for (; v + hn::Lanes(Wide()) <= vertex_count_; v += hn::Lanes(Wide()))
      write<kFaceted>(Wide(), v, reinterpret_cast<std::uint32_t*>(out + 16 * v));
    for (; v < vertex_count_; v += hn::Lanes(Small())) {
      HWY_ALIGN std::uint32_t last[16];
      write<kFaceted>(Small(), v, last);
      std::memcpy(out + 16 * v, last, 16 * std::min(hn::Lanes(Small()), vertex_count_ - v));
    }
  }

  template <bool kFaceted, class D>
  HWY_INLINE void write(D d, std::size_t v, std::uint32_t* out) {
    const hn::RebindToUnsigned<D> du;
    const Vectors<D> n = normals(d, v);
    const auto scale = octahedral_scale(d, n);
    auto normal = hn::Zero(du);
    if constexpr (kFaceted) {
      const auto length = hn::Div(hn::Set(d, 1.0F - s_.facet), hn::Sqrt(dot(n, n)));
      hn::StoreInterleaved4(hn::Mul(n.x, length), hn::Mul(n.y, length), hn::Mul(n.z, length),
                            hn::Zero(d), d, normal_ + 4 * v);
    } else {
      normal = octahedral(d, n, scale);
    }
    const auto height = hn::LoadU(d, y_ + v);
    const auto x = packed(d, hn::LoadU(d, x_ + v), s_.box_centre.x, s_.box_scale.x);
    const auto y = packed(d, height, s_.box_centre.y, s_.box_scale.y);
    const auto z = packed(d, hn::LoadU(d, z_ + v), s_.box_centre.z, s_.box_scale.z);
    Uint<D> ambient, colour;
    paint(d, v, height, hn::Mul(n.y, scale), ambient, colour);
    hn::StoreInterleaved4(pair(d, x, y), pair(d, z, ambient), normal, colour, du, out);
  }
  // As snorm16. No clamping: the box is larger than the rock.
  template <class D>
  HWY_INLINE static Uint<D> packed(D d, hn::Vec<D> place, float centre, float scale) {
    return rounded(d, hn::Mul(hn::Sub(place, hn::Set(d, centre)), hn::Set(d, scale)));
  }

  // The sum of the area vectors of the triangles around each vertex: twice the area of the ring of
  // neighbours.
  template <class D>
  HWY_INLINE Vectors<D> normals(D d, std::size_t v) const {
    const std::array<RockTopology::Offsets, 6>& rings = topology_.rings(subdivisions_);
    const auto ring = [&](std::size_t i) { return rings[i].data() + v; };
    Vectors<D> a, b;
    if constexpr (hn::MaxLanes(D()) == 16 && kMax == 2) {
      const Vectors<D> p1 = look_up(d, ring(1)), p4 = look_up(d, ring(4));
      a = cross(minus(look_up(d, ring(3)), p1), minus(p4, look_up(d, ring(2))));
      b = cross(minus(look_up(d, ring(5)), p1), minus(look_up(d, ring(0)), p4));
    } else {
      const Items<D> p1 = load_items(d, place_, ring(1)), p4 = load_items(d, place_, ring(4));
      a = cross(difference(d, load_items(d, place_, ring(3)), p1),
                difference(d, p4, load_items(d, place_, ring(2))));
      b = cross(difference(d, load_items(d, place_, ring(5)), p1),
                difference(d, load_items(d, place_, ring(0)), p4));
    }
    return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z), a.w};
  }

  // Places of any vertices by their offsets. Requires that all vertices fit into three vectors.
  template <class D>
  HWY_INLINE Vectors<D> look_up(D d, const std::uint16_t* offsets) const {
    const hn::RebindToSigned<D> di;
    const auto vertex =
        hn::ShiftRight<2>(hn::PromoteTo(di, hn::LoadU(hn::Rebind<std::uint16_t, D>(), offsets)));
    const auto in_third = hn::RebindMask(d, hn::Gt(vertex, hn::Set(di, 31)));
    const auto lane = hn::IndicesFromVec(d, hn::And(vertex, hn::Set(di, 15)));
    const auto of = [&](const float* places) HWY_ATTR {
      const auto first = hn::Load(d, places), second = hn::Load(d, places + 16);
#if HWY_TARGET == HWY_AVX3
      const hn::Vec<D> some{_mm512_permutex2var_ps(first.raw, vertex.raw, second.raw)};
#else
      const auto some =
          hn::IfThenElse(hn::RebindMask(d, hn::Gt(vertex, hn::Set(di, 15))),
                         hn::TableLookupLanes(second, lane), hn::TableLookupLanes(first, lane));
#endif
      return hn::IfThenElse(in_third, hn::TableLookupLanes(hn::Load(d, places + 32), lane), some);
    };
    return {of(x_), of(y_), of(z_), hn::Zero(d)};
  }

  // Ambient light and stored colour of vertices. `height` is in metres, `up` the scaled y of the
  // normal.
  template <class D>
  HWY_INLINE void paint(D d, std::size_t v, hn::Vec<D> height, hn::Vec<D> up, Uint<D>& ambient,
                        Uint<D>& colour) const {
    const hn::RebindToUnsigned<D> du;
    const auto one = hn::Set(d, 1.0F);
    const auto grain = hn::LoadU(d, grain_ + v);
    const auto rise =
        clamp(d, hn::Add(hn::Mul(height, hn::Set(d, s_.rise)), hn::Set(d, kRiseAtFoot)), 0, 1);
    ambient = rounded(
        d, hn::Mul(hn::Add(hn::Set(d, 255.0F * 0.3F), hn::Mul(hn::Set(d, 255.0F * 0.7F), rise)),
                   hn::Add(hn::Set(d, 0.8F), hn::Mul(hn::Set(d, 0.2F), up))));
    const auto green = hn::Add(hn::Mul(hn::Sub(up, hn::Set(d, 0.35F)), hn::Set(d, 4.0F)),
                               hn::Mul(grain, hn::Set(d, 2.0F)));
    const auto cover = hn::Mul(hn::Set(d, s_.moss), clamp(d, green, 0, 1));
    auto tone = hn::Mul(hn::Add(one, hn::Mul(hn::Set(d, 0.25F), grain)),
                        hn::Add(hn::Set(d, 0.86F), hn::Mul(hn::Set(d, 0.14F), rise)));
    if (s_.ledge > 0)
      tone = hn::Mul(tone, hn::Add(one, hn::Mul(hn::Set(d, s_.tint), hn::LoadU(d, band_ + v))));
    const auto red = channel(d, s_.colour.x, tone, 255.0F * 0.26F, cover);
    const auto middle = channel(d, s_.colour.y, tone, 255.0F * 0.33F, cover);
    const auto blue = channel(d, s_.colour.z, tone, 255.0F * 0.17F, cover);
    const auto sum = hn::Add(hn::Add(red, hn::ShiftLeft<8>(middle)), hn::ShiftLeft<16>(blue));
    colour = hn::Sub(sum, hn::Set(du, kRounding + (kRounding << 8)));
  }
  // A channel of the colour, 0 … 255, plus kRounding.
  template <class D>
  HWY_INLINE static Uint<D> channel(D d, float stone_colour, hn::Vec<D> tone, float moss_colour,
                                    hn::Vec<D> cover) {
    const auto stone = hn::Mul(hn::Set(d, stone_colour), tone);
    const auto mixed = hn::Add(stone, hn::Mul(hn::Sub(hn::Set(d, moss_colour), stone), cover));
    return rounded(d, hn::Min(mixed, hn::Set(d, 255.0F)));
  }

  // ---- Facets ----

  // Writes the corners of all triangles. Their normals lie between the triangle's and the vertex's.
  void write_facets(std::byte* out) const {
    const Wide d;
    const std::array<RockTopology::Offsets, 3>& corners = topology_.corners(subdivisions_);
    const std::size_t triangle_count = rock_triangles(subdivisions_);
    for (std::size_t t = 0; t < triangle_count; t += hn::Lanes(d)) {
      const Items<Wide> a = load_items(d, place_, corners[0].data() + t);
      const Items<Wide> b = load_items(d, place_, corners[1].data() + t);
      const Items<Wide> c = load_items(d, place_, corners[2].data() + t);
      const Vectors<Wide> face = cross(difference(d, b, a), difference(d, c, a));
      const auto length = hn::Div(hn::Set(d, s_.facet), hn::Sqrt(dot(face, face)));
      const std::size_t count = std::min(hn::Lanes(d), triangle_count - t);
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint16_t* const corner = corners[i].data() + t;
        Vectors<Wide> n = to_lanes(d, load_items(d, normal_, corner));
        n.x = hn::Add(n.x, hn::Mul(face.x, length));
        n.y = hn::Add(n.y, hn::Mul(face.y, length));
        n.z = hn::Add(n.z, hn::Mul(face.z, length));
        HWY_ALIGN std::uint32_t packed[kPad];
        hn::Store(octahedral(d, n, octahedral_scale(d, n)), hn::RebindToUnsigned<Wide>(), packed);
        std::byte* to = out + 16 * (3 * t + i);
        for (std::size_t k = 0; k < count; ++k, to += 16 * 3) {
          std::memcpy(to, words_ + std::size_t{corner[k]} * 4, 16);
          std::memcpy(to + 8, packed + k, 4);
        }
      }
    }
  }

  const RockShape& s_;
  const RockTopology& topology_;
  const int subdivisions_;
  const std::size_t vertex_count_;
  // Items of four: places in units from the centre with their distance, places in metres, normals.
  // Then packed vertices, and separate components.
  HWY_ALIGN float unit_[4 * (kVertices + kPad)];
  HWY_ALIGN float place_[4 * (kVertices + kPad)];
  HWY_ALIGN float normal_[4 * (kVertices + kPad)];
  HWY_ALIGN std::byte words_[16 * (kVertices + kPad)];
  HWY_ALIGN float x_[kVertices + kPad], y_[kVertices + kPad], z_[kVertices + kPad];
  HWY_ALIGN float grain_[kVertices + kPad], band_[kVertices + kPad];
};

core::Bounds mesh(const RockShape& shape, const RockTopology& topology, int subdivisions,
                  std::byte* out) {
  if (subdivisions <= 2) return RockMesher<2>(shape, topology, subdivisions).run(out);
  return Scratch<RockMesher<kMaxSubdivisions>>(shape, topology, subdivisions)->run(out);
}

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace psygen::models {

HWY_EXPORT(mesh);

core::Bounds mesh_rock(const RockShape& shape, const RockTopology& topology, int subdivisions,
                       std::byte* out) {
  return HWY_DYNAMIC_DISPATCH(mesh)(shape, topology, subdivisions, out);
}

}  // namespace psygen::models
#endif
