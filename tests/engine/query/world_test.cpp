#include "engine/query/world.hpp"

#include <cfenv>
#include <cmath>
#include <future>
#include <glm/geometric.hpp>
#include <limits>
#include <type_traits>

#include "engine/models/terrain/grid.hpp"
#include "engine/query/path_finder.hpp"
#include "engine/world/edits/edits.hpp"
#include "tests/engine/models/mesh_helpers.hpp"
#include "tests/engine/query/triangles.hpp"
#include "tests/engine/query/worlds.hpp"

namespace psygen::query {
namespace {

using testing::crosses;
using testing::kBounded;
using testing::kWorldNames;
using testing::Loaded;
using testing::some_block;

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The triangles of the finest mesh of a block's ground, in metres from its corner.
struct MeshGround {
  std::vector<glm::dvec3> vertices;
  std::vector<std::uint16_t> indices;  // of the surface

  MeshGround(const Loaded& loaded, core::BlockCoord block) {
    const models::Parameters p = world::terrain_parameters(loaded.world, block);
    const models::ModelType& type = loaded.registry[loaded.world.terrain_model];
    const auto mesh = models::test::synthesise(type, p, 0);
    for (const core::TerrainVertex& v : mesh.vertices<core::TerrainVertex>())
      vertices.emplace_back(v.grid_x * loaded.world.cell_m(),
                            v.height / 65535.0 * p.real(models::kTerrainReliefM),
                            v.grid_z * loaded.world.cell_m());
    indices = mesh.indices;
    indices.resize(std::size_t{3} * models::terrain_surface_triangles(p, 0));
  }

  // Calls visit(a, b, c) for every triangle.
  template <class Visit>
  void each(const Visit& visit) const {
    for (std::size_t i = 0; i < indices.size(); i += 3)
      visit(vertices[indices[i]], vertices[indices[i + 1]], vertices[indices[i + 2]]);
  }
};

double random_in(core::RandomStream& random, double low, double high) {
  return random.next_real(low, high);
}

TEST(QueryWorld, GroundIsTheTrianglesOfTheFinestMesh) {
  for (const char* name : kWorldNames) {
    const Loaded loaded = Loaded::shipped(name);
    World query(loaded.world, loaded.registry);
    for (const core::BlockCoord block : {some_block(loaded.world), core::BlockCoord{0, 0}}) {
      const MeshGround mesh(loaded, block);
      core::RandomStream random(1, 0, 0, 0, core::Purpose::kPosition);
      mesh.each([&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        double u = random.next_unit(), v = random.next_unit();
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const glm::dvec3 at = a + u * (b - a) + v * (c - a);
        const auto ground = query.ground({block, {at.x, 12345, at.z}});
        ASSERT_TRUE(ground) << ground.error().message;
        ASSERT_NEAR(ground->height_m, at.y, 1e-5) << name;
        const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
        ASSERT_GT(glm::dot(normal, glm::dvec3(ground->normal)), 0.999999);
      });
    }
  }
}

TEST(QueryWorld, AnswersAreTheSameInEveryRoundingModeOfTheProgram) {
  const Loaded loaded = Loaded::shipped("lakes");
  const auto answers = [&](int mode) {
    World query(loaded.world, loaded.registry);
    core::RandomStream random(3, 0, 0, 0, core::Purpose::kPosition);
    std::vector<double> all;
    for (int i = 0; i < 300; ++i) {
      const core::WorldPosition at{{5, -2}, {random.next_real(0, 63), 90, random.next_real(0, 63)}};
      const glm::dvec3 down{random.next_real(-1, 1), -1, random.next_real(-1, 1)};
      std::fesetround(mode);
      const auto ground = query.ground(at);
      const auto hit = query.cast({.origin = at, .direction = down});
      const auto tree = query.nearest(at, 80);
      std::fesetround(FE_TONEAREST);
      if (!ground || !hit || !tree) return all;
      const glm::vec3 normal = ground->normal;
      all.insert(all.end(),
                 std::initializer_list<double>{ground->height_m, ground->water_depth_m, normal.x,
                                               normal.y, hit->distance_m, hit->position.local.y,
                                               *tree ? (*tree)->distance_m : -1});
    }
    return all;
  };
  const auto expected = answers(FE_TONEAREST);
  ASSERT_EQ(expected.size(), 2100U);
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO})
    EXPECT_EQ(answers(mode), expected) << mode;
}

