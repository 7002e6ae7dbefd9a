// The index lists of sixteen tubes or sprays, built at compile time. A mesh repeats them and adds
// the numbers of its first vertices.
#include "engine/core/assert.hpp"
#include "engine/models/tree/mesh.hpp"
#include "engine/models/tree/spray_forms.hpp"

namespace psygen::models {
namespace {

template <std::size_t kSize>
struct alignas(64) Pattern {
  std::uint16_t indices[kSize];
};

// The index, in a block of sixteen, of vertex `index` of object i.
constexpr std::uint16_t in_block(std::uint32_t index, std::uint32_t i) {
  return static_cast<std::uint16_t>(index * kTreeLanes + i % 4 * 4 + i / 4);
}

// Calls `put` with the indices of one tube, segment by segment and corner by corner.
template <class Put>
constexpr void visit_tube(const TubePlan& tube, const Put& put) {
  for (std::uint32_t ring = 0; ring < tube.segments; ++ring) {
    const std::uint32_t low = ring * tube.sides, high = low + tube.sides;
    const bool apex = tube.pointed && ring + 1 == tube.segments;
    for (std::uint32_t side = 0; side < tube.sides; ++side) {
      const std::uint32_t next = side + 1 == tube.sides ? 0 : side + 1;
      for (const std::uint32_t v : {low + side, low + next, apex ? high : high + side})
        put(v);
      for (const std::uint32_t v : {low + next, high + next, high + side})
        if (!apex) put(v);
    }
  }
}

template <std::uint32_t kSides, std::uint32_t kSegments, bool kPointed>
struct Tubes {
  static constexpr TubePlan kTube{kSides, kSegments, kPointed};
  using Table = Pattern<std::size_t{kTreeLanes} * 3 * kTube.triangles()>;
  static constexpr Table table(bool blocked) {
    Table out{};
    std::size_t n = 0;
    for (std::uint32_t i = 0; i < kTreeLanes; ++i)
      visit_tube(kTube, [&](std::uint32_t v) {
        out.indices[n++] =
            blocked ? in_block(v, i) : static_cast<std::uint16_t>(v + i * kTube.vertices());
      });
    return out;
  }
  static constexpr Table kBlocked = table(true), kApart = table(false);
};

template <std::uint32_t kSides, std::uint32_t kSegments>
const std::uint16_t* pattern_of(const TubePlan& tube, bool blocked) {
  using Pointed = Tubes<kSides, kSegments, true>;
  using Open = Tubes<kSides, kSegments, false>;
  if (tube.pointed) return (blocked ? Pointed::kBlocked : Pointed::kApart).indices;
  return (blocked ? Open::kBlocked : Open::kApart).indices;
}

template <std::uint32_t kTriangles>
constexpr auto spray_block(const SprayForm& form) {
  Pattern<std::size_t{kSprayBlock} * 3 * kTriangles> out{};
  std::size_t n = 0;
  for (std::uint32_t i = 0; i < kSprayBlock; ++i)
    for (std::size_t k = 0; k < 3 * kTriangles; ++k)
      out.indices[n++] = in_block(form.indices[k], i);
  return out;
}
constexpr auto kLeafletBlock = spray_block<8>(kLeaflets);
constexpr auto kNeedleBlock = spray_block<8>(kNeedles);
constexpr auto kFrondBlock = spray_block<8>(kFrond);
constexpr auto kClumpBlock = spray_block<8>(kClump);
constexpr auto kPatchBlock = spray_block<4>(kPatch);

}  // namespace

const std::uint16_t* tube_pattern(const TubePlan& tube, bool blocked) {
  switch (10 * tube.sides + tube.segments) {
    case 31:
      return pattern_of<3, 1>(tube, blocked);
    case 42:
      return pattern_of<4, 2>(tube, blocked);
    case 53:
      return pattern_of<5, 3>(tube, blocked);
    case 63:
      return pattern_of<6, 3>(tube, blocked);
    case 86:
      return pattern_of<8, 6>(tube, blocked);
    default:
      break;
  }
  PSYGEN_CHECK(false, "tube_plan() makes no other tubes");
  return nullptr;
}

const std::uint16_t* spray_pattern(const SprayForm& form) {
  if (&form == &kLeaflets) return kLeafletBlock.indices;
  if (&form == &kNeedles) return kNeedleBlock.indices;
  if (&form == &kFrond) return kFrondBlock.indices;
  if (&form == &kClump) return kClumpBlock.indices;
  PSYGEN_CHECK(&form == &kPatch, "spray_forms.hpp has no other forms");
  return kPatchBlock.indices;
}

}  // namespace psygen::models
