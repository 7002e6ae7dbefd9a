// Works from the widest grid to the finest. Each grid interpolates the results of the next wider
// one to its own points and adds its own heights around every point. Every value uses the same
// numbers in the same order, wherever a node begins.
#include "engine/models/terrain/light_kernel.hpp"

#include <algorithm>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/models/terrain/light_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "engine/models/terrain/spread-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

constexpr std::size_t kDirections = 8;
constexpr std::size_t kFields = kDirections + 2;  // slopes of the horizon, then the two shadows
constexpr float kNoShadow = -1e30F;               // a height
constexpr float kSteepest = 1e4F;                 // steeper horizons count as this slope

// The horizons and shadows at the points of a grid.
struct Fields {
  static constexpr std::size_t kStride = kLightCoarseRow + 16;
  HWY_ALIGN float rows[kFields][kLightCoarseRow][kStride];
};

// The fields at the points of one vector.
struct Seen {
  Float horizon[kDirections];
  // A point above `lit_above` sees the whole disc of the sun, one below `dark_below` none of it.
  Float lit_above, dark_below;
  HWY_INLINE Seen() {}  // in the kernel's instruction set (docs/models.md#arithmetic)
};

// A row of a wider grid, interpolated at a row of the finer one.
struct WideRow {
  HWY_ALIGN float field[kFields][Fields::kStride];

  void load(const Fields& wide, std::size_t columns, std::size_t at) {
    const FloatTag d;
    const std::size_t row = at / kLightRatio;
    const Float weight = set(static_cast<float>(at % kLightRatio) * (1.0F / kLightRatio));
    for (std::size_t k = 0; k < kFields; ++k) {
      for (std::size_t x = 0; x < columns; x += hn::Lanes(d)) {
        const Float a = hn::Load(d, wide.rows[k][row] + x);
        const Float b = hn::Load(d, wide.rows[k][row + 1] + x);
        hn::Store(hn::Add(a, hn::Mul(weight, hn::Sub(b, a))), d, field[k] + x);
      }
    }
  }
};

// A grid with the rays that leave its points.
class Viewpoints {
 public:
  Viewpoints(const LightGrid& grid, const SunRays* sun) : g_(grid), sun_(sun) {
    // Slope per difference of heights, for the near and the far point.
    const float near = 1.0F / grid.spacing;
    straight_[0] = near;
    straight_[1] = near * (1.0F / kLightReach);
    diagonal_[0] = near * 0.70710678F;
    diagonal_[1] = near * 0.35355339F;
  }

  HWY_INLINE Float height(std::size_t x, std::size_t z) const {
    return hn::LoadU(FloatTag(), place(x, z));
  }

  HWY_INLINE void look(std::size_t x, std::size_t z, Seen& seen) const {
    if (g_.sky) look_around(place(x, z), seen);
    if (sun_ != nullptr) look_at_sun(place(x, z), seen);
  }

 private:
  const float* place(std::size_t x, std::size_t z) const {
    return g_.heights + (z + kLightReach) * g_.stride + x + kLightReach;
  }

  HWY_INLINE void look_around(const float* at, Seen& seen) const {
    static constexpr int kX[kDirections] = {1, -1, 0, 0, 1, -1, -1, 1};
    static constexpr int kZ[kDirections] = {0, 0, 1, -1, 1, 1, -1, -1};
    const FloatTag d;
    const auto row = static_cast<std::ptrdiff_t>(g_.stride);
    const Float own = hn::LoadU(d, at);
    for (std::size_t k = 0; k < kDirections; ++k) {
      const float* const scale = k < 4 ? straight_ : diagonal_;
      const std::ptrdiff_t near = kX[k] + kZ[k] * row, far = near * (k < 4 ? kLightReach : 2);
      const Float first = hn::Mul(hn::Sub(hn::LoadU(d, at + near), own), set(scale[0]));
      const Float second = hn::Mul(hn::Sub(hn::LoadU(d, at + far), own), set(scale[1]));
      seen.horizon[k] = hn::Max(seen.horizon[k], hn::Max(first, second));
    }
  }

  HWY_INLINE void look_at_sun(const float* at, Seen& seen) const {
    const FloatTag d;
    const auto row = static_cast<std::ptrdiff_t>(g_.stride);
    for (std::size_t i = 0; i < g_.sun_steps; ++i) {
      const LightStep& step = sun_->steps[i];
      const float* const corner = at + step.x + step.z * row;
      const Float h00 = hn::LoadU(d, corner), h10 = hn::LoadU(d, corner + 1);
      const Float h01 = hn::LoadU(d, corner + row), h11 = hn::LoadU(d, corner + row + 1);
      const Float across = set(step.fraction_z);
      const Float left = hn::Add(h00, hn::Mul(across, hn::Sub(h01, h00)));
      const Float right = hn::Add(h10, hn::Mul(across, hn::Sub(h11, h10)));
      const Float height = hn::Add(left, hn::Mul(set(step.fraction_x), hn::Sub(right, left)));
      const float length = step.length * g_.spacing;
      seen.lit_above = hn::Max(seen.lit_above, hn::Sub(height, set(length * sun_->low)));
      seen.dark_below = hn::Max(seen.dark_below, hn::Sub(height, set(length * sun_->high)));
    }
  }