TEST(QueryWorld, NeighbouringBlocksAgreeAtTheirBorder) {
  const Loaded loaded = Loaded::shipped("silver_combe");
  World query(loaded.world, loaded.registry);
  const double size = loaded.world.block_size_m();
  const core::BlockCoord block = some_block(loaded.world);
  for (int i = 0; i < 200; ++i) {
    const double along = i * size / 200;
    const auto before = query.ground({block, {size - 1e-9, 0, along}});
    const auto after = query.ground({block, {size, 0, along}});
    const auto next = query.ground({{block.x + 1, block.z}, {0, 0, along}});
    ASSERT_TRUE(before && after && next);
    EXPECT_NEAR(before->height_m, after->height_m, 1e-7);
    EXPECT_EQ(after->height_m, next->height_m);
  }
}

TEST(QueryWorld, GroundHasTheSurfaceKindThatIsDrawn) {
  for (const char* name : {"frost_isle", "lakes"}) {
    const Loaded loaded = Loaded::shipped(name);
    const double sea_m = loaded.world.water.level_m;
    World query(loaded.world, loaded.registry);
    std::array<int, world::kGroundKinds> count{};
    int wet = 0;
    for (int i = 0; i < 20'000; ++i) {
      const auto ground = query.ground({{0, 0}, {(i % 200) * 17.0, 0, (i / 200) * 29.0}});
      ASSERT_TRUE(ground);
      ++count[static_cast<std::size_t>(ground->kind)];
      if (ground->water_depth_m > 0) {
        ++wet;
        ASSERT_NEAR(ground->water_depth_m, ground->surface_m - ground->height_m, 1e-12);
        if (ground->water == world::kSea) {
          ASSERT_EQ(ground->surface_m, sea_m);
        } else {
          ASSERT_GE(ground->surface_m, sea_m);
        }
      } else {
        ASSERT_GE(ground->height_m, sea_m);
      }
      if (ground->height_m < sea_m - 3 && ground->normal.y > 0.97F) {
        ASSERT_EQ(ground->kind, world::GroundKind::kSand);
      }
      if (ground->normal.y < 0.4F) {
        ASSERT_EQ(ground->kind, world::GroundKind::kRock);
      }
    }
    EXPECT_GT(wet, 0) << name;
    for (const auto kind :
         {world::GroundKind::kGrass, world::GroundKind::kForest, world::GroundKind::kSand})
      EXPECT_GT(count[static_cast<std::size_t>(kind)], 0) << name;
  }
}

TEST(QueryWorld, WaterLiesOverTheExactGround) {
  for (const char* sea : {"", "[water]\nlevel_m = 40\n"}) {
    const Loaded loaded = Loaded::parsed(std::string(kBounded) + sea);
    World query(loaded.world, loaded.registry);
    int wet = 0;
    for (int i = 0; i < 3000; ++i) {
      const core::WorldPosition at{{i % 7, i % 3}, {0.021 * i, 900 - i, 0.019 * (i % 3100)}};
      const auto ground = query.ground(at);
      const auto water = query.water(at);
      ASSERT_TRUE(ground && water);
      const double level_m = loaded.world.water.level_m;
      ASSERT_EQ(water->depth_m, std::max(level_m - ground->height_m, 0.0));
      ASSERT_EQ(ground->water_depth_m, water->depth_m);
      ASSERT_EQ(ground->surface_m, std::max(level_m, ground->height_m));
      ASSERT_EQ(ground->water, water->body);
      ASSERT_EQ(water->body, water->depth_m > 0 ? world::kSea : world::kNoWater);
      wet += water->is_dry() ? 0 : 1;
    }
    EXPECT_EQ(wet > 300, *sea != 0) << wet;
  }
}

TEST(QueryWorld, ThereIsNoGroundOutsideABoundedWorld) {
  const Loaded loaded = Loaded::parsed(kBounded);
  World query(loaded.world, loaded.registry);
  EXPECT_TRUE(query.ground({{7, 3}, {63.9, 0, 63.9}}));
  EXPECT_TRUE(query.ground({{9, 3}, {-128.5, 0, 0}}));
  for (const core::WorldPosition& at :
       {core::WorldPosition{{8, 0}, {0, 0, 0}}, {{0, 0}, {-0.01, 0, 5}}, {{0, 3}, {0, 0, 64}}}) {
    const auto ground = query.ground(at);
    ASSERT_FALSE(ground);
    EXPECT_EQ(ground.error().code, core::ErrorCode::kInvalidArgument);
    EXPECT_NE(ground.error().message.find("outside the world"), std::string::npos);
    const auto water = query.water(at);
    ASSERT_FALSE(water);
    EXPECT_EQ(water.error().message, ground.error().message);
  }
}

