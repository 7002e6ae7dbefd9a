#include "engine/physics/world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "engine/physics/shapes.hpp"
#include "engine/physics/world_impl.hpp"

namespace psygen::physics {
namespace {

tl::unexpected<core::Error> no_character(CharacterId id) {
  return core::invalid_argument(fmt::format("character {} does not exist", id.number));
}

core::Result<void> check(const CharacterSettings& s) {
  const auto is_in = [](double v, double low, double high) { return v >= low && v <= high; };
  if (!is_in(s.radius_m, kMinSizeM, kMaxSizeM) || !is_in(s.height_m, 2 * s.radius_m, kMaxSizeM))
    return core::invalid_argument(
        fmt::format("a character of radius {} m and height {} m: both must be {} … {} m, and "
                    "the height at least twice the radius",
                    s.radius_m, s.height_m, kMinSizeM, kMaxSizeM));
  if (!is_in(s.walk_speed, 0, 100) || !is_in(s.run_speed, 0, 100) || !is_in(s.jump_speed, 0, 100))
    return core::invalid_argument("the speeds of a character must be 0 … 100 m/s");
  if (!is_in(s.step_height_m, 0, s.height_m))
    return core::invalid_argument("the steps of a character must not be higher than itself");
  if (!is_in(s.max_slope_deg, 0, 89))
    return core::invalid_argument("the steepest slope must be 0 … 89 degrees");
  if (!is_in(s.mass_kg, 1e-3, 1e9))
    return core::invalid_argument("the mass of a character must be 0.001 … 10^9 kg");
  return {};
}

// Finds the nearest body or character on a ray.
struct NearestBody : btCollisionWorld::ClosestRayResultCallback {
  NearestBody(const btVector3& from, const btVector3& to) : ClosestRayResultCallback(from, to) {
    m_collisionFilterGroup = kBodies | kCharacters;
    m_collisionFilterMask = kBodies | kCharacters;
  }
};

}  // namespace

core::Result<World> World::create(query::World& query, const Settings& settings) {
  if (!(settings.gravity >= 0 && settings.gravity <= 100))
    return core::invalid_argument(
        fmt::format("gravity must be 0 … 100 m/s², not {}", settings.gravity));
  if (!(settings.water_kg_m3 >= 0 && settings.water_kg_m3 <= 20'000))
    return core::invalid_argument(
        fmt::format("the density of water must be 0 … 20,000 kg/m³, not {}", settings.water_kg_m3));
  if (settings.max_bodies > 1'000'000) return core::invalid_argument("at most 1,000,000 bodies");
  return World(std::make_unique<Impl>(query, settings));
}

World::World(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;
World::~World() = default;

core::Result<CharacterId> World::add(const CharacterSettings& settings) {
  if (auto sound = check(settings); !sound) return tl::unexpected(sound.error());
  if (auto room = impl_->check_room(); !room) return tl::unexpected(room.error());
  const auto feet = impl_->place(settings.feet, impl_->count());
  if (!feet) return tl::unexpected(feet.error());
  const std::uint32_t number = ++impl_->last_number;
  impl_->characters.try_emplace(number, impl_->bullet, impl_->terrain, settings, *feet, number);
  return CharacterId{number};
}

core::Result<void> World::remove(CharacterId id) {
  if (impl_->characters.erase(id.number) == 0) return no_character(id);
  return {};
}

core::Result<CharacterState> World::state(CharacterId id) const {
  impl_->follow_world();
  const Character* character = impl_->find(id);
  if (character == nullptr) return no_character(id);
  return CharacterState{impl_->terrain.position(character->feet()), to_glm(character->velocity),
                        character->on_ground};
}

core::Result<void> World::tell(CharacterId id, const CharacterInput& input) {
  Character* character = impl_->find(id);
  if (character == nullptr) return no_character(id);
  if (!is_within({input.direction.x, 0, input.direction.y}, 1e6))
    return core::invalid_argument(
        "the direction of a character must be finite and at most 10^6 long");
  if (!(input.speed >= 0 && input.speed <= kMaxSpeed))
    return core::invalid_argument("the speed of a character must be 0 … 1000 m/s");
  if (input.rise && !(std::abs(*input.rise) <= kMaxSpeed))
    return core::invalid_argument("a character must not rise or sink faster than 1000 m/s");
  character->input = input;
  return {};
}

core::Result<void> World::set_feet(CharacterId id, const core::WorldPosition& feet) {
  Character* character = impl_->find(id);
  if (character == nullptr) return no_character(id);
  const auto at = impl_->place(feet, impl_->count() - 1);
  if (!at) return tl::unexpected(at.error());
  character->teleport(*at);
  return {};
}

core::Result<void> World::set_velocity(CharacterId id, const glm::dvec3& velocity) {
  Character* character = impl_->find(id);
  if (character == nullptr) return no_character(id);
  if (!is_within(velocity, kMaxSpeed))
    return core::invalid_argument(
        fmt::format("a velocity must be finite, and at most {} m/s along each axis", kMaxSpeed));
  character->velocity = to_bt(velocity);
  if (velocity.y > 0) character->on_ground = false;
  return {};
}

core::Result<void> World::step(double dt) {
  if (!(dt >= 0.001 && dt <= 0.1))
    return core::invalid_argument(fmt::format("a step must take 0.001 to 0.1 s, not {}", dt));
  impl_->step(dt);
  return {};
}

core::Result<std::optional<BodyHit>> World::cast(const core::WorldPosition& origin,
                                                 const glm::dvec3& direction,
                                                 double longest_m) const {
  impl_->follow_world();
  const auto from = query::checked(origin, impl_->query.world().block_size_m());
  if (!from) return tl::unexpected(from.error());
  const double largest =
      std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
  if (!is_within(direction, 1e300) || largest == 0 || !(longest_m > 0))
    return core::invalid_argument("a ray needs a finite, non-zero direction and a length above 0");
  const btVector3 unit = to_bt(direction / largest).normalized();
  const btVector3 start = impl_->terrain.coordinates(*from);
  const btVector3 end = start + unit * std::min(longest_m, 1e6);
  NearestBody nearest(start, end);
  impl_->bullet.rayTest(start, end, nearest);
  if (!nearest.hasHit()) return std::nullopt;
  BodyHit hit;
  const auto number = static_cast<std::uint32_t>(nearest.m_collisionObject->getUserIndex());
  if (nearest.m_collisionObject->getUserIndex2() == kBodies)
    hit.body = {number};
  else
    hit.character = {number};
  hit.distance_m = (nearest.m_hitPointWorld - start).length();
  hit.position = impl_->terrain.position(nearest.m_hitPointWorld);
  hit.normal = to_glm(nearest.m_hitNormalWorld);
  return hit;
}

std::size_t World::block_count() const {
  return impl_->terrain.size();
}

}  // namespace psygen::physics
