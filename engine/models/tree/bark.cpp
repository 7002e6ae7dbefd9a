// Trunk and branches: tapering tubes around the skeleton's curves. The lanes are the branches of
// one kind and depth; where a depth has few branches, the lanes are the rings of all of them.
#include "engine/models/kit/scratch.hpp"
#include "engine/models/tree/mesh.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/models/tree/bark.cpp"
#include <hwy/foreach_target.h>

#include "engine/models/tree/lanes-inl.hpp"

#ifndef PSYGEN_MODELS_TREE_BARK_ONCE
#define PSYGEN_MODELS_TREE_BARK_ONCE
namespace psygen::models {

struct Circle {
  float x[kMaxSides], z[kMaxSides];
};

// BarkLanes holds branches, or rings with the rows of their branch. Copies of the last one follow,
// up to a whole vector.
inline constexpr std::size_t kMaxRingLanes = 128;
// Noise of vertex k: (noise + 0x9E3779B9 k) · kNoiseFactor, multiplied out.
inline constexpr std::uint32_t kNoiseFactor = 0x846CA68BU;
inline constexpr std::uint32_t kNoiseStep = 0x9E3779B9U * kNoiseFactor;
struct BarkLanes {
  alignas(64) float rows[kTreeRows][kMaxTreeNodes + 2 * kTreeLanes];
  alignas(64) std::uint32_t key[kMaxTreeNodes + 2 * kTreeLanes];
  std::size_t count = 0;
  // Positions of rings on their branch and widening there; only for rings as lanes.
  alignas(64) float t[kMaxRingLanes + kTreeLanes], flare[kMaxRingLanes + kTreeLanes];
  alignas(64) std::uint32_t ring[kMaxRingLanes + kTreeLanes];
  BarkLanes() {}
};

// The positions of the rings of one branch, padded to a whole vector.
struct RingPlaces {
  alignas(32) float t[8] = {}, flare[8] = {};
  std::uint32_t count = 0;
};
static_assert(kMaxSegments + 1 <= 8);

// Values that the branches of one depth share.
struct BarkJob {
  const TreePlan& plan;
  const TreeCrown& crown;
  const TubePlan& tube;
  const Circle& circle;
  const std::uint32_t* colours;  // eight that the noise selects from, stored twice
  float sway_start, sway_end;
  bool trunk, tip;
};

}  // namespace psygen::models
#endif

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

struct Branches {
  Vec3 base, direction, bend, u, v;
  VF length, radius;
  VU noise;  // times kNoiseFactor
  VU normal[kMaxSides], point_normal;
  HWY_INLINE Branches() {}
};

HWY_INLINE void gather(const BarkJob& job, const BarkLanes& lanes, std::size_t i, Branches& b) {
  const auto three = [&](std::size_t r) {
    return load3(&lanes.rows[r][i], &lanes.rows[r + 1][i], &lanes.rows[r + 2][i]);
  };
  b.base = three(kBase);
  b.direction = three(kDirection);
  b.bend = three(kBend);
  b.length = hn::LoadU(DF(), &lanes.rows[kLength][i]);
  b.radius = hn::LoadU(DF(), &lanes.rows[kRadius][i]);
  b.noise = number(hn::LoadU(DU(), &lanes.key[i]), job.plan.salt, kBarkNumber) * u1(kNoiseFactor);
  frame_around(b.direction, b.u, b.v);
  for (std::uint32_t c = 0; c < job.tube.sides; ++c)
    b.normal[c] = octahedral(f1(job.circle.x[c]) * b.u + f1(job.circle.z[c]) * b.v);
  b.point_normal = job.tip ? octahedral(b.direction) : u1(0);
}

// The random step, 0 … 7, of vertex k of each branch. `ahead` is kNoiseStep · k.
HWY_INLINE VU noise_step(VU noise, VU ahead) {
  return hn::ShiftRight<29>(noise + ahead);
}
HWY_INLINE VU chosen(const std::uint32_t* table, VU step) {
#if HWY_TARGET <= HWY_AVX2 && HWY_ARCH_X86
  return hn::TableLookupLanes(hn::LoadU(DU(), table), hn::IndicesFromVec(DU(), step));
#else
  return hn::GatherIndex(DU(), table, hn::BitCast(DI(), step));
#endif
}

