#include "game/pilot/pilot.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace cairns {
namespace {

constexpr double kReachedM = 2.5, kLookAheadM = 2.6, kLostM = 12, kPlanS = 45;
constexpr double kStillS = 1.4, kFreeS = 1.1;
constexpr double kTurn = 4;  // rad/s
constexpr double kBuildEveryS = 150, kFetchEveryS = 140, kGiveUpS = 12, kTreeM = 30;
constexpr double kGlideAheadM = 22,
                 kLandM = 30;  // look-ahead in the air; distance at which it lands
constexpr double kDropM = 3.5, kDropAheadM = 7, kGlideAtLeastS = 1.5;
constexpr double kRaftCost = 1.1;  // path cost of water with the raft
constexpr std::size_t kCellsAStep = 500;

}  // namespace

// Starts a path search from the current position. The player waits until it ends.
void Pilot::plan() {
  path_.clear();
  const auto next = play_->next_cairn();
  if (!next || (finder_.is_searching() && goal_ == *next)) return;
  goal_ = *next;
  if (has(play_->abilities(), Ability::kRaft)) finder_.settings().swim_cost = kRaftCost;
  finder_.begin(play_->walker().feet(), play_->route().cairns[goal_]);
  plan_s_ = 0;
}

void Pilot::look_for_path() {
  auto found = finder_.advance(kCellsAStep);
  if (!found) return;
  path_ = std::move(*found);
  next_ = 0;
}

// Returns true if the ground drops away ahead.
bool Pilot::is_over_drop() const {
  const Walker& walker = play_->walker();
  const core::WorldPosition ahead = position_at_offset(
      walker.feet(), kDropAheadM * glm::dvec3(std::sin(walker.yaw()), 0, -std::cos(walker.yaw())),
      play_->block_m());
  const auto ground = play_->query().ground(ahead);
  return ground && walker.feet().local.y - ground->height_m > kDropM;
}

// Turns towards a position and runs there.
void Pilot::walk_to(Intent& intent, const core::WorldPosition& at, double dt) const {
  const Walker& walker = play_->walker();
  const glm::dvec3 way = way_m(walker.feet(), at, play_->block_m());
  const double wanted = std::atan2(way.x, -way.z);
  const double turn = std::remainder(wanted - walker.yaw(), 2 * std::numbers::pi);
  intent.turn = std::clamp(turn, -kTurn * dt, kTurn * dt);
  intent.look = std::clamp(-0.06 - walker.pitch(), -dt, dt);
  if (std::abs(turn) < 1.2) intent.move.y = 1;
  intent.run = true;
}

void Pilot::follow_path(Intent& intent, double dt) {
  const Walker& walker = play_->walker();
  const double block_m = play_->block_m();
  const bool glides = walker.gait() == Gait::kGlide;
  const double ahead_m = glides ? kGlideAheadM : kLookAheadM;
  while (next_ + 1 < path_.size() && distance_m(walker.feet(), path_[next_], block_m) < ahead_m)
    ++next_;
  walk_to(intent, path_[next_], dt);
  const double far_m = distance_m(walker.feet(), path_[next_], block_m);
  if (far_m > kLostM && !glides) plan_s_ += 10 * dt;
  // Leaps from an edge, and glides as long as that leads to the goal.
  const bool sail = has(play_->abilities(), Ability::kSail) &&
                    distance_m(walker.feet(), path_.back(), block_m) > kLandM;
  if (sail && walker.gait() == Gait::kGround && std::abs(intent.turn) < 0.3 * dt * kTurn &&
      is_over_drop()) {
    intent.jump = true;
    glide_s_ = kGlideAtLeastS;
  }
  glide_s_ =
      sail && glides && is_over_drop() ? std::max(glide_s_, 0.3) : std::max(glide_s_ - dt, 0.0);
  intent.jump_held = intent.jump || (sail && glide_s_ > 0);
  if (was_gliding_ && walker.gait() == Gait::kGround) plan();  // gliding may have left the path
  was_gliding_ = glides || (was_gliding_ && walker.gait() == Gait::kAir);
}

