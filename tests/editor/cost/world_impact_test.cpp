#include "editor/cost/world_impact.hpp"

#include "tests/editor/cost/worlds.hpp"

namespace psygen::editor {
namespace {

using Kind = HeldMeshes::Kind;
constexpr core::BlockCoord kMiddle{32, 32};

CacheContents contents() {
  CacheContents contents;
  contents.budget_bytes = 1e6;
  contents.modelers = 2;
  contents.held = {{"terrain", Kind::kGround, 100, 1e5, 0.1},
                   {"tree", Kind::kModel, 600, 3e5, 1.2},
                   {"rock", Kind::kModel, 500, 2e5, 0.5},
                   {"merged", Kind::kDerived, 50, 1e5, 0.4}};
  return contents;
}

WorldImpact impact_of_value(const world::TextPath& path, const std::string& toml) {
  return impact_of(*costed(), *costed_with(path, toml), kMiddle, contents(), nullptr);
}

TEST(WorldImpact, ColoursChangeNoMesh) {
  const WorldImpact impact = impact_of_value({"sky", "exposure"}, "2");
  EXPECT_EQ(impact.changed, 0);
  EXPECT_EQ(impact.seconds, 0);
  EXPECT_EQ(impact.held, 1250);
  EXPECT_DOUBLE_EQ(impact.bytes, 7e5);
  EXPECT_EQ(impact_text(impact), "Nothing to rebuild.");
}

// Changes outside of the sample blocks are reported as such.
TEST(WorldImpact, ARoadFarAwayChangesFewMeshes) {
  const auto with_road =
      parse_world_text(std::string(kCostedWorld) + "\n[[road]]\npoints_m = [[10, 10], [60, 20]]\n",
                       "costed.toml", {});
  ASSERT_TRUE(with_road);
  const WorldImpact impact = impact_of(*costed(), **with_road, kMiddle, contents(), nullptr);
  EXPECT_EQ(impact.changed, 0);
  EXPECT_TRUE(impact.is_elsewhere);
  EXPECT_EQ(impact_text(impact), "Nothing near the camera needs rebuilding.");
}

TEST(WorldImpact, AnotherModelChangesItsMeshesAndMergedOnes) {
  const WorldImpact impact = impact_of_value({"scatter", 1, "subdivisions"}, "1");
  EXPECT_DOUBLE_EQ(impact.changed, 550);
  EXPECT_GT(impact.seconds, 0.2);
}

TEST(WorldImpact, AnotherGroundChangesAllModelsOnIt) {
  const WorldImpact impact = impact_of_value({"terrain", "relief_m"}, "77");
  EXPECT_GE(impact.changed, 150);
  const WorldImpact seed = impact_of_value({"world", "seed"}, "6");
  EXPECT_DOUBLE_EQ(seed.changed, 1250);
  EXPECT_NEAR(seed.seconds, 1.1, 0.6) << "of two modelers";
}

TEST(WorldImpact, MoreInstancesOfTheLastScatterKeepTheOthers) {
  const WorldImpact impact = impact_of_value({"scatter", 1, "count"}, "10");
  EXPECT_DOUBLE_EQ(impact.changed, 550) << "as many rocks again, and the merged ones";
  EXPECT_NEAR(impact.bytes, 9e5, 5e4);
}

TEST(WorldImpact, AModelWithoutCachedMeshesIsEstimatedFromTheOthers) {
  const WorldImpact impact = impact_of_value({"scatter", 1, "model"}, "\"grass\"");
  EXPECT_GT(impact.changed, 50);
  EXPECT_TRUE(impact_text(impact).contains("Memory afterwards"));
}

}  // namespace
}  // namespace psygen::editor