// The position of a ring: anywhere, at the base of a branch other than the trunk, or at the end of
// a tip. The last two give the same bits as the first, with less arithmetic.
enum class RingAt { kAny, kFoot, kPoint };

// Passes the vertices of one ring of every lane to `store`, with the number of their corner.
// `place` is kNoiseStep times the number of the ring's first vertex.
template <RingAt kAt, class Store>
HWY_INLINE void write_ring(const BarkJob& job, const Branches& b, const MeshWriter& box, VF t,
                           VU place, VF flare, const Store& store, Extent& extent) {
  constexpr bool kPoint = kAt == RingAt::kPoint;
  const TreePlan& plan = job.plan;
  Vec3 middle = b.base;
  if constexpr (kPoint) middle = middle + b.length * (b.direction + b.bend);
  if constexpr (kAt == RingAt::kAny)
    middle = middle + b.length * (t * b.direction + (t * t) * b.bend);
  if (job.trunk) {
    const VF sunk = middle.y - f1(sink_m(plan));
    middle.y = hn::IfThenElse(t <= f1(0.0F), sunk, middle.y);
  }
  const float end = job.tip ? 0.0F : plan.taper;
  const VF radius = b.radius * (f1(1.0F) - t * f1(1.0F - end));

  const Vec3 c{f1(job.crown.centre.x), f1(job.crown.centre.y), f1(job.crown.centre.z)};
  const Vec3 inverse{f1(job.crown.inverse_half.x), f1(job.crown.inverse_half.y),
                     f1(job.crown.inverse_half.z)};
  const VF contact =
      hn::Min(f1(0.55F) + f1(1.5F / plan.size_m) * hn::Max(middle.y, f1(0.0F)), f1(1.0F));
  const VF sway = f1(job.sway_start) + t * f1(job.sway_end - job.sway_start);
  const VU light = hn::ShiftLeft<16>(unorm8(contact * ambient_at(scaled(middle - c, inverse)))) |
                   hn::ShiftLeft<24>(rounded_word(sway));

  const Vec3 scale = set3(box.scale);
  const Vec3 at = scaled(middle - set3(box.centre), scale);
  Vec3 across = b.u, beyond = b.v;
  if constexpr (kAt == RingAt::kAny) {
    const Vec3 turn = (f1(2.0F) * t) * b.bend;
    across = across - dot(b.u, turn) * b.direction;
    beyond = beyond - dot(b.v, turn) * b.direction;
  }
  across = scaled(radius * across, scale);
  beyond = scaled(radius * beyond, scale);
  const std::uint32_t corners = kPoint ? 1 : job.tube.sides;
  for (std::uint32_t k = 0; k < corners; ++k) {
    Vec3 p = at;
    if constexpr (!kPoint) {
      Vec3 out = f1(job.circle.x[k]) * across + f1(job.circle.z[k]) * beyond;
      if (job.trunk) {
        const VF lobe =
            f1(0.4F) + f1(0.16F) * as_float(noise_step(b.noise, u1((k + 1000) * kNoiseStep)));
        out = (f1(1.0F) + flare * lobe) * out;
      }
      p = at + out;
    }
    const VU x = rounded_bits(clamped(p.x, -32767.0F, 32767.0F));
    const VU y = rounded_bits(clamped(p.y, -32767.0F, 32767.0F));
    const VU z = rounded_bits(clamped(p.z, -32767.0F, 32767.0F));
    const VU xy = xy_word(x, y), zl = z_word(z, light);
    extent.add(xy, zl);
    const VU colour = chosen(job.colours, noise_step(b.noise, place + u1(k * kNoiseStep)));
    const VU normal = kPoint ? b.point_normal : b.normal[k];
    store(vertices_of(xy, zl, paired(normal, colour)), k);
  }
}