TEST(QueryWorld, RejectsPositionsDirectionsAndSizesThatAreNotFinite) {
  const Loaded loaded = Loaded::parsed(kBounded);
  World query(loaded.world, loaded.registry);
  const core::WorldPosition sound{{1, 1}, {5, 80, 5}};
  std::vector<NearbyModel> out;
  for (const double bad : {kNoNumber, kInfinity, -kInfinity, 1e300}) {
    for (int axis = 0; axis < 3; ++axis) {
      core::WorldPosition at = sound;
      at.local[axis] = bad;
      EXPECT_FALSE(query.ground(at));
      EXPECT_FALSE(query.cast({.origin = at}));
      EXPECT_FALSE(query.models_within(at, 5, out));
      EXPECT_FALSE(query.nearest(at, 5));
    }
  }
  for (const glm::dvec3& direction :
       {glm::dvec3(0), glm::dvec3(0, kNoNumber, 0), glm::dvec3(kInfinity, 0, 0)})
    EXPECT_FALSE(query.cast({.origin = sound, .direction = direction}));
  for (const double length : {0.0, -1.0, kNoNumber})
    EXPECT_FALSE(query.cast({.origin = sound, .longest_m = length}));
  for (const double radius : {-1.0, kNoNumber, kInfinity}) {
    const auto result = query.models_within(sound, radius, out);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, core::ErrorCode::kInvalidArgument);
  }
  const auto huge = query.models_within(sound, 1e8, out);
  ASSERT_FALSE(huge);
  EXPECT_EQ(huge.error().code, core::ErrorCode::kOverBudget);
}

TEST(QueryWorld, RaysDoNotDependOnTheLengthOfTheirDirection) {
  const Loaded loaded = Loaded::parsed(kBounded);
  World query(loaded.world, loaded.registry);
  const auto hit = query.cast({.origin = {{1, 1}, {5, 90, 5}}, .direction = {1, -1, 0.5}});
  ASSERT_TRUE(hit);
  ASSERT_EQ(hit->kind, HitKind::kGround);
  for (const double scale : {1e-300, 1e-5, 1e5, 1e307}) {
    const auto same =
        query.cast({.origin = {{1, 1}, {5, 90, 5}}, .direction = glm::dvec3(1, -1, 0.5) * scale});
    ASSERT_TRUE(same);
    EXPECT_NEAR(same->distance_m, hit->distance_m, 1e-9);
  }
}

TEST(QueryWorld, RaysHitTheFirstTriangleOfTheMeshes) {
  for (const char* name : {"paper", "lakes", "silver_combe"}) {
    const Loaded loaded = Loaded::shipped(name);
    World query(loaded.world, loaded.registry);
    const core::BlockCoord middle = some_block(loaded.world);
    const double size = loaded.world.block_size_m();
    std::vector<std::pair<glm::dvec3, MeshGround>> meshes;
    for (int z = -1; z <= 1; ++z)
      for (int x = -1; x <= 1; ++x)
        meshes.emplace_back(glm::dvec3(x * size, 0, z * size),
                            MeshGround(loaded, {middle.x + x, middle.z + z}));
    const auto base = query.ground({middle, {size / 2, 0, size / 2}});
    ASSERT_TRUE(base);
    core::RandomStream random(2, 0, 0, 0, core::Purpose::kPosition);
    const auto place = [&] {
      const double x = random_in(random, -size, 2 * size), z = random_in(random, -size, 2 * size);
      return glm::dvec3(x, base->height_m + random_in(random, -30, 30), z);
    };
    int hits = 0;
    for (int i = 0; i < 300; ++i) {
      const glm::dvec3 from = place(), to = place();
      const double length = glm::length(to - from);
      const glm::dvec3 d = (to - from) / length;
      double first = kInfinity;
      for (const auto& [corner, mesh] : meshes)
        mesh.each([&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
          if (const double t = crosses(from - corner, d, a, b, c, 1e-9); t >= 0)
            first = std::min(first, t);
        });
      const auto hit = query.cast(
          {.origin = {middle, from}, .direction = d, .longest_m = length, .models = false});
      ASSERT_TRUE(hit);
      ASSERT_EQ(hit->kind == HitKind::kGround, first <= length) << name << " " << i;
      if (hit->kind == HitKind::kNothing) continue;
      ++hits;
      ASSERT_NEAR(hit->distance_m, first, 1e-4);
      const auto under = query.ground(hit->position);
      ASSERT_TRUE(under);
      ASSERT_NEAR(under->height_m, hit->position.local.y, 1e-6);
      ASSERT_EQ(hit->block, hit->position.block);
      ASSERT_EQ(hit->index, world::kTerrainIndex);
    }
    EXPECT_GT(hits, 100);
  }
}

