#include "engine/models/ground/ground_edits.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace psygen::models {
namespace {

using Cell = QuadMap<GroundCell>::Cell;
using EditPtr = std::shared_ptr<const GroundEdit>;

// The steepest slope of the curve by which edits fade out.
constexpr double kSteepest = 1.5;
// Cells of this level and below count as a whole if they touch a node's margin.
int whole_level(const QuadCoord& node) {
  constexpr int kMarginLevels = 4;
  return static_cast<int>(node.level) - kMarginLevels;
}

// A rectangle in blocks from block −2^31.
struct Area {
  double x0, z0, x1, z1;
  bool touches(const Area& o) const { return x0 <= o.x1 && o.x0 <= x1 && z0 <= o.z1 && o.z0 <= z1; }
  bool holds(const Area& o) const { return x0 <= o.x0 && o.x1 <= x1 && z0 <= o.z0 && o.z1 <= z1; }
  Area common(const Area& o) const {
    return {std::max(x0, o.x0), std::max(z0, o.z0), std::min(x1, o.x1), std::min(z1, o.z1)};
  }
  double size() const { return std::max(x1 - x0, 0.0) * std::max(z1 - z0, 0.0); }  // in blocks²
};

Area area_of(const QuadCoord& place, double margin = 0) {
  const double side = std::ldexp(1.0, static_cast<int>(place.level));
  const double x = static_cast<double>(place.x) * side, z = static_cast<double>(place.z) * side;
  return {x - margin, z - margin, x + side + margin, z + side + margin};
}

Area area_of(const GroundEdit& edit, double reach_m, double block_m) {
  const QuadCoord block = QuadCoord::of(edit.centre.block);
  const double x = static_cast<double>(block.x) + edit.centre.local.x / block_m;
  const double z = static_cast<double>(block.z) + edit.centre.local.z / block_m;
  const double reach = reach_m / block_m;
  return {x - reach, z - reach, x + reach, z + reach};
}

std::uint64_t content_hash(const GroundEdit& edit) {
  std::uint64_t hash = core::combine(0x6D0E, edit.id);  // the order of the edits matters
  const auto add = [&hash](double v) {
    hash = core::combine(hash, std::bit_cast<std::uint64_t>(v));
  };
  hash = core::combine(hash, static_cast<std::uint64_t>(edit.change) * 2 + (edit.square ? 1 : 0));
  hash = core::combine(
      hash, QuadCoord::of(edit.centre.block).x << 32 | QuadCoord::of(edit.centre.block).z);
  for (const double v :
       {edit.centre.local.x, edit.centre.local.z, edit.radius_m, edit.falloff, edit.height_m})
    add(v);
  if (edit.map) {
    hash = core::combine(hash, (std::uint64_t{edit.map->columns} << 32) | edit.map->rows);
    hash = core::combine(hash, core::hash_bytes(std::as_bytes(std::span(edit.map->heights_m))));
  }
  for (const auto& [now, usual] :
       {std::pair{edit.turn, glm::dvec2(1, 0)}, std::pair{edit.sides, glm::dvec2(1, 1)}}) {
    if (now == usual) continue;
    add(now.x);
    add(now.y);
  }
  if (!edit.is_whole()) {
    add(edit.strength);
    hash = core::combine(hash, static_cast<std::uint64_t>(edit.blend));
    hash = core::combine(hash, edit.mask ? edit.mask->hash() : 0);
  }
  if (edit.river) hash = core::combine(hash, content_of(*edit.river));
  if (edit.lake) hash = core::combine(hash, content_of(*edit.lake));
  if (!edit.road) return hash;
  const RoadPiece& road = *edit.road;
  const QuadCoord origin = QuadCoord::of(road.origin.block);
  hash = core::combine(hash, origin.x << 32 | origin.z);
  hash = core::combine(hash, road.first << 32 | road.end);
  for (const double v :
       {road.origin.local.x, road.origin.local.z, road.half_width_m, road.border_m, road.clear_m})
    add(v);
  return core::combine(hash, core::hash_bytes(std::as_bytes(std::span(road.segments))));
}

// Returns the largest height change of an edit.
float max_of(const GroundEdit& edit) {
  if (edit.change == GroundChange::kRaise || edit.change == GroundChange::kRoad ||
      is_water(edit.change))
    return static_cast<float>(edit.strength * std::abs(edit.height_m));
  if (edit.change != GroundChange::kStampAdd) return 1e30F;  // limited by the height range
  float most = 0;
  for (const float h : edit.map->heights_m)
    most = std::max(most, std::abs(h));
  return static_cast<float>(edit.strength * double{most});
}

// Calls visit(place) for the at most four squares that list an edit: as large as its influence,
// with some margin for rounding.
template <class Visit>
void each_place(const GroundEdit& edit, double block_m, const Visit& visit) {
  const double reach_m = GroundEdits::kInfluence * edit.reach_m() + 1e-3 * block_m;
  const Area area = area_of(edit, reach_m, block_m);
  std::uint32_t level = 0;
  while (level < QuadCoord::kMaxLevel &&
         std::ldexp(1.0, static_cast<int>(level)) < area.x1 - area.x0)
    ++level;
  const auto square = [level](double block) {
    constexpr double kLast = 4294967295.0;
    return static_cast<std::uint64_t>(std::clamp(std::floor(block), 0.0, kLast)) >> level;
  };
  for (std::uint64_t z = square(area.z0); z <= square(area.z1); ++z) {
    for (std::uint64_t x = square(area.x0); x <= square(area.x1); ++x)
      visit(QuadCoord{level, x, z});
  }
}

float steepness_of(const GroundEdit& edit) {
  double fades_m = edit.road ? edit.road->border_m : edit.falloff * edit.radius_m;
  if (edit.river) {
    fades_m = edit.radius_m;
    for (const RiverPoint& point : edit.river->points)
      fades_m = std::min({fades_m, point.bank_m, point.half_width_m});
  } else if (edit.lake) {
    fades_m = edit.lake->shore_m;
  }
  double slope = kSteepest / std::max(fades_m, 1e-6);
  if (edit.map) {
    const double points = std::max(edit.map->columns / edit.sides.x, edit.map->rows / edit.sides.y);
    slope += (edit.map->has_holes ? 1.5 : 1) * points / edit.radius_m;
  }
  if (edit.mask)
    slope += edit.mask->steepness(2 * edit.radius_m * std::min(edit.sides.x, edit.sides.y));
  return std::min(std::min(edit.max_m, 1e6F) * static_cast<float>(slope), 1e30F);
}

// Visits the edits of the cells that touch an area, from the largest cell down: visit(edit). A cell
// for which `takes_whole`(cell, its area) is true is left out with everything below it.
template <class TakesWhole, class Visit>
void each_edit(const Cell* cell, const Area& area, const TakesWhole& takes_whole,
               const Visit& visit) {
  if (cell == nullptr) return;
  const Area own = area_of(cell->place);
  if (!own.touches(area) || takes_whole(*cell, own)) return;
  for (std::size_t i = 0; cell->value && i < cell->value->edits.size(); ++i)
    visit(*cell->value->edits[i]);
  for (const auto& quarter : cell->quarters)
    each_edit(quarter.get(), area, takes_whole, visit);
}

// Cells that hash_of() counts as a whole are compared as a whole.
bool same(const Cell* a, const Cell* b, const Area& area, int whole) {
  if (a == b) return true;
  const auto outside = [&](const Cell* c) {
    return c == nullptr || !area_of(c->place).touches(area);
  };
  if (a == nullptr || b == nullptr || a->place != b->place) return outside(a) && outside(b);
  if (outside(a)) return true;
  if (static_cast<int>(a->place.level) <= whole) return a->hash == b->hash;
  if (a->value != b->value) return false;
  for (std::size_t q = 0; q < 4; ++q) {
    if (!same(a->quarters[q].get(), b->quarters[q].get(), area, whole)) return false;
  }
  return true;
}

// Returns the edits that may reach an area, each once, for which `is_wanted`(edit). A cell
// with `lacks`(cell, its area) has none of them.
template <class Lacks, class IsWanted>
std::vector<const GroundEdit*> pieces_in(const Cell* cell, const Area& area, double block_m,
                                         const Lacks& lacks, const IsWanted& is_wanted) {
  std::vector<const GroundEdit*> pieces;
  each_edit(cell, area, lacks, [&](const GroundEdit& edit) {
    if (is_wanted(edit) && area_of(edit, edit.reach_m(), block_m).touches(area))
      pieces.push_back(&edit);
  });
  std::ranges::sort(pieces);  // a piece is listed in several cells
  pieces.erase(std::unique(pieces.begin(), pieces.end()), pieces.end());
  return pieces;
}

// Returns the largest sum of successive edits on a path from `cell` down, within an area.
GroundCell::Summary max_in(const Cell* cell, const Area& area, double block_m) {
  GroundCell::Summary most;
  if (cell == nullptr) return most;
  const Area own = area_of(cell->place);
  if (!own.touches(area)) return most;
  if (area.holds(own)) return cell->summary;
  if (cell->value) {
    for (const EditPtr& edit : cell->value->edits) {
      if (!area_of(*edit, edit->reach_m(), block_m).touches(area)) continue;
      most.change_m += edit->max_m;
      most.steepness += steepness_of(*edit);
    }
  }
  for (const auto& quarter : cell->quarters)
    most.add(max_in(quarter.get(), area, block_m));
  return most;
}

// Time that a mask takes for a height without the guide, in the same units as its edit. Measured.
double weight_of(const GroundMask& mask) {
  return (mask.picture ? 3 : 0) + (mask.noise_m > 0 ? 14 : 0) + (mask.reads_guide() ? 2 : 0) +
         (mask.slope.is_limited() ? 1 : 0);
}

double guide_reads_of(const GroundEdit& edit) {
  return edit.mask ? edit.mask->guide_reads() : 0;
}

// Time that an edit takes for a height, in units of a simple edit. Measured.
double weight_of(const GroundEdit& edit) {
  std::size_t segments = 0;
  if (edit.road) segments = edit.road->segments.size();
  if (edit.river) segments = edit.river->points.size() + edit.river->near.size();
  if (edit.lake) segments = edit.lake->segments.size();
  if (segments > 0) return 1 + 0.5 * static_cast<double>(segments);
  const double weight = is_stamp(edit.change) ? 3 : 1;
  return edit.mask ? weight + weight_of(*edit.mask) : weight;
}

// Adds the weighted areas of edits within an area to `sum`, in blocks².
void add_work_in(const Cell* cell, const Area& area, double block_m, HeightWork& sum) {
  if (cell == nullptr) return;
  const Area own = area_of(cell->place);
  if (!own.touches(area)) return;
  if (area.holds(own)) {
    sum.edits += cell->summary.work_m2 / (block_m * block_m);
    sum.guide_reads += cell->summary.guide_m2 / (block_m * block_m);
    return;
  }
  if (cell->value) {
    const Area part = own.common(area);
    for (const EditPtr& edit : cell->value->edits) {
      const double size = area_of(*edit, edit->reach_m(), block_m).common(part).size();
      sum.edits += weight_of(*edit) * size;
      sum.guide_reads += guide_reads_of(*edit) * size;
    }
  }
  for (const auto& quarter : cell->quarters)
    add_work_in(quarter.get(), area, block_m, sum);
}

}  // namespace

