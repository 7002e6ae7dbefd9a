#include "engine/models/ground/water.hpp"

#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <tuple>

#include "engine/core/hash.hpp"
#include "engine/models/kit/quad_map.hpp"

namespace psygen::models {
namespace {

constexpr double kBankSlope = 0.12;  // of the ground beside the water, before it meets its bank

double dot(glm::dvec2 a, glm::dvec2 b) {
  return a.x * b.x + a.y * b.y;
}

// The nearest point of a segment: its fraction of the length, and the square of its distance.
// `per_length2` is 1 over the square of the length of `along`.
struct Foot {
  double share = 0, away2 = std::numeric_limits<double>::infinity();
};
Foot foot_of(glm::dvec2 from_m, glm::dvec2 along, double per_length2, glm::dvec2 place_m) {
  const glm::dvec2 to = place_m - from_m;
  const double share = std::clamp(dot(to, along) * per_length2, 0.0, 1.0);
  const double x = to.x - share * along.x, z = to.y - share * along.y;
  return {share, x * x + z * z};
}
double per_length2_of(glm::dvec2 along) {
  const double length2 = dot(along, along);
  return length2 > 0 ? 1 / length2 : 0;
}

double between(double from, double to, double share) {
  return from + share * (to - from);
}

// The river at the point of its centre line that is nearest to a place.
struct RiverFoot {
  const RiverPoint *from, *to;
  double share, away_m;
  double value(double RiverPoint::*member) const {
    return between(from->*member, to->*member, share);
  }
};
std::optional<RiverFoot> foot_of(const RiverPiece& river, glm::dvec2 place_m) {
  if (!(place_m.x >= river.low_m.x && place_m.x <= river.high_m.x && place_m.y >= river.low_m.y &&
        place_m.y <= river.high_m.y))
    return std::nullopt;
  const std::size_t own = river.points.size() - 1;
  std::size_t nearest = 0;
  Foot foot;
  for (std::size_t i = 0; i < own; ++i) {
    const Foot of = foot_of(river.points[i].at_m, river.along[i], river.per_length2[i], place_m);
    if (of.away2 < foot.away2) foot = of, nearest = i;
  }
  if (foot.away2 > river.reach_m * river.reach_m) return std::nullopt;
  for (std::size_t i = 0; i < river.near.size(); ++i) {
    const RiverNeighbour& other = river.near[i];
    const double away2 =
        foot_of(other.from_m, river.along[own + i], river.per_length2[own + i], place_m).away2;
    if (away2 < foot.away2 || (other.is_earlier && away2 == foot.away2)) return std::nullopt;
  }
  return RiverFoot{&river.points[nearest], &river.points[nearest + 1], foot.share,
                   std::sqrt(foot.away2)};
}

bool is_in_tile(const LakePiece& lake, glm::dvec2 place_m) {
  return place_m.x >= lake.low_m.x && place_m.x < lake.high_m.x && place_m.y >= lake.low_m.y &&
         place_m.y < lake.high_m.y;
}

std::uint64_t with(std::uint64_t hash, double value) {
  return core::combine(hash, std::bit_cast<std::uint64_t>(value));
}
std::uint64_t with(std::uint64_t hash, glm::dvec2 value) {
  return with(with(hash, value.x), value.y);
}
std::uint64_t with(std::uint64_t hash, const core::WorldPosition& at) {
  const QuadCoord block = QuadCoord::of(at.block);
  return with(core::combine(hash, block.x << 32 | block.z), glm::dvec2(at.local.x, at.local.z));
}

}  // namespace

// The side of the nearest segment decides, or at a corner the mean normal there.
double outside_m(const LakePiece& lake, glm::dvec2 place_m) {
  const LakeSegment* nearest = nullptr;
  Foot foot;
  for (const LakeSegment& segment : lake.segments) {
    const glm::dvec2 along = segment.to_m - segment.from_m;
    const Foot of = foot_of(segment.from_m, along, segment.per_length2, place_m);
    if (of.away2 < foot.away2) foot = of, nearest = &segment;
  }
  if (nearest == nullptr) {
    constexpr double kFar = 1e30;
    return lake.inside ? -kFar : kFar;
  }
  const glm::dvec2 along = nearest->to_m - nearest->from_m;
  glm::dvec2 normal{along.y, -along.x};
  if (foot.share <= 0) normal = nearest->from_normal;
  if (foot.share >= 1) normal = nearest->to_normal;
  const glm::dvec2 at = nearest->from_m + foot.share * along;
  const double away_m = std::sqrt(foot.away2);
  return dot(place_m - at, normal) > 0 ? away_m : -away_m;
}

double depth_of(const LakePiece& lake, double outside_m) {
  const double in = std::clamp(-outside_m / lake.shore_m, 0.0, 1.0);
  return lake.depth_m * in * (2 - in);
}

void seal(RiverPiece& river) {
  constexpr double kFar = std::numeric_limits<double>::max();
  river.reach_m = 0;
  river.low_m = glm::dvec2(kFar), river.high_m = glm::dvec2(-kFar);
  for (const RiverPoint& point : river.points) {
    river.reach_m =
        std::max(river.reach_m, point.half_width_m + std::max(point.bank_m, river.edge_m));
    river.low_m = glm::min(river.low_m, point.at_m);
    river.high_m = glm::max(river.high_m, point.at_m);
  }
  river.low_m -= river.reach_m, river.high_m += river.reach_m;
  river.along.clear();
  for (std::size_t i = 0; i + 1 < river.points.size(); ++i)
    river.along.push_back(river.points[i + 1].at_m - river.points[i].at_m);
  for (const RiverNeighbour& other : river.near)
    river.along.push_back(other.to_m - other.from_m);
  river.per_length2.clear();
  for (const glm::dvec2& along : river.along)
    river.per_length2.push_back(per_length2_of(along));
}

void seal(LakePiece& lake) {
  for (LakeSegment& segment : lake.segments)
    segment.per_length2 = per_length2_of(segment.to_m - segment.from_m);
}

double shaped_by(const RiverPiece& river, double ground_m, glm::dvec2 place_m) {
  const auto foot = foot_of(river, place_m);
  if (!foot) return ground_m;
  const double half_m = foot->value(&RiverPoint::half_width_m);
  const double surface_m = foot->value(&RiverPoint::surface_m);
  if (foot->away_m <= half_m) {
    const double across = foot->away_m / half_m;
    const double depth_m = surface_m - foot->value(&RiverPoint::bed_m);
    return std::min(ground_m, surface_m - depth_m * (1 - across * across));
  }
  const double bank_m = foot->value(&RiverPoint::bank_m), beside_m = foot->away_m - half_m;
  const double wished_m = std::min(ground_m, surface_m + kBankSlope * beside_m);
  return ground_m + faded(bank_m - beside_m, bank_m) * (wished_m - ground_m);
}

double shaped_by(const LakePiece& lake, double ground_m, glm::dvec2 place_m) {
  if (!is_in_tile(lake, place_m)) return ground_m;
  const double outside = outside_m(lake, place_m);
  if (outside >= lake.shore_m) return ground_m;
  const double left_m = lake.shore_m - std::abs(outside);
  if (outside > 0) {
    const double wished_m = lake.level_m + kBankSlope * outside;
    return ground_m + faded(left_m, lake.shore_m) * (wished_m - ground_m);
  }
  const double bed_m = lake.level_m - depth_of(lake, outside);
  if (ground_m >= bed_m) return bed_m;
  return ground_m + faded(left_m, lake.shore_m) * (bed_m - ground_m);
}

bool BodySurface::owns_before(const BodySurface& other) const {
  return std::tuple(widths, surface_m, body) <
         std::tuple(other.widths, other.surface_m, other.body);
}

std::optional<BodySurface> surface_of(const RiverPiece& river, glm::dvec2 place_m) {
  const auto foot = foot_of(river, place_m);
  if (!foot) return std::nullopt;
  const double half_m = foot->value(&RiverPoint::half_width_m);
  if (foot->away_m > half_m + river.edge_m) return std::nullopt;
  BodySurface water;
  water.body = river.body;
  water.surface_m = foot->value(&RiverPoint::surface_m);
  water.foam = foot->value(&RiverPoint::foam);
  water.discharge_m3_s = foot->value(&RiverPoint::discharge_m3_s);
  water.width_m = 2 * half_m;
  water.widths = foot->away_m / (2 * half_m);
  glm::dvec2 direction =
      foot->from->direction + foot->share * (foot->to->direction - foot->from->direction);
  const double length = std::sqrt(dot(direction, direction));
  direction = length > 0 ? direction / length : foot->from->direction;
  water.slope = direction * -foot->value(&RiverPoint::fall);
  // A parabola across: 1.25 times the mean of the cross-section in the middle, 0 at the border.
  const double across = std::min(foot->away_m / half_m, 1.0);
  water.flow_m_s = direction * (1.25 * foot->value(&RiverPoint::speed_m_s) * (1 - across * across));
  return water;
}

std::optional<BodySurface> surface_of(const LakePiece& lake, glm::dvec2 place_m) {
  if (!is_in_tile(lake, place_m)) return std::nullopt;
  const double outside = outside_m(lake, place_m);
  if (outside > lake.edge_m) return std::nullopt;
  BodySurface water;
  water.body = lake.body;
  water.surface_m = lake.level_m;
  water.widths = outside > 0 ? 0.5 + outside / lake.shore_m : -1;
  return water;
}

bool is_in_bed(const RiverPiece& river, glm::dvec2 place_m) {
  const auto foot = foot_of(river, place_m);
  return foot && foot->away_m <= foot->value(&RiverPoint::half_width_m);
}

bool is_in_bed(const LakePiece& lake, glm::dvec2 place_m) {
  return is_in_tile(lake, place_m) && outside_m(lake, place_m) <= 0;
}

std::uint64_t content_of(const RiverPiece& river) {
  std::uint64_t hash = with(core::mix64(river.body), river.origin);
  hash = with(hash, river.edge_m);
  for (const RiverPoint& p : river.points) {
    hash = with(with(hash, p.at_m), p.direction);
    for (const double v :
         {p.half_width_m, p.surface_m, p.bed_m, p.bank_m, p.speed_m_s, p.fall, p.foam})
      hash = with(hash, v);
  }
  for (const RiverNeighbour& n : river.near)
    hash = core::combine(with(with(hash, n.from_m), n.to_m), n.is_earlier ? 1 : 0);
  return hash;
}

std::uint64_t content_of(const LakePiece& lake) {
  std::uint64_t hash = with(core::mix64(lake.body), lake.origin);
  for (const double v : {lake.level_m, lake.depth_m, lake.shore_m, lake.edge_m})
    hash = with(hash, v);
  hash = core::combine(with(with(hash, lake.low_m), lake.high_m), lake.inside ? 1 : 0);
  for (const LakeSegment& s : lake.segments)
    hash = with(with(with(with(hash, s.from_m), s.to_m), s.from_normal), s.to_normal);
  return hash;
}

}  // namespace psygen::models
