#include "engine/models/terrain/ground_edits.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace psygen::models {
namespace {

using Cell = QuadMap<GroundCell>::Cell;
using EditPtr = std::shared_ptr<const GroundEdit>;

// The steepest slope of the curve by which edits fade out.
constexpr double kSteepest = 1.5;
// Cells this many levels below a node's are taken as a whole where they touch its margin.
constexpr int kMarginLevels = 4;

// A rectangle in blocks from block −2^31.
struct Area {
  double x0, z0, x1, z1;
  bool touches(const Area& o) const { return x0 <= o.x1 && o.x0 <= x1 && z0 <= o.z1 && o.z0 <= z1; }
  bool holds(const Area& o) const { return x0 <= o.x0 && o.x1 <= x1 && z0 <= o.z0 && o.z1 <= z1; }
};

Area area_of(const QuadPlace& place, double margin = 0) {
  const double side = std::ldexp(1.0, static_cast<int>(place.level));
  const double x = static_cast<double>(place.x) * side, z = static_cast<double>(place.z) * side;
  return {x - margin, z - margin, x + side + margin, z + side + margin};
}

Area area_of(const GroundEdit& edit, double reach_m, double block_m) {
  const QuadPlace block = QuadPlace::of(edit.centre.block);
  const double x = static_cast<double>(block.x) + edit.centre.local.x / block_m;
  const double z = static_cast<double>(block.z) + edit.centre.local.z / block_m;
  const double reach = reach_m / block_m;
  return {x - reach, z - reach, x + reach, z + reach};
}

// visit(place) for the at most four squares that list an edit: as large as its influence, with some
// room for rounding.
template <class Visit>
void each_place(const GroundEdit& edit, double block_m, const Visit& visit) {
  const double reach_m = GroundEdits::kInfluence * edit.radius_m + 1e-3 * block_m;
  const Area area = area_of(edit, reach_m, block_m);
  std::uint32_t level = 0;
  while (level < QuadPlace::kMaxLevel &&
         std::ldexp(1.0, static_cast<int>(level)) < area.x1 - area.x0)
    ++level;
  const auto square = [level](double block) {
    constexpr double kLast = 4294967295.0;
    return static_cast<std::uint64_t>(std::clamp(std::floor(block), 0.0, kLast)) >> level;
  };
  for (std::uint64_t z = square(area.z0); z <= square(area.z1); ++z) {
    for (std::uint64_t x = square(area.x0); x <= square(area.x1); ++x)
      visit(QuadPlace{level, x, z});
  }
}

float change_of(const GroundEdit& edit) {
  switch (edit.change) {
    case GroundChange::kRaise:
      return static_cast<float>(std::abs(edit.height_m));
    case GroundChange::kStampAdd: {
      float most = 0;
      for (const float h : edit.map->heights_m)
        most = std::max(most, std::abs(h));
      return most;
    }
    default:
      return 1e30F;  // depends on the ground; the relief limits it
  }
}

float steepness_of(const GroundEdit& edit, float change_m) {
  double slope = kSteepest / std::max(edit.falloff * edit.radius_m, 1e-6);
  if (edit.map) {
    const double points = std::max(edit.map->columns, edit.map->rows);
    slope += points / edit.radius_m;
  }
  return std::min(change_m, 1e6F) * static_cast<float>(slope);
}

// The weight of an edit at a distance from its centre: smooth from 1 to 0.
double weight_of(const GroundEdit& edit, double dx, double dz) {
  const double away =
      edit.square ? std::max(std::abs(dx), std::abs(dz)) : std::sqrt(dx * dx + dz * dz);
  if (!(away <= edit.radius_m)) return 0;
  const double fades = edit.falloff * edit.radius_m;
  const double left = edit.radius_m - away;
  if (left >= fades) return 1;
  const double t = left / fades;
  return t * t * (3 - 2 * t);
}

double height_in(const Heightmap& map, double u, double v) {
  const auto place = [](double share, std::uint32_t points) {
    const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(points - 1);
    const double first = std::min(std::floor(at), static_cast<double>(points - 2));
    return std::pair{static_cast<std::size_t>(first), at - first};
  };
  const auto [x, s] = place(u, map.columns);
  const auto [z, t] = place(v, map.rows);
  const float* const near = &map.heights_m[z * map.columns + x];
  const float* const far = near + map.columns;
  const double a = double{near[0]} + s * (double{near[1]} - double{near[0]});
  const double b = double{far[0]} + s * (double{far[1]} - double{far[0]});
  return a + t * (b - a);
}

// A height of the ground, in metres, as an edit leaves it.
double edited(const GroundEdit& edit, double height_m, double dx, double dz) {
  const double weight = weight_of(edit, dx, dz);
  const auto stamp = [&] {
    return height_in(*edit.map, 0.5 + 0.5 * dx / edit.radius_m, 0.5 + 0.5 * dz / edit.radius_m);
  };
  switch (edit.change) {
    case GroundChange::kRaise:
      return height_m + weight * edit.height_m;
    case GroundChange::kFlatten:
      return height_m + weight * (edit.height_m - height_m);
    case GroundChange::kStampAdd:
      return height_m + weight * stamp();
    case GroundChange::kStampSet:
      return height_m + weight * (stamp() - height_m);
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

  void walk(const Cell* cell, QuadPlace region, Range columns, Range rows) {
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
        const QuadPlace quarter = region.quarter(q);
        const Cell* below = itself ? cell->quarters[q].get()
                                   : (region.quarter_of(cell->place) == q ? cell : nullptr);
        walk(below, quarter, narrowed(x_, columns, quarter.x, quarter.level),
             narrowed(z_, rows, quarter.z, quarter.level));
      }
    }
    active_.resize(before);
  }

