// Finds paths over the ground for walkers that code controls: A* on a grid of cells, which query
// their ground when a search first visits them. It respects slopes, water and solid obstacles. It
// prepares and keeps nothing of the world except positions to avoid, so it works anywhere.
// Deterministic. One thread: the thread of its queries.
#pragma once

#include <memory>
#include <optional>
#include <unordered_set>
#include <vector>

#include "engine/query/world.hpp"

namespace psygen::query {

// Abilities of a walker.
struct PathSettings {
  double steepest_up = 0.8, steepest_down = 2.2;  // rise over run between cells; above 0
  double wade_m = 0.9;                            // the walker swims in deeper water
  double swim_cost = 2.5;  // cost of a metre in deep water, relative to a metre of level ground; >=
                           // 1
  bool swims = true;       // false: deeper water than wade_m is no way
  double fastest_m_s = 1.5;  // no way through faster currents, where deeper than knee_m
  double knee_m = 0.3;
  double wade_cost = 1;    // cost factor of water up to wade_m; >= 1
  double narrow_cost = 5;  // cost factor of cells with an obstacle; >= 1
  double step_m = 0.55;    // lower obstacles do not block
  double aside_m = 0.45;   // minimum distance to obstacles
  // The most cells that one search visits; some microseconds each.
  std::size_t max_cells = 150'000;
};

// Searches paths in the world of its queries. When that world is replaced (World::revision), a
// search in progress starts again and positions to avoid are forgotten. Movable; not copyable.
class PathFinder {
 public:
  static constexpr double kCellM = 2;

  // `query` must outlive the finder.
  explicit PathFinder(World& query, const PathSettings& settings = {});
  ~PathFinder();
  PathFinder(PathFinder&&) noexcept;
  PathFinder& operator=(PathFinder&&) noexcept;

  PathSettings& settings() { return settings_; }
  // Returns points on the ground from `from` to `to`, both included, a cell apart. If there is no
  // path, or the search visits max_cells without finding one, the path ends at the nearest reached
  // point. It has only `from` if a position is not finite or beyond World::kMaxLocalM. No path
  // crosses the seam of an endless world.
  std::vector<core::WorldPosition> find(const core::WorldPosition& from,
                                        const core::WorldPosition& to);
  // Like find(), but in slices for a game's steps. begin() starts a search, replaces one in
  // progress, and uses the current settings and avoided positions. advance() visits up to `cells`
  // more cells and returns the path once it is found; nothing before that, and without a search in
  // progress.
  void begin(const core::WorldPosition& from, const core::WorldPosition& to);
  std::optional<std::vector<core::WorldPosition>> advance(std::size_t cells);
  bool is_searching() const { return search_ != nullptr; }
  // Returns true if a path exists, obstacles ignored. Faster than find().
  bool reaches(const core::WorldPosition& from, const core::WorldPosition& to);
  // Makes later searches avoid the cell at `at` and its neighbours, because something blocks the
  // walker there. The cells where a search ends are never avoided.
  void avoid(const core::WorldPosition& at);

 private:
  class Search;
  void follow_world();

  World* query_;
  std::uint64_t revision_;  // of the world at the last call
  double block_m_;          // and its blocks
  PathSettings settings_;
  std::unordered_set<std::uint64_t> avoided_;
  std::unique_ptr<Search> search_;  // the search in progress
};

}  // namespace psygen::query
