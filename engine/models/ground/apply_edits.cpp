// Applies edits of the ground to heights: the curves of single edits, and the walk down the
// quadtree to the edits that reach the samples.
#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/models/ground/ground_edits.hpp"

namespace psygen::models {
namespace {

using Cell = QuadMap<GroundCell>::Cell;
using EditPtr = std::shared_ptr<const GroundEdit>;

// Returns the weight of an edit at a distance from its centre: smooth from 1 to 0.
double weight_of(const GroundEdit& edit, double dx, double dz) {
  const double left = edit.square ? std::min(edit.radius_m * edit.sides.x - std::abs(dx),
                                             edit.radius_m * edit.sides.y - std::abs(dz))
                                  : edit.radius_m - std::sqrt(dx * dx + dz * dz);
  return faded(left, edit.falloff * edit.radius_m);
}

// The nearest point of a segment: its fraction of the length, and the square of its distance.
struct Foot {
  double share, away2;
};
Foot foot_of(const RoadSegment& segment, glm::dvec2 place_m) {
  const glm::dvec2 along = segment.to_m - segment.from_m, to = place_m - segment.from_m;
  const double length2 = along.x * along.x + along.y * along.y;
  const double at = to.x * along.x + to.y * along.y;
  const double share = length2 > 0 ? std::clamp(at / length2, 0.0, 1.0) : 0;
  const double x = to.x - share * along.x, z = to.y - share * along.y;
  return {share, x * x + z * z};
}

// A height of a heightmap and its weight: 1, falling to 0 at holes.
struct MapPoint {
  double height_m = 0, weight = 1;
};
MapPoint height_in(const Heightmap& map, double u, double v) {
  const auto place = [](double share, std::uint32_t points) {
    const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(points - 1);
    const double first = std::min(std::floor(at), static_cast<double>(points - 2));
    return std::pair{static_cast<std::size_t>(first), at - first};
  };
  const auto [x, s] = place(u, map.columns);
  const auto [z, t] = place(v, map.rows);
  const float* const near = &map.heights_m[z * map.columns + x];
  const float* const far = near + map.columns;
  if (map.has_holes) {
    MapPoint point{0, 0};
    const auto add = [&point](float height_m, double share) {
      if (std::isnan(height_m)) return;
      point.height_m += share * double{height_m};
      point.weight += share;
    };
    add(near[0], (1 - s) * (1 - t));
    add(near[1], s * (1 - t));
    add(far[0], (1 - s) * t);
    add(far[1], s * t);
    if (point.weight > 0) point.height_m /= point.weight;
    return point;
  }
  const double a = double{near[0]} + s * (double{near[1]} - double{near[0]});
  const double b = double{far[0]} + s * (double{far[1]} - double{far[0]});
  return {a + t * (b - a), 1};
}

// Returns a height of the ground, in metres, after an edit.
double edited(const GroundEdit& edit, double height_m, double dx, double dz) {
  if (edit.road) {
    const RoadEffect road = effect_of(*edit.road, {dx, dz});
    return height_m + road.weight * (road.height_m - height_m);
  }
  if (edit.river) return shaped_by(*edit.river, height_m, {dx, dz});
  if (edit.lake) return shaped_by(*edit.lake, height_m, {dx, dz});
  if (edit.turn != glm::dvec2(1, 0)) {  // back to the sides of the stamp
    const double x = dx * edit.turn.x - dz * edit.turn.y;
    dz = dx * edit.turn.y + dz * edit.turn.x;
    dx = x;
  }
  const double weight = weight_of(edit, dx, dz);
  const auto stamp = [&] {
    return height_in(*edit.map, 0.5 + 0.5 * dx / (edit.radius_m * edit.sides.x),
                     0.5 + 0.5 * dz / (edit.radius_m * edit.sides.y));
  };
  switch (edit.change) {
    case GroundChange::kRaise:
      return height_m + weight * edit.height_m;
    case GroundChange::kFlatten:
      return height_m + weight * (edit.height_m - height_m);
    case GroundChange::kStampAdd: {
      const MapPoint p = stamp();
      return height_m + weight * p.weight * p.height_m;
    }
    case GroundChange::kStampSet: {
      const MapPoint p = stamp();
      return height_m + weight * p.weight * (p.height_m - height_m);
    }
    case GroundChange::kRoad:
    case GroundChange::kRiver:
    case GroundChange::kLake:
      break;
  }
  return height_m;
}

struct Range {
  std::size_t first, end;
  bool empty() const { return first >= end; }
};

// One call of GroundEdits::apply(): walks down the quadtree with the samples of each square.
class Application {
 public:
  Application(const GroundScale& scale, std::span<const std::int64_t> x,
              std::span<const std::int64_t> z, std::span<float> values, std::size_t stride,
              double narrowest_m)
      : scale_(scale), x_(x), z_(z), values_(values), stride_(stride), narrowest_m_(narrowest_m) {}

