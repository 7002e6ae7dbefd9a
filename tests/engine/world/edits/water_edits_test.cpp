// Rivers and lakes that a game adds.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "engine/world/edits/edit_bytes.hpp"
#include "engine/world/edits/edits.hpp"
#include "tests/engine/world/river_world.hpp"

namespace psygen::world {
namespace {

using testing::ground_in;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kBrookLand;
using testing::parsed;
using testing::registry;
using testing::river_world;

// A brook like that of river_world(), and a pond on its way.
River brook() {
  return river_world().shaped.rivers[1];
}
Lake pond() {
  Lake lake;
  lake.centre_m = {1770, 1425};
  lake.radius_m = 18;
  lake.depth_m = 2;
  return lake;
}

class WaterByHand : public ::testing::Test {
 protected:
  World world_ = parsed(kBrookLand);
  Edits edits_;
  void apply() { set_edits(world_, edits_.layer()); }
  WaterPoint water(glm::dvec2 at_m) const { return water_at(world_, world_.position(at_m)); }
};

TEST_F(WaterByHand, ARiverIsThatOfAFile) {
  const World of_file = parsed(std::string(kBrookLand) + testing::kBrookTable);
  const auto added = edits_.add_river(world_, brook());
  ASSERT_TRUE(added) << added.error().message;
  EXPECT_GE(added->body, kFirstAdded);
  EXPECT_THAT(added->warnings, IsEmpty());
  apply();
  int wet = 0;
  for (double z = 1240; z < 1660; z += 3.7) {
    for (double x = 1650; x < 1960; x += 3.3) {
      EXPECT_EQ(ground_in(world_, {x, z}), ground_in(of_file, {x, z}));
      const WaterPoint a = water({x, z}), b = water_at(of_file, of_file.position({x, z}));
      ASSERT_EQ(a.depth_m, b.depth_m);
      ASSERT_EQ(a.flow_m_s, b.flow_m_s);
      if (a.body >= kFirstAdded) {
        EXPECT_EQ(a.body, added->body);
        ++wet;
      }
    }
  }
  EXPECT_GT(wet, 100);
}

TEST_F(WaterByHand, ARiverFlowsThroughALakeThatWasAddedBefore) {
  const auto lake = edits_.add_lake(world_, pond());
  ASSERT_TRUE(lake) << lake.error().message;
  apply();
  const auto river = edits_.add_river(world_, brook());
  ASSERT_TRUE(river) << river.error().message;
  apply();
  EXPECT_EQ(water({1770, 1425}).body, lake->body);
  EXPECT_EQ(water({1850, 1332}).body, river->body);
  EXPECT_GT(water({1850, 1332}).surface_m, water({1770, 1425}).surface_m);
  ASSERT_TRUE(edits_.remove_water(world_, lake->body));
  apply();
  EXPECT_NE(water({1770, 1425}).body, lake->body);
  EXPECT_EQ(water({1850, 1332}).body, river->body);
  ASSERT_TRUE(edits_.remove_water(world_, river->body));
  EXPECT_TRUE(edits_.empty());
  EXPECT_FALSE(edits_.remove_water(world_, river->body));
}

TEST_F(WaterByHand, ALakeDamsARiverOfTheFile) {
  world_ = river_world();
  const core::WorldPosition above = world_.position({1789, 1411});
  const WaterPoint before = water_at(world_, above);
  Lake dam = pond();
  dam.centre_m = {1765, 1427};
  dam.radius_m = 30;
  dam.spill_m = before.surface_m + 1;
  const auto lake = edits_.add_lake(world_, dam);
  ASSERT_TRUE(lake) << lake.error().message;
  apply();
  const WaterPoint here = water({1765, 1427});
  EXPECT_EQ(here.body, lake->body);
  EXPECT_EQ(here.surface_m, *dam.spill_m);
  EXPECT_EQ(water({1735, 1495}).body, testing::kTheBrook) << "no water follows below the dam";
}

TEST_F(WaterByHand, LaterEditsOfTheGroundMoveNoWater) {
  const auto river = edits_.add_river(world_, brook());
  ASSERT_TRUE(river);
  apply();
  const WaterPoint before = water({1789, 1411});
  ASSERT_FALSE(before.is_dry());
  ASSERT_TRUE(edits_.raise(world_, world_.position({1789, 1411}), 12, 8));
  apply();
  EXPECT_TRUE(water({1789, 1411}).is_dry()) << "a dam is dry";
  EXPECT_EQ(water_surface(world_, world_.position({1789, 1411}))->surface_m, before.surface_m);
}

TEST_F(WaterByHand, BytesOfTheBlocksInAnyOrderGiveTheSameWater) {
  ASSERT_TRUE(edits_.add_lake(world_, pond()));
  apply();
  ASSERT_TRUE(edits_.add_river(world_, brook()));
  const auto blocks = changed_blocks({}, edits_);
  EXPECT_GT(blocks.size(), 8U);
  Edits loaded;
  for (auto block = blocks.rbegin(); block != blocks.rend(); ++block) {
    const auto ok =
        load_block(loaded, world_, registry(), *block, encode_block(edits_, registry(), *block));
    ASSERT_TRUE(ok) << ok.error().message;
  }
  EXPECT_THAT(changed_blocks(edits_, loaded).size(), blocks.size()) << "other objects";
  apply();
  World other = world_;
  set_edits(other, loaded.layer());
  const models::QuadCoord all{models::QuadCoord::kMaxLevel, 0, 0};
  EXPECT_EQ(loaded.layer()->ground.edits.hash_of(all, 0, 64),
            edits_.layer()->ground.edits.hash_of(all, 0, 64));
  int rivers = 0;
  for (double z = 1240; z < 1660; z += 11) {
    for (double x = 1650; x < 1960; x += 7) {
      const WaterPoint a = water({x, z}), b = water_at(other, other.position({x, z}));
      ASSERT_EQ(a.surface_m, b.surface_m);
      ASSERT_EQ(a.depth_m, b.depth_m);
      ASSERT_EQ(a.body, b.body);
      ASSERT_EQ(a.discharge_m3_s, b.discharge_m3_s);
      rivers += a.discharge_m3_s ? 1 : 0;
    }
  }
  EXPECT_GT(rivers, 0);
}

// The blocks of older programs have no discharge of a river's points.
TEST_F(WaterByHand, RiversWithoutADischargeGetThatOfTheirSpeed) {
  ASSERT_TRUE(edits_.add_river(world_, brook()));
  const core::BlockCoord block = changed_blocks({}, edits_).front();
  std::vector<std::byte> bytes = encode_block(edits_, registry(), block);
  const models::GroundEdit& edit = *edits_.layer()->block(block)->ground.front();
  const std::vector<models::RiverPoint>& points = edit.river->points;
  const auto first = std::bit_cast<std::array<std::byte, 8>>(points[0].at_m.x);
  const auto found = std::ranges::search(bytes, first);
  ASSERT_FALSE(found.empty());
  auto at = found.begin();
  for (std::size_t i = 0; i < points.size(); ++i) {  // 11 numbers stay, the discharge goes
    const auto after = std::next(at, 11 * sizeof(double));
    at = bytes.erase(after, std::next(after, sizeof(double)));
  }
  constexpr std::size_t kChange = 4 + 2 + 3 * 4 + 4;  // magic, version, counts, id
  ASSERT_NE(bytes[kChange] & std::byte{0x40}, std::byte{0});
  bytes[kChange] &= std::byte{0xBF};
  Edits loaded;
  const auto ok = load_block(loaded, world_, registry(), block, bytes);
  ASSERT_TRUE(ok) << ok.error().message;
  const auto& old = loaded.layer()->block(block)->ground.front()->river->points;
  ASSERT_EQ(old.size(), points.size());
  for (std::size_t i = 0; i < old.size(); ++i) {
    const models::RiverPoint& p = old[i];
    EXPECT_EQ(p.foam, points[i].foam);
    EXPECT_EQ(p.discharge_m3_s, p.speed_m_s * models::cross_section_m2(p));
    EXPECT_NEAR(p.discharge_m3_s, points[i].discharge_m3_s, 1e-9 * points[i].discharge_m3_s);
  }
  // Nothing but a river has a discharge.
  bytes = encode_block(edits_, registry(), block);
  bytes[kChange] = std::byte{0x40};
  EXPECT_FALSE(load_block(loaded, world_, registry(), block, bytes));
}

TEST_F(WaterByHand, DamagedBytesAreRejected) {
  ASSERT_TRUE(edits_.add_river(world_, brook()));
  const core::BlockCoord block = changed_blocks({}, edits_).front();
  const std::vector<std::byte> good = encode_block(edits_, registry(), block);
  Edits loaded;
  for (std::size_t size = 0; size + 1 < good.size(); size += 13) {
    const std::vector<std::byte> cut(good.begin(),
                                     good.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(load_block(loaded, world_, registry(), block, cut));
  }
  // A number that is not finite, anywhere.
  int refused = 0;
  const auto nan =
      std::bit_cast<std::array<std::byte, 8>>(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t at = 100; at + 8 < good.size(); at += 8) {
    std::vector<std::byte> bad = good;
    std::ranges::copy(nan, bad.begin() + static_cast<std::ptrdiff_t>(at));
    const auto ok = load_block(loaded, world_, registry(), block, bad);
    if (ok) continue;
    ++refused;
    EXPECT_FALSE(ok.error().message.empty());
  }
  EXPECT_GT(refused, 20);
}

TEST_F(WaterByHand, KeepTheirPlacesInBlocksOfAnotherSize) {
  ASSERT_TRUE(edits_.add_river(world_, brook()));
  apply();
  const WaterPoint before = water({1789, 1411});
  World other = parsed(
      testing::replaced(testing::replaced(kBrookLand, "block_vertices = 65", "block_vertices = 33"),
                        "[48, 48]", "[96, 96]"));
  set_edits(other, fitted(edits_, other, registry()).layer());
  const WaterPoint after = water_at(other, other.position({1789, 1411}));
  EXPECT_EQ(after.surface_m, before.surface_m);
  EXPECT_EQ(after.body, before.body);
}

TEST_F(WaterByHand, WrongWaterIsRejectedInOneSentenceAndChangesNothing) {
  constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
  const auto refusal_of_river = [&](const auto& change) {
    River river = brook();
    change(river);
    const auto added = edits_.add_river(world_, river);
    EXPECT_TRUE(edits_.empty());
    return added ? std::string() : added.error().message;
  };
  EXPECT_THAT(refusal_of_river([](River& r) { r.points_m.resize(1); }),
              HasSubstr("the river is not allowed: points_m: it must be 2 to 1000 points, not 1"));
  EXPECT_THAT(refusal_of_river([&](River& r) { r.points_m[2].x = kNoNumber; }),
              HasSubstr("point 2 is not finite"));
  EXPECT_THAT(refusal_of_river([](River& r) { r.enabled = false; }), HasSubstr("not enabled"));
  EXPECT_THAT(refusal_of_river([](River& r) { r.width_m = {}; }), HasSubstr("width_m"));
  EXPECT_THAT(refusal_of_river([](River& r) { r.width_m = {0}; }), HasSubstr("0 is not allowed"));
  EXPECT_THAT(refusal_of_river([&](River& r) { r.depth_m = {kNoNumber}; }),
              HasSubstr("depth_m: nan"));
  EXPECT_THAT(refusal_of_river([&](River& r) {
                r.discharge_m3_s = {1, 2};
              }),
              HasSubstr("discharge_m3_s"));
  EXPECT_THAT(refusal_of_river([&](River& r) { r.bank_m = kNoNumber; }), HasSubstr("bank_m"));
  EXPECT_THAT(refusal_of_river([&](River& r) { r.smoothing_m = -1; }), HasSubstr("smoothing_m"));
  const auto refusal_of_lake = [&](const auto& change) {
    Lake lake = pond();
    change(lake);
    const auto added = edits_.add_lake(world_, lake);
    EXPECT_TRUE(edits_.empty());
    return added ? std::string() : added.error().message;
  };
  EXPECT_THAT(refusal_of_lake([&](Lake& l) { l.radius_m = kNoNumber; }),
              HasSubstr("radius_m: nan"));
  EXPECT_THAT(refusal_of_lake([&](Lake& l) { l.centre_m.x = kNoNumber; }), HasSubstr("centre_m"));
  EXPECT_THAT(refusal_of_lake([&](Lake& l) { l.spill_m = kNoNumber; }), HasSubstr("spill_m"));
  EXPECT_THAT(refusal_of_lake([&](Lake& l) { l.depth_m = 0; }), HasSubstr("depth_m: 0"));
  EXPECT_THAT(refusal_of_lake([&](Lake& l) { l.shore_m = kNoNumber; }), HasSubstr("shore_m: nan"));
  models::GroundEdit raw;
  raw.change = models::GroundChange::kRiver;
  raw.centre = world_.position({1000, 1000});
  EXPECT_THAT(edits_.edit_ground(world_, raw).error().message, HasSubstr("add_river()"));
}

}  // namespace
}  // namespace psygen::world