  const LightGrid& g_;
  const SunRays* sun_;
  float straight_[2], diagonal_[2];
};

HWY_INLINE Float sun_of(const Seen& seen, Float height) {
  const Float range = hn::Max(hn::Sub(seen.lit_above, seen.dark_below), set(1e-20F));
  const Float part = hn::Div(hn::Max(hn::Sub(height, seen.dark_below), set(0.0F)), range);
  return hn::IfThenElse(hn::Ge(height, seen.lit_above), set(255.0F),
                        hn::Mul(hn::Min(part, set(1.0F)), set(255.0F)));
}

// The visible share of the sky above horizons of slope t: the mean of their squared cosines,
// 1 / (1 + t²). Two fractions share one division.
HWY_INLINE Float ambient_of(const Seen& seen) {
  Float sum = set(0.0F);
  for (std::size_t k = 0; k < kDirections; k += 2) {
    const Float t = hn::Min(seen.horizon[k], set(kSteepest));
    const Float u = hn::Min(seen.horizon[k + 1], set(kSteepest));
    const Float a = hn::Add(hn::Mul(t, t), set(1.0F)), b = hn::Add(hn::Mul(u, u), set(1.0F));
    sum = hn::Add(sum, hn::Div(hn::Add(a, b), hn::Mul(a, b)));
  }
  return hn::Mul(sum, set(255.0F / kDirections));
}

// Calls `store` for the points of one grid. `wide` has the next wider grid, or is null for the
// widest.
template <class Store>
HWY_INLINE void view(const LightGrid& grid, const SunRays* sun, const Fields* wide,
                     std::size_t wide_columns, const Store& store) {
  const FloatTag d;
  const Viewpoints points(grid, sun);
  const Spread<kLightRow> spread(grid.count_x, grid.phase_x, 1, kLightRatio);
  WideRow row;
  for (std::size_t z = 0; z < grid.count_z; ++z) {
    if (wide != nullptr) row.load(*wide, wide_columns, grid.phase_z + z);
    for (std::size_t x = 0; x < grid.count_x; x += hn::Lanes(d)) {
      Seen seen;
      for (std::size_t k = 0; k < kDirections; ++k)
        seen.horizon[k] = wide != nullptr ? spread.at(row.field[k], x) : set(0.0F);
      seen.lit_above = seen.dark_below = set(kNoShadow);
      if (wide != nullptr && sun != nullptr) {
        seen.lit_above = spread.at(row.field[kDirections], x);
        seen.dark_below = spread.at(row.field[kDirections + 1], x);
      }
      points.look(x, z, seen);
      store(x, z, seen, points);
    }
  }
}

void light(const LightGrid* grids, std::size_t grid_count, const SunRays* sun,
           const LightOutput& out) {
  const FloatTag d;
  Fields fields[2];
  Fields *wide = nullptr, *now = &fields[0], *spare = &fields[1];
  for (std::size_t g = grid_count - 1; g > 0; --g) {
    view(grids[g], sun, wide, g + 1 < grid_count ? grids[g + 1].count_x : 0,
         [&](std::size_t x, std::size_t z, const Seen& seen, const Viewpoints&) {
           for (std::size_t k = 0; k < kDirections; ++k)
             hn::Store(seen.horizon[k], d, now->rows[k][z] + x);
           hn::Store(seen.lit_above, d, now->rows[kDirections][z] + x);
           hn::Store(seen.dark_below, d, now->rows[kDirections + 1][z] + x);
         });
    wide = now;
    std::swap(now, spare);
  }
  view(grids[0], sun, wide, grid_count > 1 ? grids[1].count_x : 0,
       [&](std::size_t x, std::size_t z, const Seen& seen, const Viewpoints& points) {
         hn::StoreU(sun_of(seen, points.height(x, z)), d, out.sun + z * out.stride + x);
         hn::StoreU(ambient_of(seen), d, out.ambient + z * out.stride + x);
       });
}

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace psygen::models {

HWY_EXPORT(light);

void light_terrain(const LightGrid* grids, std::size_t grid_count, const SunRays* sun,
                   const LightOutput& out) {
  HWY_DYNAMIC_DISPATCH(light)(grids, grid_count, sun, out);
}

}  // namespace psygen::models
#endif
