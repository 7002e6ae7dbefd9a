// Sprays: the foliage of levels 0 … 3, in clusters around the branches that bear leaves. A spray is
// a twig of eight triangles at levels 0 and 1, a patch of four at levels 2 and 3. Coarser levels
// have fewer and larger sprays on the same skeleton. These are moved towards the crown's centre by
// the difference in size, which keeps the outline. Normals follow the crown rather than the leaf,
// which shades it as one soft volume. Spray k belongs to bearer k mod M, so neighbouring lanes read
// neighbouring bearers.
#include <utility>

#include "engine/models/kit/scratch.hpp"
#include "engine/models/tree/mesh.hpp"
#include "engine/models/tree/paths.hpp"
#include "engine/models/tree/spray_forms.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/models/tree/sprays.cpp"
#include <hwy/foreach_target.h>

#include "engine/models/tree/lanes-inl.hpp"

#ifndef PSYGEN_MODELS_TREE_SPRAYS_ONCE
#define PSYGEN_MODELS_TREE_SPRAYS_ONCE
namespace psygen::models {

// The branches with leaves as curves from the crown's centre. `rows` are base, length · direction
// and length · bend, all times the pull. The first branches are repeated behind the last.
struct Bearers {
  static constexpr std::size_t kRows = 9;
  alignas(64) float rows[kRows][kMaxTreeNodes + 2 * kTreeLanes];
  std::uint32_t count;
  Bearers() {}
};

// Values that all sprays of one mesh share. "raw" values are factors of random integers of 16 bits.
struct SprayJob {
  const SprayForm& form;
  std::uint32_t key;            // of the random numbers
  float from, from_raw;         // position on the bearer
  float cluster, cluster_fall;  // cluster · o = (cluster − cluster_fall · raw²) · raw
  float inverse_half[3] = {}, outward[3] = {};  // of the crown
  float random_raw, out, branch, up;            // of the axis
  float side_random_raw, side_out, side_up, normal_up;
  float length, length_raw;  // of a spray
  float scale[3] = {},
        centre[3] = {};  // packed = (position from the crown's centre) · scale + centre
  float room = 1.3F;     // distance to keep from the box, in lengths of the spray
  float colour[3] = {}, colour_raw[3] = {};  // outer corners, stored bytes
  float bright = 0, bright_raw = 0;
};

}  // namespace psygen::models
#endif

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

// A chunk of sprays goes through three steps before the corners are written. Each step is a short
// loop, so the long dependency chains of neighbouring vectors overlap. Steps pass rows of a Chunk.
constexpr std::size_t kChunk = 64;
struct Chunk {
  using Row = float[kChunk];
  using Words = std::uint32_t[kChunk];
  alignas(64) Row place[3], axis[3], side[3], size, hue;  // place is relative to the crown's centre
  alignas(64) Row foot[3], along[3], across[3], face[3];  // in packed units relative to the box
  alignas(64) Words light_inner, light_outer, normal, inner, outer;
  Chunk() {}
};
HWY_INLINE void store3(Vec3 v, Chunk::Row (&to)[3], std::size_t i) {
  const DF d;
  hn::Store(v.x, d, to[0] + i);
  hn::Store(v.y, d, to[1] + i);
  hn::Store(v.z, d, to[2] + i);
}
HWY_INLINE Vec3 row3(const Chunk::Row (&from)[3], std::size_t i) {
  const DF d;
  return {hn::Load(d, from[0] + i), hn::Load(d, from[1] + i), hn::Load(d, from[2] + i)};
}

