#include "engine/models/ground/ground_edits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "engine/models/edits.hpp"
#include "engine/models/terrain/ground.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "tests/engine/models/mesh_helpers.hpp"

namespace psygen::models {
namespace {

using core::TerrainVertex;
using test::synthesise;

constexpr double kBlockM = 63;

class EditedTerrain : public ::testing::Test {
 protected:
  std::unique_ptr<ModelType> type = make_terrain_type();
  Parameters paper = default_parameters(*type);
  EditLayer layer;
  std::vector<std::shared_ptr<const GroundEdit>> edits;

  void SetUp() override {
    paper.set_real(kTerrainSunAzimuth, 130);
    paper.set_real(kTerrainSunElevation, 20);
  }

  const GroundEdit& add(GroundEdit edit) {
    edit.id = static_cast<std::uint32_t>(edits.size()) + 1;
    edit.centre = core::normalised(edit.centre, kBlockM);
    seal(edit);
    edits.push_back(std::make_shared<const GroundEdit>(edit));
    EXPECT_TRUE(layer.ground.edits.add(edits.back(), kBlockM));
    return *edits.back();
  }
  static GroundEdit raised(core::WorldPosition at, double radius_m, double height_m) {
    GroundEdit edit;
    edit.centre = at;
    edit.radius_m = radius_m;
    edit.height_m = height_m;
    return edit;
  }
  GroundEdit any_edit(std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0, 1);
    GroundEdit edit;
    edit.change = static_cast<GroundChange>(random() % 4);
    edit.square = random() % 2 == 0;
    edit.centre = {{static_cast<std::int32_t>(random() % 16) - 8,
                    static_cast<std::int32_t>(random() % 16) - 8},
                   {kBlockM * unit(random), 0, kBlockM * unit(random)}};
    edit.radius_m = std::exp(unit(random) * 5) * 0.5;
    edit.falloff = random() % 4 == 0 ? 0 : unit(random);
    edit.height_m =
        edit.change == GroundChange::kRaise ? 80 * unit(random) - 40 : 100 * unit(random);
    if (edit.change >= GroundChange::kStampAdd) {
      auto map = std::make_shared<Heightmap>();
      map->columns = 2 + static_cast<std::uint32_t>(random() % 9);
      map->rows = 2 + static_cast<std::uint32_t>(random() % 9);
      for (std::uint32_t i = 0; i < map->columns * map->rows; ++i)
        map->heights_m.push_back(static_cast<float>(60 * unit(random)));
      edit.map = map;
      edit.square = true;
    }
    return edit;
  }