TEST(QueryWorld, RaysAreTheSameFromAnyBlockOfTheirOrigin) {
  const Loaded loaded = Loaded::shipped("endless");
  World query(loaded.world, loaded.registry);
  const double size = loaded.world.block_size_m();
  const core::BlockCoord block{1 << 30, -(1 << 30)};
  for (int i = 0; i < 50; ++i) {
    const glm::dvec3 direction(std::cos(i), -0.1, std::sin(i));
    const auto here =
        query.cast({.origin = {block, {10, 300, 20}}, .direction = direction, .longest_m = 5000});
    const auto there =
        query.cast({.origin = {{block.x + 3, block.z - 2}, {10 - 3 * size, 300, 20 + 2 * size}},
                    .direction = direction,
                    .longest_m = 5000});
    ASSERT_TRUE(here && there);
    EXPECT_EQ(here->kind, there->kind);
    EXPECT_EQ(here->block, there->block);
    EXPECT_EQ(here->index, there->index);
    EXPECT_NEAR(here->distance_m, there->distance_m, 1e-9);
  }
}

TEST(QueryWorld, RaysEndAtTheSeamOfAnEndlessWorld) {
  const Loaded loaded = Loaded::shipped("endless");
  World query(loaded.world, loaded.registry);
  const double size = loaded.world.block_size_m();
  const auto east = query.cast(
      {.origin = {{INT32_MAX, 4}, {10, 5000, 10}}, .direction = {1, -1, 0}, .longest_m = 9000});
  const auto north = query.cast(
      {.origin = {{4, INT32_MIN + 1}, {10, 5000, 10}}, .direction = {0, 0, -3}, .longest_m = 9000});
  ASSERT_TRUE(east && north);
  EXPECT_EQ(east->kind, HitKind::kNothing);
  EXPECT_NEAR(east->distance_m, (size - 10) * std::sqrt(2.0), 1e-3);
  EXPECT_EQ(east->position.block, (core::BlockCoord{INT32_MAX, 4}));
  EXPECT_NEAR(north->distance_m, size + 10, 1e-3);
  EXPECT_EQ(north->position.block, (core::BlockCoord{4, INT32_MIN}));
  const auto west = query.cast(
      {.origin = {{INT32_MAX, 4}, {10, 5000, 10}}, .direction = {-1, -1, 0}, .longest_m = 9000});
  ASSERT_TRUE(west);
  EXPECT_EQ(west->kind, HitKind::kGround) << "away from the seam";
}

TEST(QueryWorld, VerticalRaysHitTheGroundFromAboveAndFromBelow) {
  const Loaded loaded = Loaded::shipped("paper");
  World query(loaded.world, loaded.registry);
  for (int i = 0; i < 300; ++i) {
    const core::WorldPosition at{{40 + i, 9}, {i * 0.21, 0, i * 0.17}};
    const auto ground = query.ground(at);
    ASSERT_TRUE(ground);
    Ray ray{.origin = at, .longest_m = kInfinity, .models = false};
    ray.origin.local.y = 5000;
    const auto down = query.cast(ray);
    ASSERT_TRUE(down);
    ASSERT_EQ(down->kind, HitKind::kGround);
    EXPECT_FALSE(down->from_inside);
    EXPECT_NEAR(down->distance_m, 5000 - ground->height_m, 1e-9);
    ray.origin.local.y = -100;
    EXPECT_EQ(query.cast(ray)->kind, HitKind::kNothing);
    ray.direction = {0, 1, 0};
    const auto up = query.cast(ray);
    ASSERT_EQ(up->kind, HitKind::kGround);
    EXPECT_TRUE(up->from_inside);
    EXPECT_NEAR(up->distance_m, 100 + ground->height_m, 1e-9);
    ray.origin.local.y = ground->height_m;
    EXPECT_EQ(query.cast(ray)->kind, HitKind::kNothing);
  }
}

