// The autopilot: finds a path to the next cairn, gathers, builds, fells, sleeps, jumps, swims and
// glides. It reads what a player sees and answers with an Intent; the game cannot tell it from a
// player. It drives the end-to-end test and the frame test of the game. Deterministic.
#pragma once

#include <optional>
#include <vector>

#include "engine/query/path_finder.hpp"
#include "game/play/play.hpp"

namespace cairns {

class Pilot {
 public:
  // `play` must outlive the pilot.
  explicit Pilot(Play& play) : play_(&play), finder_(play.query()) {}
  // Returns the intent for the next step of `dt` seconds.
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
  std::size_t next_ = 0, seen_next_ = 0;  // target point of the path, now and in the last step
  std::size_t goal_ = kCairns;
  double still_s_ = 0, plan_s_ = 0, free_s_ = 0, aside_ = 1, glide_s_ = 0;
  double time_s_ = 0, built_s_ = 0, lit_s_ = -1e9;
  bool was_gliding_ = false;
  std::optional<core::WorldPosition> tree_;  // the tree to fell
  double fetched_s_ = 0;                     // time when the last search for wood began
};

}  // namespace cairns