// Gets past an obstacle: jumps, steps aside, and finally searches another path.
void Pilot::free_itself(Intent& intent, double dt) {
  const bool moves_on = next_ != seen_next_ || play_->walker().gait() == Gait::kGlide;
  seen_next_ = next_;
  still_s_ = moves_on ? 0 : still_s_ + dt;
  if (still_s_ > kStillS && free_s_ <= 0) {
    free_s_ = kFreeS;
    aside_ = -aside_;
    if (still_s_ > 3 * kStillS) {
      if (next_ < path_.size()) finder_.avoid(path_[next_]);
      plan();
      still_s_ = 0;
    }
  }
  if (free_s_ <= 0) return;
  free_s_ -= dt;
  const bool back = free_s_ > 0.6 * kFreeS;
  intent.move = {aside_, back ? -0.6 : 0.7};
  intent.jump = back && free_s_ - dt <= 0.6 * kFreeS;
  intent.jump_held = !back;
}

// Walks to a nearby tree and fells it. Returns true while that takes all of the step.
bool Pilot::fetch_wood(Intent& intent, double dt) {
  const Walker& walker = play_->walker();
  if (!tree_ && !finder_.is_searching() && walker.gait() == Gait::kGround &&
      play_->progress().stock.wood < kWoodOfFire && time_s_ - fetched_s_ > kFetchEveryS) {
    fetched_s_ = time_s_;
    const models::Registry& types = play_->registry();
    std::vector<models::ModelIndex> trees;
    for (models::ModelIndex i = 0; i < types.size(); ++i) {
      if (types[i].surface() == core::SurfaceKind::kBark) trees.push_back(i);
    }
    const auto near = play_->query().nearest(walker.feet(), kTreeM, trees);
    if (near && *near) tree_ = (*near)->position;
  }
  if (!tree_) return false;
  const bool there = play_->target().kind == Target::Kind::kTree;
  if (!there) walk_to(intent, *tree_, dt);
  intent.use_held = there;
  if (time_s_ - fetched_s_ > kGiveUpS || play_->progress().stock.wood >= kWoodOfFire) {
    tree_.reset();
    plan();
  }
  return true;
}

// Gathers, builds, sleeps and fetches wood. Returns true while that takes all of the step.
bool Pilot::work(Intent& intent, double dt) {
  const Target& target = play_->target();
  const Progress& progress = play_->progress();
  if (target.kind == Target::Kind::kStone && progress.stock.stones < kStonesOfCairn)
    intent.use = true;
  if (progress.stock.stones >= kStonesOfCairn && time_s_ - built_s_ > kBuildEveryS &&
      play_->walker().gait() == Gait::kGround) {
    built_s_ = time_s_;
    intent.build = true;
  }
  const bool sleepy = play_->is_night() && play_->walker().gait() == Gait::kGround;
  if (sleepy && play_->fire_near(4) != nullptr) {
    intent.sleep = true;
  } else if (sleepy && progress.stock.wood >= kWoodOfFire && time_s_ - lit_s_ > kGiveUpS) {
    lit_s_ = time_s_;
    intent.fire = true;
  }
  if (play_->is_night() && !progress.lantern) intent.lantern = true;
  return fetch_wood(intent, dt);
}

Intent Pilot::steer(double dt) {
  time_s_ += dt;
  plan_s_ += dt;
  Intent intent;
  if (play_->is_finished()) return intent;
  if (goal_ != play_->next_cairn() || plan_s_ > kPlanS) plan();
  look_for_path();
  if (work(intent, dt) || path_.empty()) return intent;
  follow_path(intent, dt);
  free_itself(intent, dt);
  return intent;
}

}  // namespace cairns
