#include "game/play/creatures.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>

namespace cairns {
namespace {

constexpr double kCellM = 72, kNearM = 190, kFarM = 260;
constexpr std::size_t kMax = 320;
constexpr int kStepsBetween = 30;                   // steps between looks around
constexpr double kDeerSees = 14, kDeerHears = 3.2;  // m, and m per m/s of the player
constexpr double kDeerWalk = 0.7, kDeerRun = 9, kBirdPace = 8, kFishPace = 0.5, kFishFlees = 3.5;
constexpr double kCalmS = 6;  // seconds until fear has faded
constexpr core::Purpose kHabitat = core::Purpose::kPosition;

double yaw_of(const glm::dvec3& way) {
  return std::atan2(way.x, -way.z);
}

// Returns a random number of a creature, 0 to 1, that changes every `period_s` seconds.
double whim(const Creature& c, double time_s, double period_s) {
  const auto turn = static_cast<std::uint64_t>(time_s / period_s);
  return static_cast<double>(core::combine(c.seed, turn) >> 11) * 0x1.0p-53;
}

// Turns a creature the shorter way towards a yaw, by at most `most` radians.
void turn_by(Creature& c, double wanted, double most) {
  c.yaw += std::clamp(std::remainder(wanted - c.yaw, 2 * std::numbers::pi), -most, most);
}

}  // namespace

void Creatures::step(const core::WorldPosition& player, double loud, double hour, double dt) {
  const bool first = steps_ == 0;
  if (steps_++ % kStepsBetween == 0) look_around(player);
  // One cell a step: each may ask about land that nothing has looked at yet.
  for (std::size_t i = first ? near_.size() : 1; i > 0; --i)
    settle_next();
  const double block_m = query_->world().block_size_m();
  const double heard_m = kDeerSees + kDeerHears * loud;
  for (Creature& c : all_) {
    c.before = c.at;
    const glm::dvec3 to_player = way_m(c.at, player, block_m);
    const double far_m = glm::length(to_player);
    const double scared_m = c.kind == Kind::kFish ? 7 : c.kind == Kind::kBird ? 13 : heard_m;
    if (far_m < scared_m) c.fear = 1;
    c.fear = std::max(c.fear - dt / kCalmS, 0.0);
    if (c.kind == Kind::kDeer) step_deer(c, to_player, dt);
    if (c.kind == Kind::kBird) step_bird(c, to_player, hour, dt);
    if (c.kind == Kind::kFish) step_fish(c, to_player, dt);
  }
}

void Creatures::look_around(const core::WorldPosition& player) {
  const glm::dvec3 at = way_m({}, player, query_->world().block_size_m());
  const auto far_m = [&](std::int32_t x, std::int32_t z) {
    return std::hypot((x + 0.5) * kCellM - at.x, (z + 0.5) * kCellM - at.z);
  };
  std::erase_if(all_, [&](const Creature& c) { return far_m(c.cell_x, c.cell_z) > kFarM; });
  std::erase_if(settled_, [&](const Cell& c) { return far_m(c.x, c.z) > kFarM; });
  near_.clear();
  const auto cell = [](double m) { return static_cast<std::int32_t>(std::floor(m / kCellM)); };
  for (std::int32_t z = cell(at.z - kNearM); z <= cell(at.z + kNearM); ++z) {
    for (std::int32_t x = cell(at.x - kNearM); x <= cell(at.x + kNearM); ++x) {
      if (far_m(x, z) < kNearM && std::ranges::find(settled_, Cell{x, z}) == settled_.end())
        near_.push_back({x, z});
    }
  }
  std::ranges::stable_sort(near_, std::greater(), [&](const Cell& c) { return far_m(c.x, c.z); });
}

void Creatures::settle_next() {
  if (near_.empty() || all_.size() >= kMax) return;
  const Cell cell = near_.back();
  near_.pop_back();
  settled_.push_back(cell);
  const world::World& world = query_->world();
  core::RandomStream random(world.seed, cell.x, cell.z, 0, kHabitat);
  core::WorldPosition home;
  home.local = {(cell.x + random.next_unit()) * kCellM, 0, (cell.z + random.next_unit()) * kCellM};
  home = core::normalised(home, world.block_size_m());
  const auto ground = query_->ground(home);
  if (!ground) return;
  home.local.y = ground->height_m;
  const double chance = random.next_unit();
  const auto seed = random.next_u64();
  if (ground->water_depth_m > 1.2) {
    if (chance < 0.8)
      add_group(Kind::kFish, static_cast<int>(random.next_integer(8, 18)), home, seed, cell);
  } else if (ground->water_depth_m == 0 && ground->normal.y > 0.88 && ground->height_m < 170) {
    if (chance < 0.28)
      add_group(Kind::kDeer, static_cast<int>(random.next_integer(2, 6)), home, seed, cell);
    if (chance > 0.45)
      add_group(Kind::kBird, static_cast<int>(random.next_integer(5, 12)), home, seed, cell);
  }
}

void Creatures::add_group(Kind kind, int count, const core::WorldPosition& home, std::uint64_t seed,
                          const Cell& cell) {
  core::RandomStream random(seed, cell.x, cell.z, static_cast<std::uint32_t>(kind), kHabitat);
  for (int i = 0; i < count; ++i) {
    Creature c;
    c.kind = kind;
    c.seed = random.next_u64();
    c.home = home;
    c.cell_x = cell.x;
    c.cell_z = cell.z;
    c.yaw = random.next_real(-3.1, 3.1);
    c.beat = random.next_real(0, 6.2);
    c.at = home;
    const double south_m = random.next_real(-9, 9), east_m = random.next_real(-9, 9);
    c.at.local += glm::dvec3(east_m, 0, south_m);
    c.at = core::normalised(c.at, query_->world().block_size_m());
    const auto ground = query_->ground(c.at);
    const bool is_wet = ground && ground->water_depth_m > 0.7;
    if (!ground || is_wet != (kind == Kind::kFish)) continue;  // not its habitat
    c.at.local.y = kind == Kind::kFish ? home.local.y : ground->height_m;
    if (kind == Kind::kBird) c.at.local.y += random.next_real(9, 26);
    c.before = c.at;
    all_.push_back(c);
  }
}

template <class MayBe>
bool Creatures::advance(Creature& c, double dt, const MayBe& may_be) {
  const glm::dvec3 step = c.pace * dt * glm::dvec3(std::sin(c.yaw), 0, -std::cos(c.yaw));
  const core::WorldPosition there = position_at_offset(c.at, step, query_->world().block_size_m());
  const auto ground = query_->ground(there);
  if (!ground || !may_be(*ground)) return false;
  const double y = c.at.local.y;
  c.at = there;
  c.ground = *ground;
  c.at.local.y = c.kind == Kind::kDeer ? ground->height_m : y;
  return true;
}

bool Creatures::is_over_ground(Creature& c) {
  if (!c.ground) {
    if (const auto ground = query_->ground(c.at)) c.ground = *ground;
  }
  return c.ground.has_value();
}

// A deer grazes around its home, and runs from the player.
void Creatures::step_deer(Creature& c, const glm::dvec3& to_player, double dt) {
  const double time_s = static_cast<double>(steps_) * dt;
  const double block_m = query_->world().block_size_m();
  const bool flees = c.fear > 0.25;
  const double mood = whim(c, time_s, 7);
  double wanted = c.yaw + (mood - 0.5) * 2 * dt;
  if (flees) {
    wanted = yaw_of(-to_player) + (whim(c, time_s, 1.5) - 0.5) * 1.2;
  } else if (distance_m(c.at, c.home, block_m) > 35) {
    wanted = yaw_of(way_m(c.at, c.home, block_m));
  }
  turn_by(c, wanted, (flees ? 4 : 1.2) * dt);
  const double pace = flees ? kDeerRun : mood > 0.45 ? kDeerWalk : 0;
  c.pace += std::clamp(pace - c.pace, -8 * dt, 12 * dt);
  c.beat += dt * (1.5 + 1.6 * c.pace);
  const auto may_be = [](const query::Ground& g) {
    return g.water_depth_m < 0.5 && g.normal.y > 0.7;
  };
  if (c.pace > 0.01 && !advance(c, dt, may_be)) c.yaw += 2.5 * dt;
}

// A bird circles above its home with its flock, and rises away from the player.
void Creatures::step_bird(Creature& c, const glm::dvec3& to_player, double hour, double dt) {
  const double time_s = static_cast<double>(steps_) * dt;
  const double block_m = query_->world().block_size_m();
  const glm::dvec3 home = way_m(c.at, c.home, block_m);
  const double out_m = std::hypot(home.x, home.z);
  // Steers along the circle, back to it from outside, and a little at random.
  const double circle_m = 12 + 14 * whim(c, time_s, 9);
  double wanted =
      yaw_of(home) + std::numbers::pi / 2 - std::clamp((out_m - circle_m) / 12, -0.7, 1.4);
  wanted += (whim(c, time_s, 2) - 0.5) * 0.9;
  if (c.fear > 0.4) wanted = yaw_of(-to_player);
  turn_by(c, wanted, 1.7 * dt);
  const bool night = hour < 5 || hour > 21;
  const double height_m = night ? 4 : 11 + 15 * whim(c, time_s, 12) + 10 * c.fear;
  c.pace = kBirdPace * (1 + 0.5 * c.fear);
  c.beat += dt * (13 + 9 * c.fear);
  if (!is_over_ground(c)) return;
  const double floor_m = c.ground->surface_m;
  const double climb = std::clamp((floor_m + height_m - c.at.local.y) * 0.8, -3.0, 4.0);
  c.pitch = std::atan2(climb, c.pace);
  c.at.local.y = std::max(c.at.local.y + climb * dt, floor_m + 1.5);
  advance(c, dt, [](const query::Ground&) { return true; });
}

// A fish stays in deep water, below the surface.
void Creatures::step_fish(Creature& c, const glm::dvec3& to_player, double dt) {
  const double time_s = static_cast<double>(steps_) * dt;
  const double block_m = query_->world().block_size_m();
  double wanted = c.yaw + (whim(c, time_s, 3) - 0.5) * 3 * dt;
  if (distance_m(c.at, c.home, block_m) > 20) wanted = yaw_of(way_m(c.at, c.home, block_m));
  if (c.fear > 0.4) wanted = yaw_of(-to_player);
  turn_by(c, wanted, 3 * dt);
  const double pace = c.fear > 0.4 ? kFishFlees : kFishPace * (0.4 + whim(c, time_s, 4));
  c.pace += std::clamp(pace - c.pace, -2 * dt, 9 * dt);
  c.beat += dt * (4 + 6 * c.pace);
  if (!advance(c, dt, [](const query::Ground& g) { return g.water_depth_m > 0.7; }))
    c.yaw += 4 * dt;
  if (!is_over_ground(c)) return;
  const double surface_m = c.ground->surface_m, depth_m = 0.35 + 0.6 * whim(c, 0, 1);
  c.at.local.y =
      std::max(surface_m - depth_m, std::min(c.ground->height_m + 0.15, surface_m - 0.15));
}

}  // namespace cairns