void seal(GroundEdit& edit) {
  edit.content = content_hash(edit);
  edit.max_m = max_of(edit);
}

void GroundCell::Summary::add(const Summary& quarter) {
  below_change_m = std::max(below_change_m, quarter.change_m + quarter.below_change_m);
  below_steepness = std::max(below_steepness, quarter.steepness + quarter.below_steepness);
  work_m2 += quarter.work_m2;
  guide_m2 += quarter.guide_m2;
  has_roads = has_roads || quarter.has_roads;
  has_water = has_water || quarter.has_water;
}

std::uint64_t GroundCell::hash() const {
  std::uint64_t hash = 0x9C311;
  for (const EditPtr& edit : edits)
    hash = core::combine(hash, edit->content);
  return hash;
}

GroundCell::Summary GroundCell::summary() const {
  Summary sum;
  for (const EditPtr& edit : edits) {
    sum.change_m += edit->max_m;
    sum.steepness += steepness_of(*edit);
    const double area_m2 = 4 * edit->reach_m() * edit->reach_m();
    sum.work_m2 += weight_of(*edit) * area_m2;
    sum.guide_m2 += guide_reads_of(*edit) * area_m2;
    sum.has_roads = sum.has_roads || edit->road != nullptr;
    sum.has_water = sum.has_water || is_water(edit->change);
  }
  return sum;
}

