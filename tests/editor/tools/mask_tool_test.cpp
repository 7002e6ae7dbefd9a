#include "editor/tools/mask_tool.hpp"

#include <gmock/gmock.h>

#include "engine/image/image_io.hpp"
#include "tests/editor/tools/support.hpp"

namespace psygen::editor {
namespace {

using testing::click;
using testing::good;
using testing::ground;
using ::testing::HasSubstr;
using testing::kWorld;
using testing::sky;
using testing::Toolbench;

// The trees of a world of 504 m × 252 m have a mask.
struct Masks : Toolbench {
  MaskTool tool{host()};
  Masks() {
    tool.choose(0);
    tool.make_mask();
    tool.set_radius_m(20);
  }
  const world::ScatterMask& mask() { return document.world().scatter[0].mask; }
  double share(double x, double z) { return world::mask_share(mask(), 0, {x, z}); }
};

TEST(MaskTool, ANewMaskChangesNothingUntilItIsPaintedOn) {
  Toolbench bench;
  MaskTool tool(bench.host());
  tool.make_mask();
  EXPECT_EQ(bench.messages.back(), "Choose a scatter layer for the mask first.");
  tool.choose(0);
  EXPECT_EQ(bench.chosen, "scatter[0]");
  click(tool, ground(50, 50));
  EXPECT_EQ(bench.messages.back(), "tree has no mask yet. Click \"New mask\".");
  EXPECT_EQ(bench.steps(), 0);
  tool.make_mask();
  ASSERT_TRUE(tool.has_picture());
  EXPECT_EQ(bench.last_step(), "New mask of tree");
  const world::ScatterMask& mask = bench.document.world().scatter[0].mask;
  EXPECT_EQ(mask.image, "world_tree_mask.png");
  EXPECT_EQ(mask.area_m, (std::array<double, 4>{0, 0, 504, 252}));
  EXPECT_EQ(mask.picture->width, 252U) << "a pixel is 2 m";
  EXPECT_EQ(world::mask_share(mask, 0, {500, 10}), 1);
  bench.document.undo_stack().undo();
  EXPECT_EQ(bench.document.text(), kWorld);
}

TEST(MaskTool, OfALargeWorldIsAroundTheViewAndItsAreaIsShownBefore) {
  Toolbench bench;
  EXPECT_TRUE(good(bench.document.set_value({"world", "blocks"}, "[0, 0]")));
  bench.around_m = {-5000.4, 7000};
  MaskTool tool(bench.host());
  EXPECT_TRUE(tool.marks().lines.empty());
  tool.choose(1);
  ASSERT_EQ(tool.marks().lines.size(), 1U) << "the border that it would have";
  EXPECT_EQ(tool.marks().lines[0].points_m[0], glm::dvec2(-5504, 6464));
  tool.make_mask();
  EXPECT_EQ(bench.document.world().scatter[1].mask.area_m,
            (std::array<double, 4>{-5504, 6464, -4480, 7488}));
  EXPECT_EQ(tool.marks().lines[0].points_m[0], glm::dvec2(-5504, 6464));
}

TEST(MaskTool, ANewMaskHasTheAreaAndTheResolutionThatWereSet) {
  Toolbench bench;
  MaskTool tool(bench.host());
  tool.choose(0);
  tool.set_new_mask(NewMask{false, 64, 0.01});
  tool.make_mask();
  EXPECT_EQ(bench.messages.back(), "A new mask's pixel is 0.01 m (allowed: 0.1 to 256 m).");
  tool.set_new_mask(NewMask{false, 2000, 0.1});
  tool.make_mask();
  EXPECT_THAT(bench.messages.back(), HasSubstr("20000 pixels a side (allowed: 4096)"));
  EXPECT_EQ(bench.steps(), 0);
  EXPECT_EQ(bench.document.text(), kWorld);
  tool.set_new_mask(NewMask{false, 64, 0.5});
  tool.make_mask();
  const world::ScatterMask& mask = bench.document.world().scatter[0].mask;
  EXPECT_EQ(mask.area_m, (std::array<double, 4>{68, 68, 132, 132}));
  EXPECT_EQ(mask.picture->width, 128U);
  EXPECT_EQ(bench.steps(), 1);
  bench.document.undo_stack().undo();
  EXPECT_EQ(bench.document.text(), kWorld);
}

TEST(MaskTool, AStrokeIsOneStepAndIsWrittenOnSave) {
  Masks bench;
  bench.tool.set_erases(true);
  bench.tool.press(ground(100, 100));
  EXPECT_LT(bench.share(100, 100), 0.01) << "the world answers at once";
  for (int x = 110; x <= 200; x += 30)
    bench.tool.drag(ground(x, 100));
  bench.tool.drag(sky());
  bench.tool.release();
  EXPECT_EQ(bench.steps(), 2);
  EXPECT_EQ(bench.last_step(), "Paint the mask of tree");
  EXPECT_LT(bench.share(125, 100), 0.01) << "between two events of the mouse";
  EXPECT_EQ(bench.share(100, 125), 1) << "beyond the radius";
  const double soft = bench.share(100, 115);
  EXPECT_GT(soft, 0.1);
  EXPECT_LT(soft, 0.9);
  bench.document.undo_stack().undo();
  EXPECT_EQ(bench.share(100, 100), 1);
  bench.document.undo_stack().redo();
  EXPECT_LT(bench.share(100, 100), 0.01);
  EXPECT_TRUE(good(bench.document.save()));
  EXPECT_TRUE(good(bench.document.open(bench.place.file)));
  EXPECT_LT(bench.share(125, 100), 0.01);
  EXPECT_EQ(bench.share(100, 125), 1);
}

TEST(MaskTool, StrengthAndShiftChangeTheBrush) {
  Masks bench;
  bench.tool.set_strength(0.5);
  ToolPoint at = ground(100, 100);
  at.fine = true;
  bench.tool.press(at);
  bench.tool.drag(ground(101, 100));
  bench.tool.drag(ground(100, 100));
  bench.tool.release();
  EXPECT_NEAR(bench.share(100, 100), 0.5, 0.01) << "twice over a place is no more";
  click(bench.tool, at);
  EXPECT_NEAR(bench.share(100, 100), 0.25, 0.01) << "another stroke is";
  click(bench.tool, ground(100, 100));
  EXPECT_NEAR(bench.share(100, 100), 0.625, 0.01);
  bench.tool.set_radius_m(0.01);
  EXPECT_EQ(bench.tool.brush().radius_m, MaskTool::kMinRadiusM);
  bench.tool.set_strength(1);
  click(bench.tool, ground(101, 101));
  EXPECT_EQ(bench.steps(), 5) << "the smallest brush meets a pixel";
}

TEST(MaskTool, EscapeCancelsTheStrokeAndAnEmptyStrokeIsNoStep) {
  Masks bench;
  EXPECT_TRUE(good(bench.document.save()));
  bench.tool.set_erases(true);
  bench.tool.press(ground(100, 100));
  EXPECT_TRUE(bench.document.is_modified());
  EXPECT_TRUE(bench.tool.cancel());
  EXPECT_EQ(bench.share(100, 100), 1);
  EXPECT_FALSE(bench.document.is_modified());
  bench.tool.release();
  EXPECT_EQ(bench.steps(), 1);
  bench.tool.set_erases(false);
  click(bench.tool, ground(100, 100));
  EXPECT_EQ(bench.steps(), 1) << "white on white";
  click(bench.tool, sky());
  EXPECT_EQ(bench.messages.back(), "There is no ground here. Paint on the ground.");
  click(bench.tool, ground(2000, 100));
  EXPECT_EQ(bench.messages.back(), "The brush is outside the mask. Paint inside the blue border.");
  // Undo during a stroke ends the stroke.
  bench.tool.set_erases(true);
  bench.tool.press(ground(100, 100));
  bench.document.undo_stack().undo();
  bench.tool.drag(ground(120, 100));
  bench.tool.release();
  EXPECT_EQ(bench.document.text(), kWorld);
}

// Undo during a stroke also removes its preview.
TEST(MaskTool, UndoDuringAStrokeRemovesItsPreview) {
  Masks bench;
  const auto share = [&](double x) { return bench.share(x, 100); };
  bench.tool.set_radius_m(10);
  bench.tool.set_erases(true);
  click(bench.tool, ground(100, 100));
  ASSERT_LT(share(100), 0.01);
  bench.tool.press(ground(200, 100));
  ASSERT_LT(share(200), 0.01);
  bench.document.undo_stack().undo();
  EXPECT_GT(share(100), 0.99);
  EXPECT_GT(share(200), 0.99);
  bench.tool.drag(ground(210, 100));
  bench.tool.release();
  EXPECT_GT(share(200), 0.99);
  bench.document.undo_stack().redo();
  EXPECT_LT(share(100), 0.01);
  EXPECT_GT(share(200), 0.99);
}

TEST(MaskTool, AnImageOfAnotherFormatStaysAndItsMaskBecomesAPng) {
  Toolbench bench;
  image::Image grey = image::make_image(16, 16, 255, 255, 255, 255);
  ASSERT_TRUE(
      good(image::write_png(bench.place.folder / "trees.jpg", grey)));  // a PNG despite its name
  ASSERT_TRUE(good(bench.document.set_value({"scatter", 0, "mask_image"}, "\"trees.jpg\"")));
  MaskTool tool(bench.host());
  tool.choose(0);
  tool.set_radius_m(60);
  tool.set_erases(true);
  click(tool, ground(100, 100));
  EXPECT_EQ(bench.document.world().scatter[0].mask.image, "world_tree_mask.png");
  EXPECT_THAT(bench.messages.back(), HasSubstr("trees.jpg is unchanged"));
  EXPECT_LT(world::mask_share(bench.document.world().scatter[0].mask, 0, {100, 100}), 0.01);
  EXPECT_TRUE(good(bench.document.save()));
  EXPECT_EQ(image::read_grey(bench.place.folder / "trees.jpg")->grey[0], 65535);
  bench.document.undo_stack().undo();
  EXPECT_EQ(bench.document.world().scatter[0].mask.image, "trees.jpg");
  EXPECT_EQ(world::mask_share(bench.document.world().scatter[0].mask, 0, {100, 100}), 1);
}

TEST(MaskTool, MarksShowTheBrushTheAreaAndTheMask) {
  Masks bench;
  EXPECT_EQ(bench.tool.marks().lines.size(), 1U) << "the border";
  bench.tool.hover(ground(100, 100));
  EXPECT_GT(bench.tool.marks().lines.size(), 100U);
  bench.tool.leave();
  EXPECT_EQ(bench.tool.marks().lines.size(), 1U);
}

}  // namespace
}  // namespace psygen::editor
