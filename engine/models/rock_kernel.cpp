// Vertices and triangles of one rock are the lanes. What is looked up through the topology is kept
// as four floats per item, so that a look-up is one load; everything else runs on separate arrays.
#include "engine/models/rock_kernel.hpp"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/models/rock_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kPad = 16;
using FloatTag = hn::CappedTag<float, kPad>;
using IntTag = hn::RebindToSigned<FloatTag>;
using UintTag = hn::RebindToUnsigned<FloatTag>;
using Float = hn::Vec<FloatTag>;

constexpr std::size_t kVertices = rock_vertices(kMaxSubdivisions);
constexpr std::size_t kTriangles = rock_triangles(kMaxSubdivisions);
constexpr std::size_t kChunk = 16;  // triangles that are written together

// Four floats, or four words, of one item.
#if HWY_TARGET == HWY_SCALAR
struct Four {
  float x, y, z, w;
};
HWY_INLINE Four load4(const float* p) {
  return {p[0], p[1], p[2], p[3]};
}
HWY_INLINE void store4(const Four& v, float* p) {
  std::memcpy(p, &v, sizeof v);
}
HWY_INLINE Four add(const Four& a, const Four& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w};
}
HWY_INLINE Four scaled(const Four& a, float s) {
  return {a.x * s, a.y * s, a.z * s, a.w * s};
}
HWY_INLINE Four area(const Four& a, const Four& b, const Four& c) {
  const Four p{b.x - a.x, b.y - a.y, b.z - a.z, 0}, q{c.x - a.x, c.y - a.y, c.z - a.z, 0};
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x, 0};
}
HWY_INLINE void write_vertex(const std::uint32_t* words, std::uint32_t normal, std::byte* out) {
  const std::uint32_t all[4] = {words[0], words[1], normal, words[3]};
  std::memcpy(out, all, sizeof all);
}
#else
using FourTag = hn::FixedTag<float, 4>;
using Four = hn::Vec<FourTag>;
HWY_INLINE Four load4(const float* p) {
  return hn::Load(FourTag(), p);
}
HWY_INLINE void store4(Four v, float* p) {
  hn::Store(v, FourTag(), p);
}
HWY_INLINE Four add(Four a, Four b) {
  return hn::Add(a, b);
}
HWY_INLINE Four scaled(Four a, float s) {
  return hn::Mul(a, hn::Set(FourTag(), s));
}
// (y, z, x, w)
HWY_INLINE Four turned(Four v) {
  alignas(16) static constexpr std::int32_t kOrder[4] = {1, 2, 0, 3};
  return hn::TableLookupLanes(v, hn::SetTableIndices(FourTag(), kOrder));
}
HWY_INLINE Four area(Four a, Four b, Four c) {
  const Four p = hn::Sub(b, a), q = hn::Sub(c, a);
  return turned(hn::Sub(hn::Mul(p, turned(q)), hn::Mul(turned(p), q)));
}
HWY_INLINE void write_vertex(const std::uint32_t* words, std::uint32_t normal, std::byte* out) {
  const hn::FixedTag<std::uint32_t, 4> d;
  hn::StoreU(hn::InsertLane(hn::Load(d, words), 2, normal), d,
             reinterpret_cast<std::uint32_t*>(out));
}
#endif

// The place of an item in an array of four words for each.
HWY_INLINE std::size_t at(std::uint16_t item) {
  return std::size_t{item} * 4;
}

