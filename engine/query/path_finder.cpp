#include "engine/query/path_finder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <unordered_map>
#include <utility>

namespace psygen::query {
namespace ways {  // named, because PathFinder::Search has members of these types

constexpr float kMinUp = 0.72F;  // y of the normal of walkable ground …
constexpr double kGentle = 0.3;  // … unless the path leads down
constexpr double kNoWay = std::numeric_limits<double>::infinity();

struct Cell {
  std::int64_t x = 0, z = 0;
  friend bool operator==(const Cell&, const Cell&) = default;
};

// Cells 2^32 apart along an axis share a name; no search reaches both.
std::uint64_t name_of(Cell c) {
  return std::uint64_t{static_cast<std::uint32_t>(c.x)} << 32 | static_cast<std::uint32_t>(c.z);
}

// Returns the cell at metres from the corner of block (0, 0).
Cell cell_at(double x_m, double z_m) {
  const auto number = [](double m) {
    return static_cast<std::int64_t>(std::floor(m / PathFinder::kCellM));
  };
  return {number(x_m), number(z_m)};
}
Cell cell_at(const core::WorldPosition& at, double block_m) {
  const glm::dvec3 m = core::offset_m(at.block, {}, block_m) + at.local;
  return cell_at(m.x, m.z);
}

double apart_m(Cell a, Cell b) {
  return PathFinder::kCellM *
         std::hypot(static_cast<double>(a.x - b.x), static_cast<double>(a.z - b.z));
}

}  // namespace ways

using namespace ways;

// One search between two positions.
class PathFinder::Search {
 public:
  Search(const PathFinder& finder, const core::WorldPosition& from, const core::WorldPosition& to,
         bool solids)
      : query_(*finder.query_),
        settings_(finder.settings_),
        avoided_(finder.avoided_),
        start_(from),
        end_(to),
        solids_(solids) {
    const double block_m = query_.world().block_size_m();
    if (!checked(from, block_m) || !checked(to, block_m)) return;
    is_sound_ = true;
    to_ = cell_at(to, block_m);
    best_ = cell_at(from, block_m);
    open(best_, 0, best_);
  }

  // Expands up to this many cells. Returns true if the search has ended.
  bool run(std::size_t cells) {
    for (std::size_t i = 0; i < cells; ++i) {
      if (open_.empty() || nodes_.size() >= settings_.max_cells) return true;
      const Open next = open_.top();
      open_.pop();
      Node& node = nodes_[name_of(next.cell)];
      if (node.closed) continue;
      node.closed = true;
      const double rest = estimate(next.cell);
      if (rest < best_rest_) {
        best_rest_ = rest;
        best_ = next.cell;
      }
      if (next.cell == to_) return true;
      visit_neighbours(next.cell);
    }
    return false;
  }

  bool has_arrived() const { return is_sound_ && best_ == to_; }
  const core::WorldPosition& start() const { return start_; }
  const core::WorldPosition& end() const { return end_; }

  // Returns the path to the reached cell that is nearest to the destination.
  std::vector<core::WorldPosition> way() {
    std::vector<core::WorldPosition> points{start_};
    if (!is_sound_) return points;
    for (const Cell c : trace()) {
      points.push_back(middle(c));
      points.back().local.y = ground(c).height_m;
    }
    points.erase(points.begin() + 1);  // the cell of the start
    if (has_arrived()) points.push_back(end_);
    return points;
  }

 private:
  struct Node {
    Cell from;
    double cost = kNoWay;
    bool closed = false;
  };
  struct Ground {
    double height_m = 0, depth_m = 0, flow_m_s = 0;
    float up = 1;  // of the normal
    bool exists = false;
  };
  struct Open {
    double total;
    Cell cell;
    bool operator<(const Open& other) const {
      if (total != other.total) return total > other.total;
      return name_of(cell) > name_of(other.cell);
    }
  };

  core::WorldPosition middle(Cell c) const {
    return core::normalised({{}, {middle_m(c.x), 0, middle_m(c.z)}}, query_.world().block_size_m());
  }
  static double middle_m(std::int64_t index) {
    return (static_cast<double>(index) + 0.5) * PathFinder::kCellM;
  }
  // True if the cell lies before the world's ends, and before the seam of an endless one.
  bool is_inside(Cell c) const {
    const auto along = [&](std::int64_t index, std::int64_t blocks) {
      const auto [first, end] = world::World::ends(blocks);
      const double at = middle_m(index) / query_.world().block_size_m();
      return at >= static_cast<double>(first) && at < static_cast<double>(end);
    };
    return along(c.x, query_.world().blocks_x) && along(c.z, query_.world().blocks_z);
  }

  double estimate(Cell c) const { return apart_m(c, to_); }

  const Ground& ground(Cell c) {
    const auto [it, is_new] = grounds_.try_emplace(name_of(c));
    if (is_new && is_inside(c)) {
      const auto found = query_.ground(middle(c));
      if (found)
        it->second = {.height_m = found->height_m,
                      .depth_m = found->water_depth_m,
                      .flow_m_s = found->water == world::kNoWater ? 0 : flow_m_s(c),
                      .up = found->normal.y,
                      .exists = true};
    }
    return it->second;
  }

  double flow_m_s(Cell c) {
    const auto water = query_.water(middle(c));
    if (!water) return 0;
    const glm::dvec2 flow(water->flow_m_s);
    return std::sqrt(flow.x * flow.x + flow.y * flow.y);
  }

  // True if a tree or a boulder is in the cell.
  bool is_narrow(Cell c) {
    const core::BlockCoord block = middle(c).block;
    if (blocks_.insert(name_of({block.x, block.z})).second) {
      const glm::dvec3 corner = core::offset_m(block, {}, query_.world().block_size_m());
      for (const core::Bounds& box : query_.solids(block).boxes) {
        if (box.max.y - box.min.y > settings_.step_m) mark(box, corner);
      }
    }
    return narrow_.contains(name_of(c));
  }