TEST(QueryWorld, EndlessRaysTakeBoundedWorkAndReportTheirLength) {
  const Loaded loaded = Loaded::shipped("endless");
  World query(loaded.world, loaded.registry);
  const double relief = loaded.world.terrain.real(models::kTerrainReliefM);
  const auto rising = query.cast({.origin = {{5, 5}, {1, relief + 500, 1}},
                                  .direction = {1, 1e-3, 0},
                                  .longest_m = kInfinity});
  ASSERT_TRUE(rising);
  EXPECT_EQ(rising->kind, HitKind::kNothing);
  EXPECT_GE(rising->distance_m, 1e9);
  // Level and below all ground: there is nothing to hit.
  const auto level = query.cast({.origin = {{5, 5}, {1, -500, 1}},
                                 .direction = {1, 0, 0.2},
                                 .longest_m = kInfinity,
                                 .models = false});
  ASSERT_TRUE(level);
  EXPECT_EQ(level->kind, HitKind::kNothing);
  // A world of a few blocks, which the ray misses.
  const Loaded bounded = Loaded::parsed(kBounded);
  World small(bounded.world, bounded.registry);
  const auto past = small.cast(
      {.origin = {{0, 0}, {1, 1000, 1}}, .direction = {-1, -1e-9, 0}, .longest_m = kInfinity});
  ASSERT_TRUE(past);
  EXPECT_EQ(past->kind, HitKind::kNothing);
  EXPECT_GT(past->distance_m, 1000 * 64);
}

TEST(QueryWorld, RaysEnterABoundedWorldFromOutside) {
  const Loaded loaded = Loaded::parsed(kBounded);
  World query(loaded.world, loaded.registry);
  const auto above = query.cast({.origin = {{-3, 1}, {0, 120, 10}}, .direction = {3, -1, 0}});
  ASSERT_TRUE(above);
  EXPECT_EQ(above->kind, HitKind::kGround);
  EXPECT_FALSE(above->from_inside);
  // Below the surface at the border, which has no vertical side: the ray comes out further in.
  const auto edge = query.ground({{0, 1}, {0, 0, 10}});
  ASSERT_TRUE(edge);
  const auto below = query.cast({.origin = {{-1, 1}, {0, edge->height_m - 70, 10}},
                                 .direction = {1, 0.9, 0},
                                 .models = false});
  ASSERT_TRUE(below);
  ASSERT_EQ(below->kind, HitKind::kGround);
  EXPECT_TRUE(below->from_inside);
}

// Every solid of the blocks around one.
struct AllSolids {
  struct One {
    core::BlockCoord block;
    std::uint32_t index;
    glm::dvec3 foot{0.0};
    Solid solid;
  };
  std::vector<One> all;

  AllSolids(const Loaded& loaded, core::BlockCoord middle, int reach) {
    const double size = loaded.world.block_size_m();
    std::vector<world::Placement> placed;
    for (int z = -reach; z <= reach; ++z) {
      for (int x = -reach; x <= reach; ++x) {
        const core::BlockCoord block{middle.x + x, middle.z + z};
        if (!loaded.world.contains(block)) continue;
        world::place_models(loaded.world, loaded.registry, block, placed);
        for (const world::Placement& p : placed)
          all.push_back({block, p.index, glm::dvec3(p.position) + glm::dvec3(x * size, 0, z * size),
                         Solid(loaded.registry[p.model].collider(p.parameters))});
      }
    }
  }
  // Finds the first hit solid, one after the other.
  const One* first(const glm::dvec3& from, const glm::dvec3& d, double& distance_m) {
    const One* best = nullptr;
    for (One& one : all) {
      const auto hit = one.solid.cast({from - one.foot, d}, distance_m);
      if (!hit || (best != nullptr && hit->t >= distance_m)) continue;
      distance_m = hit->t;
      best = &one;
    }
    return best;
  }
};

TEST(QueryWorld, RaysHitTheFirstOfAllModels) {
  for (const char* name : kWorldNames) {
    const Loaded loaded = Loaded::shipped(name);
    World query(loaded.world, loaded.registry);
    const core::BlockCoord block = some_block(loaded.world);
    AllSolids solids(loaded, block, 3);
    core::RandomStream random(4, 0, 0, 0, core::Purpose::kPosition);
    int hits = 0;
    for (int i = 0; i < 200; ++i) {
      core::WorldPosition origin{block, {random.next_real(0, 63), 0, random.next_real(0, 63)}};
      origin.local.y = query.ground(origin)->height_m + random.next_real(0.2, 1);
      // Towards some model, so that most rays hit one.
      const auto aim = static_cast<std::size_t>(
          random.next_integer(0, static_cast<std::int64_t>(solids.all.size()) - 1));
      const glm::dvec3 to = solids.all[aim].foot + glm::dvec3(random.next_real(-0.3, 0.3), 0.2, 0);
      const glm::dvec3 d = glm::normalize(to - origin.local);
      const auto hit =
          query.cast({.origin = origin, .direction = d, .longest_m = 120, .ground = false});
      ASSERT_TRUE(hit);
      double distance_m = 120;
      const auto* expected = solids.first(origin.local, d, distance_m);
      ASSERT_EQ(hit->kind, expected == nullptr ? HitKind::kNothing : HitKind::kModel)
          << name << " " << i;
      ASSERT_NEAR(hit->distance_m, distance_m, 1e-9);
      if (expected == nullptr) continue;
      ++hits;
      ASSERT_EQ(hit->block, expected->block);
      ASSERT_EQ(hit->index, expected->index);
    }
    EXPECT_GT(hits, 20) << name;
  }
}

