#include "game/play/play.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "game/play/cairn_type.hpp"

namespace cairns {
namespace {

constexpr int kHiddenStones = 11;
constexpr double kHiddenWidthM = 1.9, kBuiltWidthM = 0.9;
constexpr double kFoundM = 4.5, kReachM = 2.6, kSeenM = 60;
constexpr double kLargestStoneM = 0.65;  // largest radius that the player can carry
constexpr double kFellS = 2.2, kAxeS = 0.7;
constexpr double kFireS = 420, kFireReachM = 5, kAheadM = 1.8;
constexpr double kMorningHour = 7;
constexpr double kBuriedM = 0.5, kSameM = 0.01;
constexpr int kTargetSteps = 6, kSeenSteps = 30;

// True if a river or lake is in the cell of the map around a position, though not in its middle.
bool has_river(query::World& query, const core::WorldPosition& middle) {
  if (!query.world().shaped.has_water()) return false;
  constexpr int kPlaces = 8;
  for (int i = 0; i < kPlaces * kPlaces; ++i) {
    core::WorldPosition at = middle;
    at.local.x += ((i % kPlaces + 0.5) / kPlaces - 0.5) * kMapCellM;
    at.local.z += ((i / kPlaces + 0.5) / kPlaces - 0.5) * kMapCellM;
    const auto water = query.water(at);
    if (water && !water->is_dry() && water->body != world::kSea) return true;
  }
  return false;
}

}  // namespace

Play::Play(const world::World& world, const models::Registry& registry)
    : world_(world), registry_(&registry), query_(world_, registry), creatures_(query_) {
  world::set_edits(world_, nullptr);
}

core::Result<std::unique_ptr<Play>> Play::create(const world::World& world,
                                                 const models::Registry& registry) {
  std::unique_ptr<Play> play(new Play(world, registry));
  if (auto ok = play->begin(); !ok) return tl::unexpected(ok.error());
  return play;
}

core::Result<void> Play::begin() {
  const auto route = find_route(query_);
  if (!route) return tl::unexpected(route.error());
  route_ = *route;
  if (auto ok = stand_cairns(); !ok) return ok;
  auto physics = physics::World::create(query_);
  if (!physics) return tl::unexpected(physics.error());
  physics_.emplace(std::move(*physics));
  auto walker = Walker::create(*physics_, query_, route_.start);
  if (!walker) return tl::unexpected(walker.error());
  walker_.emplace(std::move(*walker));
  const glm::dvec3 to_first = way_m(route_.start, route_.cairns[0], block_m());
  progress_.feet = walker_->feet();
  // The player starts facing a little past the first cairn, and has to look for it.
  progress_.yaw = std::atan2(to_first.x, -to_first.z) + 0.35;
  return walker_->put(progress_.feet, progress_.yaw);
}

core::Result<void> Play::resume(Progress progress, world::Edits edits) {
  const world::Edits before = edits_;
  take_edits(std::move(edits));
  auto ok = stand_cairns();
  const auto ground = query_.ground(progress.feet);
  if (ground && ground->height_m > progress.feet.local.y + kBuriedM)
    progress.feet.local.y = ground->height_m;
  if (ok) ok = walker_->put(progress.feet, progress.yaw);
  if (!ok) {
    take_edits(before);
    return ok;
  }
  progress_ = std::move(progress);
  return {};
}

// Places the cairns of the route, and removes those of the route that the land had before.
core::Result<void> Play::stand_cairns() {
  std::bitset<kCairns> standing;
  world::Edits next = edits_;
  for (const core::BlockCoord block : world::changed_blocks({}, edits_)) {
    for (const models::PlacedModel& model : edits_.layer()->block(block)->placed) {
      if (model.type != kCairnType || model.parameters.integer(kCairnStones) != kHiddenStones)
        continue;
      const core::WorldPosition at{block, {model.local_m.x, 0, model.local_m.y}};
      const auto is_here = [&](const core::WorldPosition& cairn) {
        return distance_m(at, cairn, block_m()) < kSameM;
      };
      const auto cairn = std::ranges::find_if(route_.cairns, is_here);
      if (cairn != route_.cairns.end()) {
        standing.set(static_cast<std::size_t>(cairn - route_.cairns.begin()));
      } else if (auto ok = next.remove_placed({block, model.id}); !ok) {
        return ok;
      }
    }
  }
  take_edits(std::move(next));
  for (std::size_t i = 0; i < kCairns; ++i) {
    if (standing[i]) continue;
    if (auto ok = place_cairn(route_.cairns[i], kHiddenStones, kHiddenWidthM); !ok) return ok;
  }
  return {};
}

void Play::take_edits(world::Edits edits) {
  edits_ = std::move(edits);
  world::set_edits(world_, edits_.layer());
}

core::Result<void> Play::place_cairn(const core::WorldPosition& at, int stones, double width_m) {
  world::NewModel model;
  const int type = registry_->find(kCairnType);
  if (type < 0)
    return core::fail(core::ErrorCode::kInternal, "the registry has no model type \"cairn\"");
  model.model = static_cast<models::ModelIndex>(type);
  model.parameters = models::default_parameters((*registry_)[model.model]);
  const auto mixed = core::combine(cell_name(at.block.x, at.block.z),
                                   static_cast<std::uint64_t>(at.local.x * 1000));
  model.parameters.set_integer(kCairnSeed, static_cast<std::int64_t>(mixed >> 1));
  model.parameters.set_integer(kCairnStones, stones);
  model.parameters.set_real(kCairnWidthM, width_m);
  model.at = at;
  world::Edits next = edits_;
  const auto placed = next.place(world_, *registry_, model);
  if (!placed) return tl::unexpected(placed.error());
  take_edits(std::move(next));
  return {};
}

void Play::step(const Intent& intent, double dt) {
  progress_.time_s += dt;
  walker_->decide(intent, abilities(), weather(), dt);
  (void)physics_->step(dt);
  walker_->follow();
  progress_.feet = walker_->feet();
  progress_.yaw = walker_->yaw();
  const glm::dvec3& v = walker_->velocity();
  creatures_.step(progress_.feet, std::hypot(v.x, v.z), hour(), dt);
  if (walker_->stepped()) happen(Happening::Kind::kStepped, progress_.feet);
  if (walker_->landed()) happen(Happening::Kind::kLanded, progress_.feet);
  if (walker_->splashed()) happen(Happening::Kind::kSplashed, progress_.feet);
  if (steps_ % kTargetSteps == 0) look_for_target();
  if (steps_ % kSeenSteps == 0) see_around();
  ++steps_;
  act(intent, dt);
  find_cairns();
}

double Play::hour() const {
  const world::Sky& sky = world_.sky;
  if (sky.day_length_s <= 0) return sky.start_hour;
  return std::fmod(sky.start_hour + progress_.time_s / sky.day_length_s * 24, 24.0);
}

std::optional<std::size_t> Play::next_cairn() const {
  for (std::size_t i = 0; i < kCairns; ++i) {
    if (!progress_.found[i]) return i;
  }
  return std::nullopt;
}

const Fire* Play::fire_near(double reach_m) const {
  const Fire* nearest = nullptr;
  for (const Fire& fire : progress_.fires) {
    const double far_m = distance_m(progress_.feet, fire.at, block_m());
    if (fire.until_s < progress_.time_s || far_m > reach_m) continue;
    nearest = &fire;
    reach_m = far_m;
  }
  return nearest;
}

// Finds the nearest usable stone or tree in front of the player.
void Play::look_for_target() {
  std::vector<query::NearbyModel> near;
  const query::NearbyModel before = target_.model;
  target_ = {};
  if (!query_.models_within(progress_.feet, kReachM, near)) return;
  const int rock = registry_->find("rock");
  for (const query::NearbyModel& model : near) {
    const glm::dvec3 way = way_m(progress_.feet, model.position, block_m());
    if (way.x * std::sin(walker_->yaw()) - way.z * std::cos(walker_->yaw()) < -0.3) continue;
    const models::ModelType& type = (*registry_)[model.model];
    if (model.model == rock) {
      const auto placed = query_.placement(model.block, model.index);
      const int radius = models::parameter_index(type, "radius_m");
      if (!placed || placed->parameters.real(static_cast<std::size_t>(radius)) > kLargestStoneM)
        continue;
      target_.kind = Target::Kind::kStone;
    } else if (type.surface() == core::SurfaceKind::kBark) {
      target_.kind = Target::Kind::kTree;
    } else {
      continue;
    }
    target_.model = model;
    break;
  }
  if (target_.model.block != before.block || target_.model.index != before.index) felling_ = 0;
}

void Play::act(const Intent& intent, double dt) {
  if (intent.use && target_.kind == Target::Kind::kStone) gather();
  if (intent.use_held && target_.kind == Target::Kind::kTree) {
    fell(dt);
  } else {
    felling_ = 0;
  }
  if (intent.build) build();
  if (intent.fire) light_fire();
  if (intent.sleep) sleep();
  if (intent.lantern && has(abilities(), Ability::kLantern)) progress_.lantern = !progress_.lantern;
}

void Play::refuse(const char* why) {
  happenings_.push_back({.kind = Happening::Kind::kRefused, .why = why, .at = progress_.feet});
}

void Play::gather() {
  if (progress_.stock.stones >= max_stones()) return refuse("You cannot carry more stones.");
  world::Edits next = edits_;
  if (!next.remove(world_, {target_.model.block, target_.model.index})) return;
  take_edits(std::move(next));
  ++progress_.stock.stones;
  happen(Happening::Kind::kGathered, target_.model.position);
  target_ = {};
}

void Play::fell(double dt) {
  constexpr double kChopS = 0.45;
  const double whole_s = has(abilities(), Ability::kAxe) ? kAxeS : kFellS;
  const double before = std::exchange(felling_, felling_ + dt / whole_s);
  if (std::floor(before * whole_s / kChopS) != std::floor(felling_ * whole_s / kChopS))
    happen(Happening::Kind::kChopped, target_.model.position);
  if (felling_ < 1) return;
  felling_ = 0;
  const auto tree = query_.placement(target_.model.block, target_.model.index);
  world::Edits next = edits_;
  if (!tree || !next.remove(world_, {target_.model.block, target_.model.index})) return;
  take_edits(std::move(next));
  progress_.stock.wood += 2;
  happenings_.push_back(
      {.kind = Happening::Kind::kFelled, .at = target_.model.position, .tree = *tree});
  target_ = {};
}

std::optional<core::WorldPosition> Play::dry_place_ahead() {
  const double yaw = walker_->yaw();
  core::WorldPosition at = position_at_offset(
      progress_.feet, kAheadM * glm::dvec3(std::sin(yaw), 0, -std::cos(yaw)), block_m());
  const auto ground = query_.ground(at);
  if (!ground || ground->water_depth_m > 0 || ground->normal.y < 0.7) return std::nullopt;
  if (std::abs(ground->height_m - progress_.feet.local.y) > 2) return std::nullopt;
  at.local.y = ground->height_m;
  return at;
}

void Play::build() {
  if (progress_.stock.stones < kStonesOfCairn) return refuse("You need five stones for a cairn.");
  const auto at = dry_place_ahead();
  if (!at) return refuse("There is no firm ground here.");
  if (!place_cairn(*at, kStonesOfCairn + 1, kBuiltWidthM)) return refuse("There is no room here.");
  progress_.stock.stones -= kStonesOfCairn;
  progress_.waymarks.push_back(*at);
  happen(Happening::Kind::kBuilt, *at);
}

void Play::light_fire() {
  const bool free = has(abilities(), Ability::kEmber);
  if (!free && progress_.stock.wood < kWoodOfFire)
    return refuse("You need wood for a fire. Fell a tree.");
  const auto at = dry_place_ahead();
  if (!at) return refuse("There is no dry ground here.");
  if (!free) progress_.stock.wood -= kWoodOfFire;
  std::erase_if(progress_.fires, [&](const Fire& f) { return f.until_s < progress_.time_s; });
  progress_.fires.push_back({*at, progress_.time_s + kFireS});
  happen(Happening::Kind::kLit, *at);
}

void Play::sleep() {
  if (fire_near(kFireReachM) == nullptr) return refuse("Light a fire to sleep beside.");
  if (!is_night()) return refuse("You can sleep only at night.");
  const double hours = std::fmod(kMorningHour - hour() + 24, 24.0);
  progress_.time_s += hours / 24 * world_.sky.day_length_s;
  happen(Happening::Kind::kSlept, progress_.feet);
}

void Play::find_cairns() {
  for (std::size_t i = 0; i < kCairns; ++i) {
    if (progress_.found[i]) continue;
    const glm::dvec3 way = way_m(progress_.feet, route_.cairns[i], block_m());
    if (std::hypot(way.x, way.z) > kFoundM || std::abs(way.y) > 2 * kFoundM) continue;
    happenings_.push_back({.kind = Happening::Kind::kFound,
                           .number = progress_.found.count(),
                           .at = route_.cairns[i]});
    progress_.found.set(i);
  }
}

void Play::see(std::int32_t x, std::int32_t z) {
  const auto [cell, is_new] = progress_.seen.try_emplace(cell_name(x, z));
  if (!is_new) return;
  core::WorldPosition middle;
  middle.local = {(x + 0.5) * kMapCellM, 0, (z + 0.5) * kMapCellM};
  const core::WorldPosition at = core::normalised(middle, block_m());
  const auto ground = query_.ground(at);
  if (!ground) return;
  const bool is_wet = ground->water_depth_m > 0 || has_river(query_, at);
  cell->second = is_wet ? kMapWater : static_cast<std::uint8_t>(ground->kind);
}

void Play::see_around() {
  const glm::dvec3 at = way_m({}, progress_.feet, block_m());
  const auto cell = [](double m) { return static_cast<std::int32_t>(std::floor(m / kMapCellM)); };
  for (std::int32_t z = cell(at.z - kSeenM); z <= cell(at.z + kSeenM); ++z) {
    for (std::int32_t x = cell(at.x - kSeenM); x <= cell(at.x + kSeenM); ++x)
      see(x, z);
  }
}

}  // namespace cairns