// Step 1: random numbers, places, and unnormalised directions. `bearer` is the next bearer.
HWY_INLINE void place_sprays(const SprayJob& job, const Bearers& bearers, std::size_t& bearer,
                             std::uint32_t first, std::size_t count, Chunk& c) {
  const DF d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const VU id =
        counting_from(DU(), first + static_cast<std::uint32_t>(i)) * u1(kChildStep) + u1(job.key);
    const VU h0 = mix(id), h1 = mix(id ^ u1(kNumberStep)), h2 = mix(id ^ u1(2 * kNumberStep)),
             h3 = mix(id ^ u1(3 * kNumberStep)), h4 = mix(id ^ u1(4 * kNumberStep));
    const auto at = [&](std::size_t r) {
      return load3(&bearers.rows[r][bearer], &bearers.rows[r + 1][bearer],
                   &bearers.rows[r + 2][bearer]);
    };
    const VF t = f1(job.from) + f1(job.from_raw) * high_number(h1);
    const Vec3 along = at(3), bend = t * at(6);
    const Vec3 o{low_signed(h0), high_signed(h0), low_signed(h1)};
    const VF ball = f1(job.cluster) - f1(job.cluster_fall) * dot(o, o);
    const Vec3 place = at(0) + t * (along + bend) + ball * o;
    const Vec3 out = scaled(place, set3(job.outward));
    Vec3 axis = f1(job.random_raw) * o + f1(job.out) * out;
    if (job.branch != 0.0F) axis = axis + f1(job.branch) * unit(along + f1(2.0F) * bend);
    axis.y = axis.y + f1(job.up);
    const Vec3 random{low_signed(h2), high_signed(h2), low_signed(h3)};
    Vec3 towards = f1(job.side_out) * out + f1(job.side_random_raw) * random;
    towards.y = towards.y + f1(job.side_up);
    store3(place, c.place, i);
    store3(axis, c.axis, i);
    store3(towards, c.side, i);
    hn::Store(high_number(h3), d, c.size + i);
    hn::Store(low_number(h4), d, c.hue + i);
    bearer += hn::Lanes(d);
    while (bearer >= bearers.count)
      bearer -= bearers.count;
  }
}

// Step 2: exact directions and lengths.
HWY_INLINE void orient_sprays(const SprayJob& job, std::size_t count, Chunk& c) {
  for (std::size_t i = 0; i < count; i += hn::Lanes(DF())) {
    const Vec3 axis = unit(row3(c.axis, i));
    const Vec3 side = unit(cross(row3(c.side, i), axis));
    const VF size = hn::Load(DF(), c.size + i);
    const Vec3 k = (f1(job.length) + f1(job.length_raw) * size) * set3(job.scale);
    const Vec3 middle = scaled(row3(c.place, i), set3(job.scale)) + set3(job.centre);
    const VF most = f1(32767.0F), room = f1(job.room);
    const Vec3 limit{most - room * k.x, most - room * k.y, most - room * k.z};
    const Vec3 kept{hn::Max(hn::Min(middle.x, limit.x), hn::Neg(limit.x)),
                    hn::Max(hn::Min(middle.y, limit.y), hn::Neg(limit.y)),
                    hn::Max(hn::Min(middle.z, limit.z), hn::Neg(limit.z))};
    const Vec3 along = scaled(k, axis);
    store3(axis, c.axis, i);
    store3(along, c.along, i);
    store3(scaled(k, side), c.across, i);
    store3(scaled(k, cross(axis, side)), c.face, i);
    store3(kept - f1(0.45F) * along, c.foot, i);
  }
}

HWY_INLINE VU channel(VF v) {
  return rounded_word(clamped(v, 0.0F, 255.0F));
}

HWY_INLINE void colour_sprays(const SprayJob& job, std::size_t count, Chunk& c) {
  const DU d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const Vec3 place = row3(c.place, i);
    Vec3 normal = scaled(place, set3(job.outward)) + f1(0.3F) * row3(c.axis, i);
    normal.y = normal.y + f1(job.normal_up);
    hn::Store(octahedral(normal), d, c.normal + i);
    const VF ambient = ambient_at(scaled(place, set3(job.inverse_half)));
    const VU light = rounded_word(ambient * f1(255.0F));
    hn::Store(hn::ShiftLeft<16>(light) | u1(245U << 24), d, c.light_outer + i);
    hn::Store(hn::ShiftLeft<16>(light - hn::ShiftRight<2>(light)) | u1(205U << 24), d,
              c.light_inner + i);
    const VF hue = hn::Load(DF(), c.hue + i);
    const VF bright = f1(job.bright) + f1(job.bright_raw) * hn::Load(DF(), c.size + i);
    const VU red = channel(bright * (f1(job.colour[0]) + hue * f1(job.colour_raw[0])));
    const VU green = channel(bright * (f1(job.colour[1]) + hue * f1(job.colour_raw[1])));
    const VU blue = channel(bright * (f1(job.colour[2]) + hue * f1(job.colour_raw[2])));
    const VU outer = red | hn::ShiftLeft<8>(green) | hn::ShiftLeft<16>(blue) | u1(1U << 24);
    hn::Store(outer, d, c.outer + i);
    hn::Store(outer - (hn::ShiftRight<3>(outer) & u1(0x001F1F1FU)), d, c.inner + i);  // 7/8
  }
}

