// Vectors of packed terrain vertices on their way to memory, and the skirt. Included once per
// instruction set, by kernel.cpp only; hence its include guard.
#if defined(PSYGEN_MODELS_TERRAIN_VERTICES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PSYGEN_MODELS_TERRAIN_VERTICES_INL
#undef PSYGEN_MODELS_TERRAIN_VERTICES_INL
#else
#define PSYGEN_MODELS_TERRAIN_VERTICES_INL
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "engine/core/vertex_layout.hpp"
#include "engine/models/kit/interleave-inl.hpp"
#include "engine/models/terrain/coarse-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

static_assert(sizeof(core::TerrainVertex) == 3 * sizeof(std::uint32_t));
constexpr std::size_t kVertexBytes = sizeof(core::TerrainVertex);

// The three words of vertices, one array each: a vector loaded from what single vertices have just
// been written to would have to wait.
struct VertexWords {
  static constexpr std::size_t kMost = 4 * kMaxTerrainSize + 16;
  HWY_ALIGN std::uint32_t low[kMost];
  HWY_ALIGN std::uint32_t high[kMost];
  HWY_ALIGN std::uint32_t light[kMost];

  HWY_INLINE void put(std::size_t i, std::uint32_t to_low, std::uint32_t to_high,
                      std::uint32_t to_light) {
    low[i] = to_low;
    high[i] = to_high;
    light[i] = to_light;
  }
};

// A vector of vertices.
struct VertexVector {
  hn::Vec<UintTag> low, high, light;

  // The first `count` of them, or all, as vertices lie in memory.
  HWY_INLINE void store(const Interleave3& interleave, std::size_t count, std::byte* out) const {
    if (HWY_LIKELY(count >= hn::Lanes(UintTag()))) return interleave.store(low, high, light, out);
    HWY_ALIGN std::byte all[16 * kVertexBytes];
    interleave.store(low, high, light, all);
    std::memcpy(out, all, count * kVertexBytes);
  }
  HWY_INLINE void store_words(VertexWords& to, std::size_t i) const {
    const UintTag du;
    hn::Store(low, du, to.low + i);
    hn::Store(high, du, to.high + i);
    hn::Store(light, du, to.light + i);
  }
};

// The vertices of the border, which runs along +x, +z, −x and −z; every side has its first corner.
struct Skirt {
  const std::size_t last;
  VertexWords words;

  explicit Skirt(std::size_t last_vertex) : last(last_vertex) {}

  // A whole row: the first or the last.
  void add_row(std::size_t z, const VertexWords& row) {
    for (std::size_t k = 0; k < last; ++k) {
      const std::size_t x = z == 0 ? k : last - k;
      words.put(z == 0 ? k : 2 * last + k, row.low[x], row.high[x], row.light[x]);
    }
  }
  // The vector at the beginning of row z.
  HWY_INLINE void add_first(std::size_t z, const VertexVector& v) {
    if (z > 0)
      words.put(4 * last - z, hn::GetLane(v.low), hn::GetLane(v.high), hn::GetLane(v.light));
  }
  // The vector at the end of row z, its last vertex in the lane `at`.
  template <class Indices>
  HWY_INLINE void add_last(std::size_t z, const VertexVector& v, Indices at) {
    const auto lane = [&](auto words_of) {
      return hn::GetLane(hn::TableLookupLanes(words_of, at));
    };
    if (z < last) words.put(last + z, lane(v.low), lane(v.high), lane(v.light));
  }
  void write(const Interleave3& interleave, std::byte* out) const {
    const UintTag du;
    const auto bit = hn::Set(du, core::kTerrainSkirtBit);
    for (std::size_t k = 0, count = 4 * last; k < count; k += hn::Lanes(du)) {
      const VertexVector v{hn::Or(hn::Load(du, words.low + k), bit), hn::Load(du, words.high + k),
                           hn::Load(du, words.light + k)};
      v.store(interleave, count - k, out + k * kVertexBytes);
    }
  }
};

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