  void mark(const core::Bounds& box, const glm::dvec3& corner) {
    const glm::dvec3 low = corner + glm::dvec3(box.min) - settings_.aside_m;
    const glm::dvec3 high = corner + glm::dvec3(box.max) + settings_.aside_m;
    const Cell first = cell_at(low.x, low.z), last = cell_at(high.x, high.z);
    for (std::int64_t z = first.z; z <= last.z; ++z) {
      for (std::int64_t x = first.x; x <= last.x; ++x)
        narrow_.insert(name_of({x, z}));
    }
  }

  // Cost of a step between neighbours; infinite if it is impossible.
  double cost(Cell a, Cell b) {
    const Ground from = ground(a), to = ground(b);
    if (!to.exists || (avoided_.contains(name_of(b)) && b != to_)) return kNoWay;
    double run = apart_m(a, b);
    // In deep water, the walker moves at the surface.
    const auto level_m = [&](const Ground& g) {
      return g.height_m + std::max(g.depth_m - settings_.wade_m, 0.0);
    };
    const double slope = (level_m(to) - level_m(from)) / run;
    if (slope > settings_.steepest_up || slope < -settings_.steepest_down) return kNoWay;
    if (to.depth_m > settings_.knee_m && to.flow_m_s > settings_.fastest_m_s) return kNoWay;
    if (to.depth_m > settings_.wade_m) return settings_.swims ? run * settings_.swim_cost : kNoWay;
    if (to.up < kMinUp && slope > -kGentle) return kNoWay;
    if (to.depth_m > 0) run *= settings_.wade_cost;
    if (solids_ && is_narrow(b)) run *= settings_.narrow_cost;
    return run * (1 + 3 * slope * slope + (slope > 0 ? slope : 0));
  }

  void open(Cell c, double cost, Cell from) {
    Node& node = nodes_[name_of(c)];
    if (cost >= node.cost) return;
    node.cost = cost;
    node.from = from;
    open_.push({cost + estimate(c), c});
  }

  void visit_neighbours(Cell c) {
    const double so_far = nodes_[name_of(c)].cost;
    for (int z = -1; z <= 1; ++z) {
      for (int x = -1; x <= 1; ++x) {
        if (x == 0 && z == 0) continue;
        const Cell there{c.x + x, c.z + z};
        if (nodes_[name_of(there)].closed) continue;
        const double step = cost(c, there);
        if (step < kNoWay) open(there, so_far + step, c);
      }
    }
  }

  std::vector<Cell> trace() {
    std::vector<Cell> cells{best_};
    while (true) {
      const Cell from = nodes_[name_of(cells.back())].from;
      if (from == cells.back()) break;
      cells.push_back(from);
    }
    std::ranges::reverse(cells);
    return cells;
  }

  World& query_;
  PathSettings settings_;
  std::unordered_set<std::uint64_t> avoided_;
  core::WorldPosition start_, end_;
  Cell to_, best_;
  bool solids_, is_sound_ = false;
  double best_rest_ = kNoWay;
  std::unordered_map<std::uint64_t, Node> nodes_;
  std::unordered_map<std::uint64_t, Ground> grounds_;
  std::unordered_set<std::uint64_t> blocks_,
      narrow_;  // blocks whose solids were visited; cells with solids
  std::priority_queue<Open> open_;
};

PathFinder::PathFinder(World& query, const PathSettings& settings)
    : query_(&query),
      revision_(query.world().revision.number),
      block_m_(query.world().block_size_m()),
      settings_(settings) {}
PathFinder::~PathFinder() = default;
PathFinder::PathFinder(PathFinder&&) noexcept = default;
PathFinder& PathFinder::operator=(PathFinder&&) noexcept = default;

void PathFinder::follow_world() {
  const world::World& world = query_->world();
  if (world.revision.number == revision_) return;
  revision_ = world.revision.number;
  avoided_.clear();
  const double before_m = std::exchange(block_m_, world.block_size_m());
  if (search_)
    search_ = std::make_unique<Search>(*this, world::rebased(search_->start(), before_m, block_m_),
                                       world::rebased(search_->end(), before_m, block_m_), true);
}

void PathFinder::avoid(const core::WorldPosition& at) {
  follow_world();
  const double block_m = query_->world().block_size_m();
  if (!checked(at, block_m)) return;
  const Cell middle = cell_at(at, block_m);
  for (std::int32_t z = -1; z <= 1; ++z) {
    for (std::int32_t x = -1; x <= 1; ++x)
      avoided_.insert(name_of({middle.x + x, middle.z + z}));
  }
}

bool PathFinder::reaches(const core::WorldPosition& from, const core::WorldPosition& to) {
  follow_world();
  Search search(*this, from, to, false);
  search.run(SIZE_MAX);
  return search.has_arrived();
}

std::vector<core::WorldPosition> PathFinder::find(const core::WorldPosition& from,
                                                  const core::WorldPosition& to) {
  follow_world();
  Search search(*this, from, to, true);
  search.run(SIZE_MAX);
  return search.way();
}

void PathFinder::begin(const core::WorldPosition& from, const core::WorldPosition& to) {
  follow_world();
  search_ = std::make_unique<Search>(*this, from, to, true);
}

std::optional<std::vector<core::WorldPosition>> PathFinder::advance(std::size_t cells) {
  follow_world();
  if (!search_ || !search_->run(cells)) return std::nullopt;
  return std::exchange(search_, nullptr)->way();
}

}  // namespace psygen::query