TEST(QueryWorld, ARayHitsTheNearestOfGroundAndModels) {
  const Loaded loaded = Loaded::shipped("paper");
  World query(loaded.world, loaded.registry);
  std::vector<NearbyModel> rocks;
  const models::ModelIndex rock[] = {static_cast<models::ModelIndex>(loaded.registry.find("rock"))};
  ASSERT_TRUE(query.models_within({{100, 100}, {30, 100, 30}}, 300, rocks, rock));
  ASSERT_GT(rocks.size(), 20U);
  const double long_m = 400;
  int ground_before_model = 0, model_before_ground = 0;
  for (const NearbyModel& m : rocks) {
    for (const glm::dvec3 from : {glm::dvec3{0, 50, 0}, {0, -50, 0}, {200, 10, 0}, {0, 10, 200}}) {
      Ray ray{.origin = m.position, .direction = -from, .longest_m = long_m};
      ray.origin.local += from;
      const auto both = query.cast(ray);
      ray.models = false;
      const auto ground = query.cast(ray);
      ray.models = true;
      ray.ground = false;
      const auto model = query.cast(ray);
      ASSERT_TRUE(both && ground && model);
      ASSERT_EQ(both->distance_m, std::min(ground->distance_m, model->distance_m));
      const bool model_first = model->distance_m < ground->distance_m;
      ASSERT_EQ(both->kind, model_first ? model->kind : ground->kind);
      if (ground->kind != HitKind::kGround || model->kind != HitKind::kModel) continue;
      ++(model_first ? model_before_ground : ground_before_model);
    }
  }
  EXPECT_GT(ground_before_model, 20);
  EXPECT_GT(model_before_ground, 20);
}

TEST(QueryWorld, ModelsWithinARadiusAreCompleteAndNearestFirst) {
  for (const char* name : kWorldNames) {
    const Loaded loaded = Loaded::shipped(name);
    World query(loaded.world, loaded.registry);
    const core::BlockCoord block = some_block(loaded.world);
    const core::WorldPosition at{block, {2, 100, 60}};
    std::vector<NearbyModel> found;
    ASSERT_TRUE(query.models_within(at, 90, found));
    std::size_t expected = 0;
    const double size = loaded.world.block_size_m();
    for (int z = -3; z <= 3; ++z)
      for (int x = -3; x <= 3; ++x) {
        const core::BlockCoord b{block.x + x, block.z + z};
        if (!loaded.world.contains(b)) continue;
        std::vector<world::Placement> placed;
        world::place_models(loaded.world, loaded.registry, b, placed);
        for (const world::Placement& p : placed)
          expected += glm::length(glm::dvec3(p.position) + glm::dvec3(x * size, 0, z * size) -
                                  at.local) <= 90;
      }
    EXPECT_EQ(found.size(), expected) << name;
    for (std::size_t i = 1; i < found.size(); ++i)
      ASSERT_LE(found[i - 1].distance_m, found[i].distance_m);
    for (const NearbyModel& m : found) {
      const auto placement = query.placement(m.block, m.index);
      ASSERT_TRUE(placement);
      ASSERT_EQ(glm::dvec3(placement->position), m.position.local);
      ASSERT_EQ(placement->model, m.model);
    }
    for (models::ModelIndex model = 0; model < loaded.registry.size(); ++model) {
      const models::ModelIndex only[] = {model};
      const auto nearest = query.nearest(at, 90, only);
      ASSERT_TRUE(nearest);
      const auto first = std::ranges::find(found, model, &NearbyModel::model);
      ASSERT_EQ(nearest->has_value(), first != found.end());
      if (*nearest) {
        EXPECT_EQ((*nearest)->block, first->block);
        EXPECT_EQ((*nearest)->index, first->index);
      }
    }
  }
}