// Writes corner kCorner of the sprays in the lanes, which are numbers `part`, `part` + 1, … of
// their block.
template <const SprayForm& kForm, std::size_t kCorner>
HWY_INLINE void write_corner(Vec3 p, Vec3 along, Vec3 across, Vec3 face, VU light, Pair look,
                             std::size_t part, std::uint32_t* block, Extent& extent) {
  if constexpr (kForm.corners.along[kCorner] != 0.0F)
    p = p + f1(kForm.corners.along[kCorner]) * along;
  // The same product as at the mirrored corner.
  if constexpr (kForm.corners.across[kCorner] > 0.0F)
    p = p + f1(kForm.corners.across[kCorner]) * across;
  if constexpr (kForm.corners.across[kCorner] < 0.0F)
    p = p - f1(-kForm.corners.across[kCorner]) * across;
  if constexpr (kForm.corners.droop[kCorner] != 0.0F)
    p = p - f1(kForm.corners.droop[kCorner]) * face;
  const VU xy = xy_word(rounded_bits(p.x), rounded_bits(p.y));
  const VU zl = z_word(rounded_bits(p.z), light);
  extent.add(xy, zl);
  store_in_block(vertices_of(xy, zl, look), part, block + 64 * kCorner);
}

// Corners 1, 9, 2, 8, …: mirrored corners follow each other, so common terms are reused soon.
constexpr std::size_t corner_at(std::size_t i, std::size_t corners) {
  return i % 2 == 0 ? 1 + i / 2 : corners - 1 - i / 2;
}

template <const SprayForm& kForm, std::size_t... kCorners>
HWY_INLINE void write_corners(const Chunk& c, std::size_t i, std::uint32_t* block, Extent& extent,
                              std::index_sequence<kCorners...>) {
  const DU d;
  const Vec3 foot = row3(c.foot, i), along = row3(c.along, i), across = row3(c.across, i),
             face = row3(c.face, i);
  const VU normal = hn::Load(d, c.normal + i), light = hn::Load(d, c.light_outer + i);
  const Pair inner = paired(normal, hn::Load(d, c.inner + i));
  const Pair outer = paired(normal, hn::Load(d, c.outer + i));
  const std::size_t part = i % kSprayBlock;
  write_corner<kForm, 0>(foot, along, across, face, hn::Load(d, c.light_inner + i), inner, part,
                         block, extent);
  (write_corner<kForm, corner_at(kCorners, kForm.vertices)>(foot, along, across, face, light, outer,
                                                            part, block, extent),
   ...);
}

// Copies the bearers from the rows of the skeleton.
void collect(const TreePlan& plan, const TreeSkeleton& s, const TreeCrown& crown, float pull,
             Bearers& b) {
  const DF d;
  const VF centre[3] = {f1(crown.centre.x), f1(crown.centre.y), f1(crown.centre.z)};
  const bool by_leaves = has_bearers(plan, s);
  b.count = 0;
  for (std::size_t g = 0; g < s.group_count; ++g) {
    const TreeGroup& group = s.groups[g];
    if (by_leaves ? !bears_leaves(plan, group) : !group.tip) continue;
    for (std::size_t i = 0; i < group.count; i += hn::Lanes(d)) {
      const std::size_t from = group.first + i, to = b.count + i;
      const VF length = hn::Load(d, &s.rows[kLength][from]) * f1(pull);
#pragma GCC unroll 3
      for (std::size_t c = 0; c < 3; ++c)
        hn::StoreU(f1(pull) * (hn::Load(d, &s.rows[kBase + c][from]) - centre[c]), d,
                   &b.rows[c][to]);
#pragma GCC unroll 6
      for (std::size_t r = 3; r < Bearers::kRows; ++r)
        hn::StoreU(length * hn::Load(d, &s.rows[r][from]), d, &b.rows[r][to]);
    }
    b.count += group.count;
  }
  for (std::size_t r = 0; r < Bearers::kRows; ++r)
    for (std::uint32_t i = 0; i < kTreeLanes; ++i)
      b.rows[r][b.count + i] = b.rows[r][i];
}

