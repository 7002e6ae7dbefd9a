#include "engine/world/water_curve.hpp"

#include <algorithm>
#include <cmath>

#include "engine/models/terrain/ground.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/spline.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {
namespace {

// The splines of both coordinates over the lengths of the chords.
struct PlaneSpline {
  std::vector<double> chords{0};
  Spline east, south;

  explicit PlaneSpline(std::span<const glm::dvec2> points) {
    std::vector<double> x{points.front().x}, z{points.front().y};
    for (std::size_t i = 1; i < points.size(); ++i) {
      chords.push_back(chords.back() + length_of(points[i] - points[i - 1]));
      x.push_back(points[i].x);
      z.push_back(points[i].y);
    }
    east = Spline(chords, x);
    south = Spline(chords, z);
  }
  glm::dvec2 at(double chord) const { return {east.value(chord), south.value(chord)}; }

  // Calls visit(place, share) from behind point i − 1 to point i.
  template <class Visit>
  void walk(std::size_t i, double step_m, const Visit& visit) const {
    const double chord_m = chords[i] - chords[i - 1];
    const auto steps = std::max(1, static_cast<int>(std::ceil(chord_m / step_m)));
    for (int k = 1; k <= steps; ++k) {
      const double share = static_cast<double>(k) / steps;
      visit(at(k < steps ? chords[i - 1] + chord_m * share : chords[i]), share);
    }
  }
};

double cross(glm::dvec2 a, glm::dvec2 b) {
  return a.x * b.y - a.y * b.x;
}

bool meet(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, glm::dvec2 d) {
  const double of_c = cross(b - a, c - a), of_d = cross(b - a, d - a);
  const double of_a = cross(d - c, a - c), of_b = cross(d - c, b - c);
  const auto opposite = [](double p, double q) { return (p <= 0 && q >= 0) || (p >= 0 && q <= 0); };
  if (!opposite(of_c, of_d) || !opposite(of_a, of_b)) return false;
  FlatBox one, other;
  one.add(a), one.add(b), other.add(c), other.add(d);
  return one.touches(other);  // matters for segments of one straight line
}

}  // namespace

std::vector<CurvePoint> curve_through(std::span<const glm::dvec2> points, double step_m) {
  const PlaneSpline spline(points);
  std::vector<CurvePoint> curve{{points.front(), 0, 0, 0}};
  for (std::size_t i = 1; i < points.size(); ++i)
    spline.walk(i, step_m, [&](glm::dvec2 at_m, double share) {
      const double along_m = curve.back().along_m + length_of(at_m - curve.back().at_m);
      curve.push_back({at_m, along_m, i - 1, share});
    });
  return curve;
}

std::vector<glm::dvec2> closed_curve_through(std::span<const glm::dvec2> points, double step_m) {
  // A natural spline forgets its ends within some points, so a few turns more close it smoothly.
  const std::size_t n = points.size(), more = std::max<std::size_t>(n, 8);
  std::vector<glm::dvec2> turns;
  for (std::size_t i = 0; i < n + 2 * more + 1; ++i)
    turns.push_back(points[(i + n * more - more) % n]);
  const PlaneSpline spline(turns);
  std::vector<glm::dvec2> curve;
  for (std::size_t i = more + 1; i <= more + n; ++i)
    spline.walk(i, step_m, [&](glm::dvec2 at_m, double) { curve.push_back(at_m); });
  return curve;
}

std::optional<glm::dvec2> self_crossing(std::span<const glm::dvec2> line, bool is_closed) {
  constexpr std::size_t kGroup = 16;
  const std::size_t count = is_closed ? line.size() : line.size() - 1;
  const auto end_of = [&](std::size_t i) { return line[(i + 1) % line.size()]; };
  std::vector<FlatBox> boxes((count + kGroup - 1) / kGroup);
  for (std::size_t i = 0; i < count; ++i)
    boxes[i / kGroup].add(line[i]), boxes[i / kGroup].add(end_of(i));
  for (std::size_t p = 0; p < boxes.size(); ++p) {
    for (std::size_t q = p; q < boxes.size(); ++q) {
      if (!boxes[p].touches(boxes[q])) continue;
      for (std::size_t i = p * kGroup; i < std::min((p + 1) * kGroup, count); ++i) {
        for (std::size_t k = std::max(q * kGroup, i + 2); k < std::min((q + 1) * kGroup, count);
             ++k) {
          if (is_closed && i == 0 && k + 1 == count) continue;  // neighbours
          if (meet(line[i], end_of(i), line[k], end_of(k))) return line[k];
        }
      }
    }
  }
  return std::nullopt;
}

double max_moved_m(const World& world, const models::GroundEdit& edit,
                   const models::Parameters& before) {
  constexpr double kMaxLookedAt = 5000;
  const double cell_m = world.cell_m(), block_m = world.block_size_m();
  const double radius_m = edit.radius_m + cell_m;
  const double vertices = 4 * radius_m * radius_m / (cell_m * cell_m);
  const auto step = static_cast<std::int64_t>(std::ceil(std::sqrt(vertices / kMaxLookedAt)));
  const auto last = world.terrain.integer(models::kTerrainSize) - 1;
  const auto block_at = [&](double local_m) {
    return static_cast<std::int64_t>(std::floor(local_m / block_m));
  };
  // Vertices in the square of the edit, along one axis of a block `away_m` from its centre.
  const auto first_of = [&](double away_m) {
    return std::clamp<std::int64_t>(
        static_cast<std::int64_t>(std::floor((-away_m - edit.radius_m) / cell_m)), 0, last);
  };
  const auto last_of = [&](double away_m) {
    return std::clamp<std::int64_t>(
        static_cast<std::int64_t>(std::ceil((-away_m + edit.radius_m) / cell_m)), 0, last);
  };
  const core::WorldPosition& centre = edit.centre;
  double most = 0;
  for (std::int64_t z = block_at(centre.local.z - radius_m);
       z <= block_at(centre.local.z + radius_m); ++z) {
    for (std::int64_t x = block_at(centre.local.x - radius_m);
         x <= block_at(centre.local.x + radius_m); ++x) {
      const core::BlockCoord block = core::moved(centre.block, x, z);
      const glm::dvec3 away = core::offset_m(block, centre, block_m);
      const std::int64_t x0 = first_of(away.x), x1 = last_of(away.x);
      const std::int64_t z0 = first_of(away.z), z1 = last_of(away.z);
      const auto questions = ((x1 - x0) / step + 1) * ((z1 - z0) / step + 1);
      const models::BlockGround ground(before, block, static_cast<std::size_t>(questions));
      for (std::int64_t k = z0; k <= z1; k += step) {
        for (std::int64_t i = x0; i <= x1; i += step) {
          const glm::dvec2 local_m =
              glm::dvec2(static_cast<double>(i), static_cast<double>(k)) * cell_m;
          const glm::dvec2 place_m = models::from_origin_m(edit.origin(), block, local_m, block_m);
          const double ground_m = ground.at(local_m).height_m;
          const double shaped_m = edit.river ? shaped_by(*edit.river, ground_m, place_m)
                                             : shaped_by(*edit.lake, ground_m, place_m);
          most = std::max(most, std::abs(shaped_m - ground_m));
        }
      }
    }
  }
  return step > 1 ? 1.1 * most + 0.5 : most;
}

}  // namespace psygen::world