  void walk(const Cell* cell, QuadCoord region, Range columns, Range rows) {
    if (cell != nullptr && active_.empty() && cell->place != region) {
      region = cell->place;
      columns = narrowed(x_, columns, region.x, region.level);
      rows = narrowed(z_, rows, region.z, region.level);
    }
    if (columns.empty() || rows.empty()) return;
    if (cell == nullptr) return act(columns, rows);
    const std::size_t before = active_.size();
    const bool itself = cell->place == region;
    if (itself && cell->value) {
      for (const EditPtr& edit : cell->value->edits) {
        if (edit->radius_m >= narrowest_m_) active_.push_back(edit.get());
      }
    }
    if (region.level == 0) {
      act(columns, rows);
    } else {
      for (std::size_t q = 0; q < 4; ++q) {
        const QuadCoord quarter = region.quarter(q);
        const Cell* below = itself ? cell->quarters[q].get()
                                   : (region.quarter_of(cell->place) == q ? cell : nullptr);
        walk(below, quarter, narrowed(x_, columns, quarter.x, quarter.level),
             narrowed(z_, rows, quarter.z, quarter.level));
      }
    }
    active_.resize(before);
  }

 private:
  // Returns the samples of `range` in a square.
  Range narrowed(std::span<const std::int64_t> at, Range range, std::uint64_t index,
                 std::uint32_t level) const {
    const auto cell = [&](std::uint64_t i) {
      return (static_cast<std::int64_t>(i << level) - (std::int64_t{1} << 31)) *
             scale_.cells_per_block;
    };
    const auto begin = at.begin() + static_cast<std::ptrdiff_t>(range.first);
    const auto end = at.begin() + static_cast<std::ptrdiff_t>(std::max(range.end, range.first));
    const auto first = std::lower_bound(begin, end, cell(index));
    const auto last = std::lower_bound(first, end, cell(index + 1));
    return {static_cast<std::size_t>(first - at.begin()),
            static_cast<std::size_t>(last - at.begin())};
  }

  // An edit with the samples that it reaches.
  struct Act {
    const GroundEdit* edit;
    Range columns, rows;
  };
  void act(Range columns, Range rows) {
    ordered_.clear();
    for (const GroundEdit* edit : active_) {
      const core::WorldPosition& centre = edit->centre;
      const Act act{edit, within(*edit, x_, columns, centre.block.x, centre.local.x),
                    within(*edit, z_, rows, centre.block.z, centre.local.z)};
      if (!act.columns.empty() && !act.rows.empty()) ordered_.push_back(act);
    }
    std::ranges::sort(ordered_, {}, [](const Act& act) { return act.edit->order(); });
    for (const Act& act : ordered_)
      apply(*act.edit, act.columns, act.rows);
  }

  // Metres from the centre of an edit to a lattice point, along one axis. Exact, with the same bits
  // for every node that has the point.
  double away_m(std::int64_t at, std::int32_t block, double local_m) const {
    return static_cast<double>(at - std::int64_t{block} * scale_.cells_per_block) * scale_.cell_m -
           local_m;
  }

  // Returns the samples of `range` within an edit's radius along one axis.
  Range within(const GroundEdit& edit, std::span<const std::int64_t> at, Range range,
               std::int32_t block, double local_m) const {
    const auto all = at.subspan(range.first, range.end - range.first);
    const auto before = [&](std::int64_t i) { return away_m(i, block, local_m) < -edit.reach_m(); };
    const auto not_after = [&](std::int64_t i) {
      return away_m(i, block, local_m) <= edit.reach_m();
    };
    const auto first = std::ranges::partition_point(all, before);
    const auto end = std::ranges::partition_point(first, all.end(), not_after);
    return {range.first + static_cast<std::size_t>(first - all.begin()),
            range.first + static_cast<std::size_t>(end - all.begin())};
  }