  Parameters node(std::int64_t x, std::int64_t z, int level, bool edited = true) const {
    Parameters p = paper;
    p.set_integer(kTerrainBlockX, x);
    p.set_integer(kTerrainBlockZ, z);
    p.set_integer(kTerrainNodeLevel, level);
    if (edited) p.set_edits(&layer, hash_of(x, z, level));
    return p;
  }
  std::uint64_t hash_of(std::int64_t x, std::int64_t z, int level) const {
    const core::BlockCoord at{static_cast<std::int32_t>(x), static_cast<std::int32_t>(z)};
    return layer.ground.hash_of(QuadCoord::of(at, static_cast<std::uint32_t>(level)),
                                std::ldexp(4 / 63.0, level), kBlockM);
  }
  std::uint64_t hash_of_all() const {
    return layer.ground.hash_of({QuadCoord::kMaxLevel, 0, 0}, 0, kBlockM);
  }
  std::vector<TerrainVertex> vertices(const Parameters& p, int mesh_level) const {
    return synthesise(*type, p, mesh_level).vertices<TerrainVertex>();
  }
};

TEST_F(EditedTerrain, ARaisedHillIsInTheMeshAndInTheQueriesAlike) {
  add(raised({{0, 0}, {31, 0, 31}}, 20, 25));
  const auto before = vertices(node(0, 0, 0, false), 0), after = vertices(node(0, 0, 0), 0);
  const double quantum_m = 120.0 / 65535;
  const std::size_t middle = 31 * 64 + 31;
  EXPECT_NEAR((after[middle].height - before[middle].height) * quantum_m, 25, 2 * quantum_m);
  EXPECT_EQ(after[0].height, before[0].height);
  const BlockGround ground(node(0, 0, 0), {0, 0}, 1000);
  const BlockGround single(node(0, 0, 0), {0, 0}, 1);
  for (int z = 0; z < 64; z += 7) {
    for (int x = 0; x < 64; x += 7) {
      const glm::dvec2 at(x, z);
      EXPECT_NEAR(ground.at(at).height_m,
                  after[static_cast<std::size_t>(z * 64 + x)].height * quantum_m, 1e-3);
      EXPECT_EQ(ground.at(at).height_m, single.at(at).height_m);
    }
  }
}

TEST_F(EditedTerrain, FlatteningMakesTheMiddleFlatAndCliffsHaveNoTransition) {
  GroundEdit flat = raised({{0, 0}, {31, 0, 31}}, 20, 40);
  flat.change = GroundChange::kFlatten;
  flat.falloff = 0;
  add(flat);
  const auto base = vertices(node(0, 0, 0, false), 0), edited = vertices(node(0, 0, 0), 0);
  for (int z = 0; z < 64; ++z) {
    for (int x = 0; x < 64; ++x) {
      const auto i = static_cast<std::size_t>(z * 64 + x);
      const double away = std::hypot(x - 31, z - 31);
      EXPECT_EQ(edited[i].height, away <= 20 ? std::round(40 / 120.0 * 65535) : base[i].height)
          << x << ' ' << z;
    }
  }
}

TEST_F(EditedTerrain, HeightsStayWithinTheHeightRange) {
  add(raised({{0, 0}, {16, 0, 31}}, 15, 120));
  add(raised({{0, 0}, {48, 0, 31}}, 15, -120));
  const auto edited = vertices(node(0, 0, 0), 0);
  EXPECT_EQ(edited[31 * 64 + 16].height, 65535);
  EXPECT_EQ(edited[31 * 64 + 48].height, 0);
}

// Nodes of every level share vertices with their neighbours and with the nodes below them.
TEST_F(EditedTerrain, SharedVerticesOfNeighboursAndLevelsAgreeWithManyEdits) {
  std::mt19937 random(5);
  for (int i = 0; i < 200; ++i)
    add(any_edit(random));
  for (int level = 0; level <= 4; ++level) {
    const auto here = vertices(node(-1, 0, level), 1);
    const auto east = vertices(node(0, 0, level), 1), south = vertices(node(-1, 1, level), 1);
    constexpr std::size_t n = 22, last = n - 1;
    std::size_t changed = 0;
    const auto base = vertices(node(-1, 0, level, false), 1);
    for (std::size_t k = 0; k < n; ++k) {
      EXPECT_EQ(here[k * n + last].height, east[k * n].height);
      EXPECT_EQ(here[last * n + k].height, south[k].height);
      EXPECT_EQ(here[k * n + last].normal_x, east[k * n].normal_x);
      EXPECT_EQ(here[k * n + last].sun, east[k * n].sun);
      EXPECT_EQ(here[k * n + last].ambient, east[k * n].ambient);
      EXPECT_EQ(here[k * n + last].coarse_height, east[k * n].coarse_height);
    }
    for (std::size_t i = 0; i < n * n; ++i)
      changed += here[i].height != base[i].height;
    EXPECT_GT(changed, n) << level;
    if (level == 0) continue;
    // The child at the node's corner has every vertex of its quarter.
    const auto child = vertices(node(-2, 0, level - 1), 1);
    for (std::size_t z = 0; 2 * z < n; ++z) {
      for (std::size_t x = 0; 2 * x < n; ++x)
        EXPECT_EQ(here[z * n + x].height, child[2 * z * n + 2 * x].height) << level;
    }
  }
}

TEST_F(EditedTerrain, EditsOutsideTheHashChangeNoBitOfAMesh) {
  std::mt19937 random(9);
  std::size_t untouched = 0, touched = 0;
  for (int round = 0; round < 600; ++round) {
    layer = {};
    edits.clear();
    GroundEdit edit = any_edit(random);
    edit.radius_m = std::min(edit.radius_m, 60.0);
    add(edit);
    const int level = static_cast<int>(random() % 4);
    const core::BlockCoord block = edits[0]->centre.block;
    const auto step = [&random] { return static_cast<std::int64_t>(random() % 5) - 2; };
    const std::int64_t x = (block.x >> level) + step(), z = (block.z >> level) + step();
    const Parameters p = node(x, z, level);
    Parameters forced = p;
    forced.set_edits(&layer, 1);
    const int mesh_level = static_cast<int>(random() % 3);
    const auto base = synthesise(*type, node(x, z, level, false), mesh_level);
    const auto edited = synthesise(*type, forced, mesh_level);
    if (p.edits_hash() == 0) {
      EXPECT_TRUE(base.vertex_bytes == edited.vertex_bytes) << round;
      ++untouched;
    } else {
      touched += base.vertex_bytes != edited.vertex_bytes;
    }
  }
  EXPECT_GT(untouched, 30u);
  EXPECT_GT(touched, 30u);
}

TEST_F(EditedTerrain, ALargeHillDarkensTheGroundBehindIt) {
  add(raised({{0, 0}, {31, 0, 31}}, 60, 60));
  // The sun is in the south-east, so the shadow falls to the north-west, beyond the hill's base.
  const auto base = vertices(node(-1, -1, 0, false), 0), edited = vertices(node(-1, -1, 0), 0);
  double before = 0, after = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < base.size(); ++i) {
    if (base[i].height != edited[i].height) continue;
    before += base[i].sun;
    after += edited[i].sun;
    ++count;
  }
  EXPECT_GT(count, base.size() / 2);
  EXPECT_LT(after, 0.95 * before);
}

