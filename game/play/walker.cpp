#include "game/play/walker.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "game/play/land.hpp"

namespace cairns {
namespace {

constexpr double kWalkSpeed = 2.2, kRunSpeed = 5.5, kStrideSpeed = 7.5;
constexpr double kJumpSpeed = 4.6, kSpringSpeed = 6.8;
constexpr double kSwimSpeed = 1.9, kRaftSpeed = 5.5;
constexpr double kSwimDepthM = 1.15, kRaftDepthM = 0.15, kFloat = 3;  // 1/s
constexpr double kClimbSpeed = 1.7, kBreathS = 3.5, kGripBreathS = 10, kWallM = 0.9;
constexpr float kWallUp = 0.64F;  // normal.y of the flattest ground to climb: 50°
constexpr double kGlideSpeed = 10, kSinkSpeed = 2.1, kWingSinkSpeed = 1.3;
constexpr double kDive = 9;                       // m/s gained when looking straight down
constexpr double kUpdraft = 1.2;                  // lift per m/s of wind against a slope,
constexpr double kMaxLift = 1.6, kUpdraftM = 35;  // its limit in m/s, and the height where it ends
constexpr double kGustS = 1.2, kGustSpeed = 4.5;
constexpr double kStrideM = 0.82;  // length of a stride
constexpr double kMaxPitch = 1.5;
constexpr double kFellFarSpeed = 3;  // m/s; faster landings make a sound

glm::dvec2 ahead_of(double yaw) {
  return {std::sin(yaw), -std::cos(yaw)};
}

}  // namespace

core::Result<Walker> Walker::create(physics::World& physics, query::World& query,
                                    const core::WorldPosition& feet) {
  Walker made(physics, query);
  const auto body = physics.add(physics::CharacterSettings{
      .feet = feet, .walk_speed = kWalkSpeed, .run_speed = kRunSpeed, .jump_speed = kJumpSpeed});
  if (!body) return tl::unexpected(body.error());
  made.body_ = *body;
  made.feet_ = made.before_ = physics.state(*body)->feet;
  return made;
}

core::Result<void> Walker::put(const core::WorldPosition& feet, double yaw) {
  if (auto ok = physics_->set_feet(body_, feet); !ok) return ok;
  if (auto ok = physics_->set_velocity(body_, {}); !ok) return ok;
  feet_ = before_ = physics_->state(body_)->feet;
  velocity_ = {};
  yaw_ = yaw_before_ = yaw;
  pitch_ = pitch_before_ = 0;
  return {};
}

double Walker::depth_m() const {
  const auto water = query_->water(feet_);
  if (!water || water->is_dry()) return -1;
  return water->surface_m - feet_.local.y;
}

bool Walker::faces_wall() const {
  const glm::dvec2 ahead = ahead_of(yaw_);
  query::Ray ray;
  ray.direction = {ahead.x, 0, ahead.y};
  ray.longest_m = kWallM;
  for (const double height_m : {0.4, 1.3}) {  // knees and chest
    ray.origin = feet_;
    ray.origin.local.y += height_m;
    const auto hit = query_->cast(ray);
    const bool walks_up = hit && hit->kind == query::HitKind::kGround && hit->normal.y > kWallUp;
    if (hit && hit->kind != query::HitKind::kNothing && !walks_up) return true;
  }
  return false;
}

Gait Walker::next_gait(const Intent& intent, const Abilities& abilities) const {
  const bool swims = gait_ == Gait::kSwim;
  const double needed_m = has(abilities, Ability::kRaft) ? 0.6 : swims ? 1.0 : kSwimDepthM;
  if (depth_m() > needed_m || (swims && depth_m() > 0.1 && !on_ground_)) return Gait::kSwim;
  if (intent.jump_held && intent.move.y > 0.3 && breath_ > 0 && !intent.jump && faces_wall())
    return Gait::kClimb;
  if (on_ground_) return Gait::kGround;
  const bool sails = intent.jump_held && has(abilities, Ability::kSail);
  if (sails && (gait_ == Gait::kGlide || velocity_.y < -1)) return Gait::kGlide;
  return Gait::kAir;
}

physics::CharacterInput Walker::walk(const Intent& intent, const Abilities& abilities) const {
  const glm::dvec2 ahead = ahead_of(yaw_), right(-ahead.y, ahead.x);
  physics::CharacterInput told;
  told.direction = right * intent.move.x + ahead * intent.move.y;
  told.run = intent.run;
  if (intent.run && has(abilities, Ability::kStride)) told.speed = kStrideSpeed;
  told.jump = intent.jump;
  return told;
}

physics::CharacterInput Walker::glide(const Abilities& abilities, const Intent& intent,
                                      const Weather& weather) {
  physics::CharacterInput told;
  told.direction = ahead_of(yaw_);
  const double dive = std::clamp(-std::sin(pitch_), -0.3, 1.0);
  told.speed = kGlideSpeed + kDive * dive;
  double rise =
      -(has(abilities, Ability::kWing) ? kWingSinkSpeed : kSinkSpeed) - kDive * dive * 0.8;
  // A slope deflects wind upwards.
  if (const auto ground = query_->ground(feet_)) {
    const double against = -glm::dot(weather.wind, glm::dvec3(ground->normal));
    const double near = 1 - (feet_.local.y - ground->height_m) / kUpdraftM;
    rise += std::clamp(kUpdraft * against, 0.0, kMaxLift) * std::clamp(near, 0.0, 1.0);
  }
  if (intent.jump && has(abilities, Ability::kWind)) gust_s_ = kGustS;
  if (gust_s_ > 0) rise = kGustSpeed;
  told.rise = rise;
  return told;
}

void Walker::decide(const Intent& intent, const Abilities& abilities, const Weather& weather,
                    double dt) {
  yaw_before_ = std::exchange(yaw_, yaw_ + intent.turn);
  pitch_before_ = pitch_;
  pitch_ = std::clamp(pitch_ + intent.look, -kMaxPitch, kMaxPitch);
  gust_s_ = std::max(gust_s_ - dt, 0.0);
  const Gait before = std::exchange(gait_, next_gait(intent, abilities));
  splashed_ = gait_ == Gait::kSwim && before != Gait::kSwim && velocity_.y < -1;
  const double breath_s = has(abilities, Ability::kGrip) ? kGripBreathS : kBreathS;
  if (gait_ == Gait::kClimb) breath_ = std::max(breath_ - dt / breath_s, 0.0);
  if (on_ground_ || gait_ == Gait::kSwim) breath_ = std::min(breath_ + dt / 2, 1.0);

  physics::CharacterInput told = walk(intent, abilities);
  if (gait_ == Gait::kSwim) {
    const bool raft = has(abilities, Ability::kRaft);
    told.speed = raft ? kRaftSpeed : kSwimSpeed;
    told.rise = std::clamp((depth_m() - (raft ? kRaftDepthM : kSwimDepthM)) * kFloat, -4.0, 4.0);
    told.jump = false;
  } else if (gait_ == Gait::kClimb) {
    told.speed = kClimbSpeed;
    told.rise = kClimbSpeed;
  } else if (gait_ == Gait::kGlide) {
    told = glide(abilities, intent, weather);
  } else if (told.jump && on_ground_ && has(abilities, Ability::kSpring)) {
    // Sets the velocity directly, because the physics character has one jump speed only.
    (void)physics_->set_velocity(body_, {velocity_.x, kSpringSpeed, velocity_.z});
    told.jump = false;
  }
  (void)physics_->tell(body_, told);
}

void Walker::follow() {
  const auto state = *physics_->state(body_);
  const double block_m = query_->world().block_size_m();
  landed_ = state.on_ground && !on_ground_ && velocity_.y < -kFellFarSpeed;
  before_ = std::exchange(feet_, state.feet);
  velocity_ = state.velocity;
  on_ground_ = state.on_ground;
  const double moved_m = distance_m(before_, feet_, block_m);
  walked_m_ += moved_m;
  stride_m_ += on_ground_ ? moved_m : 0;
  stepped_ = stride_m_ > kStrideM * std::clamp(std::hypot(velocity_.x, velocity_.z) / 2, 0.8, 2.2);
  if (stepped_) stride_m_ = 0;
}

core::CameraPose Walker::eyes(double share) const {
  const double block_m = query_->world().block_size_m();
  core::CameraPose pose;
  pose.position = feet_;
  pose.position.local -= way_m(before_, feet_, block_m) * (1 - share);
  pose.position.local.y += kEyesM;
  pose.yaw = std::lerp(yaw_before_, yaw_, share);
  pose.pitch = std::lerp(pitch_before_, pitch_, share);
  return pose;
}

}  // namespace cairns
