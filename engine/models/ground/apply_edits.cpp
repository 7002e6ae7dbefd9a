// Applies edits of the ground to heights: the curves of single edits, and the walk down the
// quadtree to the edits that reach the samples.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/core/assert.hpp"
#include "engine/models/ground/erosion.hpp"
#include "engine/models/ground/ground_edits.hpp"
#include "engine/models/kit/scratch.hpp"

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

// Turns a place around the centre of an edit back to the sides of its stamp.
glm::dvec2 along_sides(const GroundEdit& edit, double dx, double dz) {
  if (edit.turn == glm::dvec2(1, 0)) return {dx, dz};
  return {dx * edit.turn.x - dz * edit.turn.y, dx * edit.turn.y + dz * edit.turn.x};
}

// The fraction of the rectangle of an edit before a place, along both sides.
glm::dvec2 share_of_sides(const GroundEdit& edit, glm::dvec2 place_m) {
  return {0.5 + 0.5 * place_m.x / (edit.radius_m * edit.sides.x),
          0.5 + 0.5 * place_m.y / (edit.radius_m * edit.sides.y)};
}

// Returns a height of the ground, in metres, after the whole change of an edit.
double edited(const GroundEdit& edit, double height_m, double dx, double dz) {
  if (edit.road) {
    const RoadEffect road = effect_of(*edit.road, {dx, dz});
    return height_m + road.weight * (road.height_m - height_m);
  }
  if (edit.river) return shaped_by(*edit.river, height_m, {dx, dz});
  if (edit.lake) return shaped_by(*edit.lake, height_m, {dx, dz});
  const glm::dvec2 place_m = along_sides(edit, dx, dz);
  const double weight = weight_of(edit, place_m.x, place_m.y);
  const auto stamp = [&] {
    const glm::dvec2 share = share_of_sides(edit, place_m);
    return height_in(*edit.map, share.x, share.y);
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

// Returns a height after the part of a change from `before_m` to `after_m` that an edit makes where
// its mask is `share`. Monotone in `before_m` if the whole change is.
double blended(const GroundEdit& edit, double before_m, double after_m, double share) {
  double change_m = after_m - before_m;
  if (edit.blend == GroundBlend::kHighest) change_m = std::max(change_m, 0.0);
  if (edit.blend == GroundBlend::kLowest) change_m = std::min(change_m, 0.0);
  return before_m + edit.strength * share * change_m;
}

struct Range {
  std::size_t first, end;
  bool empty() const { return first >= end; }
  std::size_t count() const { return end - first; }
  Range with(const Range& o) const { return {std::min(first, o.first), std::max(end, o.end)}; }
  std::span<const std::int64_t> of(std::span<const std::int64_t> axis) const {
    return axis.subspan(first, count());
  }
};

// A rectangle of samples.
struct Samples {
  Range columns, rows;
  std::size_t count() const { return columns.count() * rows.count(); }
};

// Masks read the slope of the guide between so many cells before and after a place: no farther away
// than the light of every node reads, so masks need no more patches of a river network.
constexpr std::int64_t kGuideStep = 4;

// The guide at some of the samples (all_x[i], all_z[k]), for masks with at most so many reads.
class GuideRows {
 public:
  GuideRows(const ErosionGuide& guide, const GroundScale& scale,
            std::span<const std::int64_t> all_x, std::span<const std::int64_t> all_z,
            const Samples& at, int reads)
      : unit_m_(scale.unit_m),
        run_m_(2 * kGuideStep * scale.cell_m),
        at_(at),
        memory_(static_cast<std::size_t>(reads) * at.count() * sizeof(float)) {
    const auto x = at.columns.of(all_x), z = at.rows.of(all_z);
    const auto fill = [&](std::size_t i, std::span<const std::int64_t> columns,
                          std::span<const std::int64_t> rows) {
      guide.heights(columns, rows, GroundMask::kGuideCells, plane(i), x.size());
    };
    fill(0, x, z);
    if (reads == 1) return;
    std::vector<std::int64_t> moved;
    const auto by = [&moved](std::span<const std::int64_t> axis, std::int64_t step) {
      moved.assign(axis.begin(), axis.end());
      for (std::int64_t& i : moved)
        i += step;
      return std::span<const std::int64_t>(moved);
    };
    fill(1, by(x, kGuideStep), z);
    fill(2, by(x, -kGuideStep), z);
    fill(3, x, by(z, kGuideStep));
    fill(4, x, by(z, -kGuideStep));
  }

  // The ranges of a mask at a sample of all.
  double share(const GroundMask& mask, std::size_t column, std::size_t row) const {
    const std::size_t i = (row - at_.rows.first) * at_.columns.count() + column - at_.columns.first;
    const double height_m = double{plane(0)[i]} * unit_m_;
    if (!mask.slope.is_limited()) return mask.on(height_m, 0);
    const auto rise_m = [&](std::size_t to, std::size_t from) {
      return (double{plane(to)[i]} - double{plane(from)[i]}) * unit_m_;
    };
    const double x = rise_m(1, 2) / run_m_, z = rise_m(3, 4) / run_m_;
    return mask.on(height_m, std::sqrt(x * x + z * z));
  }

 private:
  std::span<float> plane(std::size_t i) const {
    return {static_cast<float*>(memory_.get()) + i * at_.count(), at_.count()};
  }

  double unit_m_, run_m_;
  Samples at_;
  ScratchMemory memory_;
};

// One call of GroundEdits::apply(): walks down the quadtree with the samples of each square.
class Application {
 public:
  Application(const GroundScale& scale, std::span<const std::int64_t> x,
              std::span<const std::int64_t> z, std::span<float> values, std::size_t stride,
              double narrowest_m, const ErosionGuide* guide)
      : scale_(scale),
        x_(x),
        z_(z),
        values_(values),
        stride_(stride),
        narrowest_m_(narrowest_m),
        guide_(guide) {}

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
    Samples at;
    int guide_reads() const { return edit->mask ? edit->mask->guide_reads() : 0; }
  };
  void act(Range columns, Range rows) {
    ordered_.clear();
    for (const GroundEdit* edit : active_) {
      const core::WorldPosition& centre = edit->centre;
      const Act act{edit,
                    {within(*edit, x_, columns, centre.block.x, centre.local.x),
                     within(*edit, z_, rows, centre.block.z, centre.local.z)}};
      if (!act.at.columns.empty() && !act.at.rows.empty()) ordered_.push_back(act);
    }
    std::ranges::sort(ordered_, {}, [](const Act& act) { return act.edit->order(); });
    const std::optional<GuideRows> shared = shared_guide();
    for (const Act& act : ordered_) {
      std::optional<GuideRows> own;
      if (!shared && act.guide_reads() > 0) own.emplace(guide_at(act.at, act.guide_reads()));
      apply(*act.edit, act.at, shared ? &*shared : own ? &*own : nullptr);
    }
  }

  // Reads the guide for all masked edits at once, unless one by one they read less.
  std::optional<GuideRows> shared_guide() const {
    Samples all{};
    int reads = 0;
    std::size_t apart = 0;
    for (const Act& act : ordered_) {
      const int own = act.guide_reads();
      if (own == 0) continue;
      all = reads == 0 ? act.at
                       : Samples{all.columns.with(act.at.columns), all.rows.with(act.at.rows)};
      reads = std::max(reads, own);
      apart += static_cast<std::size_t>(own) * act.at.count();
    }
    if (reads == 0 || static_cast<std::size_t>(reads) * all.count() > apart) return std::nullopt;
    return guide_at(all, reads);
  }
  GuideRows guide_at(const Samples& at, int reads) const {
    PSYGEN_ASSERT(guide_ != nullptr, "masks of height and slope have a guide");
    return {*guide_, scale_, x_, z_, at, reads};
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

  void apply(const GroundEdit& edit, const Samples& at, const GuideRows* guide) {
    const core::WorldPosition& from = edit.origin();
    const auto& [columns, rows] = at;
    for (std::size_t k = rows.first; k < rows.end; ++k) {
      const double dz = away_m(z_[k], from.block.z, from.local.z);
      for (std::size_t i = columns.first; i < columns.end; ++i) {
        const double dx = away_m(x_[i], from.block.x, from.local.x);
        float& value = values_[k * stride_ + i];
        const double before_m = double{value} * scale_.unit_m;
        double height_m = edited(edit, before_m, dx, dz);
        if (!edit.is_whole()) {
          double share = edit.mask ? edit.mask->at({world_m(x_[i]), world_m(z_[k])},
                                                   share_of_sides(edit, along_sides(edit, dx, dz)))
                                   : 1;
          if (edit.mask && edit.mask->reads_guide()) share *= guide->share(*edit.mask, i, k);
          height_m = blended(edit, before_m, height_m, share);
        }
        value = std::clamp(static_cast<float>(height_m / scale_.unit_m), 0.0F, scale_.highest);
      }
    }
  }

  double world_m(std::int64_t at) const { return static_cast<double>(at) * scale_.cell_m; }

  const GroundScale& scale_;
  std::span<const std::int64_t> x_, z_;
  std::span<float> values_;
  std::size_t stride_;
  double narrowest_m_;
  const ErosionGuide* guide_;
  std::vector<const GroundEdit*> active_;
  std::vector<Act> ordered_;
};

// The squared distance from the centre line of a piece of a road.
double away2(const RoadPiece& road, glm::dvec2 place_m) {
  double nearest2 = std::numeric_limits<double>::infinity();
  for (std::size_t i = road.first; i < road.end; ++i)
    nearest2 = std::min(nearest2, foot_of(road.segments[i], place_m).away2);
  return nearest2;
}

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
  const double nearest2 = std::min(outside_m * outside_m, away2(road, place_m));
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
  return away2(road, place_m) <= clear_m * clear_m;
}

double beside_road_m(const RoadPiece& road, core::BlockCoord block, glm::dvec2 local_m,
                     double block_m) {
  const glm::dvec2 place_m = from_origin_m(road.origin, block, local_m, block_m);
  return std::max(std::sqrt(away2(road, place_m)) - road.half_width_m, 0.0);
}

void GroundEdits::apply(const GroundScale& scale, std::span<const std::int64_t> x,
                        std::span<const std::int64_t> z, std::span<float> values,
                        std::size_t stride, double narrowest_m, const ErosionGuide* guide) const {
  if (cells_.empty()) return;
  Application(scale, x, z, values, stride, narrowest_m, guide)
      .walk(cells_.root(), {QuadCoord::kMaxLevel, 0, 0}, {0, x.size()}, {0, z.size()});
}

}  // namespace psygen::models