TEST_F(EditedTerrain, UndoingAnEditRestoresEveryHash) {
  std::mt19937 random(2);
  for (int i = 0; i < 100; ++i)
    add(any_edit(random));
  const std::uint64_t all = hash_of_all();
  std::vector<std::uint64_t> hashes;
  for (int level = 0; level < 6; ++level)
    hashes.push_back(hash_of(-1, 0, level));
  const EditLayer before = layer;
  const GroundEdit last = add(any_edit(random));
  EXPECT_NE(hash_of_all(), all);
  layer.ground.edits.remove(last, kBlockM);
  EXPECT_EQ(hash_of_all(), all);
  for (int level = 0; level < 6; ++level)
    EXPECT_EQ(hash_of(-1, 0, level), hashes[static_cast<std::size_t>(level)]);
  EXPECT_TRUE(GroundStack::same_in(before.ground, before.ground, QuadCoord::of({0, 0}, 3), 0.5));
}

// Wide enough that the nodes of all levels have edits at their margins.
TEST_F(EditedTerrain, SameInNeverMissesAChangeOfTheHash) {
  std::mt19937 random(21);
  const auto add_anywhere = [&] {
    GroundEdit edit = any_edit(random);
    edit.centre.block = {static_cast<std::int32_t>(random() % 80) - 40,
                         static_cast<std::int32_t>(random() % 80) - 40};
    add(edit);
  };
  for (int i = 0; i < 60; ++i)
    add_anywhere();
  std::size_t same = 0;
  for (int round = 0; round < 2000; ++round) {
    const EditLayer before = layer;
    const int level = static_cast<int>(random() % 9);
    const unsigned span = level < 4 ? 17 : 4;
    const std::int64_t x = static_cast<std::int64_t>(random() % span) - span / 2;
    const std::int64_t z = static_cast<std::int64_t>(random() % span) - span / 2;
    const std::uint64_t hash = hash_of(x, z, level);
    add_anywhere();
    const core::BlockCoord at{static_cast<std::int32_t>(x), static_cast<std::int32_t>(z)};
    const bool says_same = GroundStack::same_in(
        before.ground, layer.ground, QuadCoord::of(at, static_cast<std::uint32_t>(level)),
        std::ldexp(4 / 63.0, level));
    if (says_same) {
      EXPECT_EQ(hash_of(x, z, level), hash) << "level " << level;
    }
    same += says_same ? 1 : 0;
  }
  EXPECT_GT(same, 200u);
}

TEST_F(EditedTerrain, TheHashDependsOnTheOrderOfTheEdits) {
  GroundEdit flat = raised({{0, 0}, {31, 0, 31}}, 10, 60);
  flat.change = GroundChange::kFlatten;
  const GroundEdit first = add(flat);
  add(raised({{0, 0}, {31, 0, 31}}, 40, 10));
  const auto lifted = vertices(node(0, 0, 0), 0);
  const std::uint64_t hash = hash_of(0, 0, 0);
  layer.ground.edits.remove(first, kBlockM);
  add(flat);  // after the hill now, which it cuts off
  const auto cut = vertices(node(0, 0, 0), 0);
  constexpr std::size_t kMiddle = 31 * 64 + 31;
  EXPECT_NE(cut[kMiddle].height, lifted[kMiddle].height);
  EXPECT_NE(hash_of(0, 0, 0), hash);
}

