// Ways over the land for whoever walks by code: A* on a grid that streams with it, whose cells ask
// the queries for their ground when they are first looked at. Knows slopes, water, and what is
// solid. Deterministic. One thread.
#pragma once

#include <unordered_set>
#include <vector>

#include "engine/query/world.hpp"
#include "game/play/land.hpp"

namespace cairns {

class PathFinder {
 public:
  static constexpr double kCellM = 2;
  static constexpr std::size_t kMostCells = 150'000;  // looked at for one path

  // `query` outlives it.
  explicit PathFinder(query::World& query) : query_(&query) {}

  // Points from `from` to `to`, both included, some metres apart. Where there is no way, or it is
  // too long to be found, towards the nearest point that was reached. `swim`: the cost of a metre
  // in deep water, over that of a metre of level ground.
  std::vector<core::WorldPosition> find(const core::WorldPosition& from,
                                        const core::WorldPosition& to, double swim);
  // Whether there is a way that can be found.
  bool reaches(const core::WorldPosition& from, const core::WorldPosition& to, double swim);
  // Leaves a place out from now on, with what is next to it.
  void avoid(const core::WorldPosition& at);

 private:
  query::World* query_;
  std::unordered_set<std::uint64_t> avoided_;
};

}  // namespace cairns