TEST(QueryWorld, ARadiusOfZeroFindsModelsAtExactlyThisPoint) {
  const Loaded loaded = Loaded::parsed(kBounded);
  World query(loaded.world, loaded.registry);
  const auto any = query.nearest({{3, 2}, {30, 30, 30}}, 500);
  ASSERT_TRUE(any && *any);
  std::vector<NearbyModel> found;
  ASSERT_TRUE(query.models_within((*any)->position, 0, found));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].index, (*any)->index);
  ASSERT_TRUE(query.models_within({{3, 2}, {30, 5000, 30}}, 0, found));
  EXPECT_TRUE(found.empty());
  EXPECT_FALSE(query.placement({3, 2}, 999));
  EXPECT_FALSE(query.placement({-1, 2}, 0));
}

TEST(QueryWorld, AnswersDoNotDependOnTheCache) {
  const Loaded loaded = Loaded::shipped("silver_combe");
  World large(loaded.world, loaded.registry), tiny(loaded.world, loaded.registry, 1);
  core::RandomStream random(6, 0, 0, 0, core::Purpose::kPosition);
  for (int i = 0; i < 60; ++i) {
    const Ray ray{.origin = {{static_cast<std::int32_t>(random.next_integer(-5, 5)), 7},
                             {random.next_real(0, 63), random.next_real(50, 300), 5}},
                  .direction = {random.next_real(-1, 1), -0.2, random.next_real(-1, 1)}};
    const auto a = large.cast(ray), b = tiny.cast(ray);
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a->kind, b->kind);
    EXPECT_EQ(a->distance_m, b->distance_m);
    EXPECT_EQ(a->index, b->index);
  }
}

TEST(QueryWorld, RaysHitModelsOfEditsAtAnyDistanceFromTheirBlock) {
  Loaded loaded = Loaded::parsed(kBounded);
  World query(loaded.world, loaded.registry);
  const double size = loaded.world.block_size_m(), before_m = query.models_reach_m();
  ASSERT_LT(before_m, 0.3 * size);
  world::NewModel rock{.model = static_cast<models::ModelIndex>(loaded.registry.find("rock")),
                       .parameters = {},
                       .at = {{2, 1}, {0.5 * size, 0, 0.5 * size}}};
  const models::ModelType& type = loaded.registry[rock.model];
  rock.parameters = models::default_parameters(type);
  rock.parameters.set_real(static_cast<std::size_t>(models::parameter_index(type, "radius_m")),
                           1.3 * size);
  world::Edits edits;
  const auto placed = edits.place(loaded.world, loaded.registry, rock);
  ASSERT_TRUE(placed) << placed.error().message;
  world::set_edits(loaded.world, edits.layer());
  EXPECT_GT(query.models_reach_m(), 1.2 * size);
  // Straight down onto the next block, from above all earlier heights.
  core::WorldPosition eye{{3, 1}, {0.3 * size, 0, 0.5 * size}};
  eye.local.y = query.ground(eye)->height_m + 200;
  const auto hit = query.cast({.origin = eye, .longest_m = 1000});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->kind, HitKind::kModel);
  EXPECT_EQ(hit->block, (core::BlockCoord{2, 1}));
  EXPECT_EQ(hit->model, rock.model);
  world::set_edits(loaded.world, nullptr);
  EXPECT_EQ(query.models_reach_m(), before_m);
  EXPECT_NE(query.cast({.origin = eye, .longest_m = 1000})->kind, HitKind::kNothing);
}

TEST(QueryWorld, QueriesOfACopyOfTheWorldRunInAnotherThreadWhileTheWorldIsEdited) {
  Loaded loaded = Loaded::parsed(kBounded);
  const double size = loaded.world.block_size_m();
  const core::WorldPosition place{{2, 1}, {0.5 * size, 0, 0.5 * size}};
  world::Edits edits;
  ASSERT_TRUE(edits.raise(loaded.world, place, 10, 3));
  world::set_edits(loaded.world, edits.layer());
  const world::World copy = loaded.world;
  World query(copy, loaded.registry, 1);  // rebuilds every block
  const double before_m = query.ground(place)->height_m;
  auto answers = std::async(std::launch::async, [&] {
    int others = 0;
    for (int i = 0; i < 500; ++i) {
      if (query.ground(place)->height_m != before_m) ++others;
      (void)query.ground({{4, 2}, {1, 0, 1}});
    }
    return others;
  });
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(edits.raise(loaded.world, place, 10, i % 2 == 0 ? 1 : -1));
    world::set_edits(loaded.world, edits.layer());
  }
  EXPECT_EQ(answers.get(), 0);
  World edited(loaded.world, loaded.registry);
  ASSERT_TRUE(edits.raise(loaded.world, place, 10, 2));
  world::set_edits(loaded.world, edits.layer());
  EXPECT_GT(edited.ground(place)->height_m, before_m);
}

