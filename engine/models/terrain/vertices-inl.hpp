// Stores vectors of packed terrain vertices, word by word, and collects the skirt. Only kernel.cpp
// includes it, once per instruction set; hence the unusual include guard.
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
#include "engine/models/terrain/grid.hpp"
#include "engine/models/terrain/spread-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

// Element i of vector v goes to place 3 · i + v. Because 3 has an inverse modulo the number of
// lanes, no two elements of one vector go to the same lane. A result costs one permutation per
// vector and two selections, half the time of hn::StoreInterleaved3.
class Interleave3 {
 public:
  using V = hn::Vec<UintTag>;

  // Written out, because GCC compiles implicit constructors for the file's own instruction set, not
  // for the kernel's: at -O0 they would call lanes_of() with another calling convention.
  HWY_INLINE Interleave3()
      : from_a_(lanes_of(0)),
        from_b_(lanes_of(1)),
        from_c_(lanes_of(2)),
        first_(third_of(0)),
        second_(third_of(1)) {}

  // Writes a0 b0 c0 a1 b1 c1 … to `bytes`: 3 · lanes words, at any alignment.
  HWY_INLINE void store(V a, V b, V c, void* bytes) const {
    const UintTag d;
    auto* const to = static_cast<std::uint32_t*>(bytes);
    if constexpr (hn::MaxLanes(UintTag()) == 1) {
      const std::uint32_t first = hn::GetLane(a), second = hn::GetLane(b), third = hn::GetLane(c);
      std::memcpy(to, &first, sizeof(first));
      std::memcpy(to + 1, &second, sizeof(second));
      std::memcpy(to + 2, &third, sizeof(third));
      return;
    }
    if constexpr (hn::MaxLanes(UintTag()) <= 4) return hn::StoreInterleaved3(a, b, c, d, to);
    const V v[3] = {hn::TableLookupLanes(a, from_a_), hn::TableLookupLanes(b, from_b_),
                    hn::TableLookupLanes(c, from_c_)};
    constexpr std::size_t kLanes = hn::MaxLanes(UintTag());
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t first = k * kLanes;
      hn::StoreU(hn::IfThenElse(first_, v[first % 3],
                                hn::IfThenElse(second_, v[(first + 1) % 3], v[(first + 2) % 3])),
                 d, to + first);
    }
  }

 private:
  using Lanes = decltype(hn::IndicesFromVec(UintTag(), hn::Zero(IntTag())));
  using Mask = hn::Mask<UintTag>;
  static constexpr std::uint32_t kInverse = 11;  // of 3, modulo 16 and smaller powers of two
  HWY_ALIGN static constexpr std::uint32_t kThirds[16] = {0, 1, 2, 0, 1, 2, 0, 1,
                                                          2, 0, 1, 2, 0, 1, 2, 0};

  // For each lane, the lane of vector `v` whose element goes there.
  static Lanes lanes_of(std::uint32_t v) {
    const UintTag d;
    const auto last = static_cast<std::uint32_t>(hn::Lanes(d)) - 1;
    const V lane = hn::Mul(hn::Add(hn::Iota(d, 0), hn::Set(d, 16 - v)), hn::Set(d, kInverse));
    return hn::IndicesFromVec(d, hn::BitCast(IntTag(), hn::And(lane, hn::Set(d, last))));
  }
  static Mask third_of(std::uint32_t number) {
    return hn::Eq(hn::Load(UintTag(), kThirds), hn::Set(UintTag(), number));
  }

  const Lanes from_a_, from_b_, from_c_;
  const Mask first_, second_;
};

static_assert(sizeof(core::TerrainVertex) == 3 * sizeof(std::uint32_t));
constexpr std::size_t kVertexBytes = sizeof(core::TerrainVertex);

// The three words of vertices, one array each. Whole vertices would be slower: a vector load stalls
// on memory that scalar stores have just written.
struct VertexWords {
  static constexpr std::size_t kMax = 4 * kMaxTerrainSize + 16;
  HWY_ALIGN std::uint32_t low[kMax];
  HWY_ALIGN std::uint32_t high[kMax];
  HWY_ALIGN std::uint32_t light[kMax];

  // Sets vertex i < kMax.
  HWY_INLINE void put(std::size_t i, std::uint32_t to_low, std::uint32_t to_high,
                      std::uint32_t to_light) {
    low[i] = to_low;
    high[i] = to_high;
    light[i] = to_light;
  }
};

// The three words of a vector of vertices.
struct VertexVector {
  hn::Vec<UintTag> low, high, light;

  // Writes the first `count` vertices, or all if there are fewer, to any address.
  HWY_INLINE void store(const Interleave3& interleave, std::size_t count, std::byte* out) const {
    if (HWY_LIKELY(count >= hn::Lanes(UintTag()))) return interleave.store(low, high, light, out);
    HWY_ALIGN std::byte all[16 * kVertexBytes];
    interleave.store(low, high, light, all);
    std::memcpy(out, all, count * kVertexBytes);
  }
  // Stores all vertices from index i on.
  HWY_INLINE void store_words(VertexWords& to, std::size_t i) const {
    const UintTag du;
    hn::Store(low, du, to.low + i);
    hn::Store(high, du, to.high + i);
    hn::Store(light, du, to.light + i);
  }
};

// Collects the vertices of the border, which runs along +x, +z, −x and −z. Every side includes its
// first corner.
struct Skirt {
  const std::size_t last;
  VertexWords words;

  // `last_vertex`: number of the last vertex along a side.
  explicit Skirt(std::size_t last_vertex) : last(last_vertex) {}

  // Adds a whole row: the first (z = 0) or the last.
  void add_row(std::size_t z, const VertexWords& row) {
    for (std::size_t k = 0; k < last; ++k) {
      const std::size_t x = z == 0 ? k : last - k;
      words.put(z == 0 ? k : 2 * last + k, row.low[x], row.high[x], row.light[x]);
    }
  }
  // Adds the first vertex of row z from the vector at the row's beginning.
  HWY_INLINE void add_first(std::size_t z, const VertexVector& v) {
    if (z > 0)
      words.put(4 * last - z, hn::GetLane(v.low), hn::GetLane(v.high), hn::GetLane(v.light));
  }
  // Adds the last vertex of row z, which is in lane `at` of the vector at the row's end.
  template <class Indices>
  HWY_INLINE void add_last(std::size_t z, const VertexVector& v, Indices at) {
    const auto lane = [&](auto words_of) {
      return hn::GetLane(hn::TableLookupLanes(words_of, at));
    };
    if (z < last) words.put(last + z, lane(v.low), lane(v.high), lane(v.light));
  }
  // Writes the 4 · last vertices of the skirt, with their skirt bit.
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