// Rings as lanes. Vertices follow each other ring by ring.
void mesh_rings(const BarkJob& job, const BarkLanes& rings, MeshWriter& box, std::byte* to) {
  const std::size_t n = hn::Lanes(DF()), sides = job.tube.sides;
  Extent extent;
  extent.clear();
  for (std::size_t i = 0; i < rings.count; i += n) {
    const std::size_t lanes = std::min<std::size_t>(n, rings.count - i);
    Branches b;
    gather(job, rings, i, b);
    const VU place = hn::Load(DU(), rings.ring + i) * u1(kMaxSides * kNoiseStep);
    write_ring<RingAt::kAny>(
        job, b, box, hn::Load(DF(), rings.t + i), place, hn::Load(DF(), rings.flare + i),
        [&](const Vertices& v, std::size_t k) {
          store_apart(v, lanes, sides, to + 16 * (i * sides + k));
        },
        extent);
  }
  extent.widen(box.low, box.high);
}

// Branches as lanes: blocks of 16 branches, vertex by vertex; the rest branch by branch.
void mesh_branches(const BarkJob& job, const BarkLanes& all, MeshWriter& box, std::byte* to) {
  const std::size_t n = hn::Lanes(DF()), stride = job.tube.vertices();
  const std::size_t blocked = all.count / kTreeLanes * kTreeLanes;
  const std::uint32_t segments = job.tube.segments;
  Extent extent;
  extent.clear();
  for (std::size_t i = 0; i < all.count; i += n) {
    const std::size_t lanes = std::min<std::size_t>(n, all.count - i);
    Branches b;
    gather(job, all, i, b);
    for (std::uint32_t ring = 0; ring <= segments; ++ring) {
      const bool point = job.tube.pointed && ring == segments;
      const float t = static_cast<float>(ring) / static_cast<float>(segments);
      const std::size_t first = std::size_t{ring} * job.tube.sides;
      const auto in_block = [&](const Vertices& v, std::size_t k) {
        std::byte* block = to + 16 * (i / kTreeLanes * kTreeLanes * stride);
        store_in_block(v, i % kTreeLanes,
                       reinterpret_cast<std::uint32_t*>(block) + 64 * (first + k));
      };
      const auto apart = [&](const Vertices& v, std::size_t k) {
        store_apart(v, lanes, stride, to + 16 * (i * stride + first + k));
      };
      const VU place = u1(ring * kMaxSides * kNoiseStep);
      const auto write = [&](const auto& store) {
        if (point)
          write_ring<RingAt::kPoint>(job, b, box, f1(t), place, f1(0.0F), store, extent);
        else if (ring == 0 && !job.trunk)
          write_ring<RingAt::kFoot>(job, b, box, f1(0.0F), place, f1(0.0F), store, extent);
        else
          write_ring<RingAt::kAny>(job, b, box, f1(t), place, f1(0.0F), store, extent);
      };
      if (i < blocked)
        write(in_block);
      else
        write(apart);
    }
  }
  extent.widen(box.low, box.high);
}

void add_branches(const TreeSkeleton& s, const TreeGroup& group, BarkLanes& out) {
  const DF d;
  const DU du;
  for (std::size_t i = 0; i < group.count; i += hn::Lanes(d)) {
    const std::size_t from = group.first + i, to = out.count + i;
    hn::StoreU(hn::Load(du, &s.key[from]), du, &out.key[to]);
#pragma GCC unroll 11
    for (std::size_t r = 0; r < kTreeRows; ++r)
      hn::StoreU(hn::Load(d, &s.rows[r][from]), d, &out.rows[r][to]);
  }
  out.count += group.count;
}

// Appends the rings of every branch of a group.
void add_rings(const TreeSkeleton& s, const TreeGroup& group, const RingPlaces& places,
               BarkLanes& out) {
  const HWY_CAPPED(float, 8) d;
  const HWY_CAPPED(std::uint32_t, 8) du;
  for (std::size_t i = group.first; i < group.first + group.count; ++i) {
    for (std::uint32_t r = 0; r < places.count; r += static_cast<std::uint32_t>(hn::Lanes(d))) {
      const std::size_t to = out.count + r;
      hn::StoreU(hn::Set(du, s.key[i]), du, &out.key[to]);
#pragma GCC unroll 11
      for (std::size_t row = 0; row < kTreeRows; ++row)
        hn::StoreU(hn::Set(d, s.rows[row][i]), d, &out.rows[row][to]);
      hn::StoreU(hn::Load(d, places.t + r), d, &out.t[to]);
      hn::StoreU(hn::Load(d, places.flare + r), d, &out.flare[to]);
      hn::StoreU(counting_from(du, r), du, &out.ring[to]);
    }
    out.count += places.count;
  }
}

