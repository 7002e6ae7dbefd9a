// Plays by itself: finds its way to the next cairn, gathers, builds, fells, sleeps, jumps, swims
// and glides. It sees what a player sees and says what a player would (Intent); the game does not
// know that it is there. The end-to-end test of the game and its frame test are its. Deterministic.
#pragma once

#include <optional>
#include <vector>

#include "engine/query/path_finder.hpp"
#include "game/play/play.hpp"

namespace cairns {

class Pilot {
 public:
  // `play` outlives it.
  explicit Pilot(Play& play) : play_(&play), finder_(play.query()) {}
  // What to do in the next step of `dt` seconds.
  Intent steer(double dt);

 private:
  void plan();
  void look_for_path();
  void follow_path(Intent& intent, double dt);
  void free_itself(Intent& intent, double dt);
  bool work(Intent& intent, double dt);
  bool fetch_wood(Intent& intent, double dt);
  void walk_to(Intent& intent, const core::WorldPosition& at, double dt) const;
  bool is_over_drop() const;

  Play* play_;
  query::PathFinder finder_;
  std::vector<core::WorldPosition> path_;
  std::size_t next_ = 0, seen_next_ = 0;  // points of the path: that it goes to; the same before
  std::size_t goal_ = kCairns;
  double still_s_ = 0, plan_s_ = 0, free_s_ = 0, aside_ = 1, glide_s_ = 0;
  double time_s_ = 0, built_s_ = 0, lit_s_ = -1e9;
  bool was_gliding_ = false;
  std::optional<core::WorldPosition> tree_;  // that it wants to fell
  double fetched_s_ = 0;                     // when it last began with that
};

}  // namespace cairns