bool GroundEdits::add(const EditPtr& edit, double block_m) {
  bool full = false;
  each_place(*edit, block_m, [&](const QuadCoord& place) {
    const GroundCell* cell = cells_.find(place);
    full = full || (cell != nullptr && cell->edits.size() >= kMaxTogether);
  });
  if (full) return false;
  each_place(*edit, block_m, [&](const QuadCoord& place) {
    const GroundCell* before = cells_.find(place);
    GroundCell cell = before != nullptr ? *before : GroundCell{};
    const auto at = std::ranges::upper_bound(cell.edits, edit->order(), {}, &GroundEdit::order);
    cell.edits.insert(at, edit);
    cells_.set(place, std::move(cell));
  });
  return true;
}

void GroundEdits::remove(const GroundEdit& edit, double block_m) {
  each_place(edit, block_m, [&](const QuadCoord& place) {
    const GroundCell* before = cells_.find(place);
    if (before == nullptr) return;
    GroundCell cell = *before;
    std::erase_if(cell.edits, [&](const EditPtr& e) { return e->order() == edit.order(); });
    cells_.set(place, std::move(cell));
  });
}

std::uint64_t GroundEdits::hash_of(const QuadCoord& node, double margin, double block_m,
                                   std::uint64_t below) const {
  std::uint64_t hash = below;
  const Area area = area_of(node, margin);
  const auto takes_whole = [&](const Cell& cell, const Area& own) {
    const bool whole = static_cast<int>(cell.place.level) <= whole_level(node) || area.holds(own);
    if (whole) hash = core::combine(hash, cell.hash);
    return whole;
  };
  each_edit(cells_.root(), area, takes_whole, [&](const GroundEdit& edit) {
    if (area_of(edit, kInfluence * edit.reach_m(), block_m).touches(area))
      hash = core::combine(hash, edit.content);
  });
  return hash;
}