// Writes copies of the last lane behind it.
void fill_up(bool rings, BarkLanes& out) {
  const DF d;
  const DU du;
  const std::size_t n = out.count;
  hn::StoreU(hn::Set(du, out.key[n - 1]), du, &out.key[n]);
  for (std::size_t r = 0; r < kTreeRows; ++r)
    hn::StoreU(hn::Set(d, out.rows[r][n - 1]), d, &out.rows[r][n]);
  if (!rings) return;
  hn::StoreU(hn::Set(d, out.t[n - 1]), d, &out.t[n]);
  hn::StoreU(hn::Set(d, out.flare[n - 1]), d, &out.flare[n]);
  hn::StoreU(hn::Set(du, out.ring[n - 1]), du, &out.ring[n]);
}

// append_pattern(), to reserved memory.
void repeat_pattern(const std::uint16_t* pattern, std::size_t length, std::uint32_t first,
                    std::uint32_t step, std::size_t total, std::uint16_t* to) {
  const HWY_CAPPED(std::uint16_t, 32) wide;
  const HWY_CAPPED(std::uint16_t, 8) d;
  for (std::size_t done = 0; done < total; done += length, first += step) {
    const auto base = static_cast<std::uint16_t>(first);
    const std::size_t count = std::min(length, total - done);
    std::size_t i = 0;
    for (; i + hn::Lanes(wide) <= count; i += hn::Lanes(wide))
      hn::StoreU(hn::Load(wide, pattern + i) + hn::Set(wide, base), wide, to + done + i);
    for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d))
      hn::StoreU(hn::Load(d, pattern + i) + hn::Set(d, base), d, to + done + i);
    for (; i < count; ++i)
      to[done + i] = static_cast<std::uint16_t>(pattern[i] + base);
  }
}

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace psygen::models {
namespace {

HWY_EXPORT(mesh_branches);
HWY_EXPORT(mesh_rings);
HWY_EXPORT(repeat_pattern);
HWY_EXPORT(add_branches);
HWY_EXPORT(add_rings);
HWY_EXPORT(fill_up);

// The unit circle with `sides` corners: 3, 4, 5, 6 or 8, the numbers that the plans use.
const Circle& circle(std::uint32_t sides) {
  static constexpr float kHalf = 0.5F, kR3 = 0.866025404F, kR2 = 0.707106781F;
  static constexpr Circle kThree{{1, -kHalf, -kHalf}, {0, kR3, -kR3}};
  static constexpr Circle kFour{{1, 0, -1, 0}, {0, 1, 0, -1}};
  static constexpr Circle kFive{{1, 0.309016994F, -0.809016994F, -0.809016994F, 0.309016994F},
                                {0, 0.951056516F, 0.587785252F, -0.587785252F, -0.951056516F}};
  static constexpr Circle kSix{{1, kHalf, -kHalf, -1, -kHalf, kHalf}, {0, kR3, kR3, 0, -kR3, -kR3}};
  static constexpr Circle kEight{{1, kR2, 0, -kR2, -1, -kR2, 0, kR2},
                                 {0, kR2, 1, kR2, 0, -kR2, -1, -kR2}};
  return sides == 3 ? kThree : sides == 4 ? kFour : sides == 5 ? kFive : sides == 6 ? kSix : kEight;
}

std::array<std::uint8_t, 3> bark_colour(const TreePlan& plan) {
  return {pack_unorm8(plan.bark[0]), pack_unorm8(plan.bark[1]), pack_unorm8(plan.bark[2])};
}

float sway_at(int depth, int tips_depth) {
  return static_cast<float>(std::min(30 + 170 * depth / std::max(tips_depth, 1), 200));
}

// Appends the indices of `count` tubes from vertex `first` on. The first `blocked` are in blocks.
void write_indices(const TubePlan& tube, std::uint32_t count, std::uint32_t blocked,
                   std::uint32_t first, MeshWriter& out) {
  const auto repeat = [&](std::uint32_t tubes, std::uint32_t start, bool in_blocks) {
    const std::uint32_t size = tube.triangles() * 3;
    append_pattern(tube_pattern(tube, in_blocks), kTreeLanes * size, start,
                   kTreeLanes * tube.vertices(), std::size_t{tubes} * size, out);
  };
  if (blocked > 0) repeat(blocked, first, true);
  if (count > blocked) repeat(count - blocked, first + blocked * tube.vertices(), false);
}

// Appends three triangles from a ring around `from` to the crown's centre.
void write_cone(const TreePlan& plan, const glm::vec3& from, float radius, std::uint8_t ambient,
                const TreeCrown& crown, MeshWriter& out) {
  const std::uint32_t first = out.vertex_count();
  const Circle& unit = circle(3);
  const auto colour = bark_colour(plan);
  for (std::size_t side = 0; side < 3; ++side) {
    const glm::vec3 normal{unit.x[side], 0.0F, unit.z[side]};
    out.vertex(from + radius * normal, {ambient, 20, normal, colour, 0});
  }
  const std::uint8_t inside = pack_unorm8(crown_ambient(crown, crown.centre));
  out.vertex(crown.centre, {inside, 100, {0.0F, 1.0F, 0.0F}, colour, 0});
  for (std::uint32_t side = 0; side < 3; ++side)
    out.triangle(first + side, first + 3, first + (side + 1) % 3);
}

// Indexed by leafy or bare tree, level, depth, and inner branch or tip.
using TubePlans = std::array<std::array<std::array<TubePlan, 2>, 4>, kTreeLevels>;
constexpr std::array<TubePlans, 2> kTubePlans = [] {
  constexpr TubePlan kPlans[4][4] = {
      {{8, 6}, {5, 3}, {4, 2}, {3, 1}},
      {{6, 3}, {4, 2}, {3, 1}, {0, 0}},
      {{4, 2}, {3, 1}, {0, 0}, {0, 0}},
      {{3, 1}, {0, 0}, {0, 0}, {0, 0}},
  };
  std::array<TubePlans, 2> plans;
  for (std::size_t level = 0; level < kTreeLevels; ++level) {
    for (std::size_t depth = 0; depth < 4; ++depth) {
      const TubePlan leafy = level < 4 ? kPlans[level][depth] : TubePlan{};
      const TubePlan bare = level < 2 && leafy.sides > 0 ? leafy : TubePlan{3, 1};
      for (const bool tip : {false, true}) {
        plans[0][level][depth][tip] = {leafy.sides, leafy.segments, tip && leafy.sides > 0};
        plans[1][level][depth][tip] = {bare.sides, bare.segments, tip};
      }
    }
  }
  return plans;
}();

using Colours = std::array<std::uint32_t, 16>;

// Eight colours from dark to bright, stored twice, because tables are as long as the widest
// vectors.
Colours bark_colours(const TreePlan& plan) {
  Colours words;
  for (std::size_t i = 0; i < 8; ++i) {
    const float brightness =
        1.0F + plan.bark_contrast * (static_cast<float>(i) * (2.0F / 7.0F) - 1.0F);
    words[i] = 0;
    for (std::size_t c = 0; c < 3; ++c)
      words[i] |= static_cast<std::uint32_t>(pack_unorm8(plan.bark[c] * brightness)) << (8 * c);
    words[i + 8] = words[i];
  }
  return words;
}

// Returns the positions of rings. On the trunk they are closer together near its base, where it
// also widens.
RingPlaces places_of_rings(const BarkJob& job) {
  static constexpr float kSix[] = {0.0F, 0.06F, 0.16F, 0.34F, 0.55F, 0.78F, 1.0F};
  static constexpr float kThree[] = {0.0F, 0.14F, 0.5F, 1.0F};
  static constexpr float kTwo[] = {0.0F, 0.2F, 1.0F};
  const std::uint32_t segments = job.tube.segments;
  const float* table = segments == 6 ? kSix : segments == 3 ? kThree : kTwo;
  const float coarse = segments >= 3 ? 1.0F : 0.3F * static_cast<float>(segments);
  RingPlaces places;
  places.count = segments + 1;
  for (std::uint32_t r = 0; r <= segments; ++r) {
    const float even = static_cast<float>(r) / static_cast<float>(segments);
    const float t = job.trunk && segments > 1 ? table[r] : even;
    const float near_foot = std::max(1.0F - 3.0F * t, 0.0F);
    places.t[r] = t;
    places.flare[r] = job.trunk ? job.plan.flare * near_foot * near_foot * coarse : 0.0F;
  }
  return places;
}

// Appends the tubes of one depth: the pointed ones if job.tip, else the others.
void mesh_depth(const BarkJob& job, const TreeSkeleton& s, std::size_t first, std::size_t last,
                BarkLanes& lanes, MeshWriter& out) {
  std::uint32_t tubes = 0;
  for (std::size_t g = first; g < last; ++g)
    if (s.groups[g].tip == job.tip) tubes += s.groups[g].count;
  if (tubes == 0) return;
  const std::uint32_t start = out.vertex_count();
  std::byte* to = out.append_vertices(tubes * job.tube.vertices());
  const bool by_rings = !job.tip && tubes < kTreeLanes;
  const RingPlaces places = by_rings ? places_of_rings(job) : RingPlaces();
  lanes.count = 0;
  for (std::size_t g = first; g < last; ++g) {
    const TreeGroup& group = s.groups[g];
    if (group.tip != job.tip) continue;
    if (by_rings)
      HWY_DYNAMIC_DISPATCH(add_rings)(s, group, places, lanes);
    else
      HWY_DYNAMIC_DISPATCH(add_branches)(s, group, lanes);
  }
  HWY_DYNAMIC_DISPATCH(fill_up)(by_rings, lanes);
  if (by_rings)
    HWY_DYNAMIC_DISPATCH(mesh_rings)(job, lanes, out, to);
  else
    HWY_DYNAMIC_DISPATCH(mesh_branches)(job, lanes, out, to);
  write_indices(job.tube, tubes, by_rings ? 0 : tubes / kTreeLanes * kTreeLanes, start, out);
}

}  // namespace

const TubePlan& tube_plan(const TreePlan& plan, int level, int depth, bool tip) {
  const TubePlans& plans = kTubePlans[plan.foliage.near != nullptr ? 0 : 1];
  return plans[static_cast<std::size_t>(level)][static_cast<std::size_t>(std::min(depth, 3))][tip];
}

void append_pattern(const std::uint16_t* pattern, std::size_t length, std::uint32_t first,
                    std::uint32_t step, std::size_t total, MeshWriter& out) {
  std::uint16_t* const to = out.append_indices(static_cast<std::uint32_t>(total));
  HWY_DYNAMIC_DISPATCH(repeat_pattern)(pattern, length, first, step, total, to);
}

void mesh_bark(const TreePlan& plan, int level, const TreeSkeleton& skeleton,
               const TreeCrown& crown, MeshWriter& out) {
  const Colours colours = bark_colours(plan);
  const Scratch<BarkLanes> lanes;
  for (std::size_t first = 0, last = 0; first < skeleton.group_count; first = last) {
    const int depth = skeleton.groups[first].depth;
    while (last < skeleton.group_count && skeleton.groups[last].depth == depth)
      ++last;
    for (const bool tip : {false, true}) {
      const TubePlan& tube = tube_plan(plan, level, depth, tip);
      if (tube.sides == 0) continue;
      const BarkJob job{.plan = plan,
                        .crown = crown,
                        .tube = tube,
                        .circle = circle(tube.sides),
                        .colours = colours.data(),
                        .sway_start = depth == 0 ? 0.0F : sway_at(depth - 1, skeleton.depth),
                        .sway_end = sway_at(depth, skeleton.depth),
                        .trunk = depth == 0,
                        .tip = tip};
      mesh_depth(job, skeleton, first, last, *lanes, out);
    }
  }
}

void mesh_core(const TreePlan& plan, const TreeSkeleton& s, const TreeCrown& crown,
               MeshWriter& out) {
  const glm::vec3 from = s.point(0, 1.0F);
  write_cone(plan, from, s.rows[kRadius][0] * plan.taper, pack_unorm8(crown_ambient(crown, from)),
             crown, out);
}

void mesh_far_trunk(const TreePlan& plan, const TreeCrown& crown, MeshWriter& out) {
  const float radius = plan.radius_m * (1.0F + 0.3F * plan.flare);
  write_cone(plan, {0.0F, -sink_m(plan), 0.0F}, radius, pack_unorm8(0.6F), crown, out);
}

}  // namespace psygen::models
#endif  // HWY_ONCE