  void apply(const GroundEdit& edit, Range columns, Range rows) {
    const core::WorldPosition& from = edit.origin();
    for (std::size_t k = rows.first; k < rows.end; ++k) {
      const double dz = away_m(z_[k], from.block.z, from.local.z);
      for (std::size_t i = columns.first; i < columns.end; ++i) {
        const double dx = away_m(x_[i], from.block.x, from.local.x);
        float& value = values_[k * stride_ + i];
        const double height_m = edited(edit, double{value} * scale_.unit_m, dx, dz);
        value = std::clamp(static_cast<float>(height_m / scale_.unit_m), 0.0F, scale_.highest);
      }
    }
  }

  const GroundScale& scale_;
  std::span<const std::int64_t> x_, z_;
  std::span<float> values_;
  std::size_t stride_;
  double narrowest_m_;
  std::vector<const GroundEdit*> active_;
  std::vector<Act> ordered_;
};

}  // namespace

RoadEffect effect_of(const RoadPiece& road, glm::dvec2 place_m) {
  const double reach_m = road.half_width_m + road.border_m;
  std::size_t nearest = road.end;
  Foot foot{0, reach_m * reach_m};
  for (std::size_t i = road.first; i < road.end; ++i) {
    const Foot of = foot_of(road.segments[i], place_m);
    if (of.away2 < foot.away2) foot = of, nearest = i;
  }
  if (nearest == road.end) return {};
  for (std::size_t i = 0; i < road.segments.size(); ++i) {
    if (i == road.first) i = road.end;
    if (i == road.segments.size()) break;
    const double away2 = foot_of(road.segments[i], place_m).away2;
    if (away2 < foot.away2 || (away2 == foot.away2 && i < nearest)) return {};
  }
  const RoadSegment& segment = road.segments[nearest];
  return {segment.from_height_m + foot.share * (segment.to_height_m - segment.from_height_m),
          faded(reach_m - std::sqrt(foot.away2), road.border_m)};
}

double road_share(const RoadPiece& road, glm::dvec2 place_m) {
  constexpr double kEdgeM = 1;
  const double outside_m = road.half_width_m + kEdgeM / 2;
  double nearest2 = outside_m * outside_m;
  for (std::size_t i = road.first; i < road.end; ++i)
    nearest2 = std::min(nearest2, foot_of(road.segments[i], place_m).away2);
  return std::clamp((outside_m - std::sqrt(nearest2)) / kEdgeM, 0.0, 1.0);
}

glm::dvec2 from_origin_m(const core::WorldPosition& o, core::BlockCoord block, glm::dvec2 local_m,
                         double block_m) {
  const auto along = [block_m](std::int32_t here, std::int32_t there, double local, double origin) {
    return static_cast<double>(std::int64_t{here} - std::int64_t{there}) * block_m + local - origin;
  };
  return {along(block.x, o.block.x, local_m.x, o.local.x),
          along(block.z, o.block.z, local_m.y, o.local.z)};
}

bool keeps_clear(const RoadPiece& road, core::BlockCoord block, glm::dvec2 local_m,
                 double block_m) {
  const glm::dvec2 place_m = from_origin_m(road.origin, block, local_m, block_m);
  const double clear_m = road.half_width_m + road.clear_m;
  for (std::size_t i = road.first; i < road.end; ++i) {
    if (foot_of(road.segments[i], place_m).away2 <= clear_m * clear_m) return true;
  }
  return false;
}

void GroundEdits::apply(const GroundScale& scale, std::span<const std::int64_t> x,
                        std::span<const std::int64_t> z, std::span<float> values,
                        std::size_t stride, double narrowest_m) const {
  if (cells_.empty()) return;
  Application(scale, x, z, values, stride, narrowest_m)
      .walk(cells_.root(), {QuadCoord::kMaxLevel, 0, 0}, {0, x.size()}, {0, z.size()});
}

}  // namespace psygen::models
