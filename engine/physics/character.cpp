#include "engine/physics/character.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>
#include <utility>

#include "engine/physics/shapes.hpp"

namespace psygen::physics {
namespace {

constexpr double kGroundAcceleration = 40, kAirAcceleration = 6;  // m/s²
constexpr double kRiseAcceleration = 20;                          // m/s², of CharacterInput::rise
constexpr double kMaxSlide = 12;                        // m/s down ground that is too steep
constexpr double kHollowM = 0.3, kHollowDepthM = 0.15;  // no ground so near lies so much lower
constexpr double kPieceM = 0.2;                         // longer distances are split into pieces
constexpr int kSlides = 4;
constexpr double kFloats = 0.9;   // fraction of the height under water at which it floats
constexpr double kWaterDrag = 3;  // 1/s, of vertical speed under water

btVector3 along_plane(const btVector3& way, const btVector3& normal) {
  return way - normal * std::min(way.dot(normal), btScalar(0));
}

// Returns the normal of a wall, without its y component. Zero for a ceiling.
btVector3 wall(const btVector3& normal) {
  const btVector3 flat(normal.x(), 0, normal.z());
  return flat.length2() > 1e-12 ? flat.normalized() : btVector3(0, 0, 0);
}

}  // namespace

Character::Character(btDynamicsWorld& bullet, Terrain& terrain, const CharacterSettings& settings,
                     const btVector3& feet, std::uint32_t number)
    : bullet_(bullet),
      terrain_(terrain),
      settings_(settings),
      min_up_(std::cos(glm::radians(settings.max_slope_deg))),
      feet_(feet),
      capsule_(settings.radius_m, settings.height_m - 2 * settings.radius_m),
      body_(std::make_unique<btRigidBody>(0, &motion_, &capsule_)),
      mover_(bullet, *body_, capsule_, settings.mass_kg) {
  body_->setCollisionFlags(body_->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  body_->setActivationState(DISABLE_DEACTIVATION);
  body_->setUserIndex(static_cast<int>(number));
  body_->setUserIndex2(kCharacters);
  teleport(feet);
  bullet_.addRigidBody(body_.get(), kCharacters, kBodies | kCharacters | kModels);
}

Character::~Character() {
  bullet_.removeRigidBody(body_.get());
}

// `jumped_there`: without pushing bodies in between.
void Character::publish(bool jumped_there) {
  const btTransform place = upright(centre(feet_));
  motion_.setWorldTransform(place);
  if (jumped_there) put(bullet_, *body_, place);
}

void Character::teleport(const btVector3& feet) {
  feet_ = terrain_.inside(feet, settings_.radius_m);
  const double height = terrain_.ground(feet_).height_m;
  on_ground = feet_.y() <= height;
  feet_.setY(std::max(feet_.y(), height));
  publish(true);
}

void Character::shift(const btVector3& by) {
  feet_ -= by;
  publish(true);
}

// Returns the displacement without its component up ground that is too steep.
btVector3 Character::climb_limited(const btVector3& way) {
  btVector3 left = way;
  for (int i = 0;; ++i) {
    const models::GroundPoint ahead = terrain_.ground(feet_ + left);
    const btVector3 normal = to_bt(ahead.normal);
    if (is_walkable(normal) || ahead.height_m <= feet_.y() + 1e-3) return left;
    if (i == 2) return {0, 0, 0};
    left = along_plane(left, wall(normal));
    stop_at(wall(normal));
  }
}

void Character::stop_at(const btVector3& normal) {
  const btVector3 flat(velocity.x(), 0, velocity.z());
  const btVector3 left = along_plane(flat, normal);
  velocity = btVector3(left.x(), velocity.y(), left.z());
}

// Climbs an obstacle: up, ahead and down again. Rejected if it gains no distance, or if the
// capsule's round bottom would leave the edge at a position that is not walkable, which may be
// several steps ahead.
bool Character::step_up(const btVector3& way) {
  const btVector3 from = centre(feet_), up(0, settings_.step_height_m, 0);
  const Sweep raise = mover_.sweep(from, from + up);
  const double lifted =
      std::max(raise.fraction * settings_.step_height_m - CapsuleMover::kSkinM, 0.0);
  if (lifted < 2 * CapsuleMover::kSkinM) return false;
  const btVector3 above = from + btVector3(0, lifted, 0), down(0, -lifted, 0);
  const double way_m = way.length();
  const btVector3 ahead = way * (1 + 0.5 * settings_.radius_m / way_m);
  const Sweep forth = mover_.sweep(above, above + ahead);
  const double gained_m = forth.fraction * ahead.length() - CapsuleMover::kSkinM;
  if (gained_m < 0.5 * ahead.length()) return false;
  const btVector3 probe = above + ahead * (gained_m / ahead.length());
  const Sweep top = mover_.sweep(probe, probe + down);
  if (!top.hit || !is_walkable(top.normal)) return false;
  // Only as far as the displacement reaches, perhaps onto the edge.
  const btVector3 there = above + way * std::min(gained_m / way_m, 1.0);
  const Sweep landing = mover_.sweep(there, there + down);
  const double dropped_m = std::max(lifted * landing.fraction - CapsuleMover::kSkinM, 0.0);
  on_edge_ = landing.hit && !is_walkable(landing.normal);
  feet_ = terrain_.inside(there - btVector3(0, dropped_m + 0.5 * settings_.height_m, 0),
                          settings_.radius_m);
  return true;
}

void Character::move_aside(btVector3 way) {
  for (int i = 0; i < kSlides && way.length2() > 1e-12; ++i) {
    way = climb_limited(way);
    if (way.length2() <= 1e-12) return;
    const btVector3 from = centre(feet_);
    const double length = way.length();
    const Sweep sweep = mover_.sweep(from, from + way * (1 + CapsuleMover::kSkinM / length));
    const double gone =
        sweep.hit
            ? std::max(sweep.fraction * (length + CapsuleMover::kSkinM) - CapsuleMover::kSkinM, 0.0)
            : length;
    feet_ = terrain_.inside(feet_ + way * (gone / length), settings_.radius_m);
    if (!sweep.hit) return;
    way *= 1 - gone / length;
    if (is_walkable(sweep.normal)) {
      way = along_plane(way, sweep.normal);
    } else if (on_ground && !rising_ && step_up(way)) {
      return;
    } else {
      way = along_plane(way, wall(sweep.normal));
      stop_at(wall(sweep.normal));
    }
  }
}

void Character::move_up(double rise) {
  const btVector3 from = centre(feet_);
  const Sweep sweep = mover_.sweep(from, from + btVector3(0, rise, 0));
  feet_.setY(feet_.y() +
             std::max(rise * sweep.fraction - (sweep.hit ? CapsuleMover::kSkinM : 0), 0.0));
  if (sweep.hit) velocity.setY(0);
}

// True if no ground beside it lies much lower: it cannot slide away, however steep the sides are.
bool Character::is_in_hollow() {
  // The gentlest ground that is too steep falls by more.
  const double depth_m = kHollowDepthM * std::min(std::sqrt(1 / (min_up_ * min_up_) - 1), 1.0);
  for (int i = 0; i < 8; ++i) {
    const double angle = i * std::numbers::pi / 4;
    const btVector3 beside(kHollowM * std::cos(angle), 0, kHollowM * std::sin(angle));
    if (terrain_.ground(feet_ + beside).height_m < feet_.y() - depth_m) return false;
  }
  return true;
}

// Falls by `drop`, or follows the ground or object that it stands on.
void Character::move_down(double drop) {
  if (std::exchange(on_edge_, false)) {
    velocity.setY(0);
    return;
  }
  const bool stood = on_ground && !rising_;
  const double depth = stood ? settings_.step_height_m : drop;
  const btVector3 from = centre(feet_);
  const Sweep sweep = mover_.sweep(from, from - btVector3(0, depth + CapsuleMover::kSkinM, 0));
  const models::GroundPoint ground = terrain_.ground(feet_);
  Support support{ground.height_m, to_bt(ground.normal)};
  query::ObjectId floor;
  if (sweep.hit) {
    const double height =
        feet_.y() - sweep.fraction * (depth + CapsuleMover::kSkinM) + CapsuleMover::kSkinM;
    if (height > support.height) {
      support = {height, sweep.normal};
      floor = object_of(*sweep.object);
    }
  }
  const double lowest = feet_.y() - depth;
  if (support.height < lowest) {
    on_ground = false;
    if (stood) leave_floor();
    if (!stood) feet_.setY(lowest);
    return;
  }
  const double fall_speed = -velocity.y();
  feet_.setY(support.height);
  floor_ = floor;
  // The foot of a rock beside it does not lift it off the ground.
  const bool on_terrain = support.height <= ground.height_m + CapsuleMover::kSkinM;
  on_ground = is_walkable(support.normal) || (on_terrain && is_walkable(to_bt(ground.normal))) ||
              (support.height <= ground.height_m && is_in_hollow());
  velocity.setY(0);
  if (on_ground) return;
  // Too steep: the character slides down.
  const btVector3 downhill = wall(support.normal);
  const double faster = kMaxSlide - velocity.dot(downhill);
  velocity += downhill * std::clamp(fall_speed * support.normal.y(), 0.0, std::max(faster, 0.0));
  if (support.height > ground.height_m) move_aside(downhill * std::max(drop, 0.02));
}

void Character::follow_ground() {
  const double height = terrain_.ground(feet_).height_m;
  if (feet_.y() < height) feet_.setY(height);
}

// Moves with the object that it stands on, unless something blocks it.
void Character::ride(const btVector3& carried) {
  if (carried.length2() == 0) return;
  const Sweep sweep = mover_.sweep(centre(feet_), centre(feet_) + carried);
  const double share = sweep.hit ? sweep.fraction - CapsuleMover::kSkinM / carried.length() : 1;
  feet_ = terrain_.inside(feet_ + carried * std::max(share, 0.0), settings_.radius_m);
}

// The character leaves its platform and keeps the platform's velocity.
void Character::leave_floor() {
  velocity += floor_velocity_;
  floor_velocity_ = {0, 0, 0};
  floor_ = {};
}

// The fraction of its height under water.
double Character::submerged(const WaterHere& water) const {
  return std::clamp((water.surface_m - feet_.y()) / settings_.height_m, 0.0, 1.0);
}

// Falls, or floats where `under` of its height are under water.
void Character::fall(double dt, double gravity, double under) {
  const bool floats = under > kFloats;
  if (on_ground && velocity.y() <= 0 && !floats) {
    velocity.setY(0);
    return;
  }
  velocity.setY((velocity.y() - gravity * (1 - under / kFloats) * dt) /
                (1 + kWaterDrag * under * dt));
  if (floats && on_ground) leave_floor();
}

void Character::step(double dt, double gravity, const btVector3& carried, const WaterHere& water) {
  ride(carried);
  floor_velocity_ = carried / dt;
  feet_ += mover_.pushed_out(centre(feet_)) - centre(feet_);
  feet_ = terrain_.inside(feet_, settings_.radius_m);
  follow_ground();

  const double length = std::max(glm::length(input.direction), 1.0);
  const double usual = input.run ? settings_.run_speed : settings_.walk_speed;
  const glm::dvec2 wanted = input.direction * ((input.speed > 0 ? input.speed : usual) / length);
  const double under = submerged(water);
  // The current carries it, the more the deeper it wades.
  const double drift = on_ground   ? std::clamp((under - 0.3) / 0.5, 0.0, 1.0)
                       : under > 0 ? 1.0
                                   : 0.0;
  btVector3 change = btVector3(wanted.x, 0, wanted.y) + drift * water.flow -
                     btVector3(velocity.x(), 0, velocity.z());
  const double most = dt * (on_ground ? kGroundAcceleration : kAirAcceleration);
  if (change.length() > most) change *= most / change.length();
  velocity += change;

  rising_ = false;
  if (on_ground && input.jump) {
    velocity.setY(settings_.jump_speed);
    leave_floor();
    rising_ = true;
    input.jump = false;
  } else if (input.rise) {
    const double max_change = kRiseAcceleration * dt;
    velocity.setY(velocity.y() + std::clamp(*input.rise - velocity.y(), -max_change, max_change));
    rising_ = velocity.y() > 0;
    if (rising_) leave_floor();
  } else {
    fall(dt, gravity, under);
    rising_ = velocity.y() > 0;
  }
  if (velocity.length() > kMaxSpeed) velocity *= kMaxSpeed / velocity.length();

  const double way_m = btVector3(velocity.x(), 0, velocity.z()).length() * dt;
  const int pieces = std::max(static_cast<int>(std::ceil(way_m / kPieceM)), 1);
  const double part = dt / pieces;
  for (int i = 0; i < pieces; ++i) {
    move_aside(btVector3(velocity.x(), 0, velocity.z()) * part);
    if (velocity.y() > 0) {
      on_ground = false;
      move_up(velocity.y() * part);
    } else {
      move_down(-velocity.y() * part);
    }
    follow_ground();
  }
  publish(false);
}

}  // namespace psygen::physics
