#include "editor/cost/edit_cost.hpp"

#include "tests/editor/cost/worlds.hpp"

namespace psygen::editor {
namespace {

TEST(EditCost, MoreModelsMakeABlockMoreExpensiveAndNoModel) {
  const EditCost few = edit_cost(*costed(), nullptr);
  const EditCost many = edit_cost(*costed_with({"scatter", 0, "count"}, "60"), nullptr);
  EXPECT_GT(few.model_seconds, 0);
  EXPECT_GT(few.block_seconds, few.model_seconds);
  EXPECT_GT(many.block_seconds, 2 * few.block_seconds);
  EXPECT_GT(many.block_bytes, 2 * few.block_bytes);
  EXPECT_EQ(many.model, few.model);
}

TEST(EditCost, ModelsWithoutInstancesCostNothing) {
  const EditCost some = edit_cost(*costed(), nullptr);
  const EditCost none = edit_cost(*costed_with({"scatter", 0, "count"}, "0"), nullptr);
  EXPECT_LT(none.block_seconds, some.block_seconds);
  EXPECT_EQ(none.model, "rock");
}

TEST(EditCost, NeedsConfirmationBeyondALimitAndOnlyIfItGrows) {
  const CostLimits limits{1, 10, 4000, 4};
  const EditCost cheap{"tree", 0.5, 5, 500};
  EXPECT_TRUE(confirmation_for({}, cheap, limits).isEmpty());
  const EditCost slow_model{"tree", 1.5, 5, 500};
  EXPECT_TRUE(confirmation_for(cheap, slow_model, limits).contains("“tree” would take 1.5 s"));
  EXPECT_TRUE(confirmation_for(slow_model, slow_model, limits).isEmpty()) << "it was so before";
  const EditCost large{"tree", 0.5, 5, 2000};
  EXPECT_TRUE(
      confirmation_for(cheap, large, limits).contains("The cache would hold 2 such blocks."));
  EXPECT_TRUE(confirmation_for({"tree", 0.5, 5, 3000}, large, limits).isEmpty()) << "it shrinks";
  EXPECT_FALSE(confirmation_for(cheap, {"tree", 0.5, 20, 500}, limits).isEmpty());
}

}  // namespace
}  // namespace psygen::editor
