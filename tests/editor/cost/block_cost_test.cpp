#include "editor/cost/block_cost.hpp"

#include <cmath>
#include <set>

#include "engine/world/files/world_schema.hpp"
#include "tests/editor/cost/worlds.hpp"

namespace psygen::editor {
namespace {

constexpr core::BlockCoord kAround{20, 20};

void expect_same(const BlockCost& a, const BlockCost& b) {
  EXPECT_DOUBLE_EQ(a.models, b.models);
  EXPECT_NEAR(a.triangles, b.triangles, 1e-9 * b.triangles);
  EXPECT_NEAR(a.bytes, b.bytes, 1e-9 * b.bytes);
  EXPECT_NEAR(a.seconds, b.seconds, 1e-9 * b.seconds);
}

TEST(BlockSurvey, CostsOfASeriesOfWorldsEqualThoseOfEachAlone) {
  BlockSurvey survey(kAround, nullptr);
  for (const auto& parsed : {
           costed(),
           costed_with({"scatter", 0, "branches"}, "[2, 3]"),
           costed_with({"scatter", 0, "branches"}, "[3, 3]"),
           costed_with({"scatter", 1, "count"}, "9"),
           costed_with({"scatter", 0, "count"}, "9"),
           costed_with({"terrain", "relief_m"}, "90"),
           costed(),
       })
    expect_same(survey.cost(*parsed, false), block_cost(*parsed, kAround, nullptr, false));
}

TEST(BlockSurvey, ACurveHasTheCostsOfItsValues) {
  const auto parsed = costed();
  const auto sections = world::world_schema(kCostedWorld, parsed->world, parsed->registry).value();
  const world::WorldField& count = *world::find_field(sections, {"scatter", 0, "count"});
  const auto curve = cost_curve({.text = kCostedWorld,
                                 .file = "costed.toml",
                                 .register_models = {},
                                 .field = count,
                                 .around = kAround},
                                [] { return true; });
  ASSERT_GT(curve.size(), 5u);
  for (const CostPoint& point : {curve[0], curve[3], curve.back()}) {
    const auto toml = std::to_string(std::llround(point.value));
    ASSERT_TRUE(point.cost) << point.error;
    expect_same(*point.cost, block_cost(*costed_with(count.path, toml), kAround, nullptr, false));
  }
}

TEST(BlockNear, BlocksAreApartAndAroundTheirMiddle) {
  world::World world;
  world.blocks_x = world.blocks_z = 0;
  for (const int count : {4, 8, 16}) {
    std::set<std::pair<int, int>> seen;
    core::BlockCoord sum{0, 0};
    for (int i = 0; i < count; ++i) {
      const core::BlockCoord at = block_near(world, kAround, i);
      sum = {sum.x + at.x - kAround.x, sum.z + at.z - kAround.z};
      seen.emplace(at.x, at.z);
    }
    EXPECT_EQ(sum, (core::BlockCoord{0, 0})) << count;
    EXPECT_EQ(seen.size(), static_cast<std::size_t>(count));
  }
  world.blocks_x = world.blocks_z = 22;
  for (int i = 0; i < 8; ++i)
    EXPECT_TRUE(world.contains(block_near(world, kAround, i)));
}

TEST(BlockSurvey, AScatterCostsMoreWithMoreInstances) {
  BlockSurvey survey(kAround, nullptr);
  const BlockCost few = survey.cost(*costed(), false);
  const BlockCost more = survey.cost(*costed_with({"scatter", 0, "count"}, "12"), false);
  EXPECT_DOUBLE_EQ(few.models, 11);
  EXPECT_DOUBLE_EQ(more.models, 17);
  EXPECT_GT(more.triangles, few.triangles);
  EXPECT_GT(more.seconds, few.seconds);
}

TEST(BlockSurvey, MeasuresABlockOnRequest) {
  BlockSurvey survey(kAround, nullptr);
  EXPECT_FALSE(survey.cost(*costed(), false).measured_seconds);
  const auto measured = survey.cost(*costed(), true).measured_seconds;
  ASSERT_TRUE(measured);
  EXPECT_GT(*measured, 0);
}

}  // namespace
}  // namespace psygen::editor