// Ids are unique in a block; blocks that were loaded separately may have equal ids.
TEST_F(EditedTerrain, EditsOfTwoBlocksWithTheSameIdAreTwoEdits) {
  GroundEdit hill = add(raised({{0, 0}, {62, 0, 31}}, 20, 30));
  GroundEdit flat = raised({{1, 0}, {1, 0, 31}}, 20, 50);
  flat.change = GroundChange::kFlatten;
  flat.id = hill.id;
  seal(flat);
  const auto first = std::make_shared<const GroundEdit>(hill);
  const auto second = std::make_shared<const GroundEdit>(flat);
  layer = {};
  ASSERT_TRUE(layer.ground.edits.add(second, kBlockM));
  const std::uint64_t alone = hash_of(0, 0, 0);
  ASSERT_TRUE(layer.ground.edits.add(first, kBlockM));
  const std::uint64_t both = hash_of(0, 0, 0);
  const auto here = vertices(node(0, 0, 0), 0);
  layer.ground.edits.remove(hill, kBlockM);
  EXPECT_EQ(hash_of(0, 0, 0), alone);
  layer = {};
  ASSERT_TRUE(layer.ground.edits.add(first, kBlockM));
  ASSERT_TRUE(layer.ground.edits.add(second, kBlockM));
  EXPECT_EQ(hash_of(0, 0, 0), both);
  const auto again = vertices(node(0, 0, 0), 0);
  for (std::size_t i = 0; i < here.size(); ++i)
    ASSERT_EQ(here[i].height, again[i].height) << i;
}

TEST_F(EditedTerrain, SealingRecordsTheLargestHeightChangeOfAnEdit) {
  GroundEdit dug = raised({{0, 0}, {31, 0, 31}}, 10, -7);
  EXPECT_EQ(add(dug).max_m, 7);
  dug.change = GroundChange::kStampAdd;
  dug.map = std::make_shared<Heightmap>(Heightmap{2, 2, {1, -9, 3, 4}});
  EXPECT_EQ(add(dug).max_m, 9);
  dug.change = GroundChange::kStampSet;
  EXPECT_GT(add(dug).max_m, 1e6);
}

TEST_F(EditedTerrain, ThePredictedStepsCountTheHeightsThatEditsChange) {
  const auto more = [&](std::int64_t x, int mesh_level) {
    return type->steps(node(x, 0, 0), mesh_level) - type->steps(node(x, 0, 0, false), mesh_level);
  };
  EXPECT_EQ(more(0, 0), 0);
  GroundEdit cover = raised({{0, 0}, {31, 0, 31}}, 200, 5);
  cover.square = true;
  add(cover);
  const double one = more(0, 0), coarse = more(0, 2);
  EXPECT_GT(one, 64 * 64);
  EXPECT_GT(coarse, 0);
  EXPECT_LT(coarse, one);
  for (int i = 1; i < 100; ++i)
    add(cover);
  EXPECT_NEAR(more(0, 0) / one, 100, 1);
  // Outside the heights on which its light depends.
  EXPECT_LT(more(1000, 0), 0.01 * one);
  layer = {};
  GroundEdit small = cover;
  small.radius_m = 3;  // of 63 m, so about a hundredth of the area
  add(small);
  EXPECT_GT(more(0, 0), 0.002 * one);
  EXPECT_LT(more(0, 0), 0.05 * one);
}

TEST_F(EditedTerrain, NoMeshDeviatesFromTheGroundByMoreThanItsError) {
  std::mt19937 random(31);
  for (int round = 0; round < 20; ++round) {
    layer = {};
    edits.clear();
    for (int i = 0; i < 3; ++i) {
      GroundEdit edit = raised({{0, 0}, {20.0 + 10 * i, 0, 30}},
                               4.0 + static_cast<double>(random() % 30), 10.0 + i);
      edit.falloff = 0.3;
      add(edit);
    }
    const BlockGround base(node(0, 0, 0, false), {0, 0}, 100000);
    const BlockGround edited(node(0, 0, 0), {0, 0}, 100000);
    const double limit_m = layer.ground.error_m(QuadCoord::of({0, 0}), 9, kBlockM);
    for (int z = 0; z < 63; ++z) {
      for (int x = 0; x < 63; ++x) {
        const auto change = [&](int stride) {
          return edited.at({x, z}, stride).height_m - base.at({x, z}, stride).height_m;
        };
        EXPECT_LE(std::abs(change(1) - change(9)), limit_m + 0.01);
      }
    }
  }
}

TEST_F(EditedTerrain, TooManyOverlappingEditsAreRejectedAndChangeNothing) {
  for (std::size_t i = 0; i < GroundEdits::kMaxTogether; ++i)
    add(raised({{0, 0}, {31, 0, 31}}, 5, 0.01));
  const std::uint64_t hash = hash_of_all();
  GroundEdit more = raised({{0, 0}, {31, 0, 31}}, 5, 0.01);
  more.id = 5000;
  EXPECT_FALSE(layer.ground.edits.add(std::make_shared<const GroundEdit>(more), kBlockM));
  EXPECT_EQ(hash_of_all(), hash);
}

}  // namespace
}  // namespace psygen::models