 private:
  // The samples of `range` that lie in a square.
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

  void act(Range columns, Range rows) {
    if (active_.empty()) return;
    ordered_ = active_;
    std::ranges::sort(ordered_, {}, &GroundEdit::id);
    for (const GroundEdit* edit : ordered_)
      act(*edit, columns, rows);
  }

  // Metres from the centre of an edit to a lattice point, along one axis. Exact in the same way for
  // every node that has the point.
  double away_m(std::int64_t at, std::int32_t block, double local_m) const {
    return static_cast<double>(at - std::int64_t{block} * scale_.cells_per_block) * scale_.cell_m -
           local_m;
  }

  void act(const GroundEdit& edit, Range columns, Range rows) {
    const core::WorldPosition& centre = edit.centre;
    for (std::size_t k = rows.first; k < rows.end; ++k) {
      const double dz = away_m(z_[k], centre.block.z, centre.local.z);
      if (std::abs(dz) > edit.radius_m) continue;
      for (std::size_t i = columns.first; i < columns.end; ++i) {
        const double dx = away_m(x_[i], centre.block.x, centre.local.x);
        if (std::abs(dx) > edit.radius_m) continue;
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
  std::vector<const GroundEdit*> active_, ordered_;
};

void add_hashes(const Cell* cell, const Area& area, int whole_level, double block_m,
                std::uint64_t& hash) {
  if (cell == nullptr) return;
  const Area own = area_of(cell->place);
  if (!own.touches(area)) return;
  if (static_cast<int>(cell->place.level) <= whole_level || area.holds(own)) {
    hash = core::combine(hash, cell->hash);
    return;
  }
  if (cell->value) {
    for (const EditPtr& edit : cell->value->edits) {
      const Area reach = area_of(*edit, GroundEdits::kInfluence * edit->radius_m, block_m);
      if (reach.touches(area)) hash = core::combine(hash, edit->content);
    }
  }
  for (const auto& quarter : cell->quarters)
    add_hashes(quarter.get(), area, whole_level, block_m, hash);
}

bool same(const Cell* a, const Cell* b, const Area& area) {
  if (a == b) return true;
  const auto outside = [&](const Cell* c) {
    return c == nullptr || !area_of(c->place).touches(area);
  };
  if (a == nullptr || b == nullptr || a->place != b->place) return outside(a) && outside(b);
  if (outside(a)) return true;
  if (a->value != b->value) return false;
  for (std::size_t q = 0; q < 4; ++q) {
    if (!same(a->quarters[q].get(), b->quarters[q].get(), area)) return false;
  }
  return true;
}

bool any_reaches(const Cell* cell, const Area& area, double block_m) {
  if (cell == nullptr) return false;
  const Area own = area_of(cell->place);
  if (!own.touches(area)) return false;
  if (area.holds(own)) return true;
  const auto reaches = [&](const EditPtr& edit) {
    return area_of(*edit, edit->radius_m, block_m).touches(area);
  };
  if (cell->value && std::ranges::any_of(cell->value->edits, reaches)) return true;
  return std::ranges::any_of(cell->quarters, [&](const auto& quarter) {
    return any_reaches(quarter.get(), area, block_m);
  });
}

// The most that edits change one after the other on a path from `cell` down, within an area.
GroundCell::Summary most_in(const Cell* cell, const Area& area, double block_m) {
  GroundCell::Summary most;
  if (cell == nullptr) return most;
  const Area own = area_of(cell->place);
  if (!own.touches(area)) return most;
  if (area.holds(own)) return cell->summary;
  if (cell->value) {
    for (const EditPtr& edit : cell->value->edits) {
      if (!area_of(*edit, edit->radius_m, block_m).touches(area)) continue;
      const float change_m = change_of(*edit);
      most.change_m += change_m;
      most.steepness += steepness_of(*edit, change_m);
    }
  }
  for (const auto& quarter : cell->quarters)
    most.add(most_in(quarter.get(), area, block_m));
  return most;
}

}  // namespace

std::uint64_t content_hash(const GroundEdit& edit) {
  std::uint64_t hash = 0x6D0E;
  const auto add = [&hash](double v) {
    hash = core::combine(hash, std::bit_cast<std::uint64_t>(v));
  };
  hash = core::combine(hash, static_cast<std::uint64_t>(edit.change) * 2 + (edit.square ? 1 : 0));
  hash = core::combine(
      hash, QuadPlace::of(edit.centre.block).x << 32 | QuadPlace::of(edit.centre.block).z);
  for (const double v :
       {edit.centre.local.x, edit.centre.local.z, edit.radius_m, edit.falloff, edit.height_m})
    add(v);
  if (edit.map) {
    hash = core::combine(hash, (std::uint64_t{edit.map->columns} << 32) | edit.map->rows);
    hash = core::combine(hash, core::hash_bytes(std::as_bytes(std::span(edit.map->heights_m))));
  }
  return hash;
}

void GroundCell::Summary::add(const Summary& quarter) {
  below_change_m = std::max(below_change_m, quarter.change_m + quarter.below_change_m);
  below_steepness = std::max(below_steepness, quarter.steepness + quarter.below_steepness);
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
    const float change_m = change_of(*edit);
    sum.change_m += change_m;
    sum.steepness += steepness_of(*edit, change_m);
  }
  return sum;
}

bool GroundEdits::add(const EditPtr& edit, double block_m) {
  bool full = false;
  each_place(*edit, block_m, [&](const QuadPlace& place) {
    const GroundCell* cell = cells_.find(place);
    full = full || (cell != nullptr && cell->edits.size() >= kMostTogether);
  });
  if (full) return false;
  each_place(*edit, block_m, [&](const QuadPlace& place) {
    const GroundCell* before = cells_.find(place);
    GroundCell cell = before != nullptr ? *before : GroundCell{};
    const auto at = std::ranges::upper_bound(cell.edits, edit->id, {}, &GroundEdit::id);
    cell.edits.insert(at, edit);
    cells_.set(place, std::move(cell));
  });
  return true;
}

void GroundEdits::remove(const GroundEdit& edit, double block_m) {
  each_place(edit, block_m, [&](const QuadPlace& place) {
    const GroundCell* before = cells_.find(place);
    if (before == nullptr) return;
    GroundCell cell = *before;
    std::erase_if(cell.edits, [&](const EditPtr& e) { return e->id == edit.id; });
    cells_.set(place, std::move(cell));
  });
}

std::uint64_t GroundEdits::hash_of(const QuadPlace& node, double margin, double block_m) const {
  std::uint64_t hash = 0;
  const int whole = static_cast<int>(node.level) - kMarginLevels;
  add_hashes(cells_.root(), area_of(node, margin), whole, block_m, hash);
  return hash;
}

bool GroundEdits::same_in(const GroundEdits& a, const GroundEdits& b, const QuadPlace& node,
                          double margin) {
  return same(a.cells_.root(), b.cells_.root(), area_of(node, margin));
}

bool GroundEdits::reaches(const QuadPlace& node, double block_m) const {
  return any_reaches(cells_.root(), area_of(node), block_m);
}

double GroundEdits::error_m(const QuadPlace& node, double spacing_m, double block_m) const {
  const GroundCell::Summary most = most_in(cells_.root(), area_of(node), block_m);
  const double change_m = double{most.change_m} + double{most.below_change_m};
  const double steepness = double{most.steepness} + double{most.below_steepness};
  return std::min(change_m, steepness * spacing_m);
}

void GroundEdits::apply(const GroundScale& scale, std::span<const std::int64_t> x,
                        std::span<const std::int64_t> z, std::span<float> values,
                        std::size_t stride, double narrowest_m) const {
  if (cells_.empty()) return;
  Application(scale, x, z, values, stride, narrowest_m)
      .walk(cells_.root(), {QuadPlace::kMaxLevel, 0, 0}, {0, x.size()}, {0, z.size()});
}

}  // namespace psygen::models