struct Vectors {
  Float x, y, z;
};
HWY_INLINE Float dot(const Vectors& a, const Vectors& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Vectors load(const float* items, Float& fourth) {
  Vectors v;
  hn::LoadInterleaved4(FloatTag(), items, v.x, v.y, v.z, fourth);
  return v;
}

HWY_INLINE Float set(float value) {
  return hn::Set(FloatTag(), value);
}
HWY_INLINE Float clamp(Float v, float low, float high) {
  return hn::Min(hn::Max(v, set(low)), set(high));
}
// Nearest integer, halves to even, as in packing.hpp.
HWY_INLINE hn::Vec<UintTag> rounded(Float v) {
  const auto bits = hn::BitCast(IntTag(), hn::Add(v, set(12582912.0F)));
  return hn::BitCast(UintTag(), hn::Sub(bits, hn::Set(IntTag(), 0x4B400000)));
}
HWY_INLINE hn::Vec<UintTag> snorm16(Float v) {
  return hn::And(rounded(hn::Mul(clamp(v, -1.0F, 1.0F), set(32767.0F))),
                 hn::Set(UintTag(), 0xFFFFU));
}
HWY_INLINE hn::Vec<UintTag> unorm8(Float v) {
  return rounded(hn::Mul(clamp(v, 0.0F, 1.0F), set(255.0F)));
}
HWY_INLINE hn::Vec<UintTag> albedo8(Float v) {
  return unorm8(hn::Sqrt(hn::Max(v, hn::Zero(FloatTag()))));
}
HWY_INLINE hn::Vec<UintTag> pair(hn::Vec<UintTag> low, hn::Vec<UintTag> high) {
  return hn::Or(low, hn::ShiftLeft<16>(high));
}

// Octahedral normal around +Y, snorm16 twice (packing.hpp).
HWY_INLINE hn::Vec<UintTag> octahedral(const Vectors& n) {
  const FloatTag d;
  const Float zero = hn::Zero(d), one = set(1.0F), positive_zero = set(0.0F);
  const Float size_x = hn::Abs(n.x), size_z = hn::Abs(n.z);
  const Float scale = hn::Div(one, hn::Add(hn::Add(size_x, hn::Abs(n.y)), size_z));
  const Float x = hn::Mul(hn::Add(n.x, positive_zero), scale);  // −0 becomes 0
  const Float z = hn::Mul(hn::Add(n.z, positive_zero), scale);
  const Float folded_x = hn::CopySignToAbs(hn::Sub(one, hn::Abs(z)), x);
  const Float folded_z = hn::CopySignToAbs(hn::Sub(one, hn::Abs(x)), z);
  const auto above = hn::Ge(n.y, zero);
  // Within [−1, 1] but for a rounding that cannot reach the next integer.
  const Float to_snorm = set(32767.0F);
  const auto low = rounded(hn::Mul(hn::IfThenElse(above, x, folded_x), to_snorm));
  const auto high = rounded(hn::Mul(hn::IfThenElse(above, z, folded_z), to_snorm));
  return pair(hn::And(low, hn::Set(UintTag(), 0xFFFFU)), high);
}

class RockMesher {
 public:
  RockMesher(const RockShape& shape, const RockTopology& topology, int subdivisions)
      : s_(shape),
        topology_(topology),
        subdivisions_(subdivisions),
        vertex_count_(rock_vertices(subdivisions)),
        triangle_count_(rock_triangles(subdivisions)) {}

  core::Bounds run(std::byte* out) {
    displace();
    const core::Bounds box = place();
    find_areas();
    finish_vertices();
    write(out);
    return box;
  }

 private:
  // Directions times distances from the centre, and the distances, in units of the radius.
  void displace() {
    for (std::size_t v = 0; v < 4; ++v) {
      const glm::vec3 p = s_.corners[v] * s_.corner_radius[v];
      const float item[4] = {p.x, p.y, p.z, s_.corner_radius[v]};
      std::memcpy(place_ + 4 * v, item, sizeof item);
      grain_[v] = RockRandom(s_.key, 2 + v).f[1];
    }
    float amplitude = s_.amplitude;
    for (int n = 1; n <= subdivisions_; ++n) {
      amplitude *= s_.decay;
      for (std::size_t v = rock_vertices(n - 1); v < rock_vertices(n); v += hn::Lanes(FloatTag()))
        find_midpoints(v, rock_vertices(n), amplitude);
    }
  }

  void find_midpoints(std::size_t first, std::size_t end, float amplitude) {
    const FloatTag d;
    const UintTag du;
    const std::size_t count = std::min(hn::Lanes(d), end - first);
    HWY_ALIGN std::uint64_t hash[kPad];
    HWY_ALIGN float middle[4 * kPad];
    const RockTopology::Edge* const edges = topology_.parents().data() + (first - 4);
    for (std::size_t i = 0; i < hn::Lanes(d); ++i)
      hash[i] = core::mix64(s_.key + 0x9E3779B97F4A7C15ull * (first + i + 3));
    for (std::size_t i = 0; i < count; ++i)
      store4(scaled(add(load4(place_ + at(edges[i].a)), load4(place_ + at(edges[i].b))), 0.5F),
             middle + 4 * i);
    std::fill(middle + 4 * count, middle + 4 * hn::Lanes(d), 1.0F);
    hn::Vec<UintTag> low, unused;
    hn::LoadInterleaved2(du, reinterpret_cast<const std::uint32_t*>(hash), low, unused);
    hn::StoreU(from_16_bits(hn::ShiftRight<16>(low)), d, grain_ + first);
    const Float move = from_16_bits(hn::And(low, hn::Set(du, 0xFFFFU)));
    Float radius;
    const Vectors m = load(middle, radius);
    radius = hn::Mul(radius, hn::Add(set(1.0F), hn::Mul(set(amplitude), move)));
    const Float scale = hn::Div(radius, hn::Sqrt(dot(m, m)));
    hn::StoreInterleaved4(hn::Mul(m.x, scale), hn::Mul(m.y, scale), hn::Mul(m.z, scale), radius, d,
                          place_ + 4 * first);
  }
  HWY_INLINE static Float from_16_bits(hn::Vec<UintTag> bits) {
    return hn::Sub(
        hn::Mul(hn::ConvertTo(FloatTag(), hn::BitCast(IntTag(), bits)), set(1.0F / 32768.0F)),
        set(1.0F));
  }

  // Layers, stretch and lift; places become metres, their fourth number the band of layers.
  core::Bounds place() {
    const FloatTag d;
    Vectors least{set(1e30F), set(1e30F), set(1e30F)}, most{set(-1e30F), set(-1e30F), set(-1e30F)};
    for (std::size_t v = 0; v < vertex_count_; v += hn::Lanes(d)) {
      Float radius;
      Vectors p = load(place_ + 4 * v, radius);
      Float band = hn::Zero(d);
      if (s_.ledge > 0) {
        const Vectors axis{set(s_.layer_axis.x), set(s_.layer_axis.y), set(s_.layer_axis.z)};
        const Float t = hn::Add(hn::Div(dot(p, axis), radius), set(s_.layer_phase));
        const Float wave = hn::Sub(hn::Mul(hn::Sub(t, hn::Floor(t)), set(2.0F)), set(1.0F));
        band = hn::Sub(hn::Mul(hn::Abs(wave), set(2.0F)), set(1.0F));
        const Float factor = hn::Add(set(1.0F), hn::Mul(set(s_.ledge), band));
        p = {hn::Mul(p.x, factor), hn::Mul(p.y, factor), hn::Mul(p.z, factor)};
      }
      p.x = hn::Mul(p.x, set(s_.stretch.x));
      p.y = hn::Add(hn::Mul(p.y, set(s_.stretch.y)), set(s_.lift));
      p.z = hn::Mul(p.z, set(s_.stretch.z));
      hn::StoreInterleaved4(p.x, p.y, p.z, band, d, place_ + 4 * v);
      const auto used = hn::FirstN(d, vertex_count_ - v);
      least.x = hn::Min(least.x, hn::IfThenElse(used, p.x, least.x));
      least.y = hn::Min(least.y, hn::IfThenElse(used, p.y, least.y));
      least.z = hn::Min(least.z, hn::IfThenElse(used, p.z, least.z));
      most.x = hn::Max(most.x, hn::IfThenElse(used, p.x, most.x));
      most.y = hn::Max(most.y, hn::IfThenElse(used, p.y, most.y));
      most.z = hn::Max(most.z, hn::IfThenElse(used, p.z, most.z));
    }
    return {{lowest(least.x), lowest(least.y), lowest(least.z)},
            {-lowest(hn::Neg(most.x)), -lowest(hn::Neg(most.y)), -lowest(hn::Neg(most.z))}};
  }
  HWY_INLINE static float lowest(Float v) { return hn::GetLane(hn::MinOfLanes(FloatTag(), v)); }

  // Of every triangle: its normal times twice its area, and what makes that `facet` long.
  void find_areas() {
    const FloatTag d;
    const std::uint16_t* const corner = topology_.indices(subdivisions_).data();
    for (std::size_t t = 0; t < triangle_count_; ++t)
      store4(area(load4(place_ + at(corner[3 * t])), load4(place_ + at(corner[3 * t + 1])),
                  load4(place_ + at(corner[3 * t + 2]))),
             area_ + 4 * t);
    std::fill_n(area_ + 4 * triangle_count_, 4, 0.0F);  // the triangle that vertices lack
    for (std::size_t t = 0; t < triangle_count_; t += hn::Lanes(d)) {
      Float unused;
      const Vectors a = load(area_ + 4 * t, unused);
      hn::Store(hn::Div(set(s_.facet), hn::Sqrt(dot(a, a))), d, area_scale_ + t);
    }
  }

  // Normals of the vertices, 1 − facet long, and all words of their bytes but the normal's.
  void finish_vertices() {
    const FloatTag d;
    const UintTag du;
    const RockTopology::Fan* const fans = topology_.fans(subdivisions_).data();
    for (std::size_t v = 0; v < vertex_count_; v += hn::Lanes(d)) {
      HWY_ALIGN float sums[4 * kPad];
      const std::size_t count = std::min(hn::Lanes(d), vertex_count_ - v);
      for (std::size_t i = 0; i < count; ++i) {
        const RockTopology::Fan& fan = fans[v + i];
        store4(add(add(add(load4(area_ + at(fan[0])), load4(area_ + at(fan[1]))),
                       add(load4(area_ + at(fan[2])), load4(area_ + at(fan[3])))),
                   add(load4(area_ + at(fan[4])), load4(area_ + at(fan[5])))),
               sums + 4 * i);
      }
      std::fill(sums + 4 * count, sums + 4 * hn::Lanes(d), 1.0F);
      Float band;
      const Vectors n = load(sums, band);
      const Float unit = hn::Div(set(1.0F), hn::Sqrt(dot(n, n)));
      const Float length = hn::Mul(unit, set(1.0F - s_.facet));
      hn::StoreInterleaved4(hn::Mul(n.x, length), hn::Mul(n.y, length), hn::Mul(n.z, length),
                            hn::Zero(d), d, normal_ + 4 * v);
      const Vectors p = load(place_ + 4 * v, band);
      const auto x = snorm16(hn::Mul(hn::Sub(p.x, set(s_.box_centre.x)), set(s_.box_scale.x)));
      const auto y = snorm16(hn::Mul(hn::Sub(p.y, set(s_.box_centre.y)), set(s_.box_scale.y)));
      const auto z = snorm16(hn::Mul(hn::Sub(p.z, set(s_.box_centre.z)), set(s_.box_scale.z)));
      hn::Vec<UintTag> ambient, colour;
      paint(p.y, hn::Mul(n.y, unit), hn::LoadU(d, grain_ + v), band, ambient, colour);
      hn::StoreInterleaved4(pair(x, y), pair(z, ambient), hn::Zero(du), colour, du, words_ + 4 * v);
    }
  }

  // Ambient light, and colour with the material above it.
  HWY_INLINE void paint(Float height, Float up, Float grain, Float band, hn::Vec<UintTag>& ambient,
                        hn::Vec<UintTag>& colour) const {
    const Float one = set(1.0F);
    const Float relative = hn::Mul(height, set(1.0F / s_.stretch.y));
    const Float rise = clamp(hn::Mul(hn::Add(relative, set(0.2F)), set(0.8F)), 0.0F, 1.0F);
    ambient = unorm8(hn::Mul(hn::Add(set(0.3F), hn::Mul(set(0.7F), rise)),
                             hn::Add(set(0.8F), hn::Mul(set(0.2F), up))));
    const Float green =
        hn::Add(hn::Mul(hn::Sub(up, set(0.35F)), set(2.5F)), hn::Mul(grain, set(0.8F)));
    const Float cover = hn::Mul(set(s_.moss), clamp(green, 0.0F, 1.0F));
    const Float tone = hn::Mul(hn::Mul(hn::Add(one, hn::Mul(set(0.22F), grain)),
                                       hn::Add(set(0.75F), hn::Mul(set(0.25F), rise))),
                               hn::Add(one, hn::Mul(set(s_.tint), band)));
    const auto red = channel(s_.colour.x, tone, 0.07F, cover);
    const auto middle = channel(s_.colour.y, tone, 0.11F, cover);
    const auto blue = channel(s_.colour.z, tone, 0.03F, cover);
    colour = hn::Or(hn::Or(red, hn::ShiftLeft<8>(middle)), hn::ShiftLeft<16>(blue));
  }
  HWY_INLINE static hn::Vec<UintTag> channel(float stone_albedo, Float tone, float moss_albedo,
                                             Float cover) {
    const Float stone = hn::Mul(set(stone_albedo), tone);
    return albedo8(hn::Add(stone, hn::Mul(hn::Sub(set(moss_albedo), stone), cover)));
  }

  // The corners of all triangles, with normals between the triangle's and the vertex's.
  void write(std::byte* out) const {
    const FloatTag d;
    const std::uint16_t* corner = topology_.indices(subdivisions_).data();
    HWY_ALIGN float mixed[4 * 3 * kChunk];
    HWY_ALIGN std::uint32_t packed[3 * kChunk];
    for (std::size_t first = 0; first < triangle_count_; first += kChunk) {
      const std::size_t count = std::min(kChunk, triangle_count_ - first);
      if (count < kChunk) std::fill_n(mixed, 4 * 3 * kChunk, 1.0F);
      for (std::size_t t = 0; t < count; ++t) {
        const Four face = scaled(load4(area_ + 4 * (first + t)), area_scale_[first + t]);
        const std::uint16_t* const c = corner + 3 * t;
        float* const to = mixed + 12 * t;
        store4(add(load4(normal_ + at(c[0])), face), to);
        store4(add(load4(normal_ + at(c[1])), face), to + 4);
        store4(add(load4(normal_ + at(c[2])), face), to + 8);
      }
      for (std::size_t i = 0; i < 3 * count; i += hn::Lanes(d)) {
        Float unused;
        hn::Store(octahedral(load(mixed + 4 * i, unused)), UintTag(), packed + i);
      }
      for (std::size_t k = 0; k < 3 * count; k += 3) {
        write_vertex(words_ + at(corner[k]), packed[k], out + 16 * k);
        write_vertex(words_ + at(corner[k + 1]), packed[k + 1], out + 16 * k + 16);
        write_vertex(words_ + at(corner[k + 2]), packed[k + 2], out + 16 * k + 32);
      }
      corner += 3 * kChunk;
      out += 16 * 3 * kChunk;
    }
  }

  const RockShape& s_;
  const RockTopology& topology_;
  const int subdivisions_;
  const std::size_t vertex_count_, triangle_count_;
  HWY_ALIGN float place_[4 * (kVertices + kPad)];
  HWY_ALIGN float normal_[4 * (kVertices + kPad)];
  HWY_ALIGN std::uint32_t words_[4 * (kVertices + kPad)];
  HWY_ALIGN float grain_[kVertices + kPad];
  HWY_ALIGN float area_[4 * (kTriangles + kPad)];
  HWY_ALIGN float area_scale_[kTriangles + kPad];
};

core::Bounds mesh(const RockShape& shape, const RockTopology& topology, int subdivisions,
                  std::byte* out) {
  return RockMesher(shape, topology, subdivisions).run(out);
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