template <const SprayForm& kForm>
void write_blocks(const SprayJob& job, const Bearers& bearers, std::uint32_t sprays,
                  MeshWriter& box, std::byte* to) {
  const std::size_t n = hn::Lanes(DF());
  Extent extent;
  extent.clear();
  Chunk chunk;
  std::size_t bearer = 0;
  auto* words = reinterpret_cast<std::uint32_t*>(to);
  for (std::uint32_t first = 0; first < sprays; first += kChunk) {
    const std::size_t count = std::min<std::size_t>(kChunk, sprays - first);
    place_sprays(job, bearers, bearer, first, count, chunk);
    orient_sprays(job, count, chunk);
    colour_sprays(job, count, chunk);
    for (std::size_t i = 0; i < count; i += n)
      write_corners<kForm>(chunk, i, words + 4 * kForm.vertices * (i / kSprayBlock * kSprayBlock),
                           extent, std::make_index_sequence<kForm.vertices - 1>());
    words += 4 * kForm.vertices * kChunk;
  }
  extent.widen(box.low, box.high);
}

// Writes `sprays` sprays, a multiple of 16, in blocks of 16, corner by corner.
void write_sprays(const SprayJob& job, const Bearers& bearers, std::uint32_t sprays,
                  MeshWriter& box, std::byte* to) {
  if (&job.form == &kLeaflets) return write_blocks<kLeaflets>(job, bearers, sprays, box, to);
  if (&job.form == &kNeedles) return write_blocks<kNeedles>(job, bearers, sprays, box, to);
  if (&job.form == &kFrond) return write_blocks<kFrond>(job, bearers, sprays, box, to);
  if (&job.form == &kClump) return write_blocks<kClump>(job, bearers, sprays, box, to);
  write_blocks<kPatch>(job, bearers, sprays, box, to);
}

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace psygen::models {
namespace {

HWY_EXPORT(collect);
HWY_EXPORT(write_sprays);

// Length of a spray times √count, at each level, with which `count` sprays fill a crown of radius
// 1.
constexpr float kFillingLength[4] = {5.3F, 6.0F, 4.4F, 4.4F};

// Length of a spray in metres, and the factor that pulls sprays towards the crown's centre.
struct SpraySize {
  float length, pull;
};
SpraySize spray_size(const TreePlan& plan, int level, const TreeCrown& crown,
                     std::uint32_t sprays) {
  const glm::vec3 room = plan.bounds.half_extent();
  const float filling = kFillingLength[level] * crown.radius * plan.foliage.fill /
                        std::sqrt(static_cast<float>(sprays));
  const float length = std::min(std::min(filling, 2.0F * plan.size_m),
                                0.6F * std::min(std::min(room.x, room.y), room.z));
  return {length, level == 0 ? 1.0F : std::max(1.0F - 0.28F * length / crown.radius, 0.5F)};
}

void set_colours(const TreePlan& plan, SprayJob& job) {
  const LeafTint tint = leaf_tint(plan);
  const std::array<float, 3> below = leaf_colour(plan, tint.hue - 0.05F);
  const std::array<float, 3> above = leaf_colour(plan, tint.hue + 0.05F);
  const float spread = 0.16F * plan.colour_variation;
  for (std::size_t c = 0; c < 3; ++c) {
    const float slope = 2677.5F * (above[c] - below[c]) * spread;  // 1.05 · 255 · 10
    job.colour_raw[c] = slope * (1.0F / 65536.0F);
    job.colour[c] = 133.875F * (below[c] + above[c]) - 0.5F * slope;
  }
  const float contrast = 0.4F * plan.colour_variation * tint.brightness;
  job.bright = tint.brightness - 0.5F * contrast;
  job.bright_raw = contrast * (1.0F / 65536.0F);
}

SprayJob spray_job(const TreePlan& plan, int level, const TreeCrown& crown, std::uint32_t bearers,
                   const SpraySize& size, const MeshWriter& box) {
  constexpr float kSigned = 1.0F / 32768.0F, kRaw = 1.0F / 65536.0F;
  const FoliagePlan& f = plan.foliage;
  const float cluster = size.pull * f.cluster * crown.radius *
                        std::min(2.1F / std::sqrt(static_cast<float>(bearers)), 0.6F);
  SprayJob job{.form = spray_form(plan, level),
               .key = plan.key ^ (plan.salt + kSprayNumber),
               .from = f.from,
               .from_raw = (1.0F - f.from) * kRaw,
               .cluster = cluster * kSigned,
               .cluster_fall = 0.2F * cluster * kSigned * kSigned * kSigned,
               .random_raw = f.random * kSigned,
               .out = f.out,
               .branch = f.branch,
               .up = f.up,
               .side_random_raw = f.side_random * kSigned,
               .side_out = f.side_out,
               .side_up = f.side_up,
               .normal_up = f.normal_up,
               .length = 0.75F * size.length,
               .length_raw = 0.5F * size.length * kRaw};
  for (int c = 0; c < 3; ++c) {
    job.inverse_half[c] = crown.inverse_half[c];
    job.outward[c] = crown.radius * crown.inverse_half[c] * crown.inverse_half[c];
    job.scale[c] = box.scale[c];
    job.centre[c] = (crown.centre[c] - box.centre[c]) * box.scale[c];
  }
  set_colours(plan, job);
  return job;
}

}  // namespace

const SprayForm& spray_form(const TreePlan& plan, int level) {
  return level <= 1 ? *plan.foliage.near : *plan.foliage.far;
}

std::uint32_t spray_count(const TreePlan& plan, int level, std::uint32_t bearers,
                          std::uint32_t bark_vertices) {
  if (plan.foliage.near == nullptr || level > 3) return 0;
  if (level == 2) return 4 * kSprayBlock;
  if (level == 3) return kSprayBlock;
  const float share = level == 0 ? plan.foliage.density : 0.3125F * plan.foliage.density;
  const std::uint32_t least = level == 0 ? 256 : 64, most = level == 0 ? 4096 : 768;
  const std::uint32_t room = (65536 - bark_vertices) / kMaxSprayVertices;
  const auto wanted =
      static_cast<std::uint32_t>(std::min(static_cast<float>(bearers) * share, 8192.0F));
  return std::min(std::clamp(wanted, least, most), room) / kSprayBlock * kSprayBlock;
}

void mesh_sprays(const TreePlan& plan, int level, const TreeSkeleton& skeleton,
                 const TreeCrown& crown, std::uint32_t sprays, MeshWriter& out) {
  if (sprays == 0) return;
  const Scratch<Bearers> scratch;
  Bearers& bearers = *scratch;
  const SpraySize size = spray_size(plan, level, crown, sprays);
  HWY_DYNAMIC_DISPATCH(collect)(plan, skeleton, crown, size.pull, bearers);
  const SprayJob job = spray_job(plan, level, crown, bearers.count, size, out);
  const std::uint32_t first = out.vertex_count();
  std::byte* to = out.append_vertices(sprays * job.form.vertices);
  HWY_DYNAMIC_DISPATCH(write_sprays)(job, bearers, sprays, out, to);
  const std::size_t indices = std::size_t{3} * job.form.triangles;
  append_pattern(spray_pattern(job.form), kSprayBlock * indices, first,
                 kSprayBlock * job.form.vertices, sprays * indices, out);
}

}  // namespace psygen::models
#endif  // HWY_ONCE