static_assert(std::is_move_constructible_v<World> && !std::is_copy_constructible_v<World>);

// Replaces a world in place, as a scene does.
void replace(Loaded& loaded, Loaded next) {
  next.world.revision.number = loaded.world.revision.number + 1;
  std::swap(loaded, next);
}

std::string changed(const char* what, const char* by) {
  std::string text = kBounded;
  return text.replace(text.find(what), std::string(what).size(), by);
}

TEST(QueryWorld, AnswersForAReplacedWorldLikeNewQueries) {
  const std::string worlds[] = {changed("seed = 5", "seed = 6"),
                                changed("relief_m = 60", "relief_m = 20"),
                                changed("block_vertices = 33", "block_vertices = 17"),
                                changed("[[scatter]]\nmodel = \"tree\"\ncount = 3\n",
                                        "[[scatter]]\nmodel = \"rock\"\ncount = 9\n#"),
                                std::string(kBounded) + "[water]\nlevel_m = 40\n"};
  for (std::string text : worlds) {
    if (const auto at = text.find("#iterations"); at != std::string::npos)
      text.erase(at, text.find("\n\n", at) - at);
    Loaded loaded = Loaded::parsed(kBounded);
    World query(loaded.world, loaded.registry);
    PathFinder finder(query);
    const auto place = [](int i) {
      return core::WorldPosition{{i % 3, i % 2}, {3.1 * i, 60, 2.7 * i}};
    };
    for (int i = 0; i < 10; ++i)
      ASSERT_TRUE(query.ground(place(i)) && query.cast({.origin = place(i)}));
    finder.begin(place(0), place(4));
    finder.avoid(place(2));
    (void)finder.advance(1);
    replace(loaded, Loaded::parsed(text));
    World fresh(loaded.world, loaded.registry);
    EXPECT_EQ(query.models_reach_m(), fresh.models_reach_m());
    std::vector<NearbyModel> near, near_fresh;
    for (int i = 0; i < 10; ++i) {
      const auto a = query.ground(place(i)), b = fresh.ground(place(i));
      ASSERT_TRUE(a && b);
      EXPECT_EQ(a->height_m, b->height_m);
      EXPECT_EQ(a->kind, b->kind);
      EXPECT_EQ(a->water_depth_m, b->water_depth_m);
      EXPECT_EQ(query.cast({.origin = place(i)})->distance_m,
                fresh.cast({.origin = place(i)})->distance_m);
      ASSERT_TRUE(query.models_within(place(i), 40, near));
      ASSERT_TRUE(fresh.models_within(place(i), 40, near_fresh));
      EXPECT_TRUE(std::ranges::equal(near, near_fresh, {}, &NearbyModel::distance_m,
                                     &NearbyModel::distance_m));
    }
    const auto points = finder.advance(100'000);
    ASSERT_TRUE(points);
    for (std::size_t i = 1; i + 1 < points->size(); ++i)
      EXPECT_NEAR((*points)[i].local.y, fresh.ground((*points)[i])->height_m, 1e-9);
  }
}

TEST(QueryWorld, ObjectsKeepTheirPlacesInBlocksOfAnotherSize) {
  Loaded loaded = Loaded::parsed(kBounded);
  Objects objects(loaded.world);
  models::Collider ball;
  ball.shapes.emplace_back(models::Collider::Sphere{{0, 0, 0}, 1});
  const auto shape = Objects::make_shape(ball);
  ASSERT_TRUE(shape);
  const auto id = objects.add(7, *shape, {.position = {{2, 1}, {10, 80, 20}}});
  ASSERT_TRUE(id);
  World query(loaded.world, loaded.registry);
  query.meet(&objects);
  replace(loaded, Loaded::parsed(changed("block_vertices = 33", "block_vertices = 17")));
  EXPECT_EQ(objects.remove_stale(), 0U);
  const auto hit = query.cast({.origin = world::rebased({{2, 1}, {10, 95, 20}}, 64, 32)});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->kind, HitKind::kObject);
  EXPECT_NEAR(hit->distance_m, 14, 1e-6);
}

}  // namespace
}  // namespace psygen::query
