// Ways over the land for whoever walks by code: A* on a grid that streams with it, whose cells ask
// the queries for their ground when a search first looks at them. Knows slopes, water, and what is
// solid. Nothing of the world is prepared or kept but places to avoid, so it works anywhere.
// Deterministic. One thread, that of its queries.
#pragma once

#include <memory>
#include <optional>
#include <unordered_set>
#include <vector>

#include "engine/query/world.hpp"

namespace psygen::query {

// What a walker can do.
struct PathSettings {
  double steepest_up = 0.8, steepest_down = 2.2;  // rise over run between cells; above 0
  double wade_m = 0.9;                            // deeper water is swum through
  double swim_cost = 2.5;  // of a metre in deep water, over that of a metre of level ground; >= 1
  double narrow_cost = 5;  // the same of cells with something solid in them; >= 1
  double step_m = 0.55;    // what is lower is stepped over
  double aside_m = 0.45;   // room that it needs beside what is solid
  // Cells that one search looks at, at most; some microseconds each.
  std::size_t max_cells = 150'000;
};

class PathFinder {
 public:
  static constexpr double kCellM = 2;

  // `query` outlives it.
  explicit PathFinder(World& query, const PathSettings& settings = {});
  ~PathFinder();
  PathFinder(PathFinder&&) noexcept;
  PathFinder& operator=(PathFinder&&) noexcept;

  PathSettings& settings() { return settings_; }
  // Points from `from` to `to`, both included, a cell apart, on the ground. Where there is no way,
  // or none was found within max_cells, to the nearest point that was reached. Positions are at
  // most 2^31 cells from the corner of block (0, 0).
  std::vector<core::WorldPosition> find(const core::WorldPosition& from,
                                        const core::WorldPosition& to);
  // The same, a piece in each step of a game. begin() starts a search, in place of one that goes
  // on, with the settings and the places to avoid of now. advance() looks at so many cells more,
  // and returns the way once it is found; nothing before that, and where no search goes on.
  void begin(const core::WorldPosition& from, const core::WorldPosition& to);
  std::optional<std::vector<core::WorldPosition>> advance(std::size_t cells);
  bool is_searching() const { return search_ != nullptr; }
  // Whether there is a way that can be found, whatever is solid on it. Faster than find().
  bool reaches(const core::WorldPosition& from, const core::WorldPosition& to);
  // Leaves a cell out from now on, with those next to it: something is in the way there. Places
  // where a search ends are never left out.
  void avoid(const core::WorldPosition& at);

 private:
  class Search;

  World* query_;
  PathSettings settings_;
  std::unordered_set<std::uint64_t> avoided_;
  std::unique_ptr<Search> search_;  // that goes on
};

}  // namespace psygen::query
