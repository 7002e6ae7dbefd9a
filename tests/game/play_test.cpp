// The rules of the game: available actions, and the effect of a step.
#include "game/play/play.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "game/play/cairn_type.hpp"
#include "game/play/streams.hpp"
#include "tests/engine/world/river_world.hpp"

namespace cairns {
namespace {

constexpr double kTick = 1.0 / 60;

struct Begun {
  std::unique_ptr<Land> land;
  std::unique_ptr<Play> play;
  explicit Begun(std::uint64_t seed = 3) : land(*Land::load(seed)) {
    play = *Play::create(land->world, land->registry);
  }
  // Moves the player to a position, with an inventory.
  void put(const core::WorldPosition& at, Stock stock = {}, int found = 0, double time_s = 1) {
    Progress progress = play->progress();
    progress.feet = at;
    progress.stock = stock;
    progress.found = std::bitset<kCairns>((1ULL << found) - 1);
    progress.time_s = time_s;
    ASSERT_TRUE(play->resume(progress, play->edits()));
  }
  void steps(int count, const Intent& intent = {}) {
    for (int i = 0; i < count; ++i)
      play->step(intent, kTick);
  }
  bool happened(Happening::Kind kind) {
    bool found = false;
    for (const Happening& happening : play->take_happenings())
      found |= happening.kind == kind;
    return found;
  }
  // Returns a position near the start with water of at least this depth.
  core::WorldPosition water(double depth_m) {
    for (int i = 0; i < 400'000; ++i) {
      const double angle = i * 0.13, far_m = 0.05 * i;
      core::WorldPosition at = position_at_offset(
          play->route().start, far_m * glm::dvec3(std::cos(angle), 0, std::sin(angle)),
          play->block_m());
      const auto ground = play->query().ground(at);
      if (!ground || ground->water_depth_m < depth_m) continue;
      at.local.y = ground->surface_m;
      return at;
    }
    ADD_FAILURE() << "no water";
    return {};
  }
};

TEST(Route, DependsOnlyOnTheSeedAndStaysOnDryGround) {
  Begun a(5), b(5), other(6);
  std::set<std::pair<int, int>> blocks;
  for (std::size_t i = 0; i < kCairns; ++i) {
    const core::WorldPosition& at = a.play->route().cairns[i];
    EXPECT_EQ(at.local, b.play->route().cairns[i].local);
    const auto ground = a.play->query().ground(at);
    ASSERT_TRUE(ground);
    EXPECT_EQ(ground->water_depth_m, 0);
    blocks.insert({at.block.x, at.block.z});
    const core::WorldPosition& before =
        i == 0 ? a.play->route().start : a.play->route().cairns[i - 1];
    EXPECT_GE(distance_m(before, at, a.play->block_m()), 199);
    EXPECT_LE(distance_m(before, at, a.play->block_m()), 361);
  }
  EXPECT_EQ(blocks.size(), kCairns);
  EXPECT_NE(other.play->route().cairns[0].local, a.play->route().cairns[0].local);
}

// The centre of this land is sea for kilometres.
TEST(Route, BeginsWhereLandIs) {
  const auto land = Land::load(seed_of("heather"));
  ASSERT_TRUE(land);
  query::World query((*land)->world, (*land)->registry);
  const auto centre = query.ground({});
  ASSERT_TRUE(centre);
  EXPECT_GT(centre->water_depth_m, 0);
  const auto route = find_route(query);
  ASSERT_TRUE(route) << route.error().message;
  EXPECT_GT(distance_m({}, route->start, (*land)->world.block_size_m()), 3000);
}

TEST(Land, AcceptsANumberOrAWordAsSeed) {
  EXPECT_EQ(seed_of("0"), 0U);
  EXPECT_EQ(seed_of("18446744073709551615"), UINT64_MAX);
  EXPECT_EQ(seed_of("heather"), seed_of("heather"));
  EXPECT_NE(seed_of("heather"), seed_of("Heather"));
  for (const char* text : {"", "18446744073709551616", "-1", "  7", "\"\n[world]", "heather"}) {
    const auto land = Land::load(seed_of(text));
    ASSERT_TRUE(land) << text << ": " << land.error().message;
    EXPECT_EQ((*land)->world.seed, seed_of(text));
  }
}

TEST(Play, FindsACairnBesideThePlayerAndGivesAnAbility) {
  Begun game;
  core::WorldPosition at = game.play->route().cairns[0];
  at.local.x += 2.5;
  at.local.y += 0.5;
  game.put(at);
  EXPECT_TRUE(game.play->abilities().none());
  game.steps(30);
  EXPECT_TRUE(game.happened(Happening::Kind::kFound));
  EXPECT_TRUE(has(game.play->abilities(), Ability::kSail));
  EXPECT_EQ(game.play->next_cairn(), std::optional<std::size_t>(1));
  game.steps(30);
  EXPECT_FALSE(game.happened(Happening::Kind::kFound));
}

TEST(Play, BuildingTakesFiveStonesAndFirmGround) {
  Begun game;
  const auto placed = game.play->edits().counts().placed;
  game.put(game.play->route().start, {.stones = 4});
  game.steps(1, {.build = true});
  EXPECT_TRUE(game.happened(Happening::Kind::kRefused));
  game.put(game.play->route().start, {.stones = 5});
  game.steps(1, {.build = true});
  EXPECT_TRUE(game.happened(Happening::Kind::kBuilt));
  EXPECT_EQ(game.play->edits().counts().placed, placed + 1);
  EXPECT_EQ(game.play->progress().stock.stones, 0);
  EXPECT_EQ(game.play->progress().waymarks.size(), 1U);
  game.put(game.water(3), {.stones = 9});
  game.steps(1, {.build = true});
  EXPECT_TRUE(game.happened(Happening::Kind::kRefused));
  EXPECT_EQ(game.play->progress().stock.stones, 9);
}

TEST(Play, SleepsAtNightBesideAFireUntilSeven) {
  Begun game;
  const double day_s = game.land->world.sky.day_length_s;
  const double night_s = (22 - game.land->world.sky.start_hour) / 24 * day_s;
  game.put(game.play->route().start, {.wood = 2}, 0, night_s);
  EXPECT_TRUE(game.play->is_night());
  game.steps(1, {.sleep = true});
  EXPECT_TRUE(game.happened(Happening::Kind::kRefused));  // no fire yet
  game.steps(1, {.fire = true});
  EXPECT_TRUE(game.happened(Happening::Kind::kLit));
  game.steps(1, {.sleep = true});
  EXPECT_TRUE(game.happened(Happening::Kind::kSlept));
  EXPECT_NEAR(game.play->hour(), 7, 0.1);
  EXPECT_EQ(game.play->progress().stock.wood, 0);
  game.steps(1, {.sleep = true});
  EXPECT_TRUE(game.happened(Happening::Kind::kRefused));  // not at night
}

TEST(Walker, FloatsInDeepWaterAndSinksNoDeeperThanTheChest) {
  Begun game;
  core::WorldPosition at = game.water(4);
  at.local.y += 12;
  game.put(at);
  game.steps(600);
  EXPECT_EQ(game.play->walker().gait(), Gait::kSwim);
  const double level_m = game.play->query().water(game.play->walker().feet())->surface_m;
  EXPECT_NEAR(game.play->walker().feet().local.y, level_m - 1.15, 0.25);
  EXPECT_GT(game.play->walker().eyes(1).position.local.y, level_m);
}

TEST(Walker, MovesAndTurnsEvenlyBetweenSteps) {
  Begun game;
  game.steps(30, {.move = {0, 1}});
  const double yaw = game.play->walker().yaw();
  game.steps(1, {.move = {0, 1}, .turn = 0.2, .look = 0.1});
  const Walker& walker = game.play->walker();
  const core::CameraPose first = walker.eyes(0), half = walker.eyes(0.5), last = walker.eyes(1);
  EXPECT_NEAR(first.yaw, yaw, 1e-12);
  EXPECT_NEAR(half.yaw, yaw + 0.1, 1e-12);
  EXPECT_NEAR(last.yaw, yaw + 0.2, 1e-12);
  EXPECT_NEAR(half.pitch, (first.pitch + last.pitch) / 2, 1e-12);
  EXPECT_GT(distance_m(first.position, last.position, game.play->block_m()), 0.01);
  EXPECT_NEAR(distance_m(first.position, half.position, game.play->block_m()),
              distance_m(half.position, last.position, game.play->block_m()), 1e-9);
}

TEST(Walker, GlidesOnlyWithTheSailAndFallsSlowly) {
  for (const int found : {0, 1}) {
    Begun game;
    core::WorldPosition at = game.play->route().start;
    at.local.y += 120;
    game.put(at, {}, found);
    game.steps(180, {.jump_held = true});
    const double fall = game.play->walker().velocity().y;
    if (found == 0) {
      EXPECT_LT(fall, -20);
    } else {
      EXPECT_EQ(game.play->walker().gait(), Gait::kGlide);
      EXPECT_GT(fall, -5);
      EXPECT_GT(std::hypot(game.play->walker().velocity().x, game.play->walker().velocity().z), 8);
    }
  }
}

// The camera stays outside the ground and all solid objects.
TEST(Walker, KeepsTheCameraOutsideSolids) {
  Begun game(4);
  core::RandomStream random(9, 0, 0, 0, core::Purpose::kStructure);
  for (int k = 0; k < 120 * 60; ++k) {
    Intent intent{.move = {0, 1}, .run = true, .jump = k % 97 == 0, .jump_held = k % 200 < 60};
    if (k % 90 == 0) intent.turn = random.next_real(-2, 2);
    game.steps(1, intent);
    const core::CameraPose eyes = game.play->walker().eyes(random.next_unit());
    const auto ground = game.play->query().ground(eyes.position);
    ASSERT_TRUE(ground);
    ASSERT_GT(eyes.position.local.y, ground->height_m + 0.2) << "step " << k;
    const auto hit = game.play->query().cast(
        {.origin = eyes.position, .direction = {0, 1, 0}, .longest_m = 0.1, .ground = false});
    ASSERT_TRUE(hit);
    ASSERT_FALSE(hit->from_inside) << "step " << k;
  }
}

TEST(Creatures, LiveInTheirHabitatAndFlee) {
  Begun game(6);
  std::set<Kind> kinds;
  std::size_t most = 0, fled = 0;
  for (const core::WorldPosition& at : game.play->route().cairns) {
    core::WorldPosition above = at;
    above.local.y += 2;
    game.put(above);
    game.steps(180, {.move = {0, 1}, .run = true});
    most = std::max(most, game.play->creatures().all().size());
    for (const Creature& c : game.play->creatures().all()) {
      kinds.insert(c.kind);
      fled += c.fear > 0.5 ? 1 : 0;
      const auto ground = game.play->query().ground(c.at);
      ASSERT_TRUE(ground);
      if (c.kind == Kind::kFish) {
        EXPECT_LE(c.at.local.y, ground->surface_m);
      } else {
        EXPECT_GE(c.at.local.y, ground->height_m - 1e-6);
      }
    }
  }
  EXPECT_GE(kinds.size(), 2U);
  EXPECT_GT(most, 60U);
  EXPECT_LE(most, 400U);
  EXPECT_GT(fled, 0U);
}

TEST(Creatures, FishStayBelowTheSurfaceAndBirdsAboveIt) {
  Begun game(6);
  game.put(game.water(2));
  game.steps(120);
  int fish = 0;
  for (const Creature& c : game.play->creatures().all()) {
    const auto ground = game.play->query().ground(c.at);
    ASSERT_TRUE(ground);
    if (c.kind == Kind::kFish) {
      ++fish;
      EXPECT_GE(c.at.local.y, ground->surface_m - 0.95);
      EXPECT_LE(c.at.local.y, ground->surface_m - 0.15);
    } else if (c.kind == Kind::kBird) {
      EXPECT_GE(c.at.local.y, ground->surface_m + 1.5 - 1e-9);
    }
  }
  EXPECT_GT(fish, 0);
}

TEST(Streams, AreHeardNearRiversAndLoudestAtFalls) {
  namespace land = psygen::world::testing;
  const world::World& world = land::river_world();
  query::World query(world, land::registry());
  const auto heard = [&](double x, double z) {
    core::WorldPosition at = world.position({x, z});
    at.local.y = query.ground(at)->surface_m;
    return loudest_stream(query, at);
  };
  EXPECT_FALSE(heard(1000, 1000));
  EXPECT_FALSE(heard(1540, 1750)) << "the sea does not flow";
  const auto beside = heard(1905, 1722), away = heard(1905, 1742);
  ASSERT_TRUE(beside && away);
  EXPECT_GT(beside->gain, 2 * away->gain);
  EXPECT_LE(beside->gain, 1);
  EXPECT_EQ(query.water(beside->at)->body, land::kTheRiver);
  EXPECT_NEAR(beside->at.local.y, query.water(beside->at)->surface_m, 1e-9);
}

TEST(Weather, DependsOnlyOnSeedAndTimeAndChangesSlowly) {
  double wettest = 0, driest = 1;
  for (int s = 0; s < 3 * 3600; ++s) {
    const Weather a = weather_at(8, s), b = weather_at(8, s + 1);
    EXPECT_LT(std::abs(a.clouds - b.clouds), 0.03);
    EXPECT_LT(std::abs(a.wet - b.wet), 0.03);
    EXPECT_GE(a.fog, 0);
    EXPECT_LE(a.fog, 1);
    wettest = std::max(wettest, a.wet);
    driest = std::min(driest, a.wet);
  }
  EXPECT_EQ(driest, 0);
  EXPECT_GT(wettest, 0.3);
  EXPECT_EQ(weather_at(8, 900).clouds, weather_at(8, 900).clouds);
}

TEST(CairnType, WritesTheDeclaredSizeWithinItsBounds) {
  const auto made = make_cairn_type();
  const models::ModelType& type = *made;
  models::Parameters p = models::default_parameters(type);
  for (const int stones : {1, 6, 24}) {
    p.set_integer(kCairnStones, stones);
    ASSERT_TRUE(models::validate(type, p));
    for (int level = 0; level < type.level_count(); ++level) {
      const models::MeshSize size = type.mesh_size(p, level);
      std::vector<std::byte> vertices(size.vertex_count * sizeof(core::ModelVertex));
      std::vector<std::uint16_t> indices(size.index_count, 0xFFFF);
      const core::Bounds tight = type.synthesise(p, level, {vertices, indices});
      const core::Bounds box = type.bounds(p);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(tight.min[axis], box.min[axis] - 1e-4F);
        EXPECT_LE(tight.max[axis], box.max[axis] + 1e-4F);
      }
      for (const std::uint16_t i : indices)
        ASSERT_LT(i, size.vertex_count);
    }
  }
}

}  // namespace
}  // namespace cairns