bool GroundEdits::same_in(const GroundEdits& a, const GroundEdits& b, const QuadCoord& node,
                          double margin) {
  return same(a.cells_.root(), b.cells_.root(), area_of(node, margin), whole_level(node));
}

bool GroundEdits::reaches(const QuadCoord& node, double block_m) const {
  const Area area = area_of(node);
  bool any = false;
  const auto takes_whole = [&](const Cell&, const Area& own) {
    any = any || area.holds(own);
    return any;
  };
  each_edit(cells_.root(), area, takes_whole, [&](const GroundEdit& edit) {
    any = any || area_of(edit, edit.reach_m(), block_m).touches(area);
  });
  return any;
}

std::vector<const GroundEdit*> GroundEdits::roads_in(const QuadCoord& node, double block_m,
                                                     double margin) const {
  const auto lacks_roads = [](const Cell& cell, const Area&) { return !cell.summary.has_roads; };
  return pieces_in(cells_.root(), area_of(node, margin), block_m, lacks_roads,
                   [](const GroundEdit& edit) { return edit.road != nullptr; });
}

std::vector<const GroundEdit*> GroundEdits::water_in(const QuadCoord& node, double block_m,
                                                     double margin) const {
  const auto is_dry = [](const Cell& cell, const Area&) { return !cell.summary.has_water; };
  return pieces_in(cells_.root(), area_of(node, margin), block_m, is_dry,
                   [](const GroundEdit& edit) { return is_water(edit.change); });
}

std::optional<BodySurface> GroundEdits::water_over(core::BlockCoord block, glm::dvec2 local_m,
                                                   double block_m) const {
  if (!has_water()) return std::nullopt;
  const QuadCoord place = QuadCoord::of(block);
  const double x = static_cast<double>(place.x) + local_m.x / block_m;
  const double z = static_cast<double>(place.z) + local_m.y / block_m;
  std::optional<BodySurface> owner;
  const auto is_dry = [](const Cell& cell, const Area&) { return !cell.summary.has_water; };
  each_edit(cells_.root(), {x, z, x, z}, is_dry, [&](const GroundEdit& edit) {
    if (!is_water(edit.change) || !area_of(edit, edit.reach_m(), block_m).touches({x, z, x, z}))
      return;
    const glm::dvec2 place_m = from_origin_m(edit.origin(), block, local_m, block_m);
    const auto water =
        edit.river ? surface_of(*edit.river, place_m) : surface_of(*edit.lake, place_m);
    if (water && (!owner || water->owns_before(*owner))) owner = water;
  });
  return owner;
}

GroundEdits::Change GroundEdits::max_change_in(const QuadCoord& node, double block_m) const {
  const GroundCell::Summary most = max_in(cells_.root(), area_of(node), block_m);
  return {double{most.change_m} + double{most.below_change_m},
          double{most.steepness} + double{most.below_steepness}};
}

HeightWork GroundEdits::work_per_height(const GroundScale& scale, LatticeSpan x,
                                        LatticeSpan z) const {
  const auto block = [&scale](std::int64_t vertex) {
    return static_cast<double>(vertex) / static_cast<double>(scale.cells_per_block) + 0x1.0p31;
  };
  const Area area{block(x.first), block(z.first), block(x.last), block(z.last)};
  HeightWork work;
  if (!(area.size() > 0)) return work;
  add_work_in(cells_.root(), area, scale.block_m(), work);
  work.edits /= area.size();
  // Masks over the same places share what they read.
  work.guide_reads = std::min(work.guide_reads / area.size(), double{GroundMask::kMaxGuideReads});
  return work;
}

}  // namespace psygen::models
