#include "engine/query/ground_grid.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/assert.hpp"
#include "engine/models/terrain/ground.hpp"

namespace psygen::query {
namespace {

constexpr int kTileCells = 8;
// Shorter intervals of a ray in a triangle are rounding errors, and the ray does not begin there.
constexpr double kShortest = 1e-12;

}  // namespace

GroundGrid::GroundGrid(std::vector<std::uint16_t> heights, double cell_m, double relief_m)
    : heights_(std::move(heights)),
      size_(static_cast<int>(std::lround(std::sqrt(static_cast<double>(heights_.size()))))),
      tiles_((size_ - 1 + kTileCells - 1) / kTileCells),
      cell_m_(cell_m),
      relief_m_(relief_m),
      tile_heights_(static_cast<std::size_t>(tiles_ * tiles_)) {
  PSYGEN_CHECK(size_ >= 2 && heights_.size() == static_cast<std::size_t>(size_ * size_),
               "the heights must form a square of vertices");
  Tile all;
  for (int tz = 0; tz < tiles_; ++tz) {
    for (int tx = 0; tx < tiles_; ++tx) {
      Tile& tile = tile_heights_[static_cast<std::size_t>(tz * tiles_ + tx)];
      for (int z = tz * kTileCells; z <= std::min((tz + 1) * kTileCells, size_ - 1); ++z) {
        for (int x = tx * kTileCells; x <= std::min((tx + 1) * kTileCells, size_ - 1); ++x) {
          const std::uint16_t height = heights_[static_cast<std::size_t>(z * size_ + x)];
          tile = {std::min(tile.low, height), std::max(tile.high, height)};
        }
      }
      all = {std::min(all.low, tile.low), std::max(all.high, tile.high)};
    }
  }
  lowest_m_ = metres(all.low);
  highest_m_ = metres(all.high);
}

std::size_t GroundGrid::bytes() const {
  return sizeof *this + heights_.capacity() * sizeof(std::uint16_t) +
         tile_heights_.capacity() * sizeof(Tile);
}

models::GroundPoint GroundGrid::at(glm::dvec2 local_xz) const {
  const double last = size_ - 1;
  const glm::dvec2 cells = glm::clamp(local_xz / cell_m_, glm::dvec2(0), glm::dvec2(last));
  const double x = std::min(std::floor(cells.x), last - 1);
  const double z = std::min(std::floor(cells.y), last - 1);
  const double u = cells.x - x, v = cells.y - z;
  const auto first =
      static_cast<std::size_t>(z) * static_cast<std::size_t>(size_) + static_cast<std::size_t>(x);
  const std::size_t below = first + static_cast<std::size_t>(size_);
  const double h[4] = {metres(heights_[first]), metres(heights_[first + 1]),
                       metres(heights_[below]), metres(heights_[below + 1])};
  // Sums as in models::BlockGround::at(), for the same bits.
  if (u + v <= 1)
    return {h[0] + u * (h[1] - h[0]) + v * (h[2] - h[0]),
            models::unit_normal((h[1] - h[0]) / cell_m_, (h[2] - h[0]) / cell_m_)};
  return {h[3] + (1 - u) * (h[2] - h[3]) + (1 - v) * (h[1] - h[3]),
          models::unit_normal((h[3] - h[2]) / cell_m_, (h[3] - h[1]) / cell_m_)};
}

GroundGrid::Plane GroundGrid::plane_of(std::int64_t x, std::int64_t z, bool lower) const {
  const auto first = static_cast<std::size_t>(z * size_ + x);
  const std::size_t below = first + static_cast<std::size_t>(size_);
  const double right = metres(heights_[first + 1]), front = metres(heights_[below]);
  if (lower) {
    const double corner = metres(heights_[first]);
    return {corner, (right - corner) / cell_m_, (front - corner) / cell_m_};
  }
  const double opposite = metres(heights_[below + 1]);
  return {right + front - opposite, (opposite - front) / cell_m_, (opposite - right) / cell_m_};
}

// The height of the ray above the triangle is linear, so its value at `from` and its rate decide.
// The side is carried from triangle to triangle, so rounding opens no gap between two.
std::optional<GroundHit> GroundGrid::cast_triangle(const GroundRay& ray, std::int64_t x,
                                                   std::int64_t z, bool lower, double from,
                                                   double to, Side& side) const {
  const Plane plane = plane_of(x, z, lower);
  const glm::dvec2 corner = glm::dvec2(x, z) * cell_m_;
  const glm::dvec2 at = ray.plane.at(from) - corner;
  double above = ray.height_at(from) - (plane.height + at.x * plane.slope_x + at.y * plane.slope_z);
  const double rate =
      ray.rise - (ray.plane.step.x * plane.slope_x + ray.plane.step.y * plane.slope_z);
  const glm::vec3 normal = models::unit_normal(plane.slope_x, plane.slope_z);
  if (side == Side::kUnknown) {
    if (to - from < kShortest) return std::nullopt;
    if (std::abs(above) <= kTouchM) {
      if (rate <= 0) return GroundHit{from, normal, false};
      above = 0;
    }
    side = above >= 0 ? Side::kAbove : Side::kBelow;
  }
  const bool from_below = side == Side::kBelow;
  const double gap = std::max(from_below ? -above : above, 0.0);
  const double closing = from_below ? rate : -rate;
  if (closing <= 0 || gap > closing * (to - from)) return std::nullopt;
  side = from_below ? Side::kAbove : Side::kBelow;
  return GroundHit{std::min(from + gap / closing, to), normal, from_below};
}

std::optional<GroundHit> GroundGrid::cast_cell(const GroundRay& ray, std::int64_t x, std::int64_t z,
                                               double from, double to, Side& side) const {
  // u + v = 1 on the diagonal.
  const glm::dvec2 start = (ray.plane.at(from) / cell_m_) - glm::dvec2(x, z);
  const double sum = start.x + start.y - 1;
  const double rate = (ray.plane.step.x + ray.plane.step.y) / cell_m_;
  const bool lower = sum < 0 || (sum == 0 && rate <= 0);
  double middle = to;
  if ((lower && rate > 0) || (!lower && rate < 0)) middle = std::clamp(from - sum / rate, from, to);
  if (const auto hit = cast_triangle(ray, x, z, lower, from, middle, side)) return hit;
  if (middle < to) return cast_triangle(ray, x, z, !lower, middle, to, side);
  return std::nullopt;
}

std::optional<GroundHit> GroundGrid::cast(const GroundRay& ray, double from, double to,
                                          Side& side) const {
  std::optional<GroundHit> hit;
  // True if the ray passes heights of [low, high] metres without touching any.
  const auto passes = [&](double low, double high, double t0, double t1) {
    const double a = ray.height_at(t0), b = ray.height_at(t1);
    if (side == Side::kAbove) return std::min(a, b) > high;
    return side == Side::kBelow && std::max(a, b) < low;
  };
  if (passes(lowest_m_, highest_m_, from, to)) return hit;
  const std::int64_t last_tile = tiles_ - 1, last_cell = size_ - 2;
  march(ray.plane, kTileCells * cell_m_, from, to,
        [&](std::int64_t tile_x, std::int64_t tile_z, double t0, double t1) {
          tile_x = std::clamp<std::int64_t>(tile_x, 0, last_tile);
          tile_z = std::clamp<std::int64_t>(tile_z, 0, last_tile);
          const Tile& tile = tile_heights_[static_cast<std::size_t>(tile_z * tiles_ + tile_x)];
          if (passes(metres(tile.low), metres(tile.high), t0, t1)) return true;
          march(ray.plane, cell_m_, t0, t1,
                [&](std::int64_t x, std::int64_t z, double c0, double c1) {
                  hit = cast_cell(ray, std::clamp<std::int64_t>(x, 0, last_cell),
                                  std::clamp<std::int64_t>(z, 0, last_cell), c0, c1, side);
                  return !hit;
                });
          return !hit;
        });
  return hit;
}

}  // namespace psygen::query
