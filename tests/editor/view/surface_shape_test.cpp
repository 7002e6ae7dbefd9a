// Heights that the view keeps when the world changes: under marks and grid, and for rays.
#include "editor/view/surface_shape.hpp"

#include <gtest/gtest.h>

#include "editor/document/parsed_world.hpp"
#include "editor/view/grid_overlay.hpp"
#include "editor/view/tool_overlay.hpp"
#include "engine/world/world.hpp"
#include "tests/editor/document/support.hpp"

namespace psygen::editor {
namespace {

using testing::kWorld;
using testing::replaced;

world::World world_of(const std::string& text) {
  const auto parsed = parse_world_text(text, "test", {});
  EXPECT_TRUE(parsed) << parsed.error().message;
  return (*parsed)->world;
}
std::string with_road(double x_m) {
  return std::string(kWorld) + "[[road]]\npoints_m = [[" + std::to_string(x_m) + ", 20], [" +
         std::to_string(x_m + 30) + ", 60]]\n";
}
std::string with_terrain(const std::string& line) {
  return replaced(kWorld, "octaves = 4", "octaves = 4\n" + line);
}

TEST(SurfaceShape, DependsOnlyOnGroundAndWater) {
  const SurfaceShape shape(world_of(kWorld));
  EXPECT_EQ(shape, SurfaceShape(world_of(kWorld)));
  EXPECT_EQ(shape, SurfaceShape(world_of(replaced(kWorld, "count = 3", "count = 30"))));
  EXPECT_EQ(SurfaceShape(world_of(with_road(20))), SurfaceShape(world_of(with_road(20))));
  EXPECT_FALSE(shape == SurfaceShape(world_of(replaced(kWorld, "seed = 5", "seed = 6"))));
  EXPECT_FALSE(shape == SurfaceShape(world_of(replaced(kWorld, "octaves = 4", "octaves = 5"))));
  EXPECT_FALSE(shape == SurfaceShape(world_of(with_road(20))));
  EXPECT_FALSE(shape == SurfaceShape(world_of(std::string(kWorld) + "[water]\nlevel_m = 3\n")));
}

TEST(SurfaceShape, DependsOnTheBordersOfTheWorld) {
  const SurfaceShape shape(world_of(kWorld));
  for (const char* blocks : {"blocks = [9, 4]", "blocks = [8, 5]", "blocks = [0, 0]"}) {
    const SurfaceShape other(world_of(replaced(kWorld, "blocks = [8, 4]", blocks)));
    EXPECT_FALSE(shape == other) << blocks;
    EXPECT_TRUE(shape.has_base_of(other)) << blocks;
    EXPECT_FALSE(SurfaceDifference(shape, other).at({0, 0})) << "its heights are the same";
  }
}

TEST(KeptGround, FollowsTheSurfaceOfTheWorldOnceItIsToldOfAChange) {
  const world::World world = world_of(kWorld);
  const world::World smaller = world_of(replaced(kWorld, "blocks = [8, 4]", "blocks = [2, 2]"));
  KeptGround kept(std::size_t{16} << 20);
  const std::shared_ptr<BareGround> first = kept.of(world);
  EXPECT_TRUE(first->world.scatter.empty());
  EXPECT_EQ(kept.of(smaller), first) << "not told yet";
  kept.note_world();
  EXPECT_EQ(kept.of(world_of(replaced(kWorld, "count = 3", "count = 30"))), first);
  const core::WorldPosition place{{5, 3}, {1, 0, 1}};
  EXPECT_TRUE(kept.of(world)->queries.ground(place));
  kept.note_world();
  EXPECT_NE(kept.of(smaller), first);
  EXPECT_FALSE(kept.of(smaller)->queries.ground(place)) << "outside the smaller world";
}

TEST(SurfaceShape, DiffersOnlyUnderARoad) {
  const SurfaceShape before(world_of(kWorld)), after(world_of(with_road(20)));
  SurfaceDifference difference(before, after);
  EXPECT_TRUE(difference.at({0, 0}));
  EXPECT_FALSE(difference.at({6, 3}));
  EXPECT_TRUE(difference.at({0, 0})) << "asked again";
  const SurfaceShape other(world_of(replaced(kWorld, "octaves = 4", "octaves = 5")));
  EXPECT_TRUE(SurfaceDifference(before, other).at({6, 3}));
}

// Lines over the whole world, and a handle.
ToolMarks marks() {
  ToolMarks marks;
  marks.handles.push_back({{400, 200}});
  for (int line = 0; line < 5; ++line)
    marks.lines.push_back({{{10, 50.0 * line + 10}, {490, 50.0 * line + 10}}});
  return marks;
}

// Expects the marks of a new overlay of this world.
void expect_as_new(const ToolOverlay& overlay, const world::World& world) {
  ToolOverlay anew;
  anew.set(marks(), world);
  std::vector<render::Line> lines, expected;
  overlay.add_lines({}, world.block_size_m(), lines);
  anew.add_lines({}, world.block_size_m(), expected);
  ASSERT_EQ(lines.size(), expected.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i].from, expected[i].from) << i;
    EXPECT_EQ(lines[i].to, expected[i].to) << i;
  }
}

TEST(ToolOverlay, ComputesHeightsOnlyWhereTheGroundHasChanged) {
  ToolOverlay overlay;
  overlay.set(marks(), world_of(kWorld));
  const std::size_t all = overlay.lookups();
  EXPECT_GE(all, 300U);
  const auto lookups_for = [&](const std::string& text) {
    const std::size_t before = overlay.lookups();
    const world::World world = world_of(text);
    overlay.note_world();
    overlay.set(marks(), world);
    expect_as_new(overlay, world);
    return overlay.lookups() - before;
  };
  EXPECT_EQ(lookups_for(replaced(kWorld, "count = 3", "count = 30")), 0U);
  const std::size_t of_road = lookups_for(with_road(20));
  EXPECT_GT(of_road, 0U);
  EXPECT_LT(of_road, all / 2);
  EXPECT_EQ(lookups_for(with_road(20)), 0U) << "read anew";
  EXPECT_LT(lookups_for(with_road(40)), all / 2);
  EXPECT_EQ(lookups_for(with_terrain("height = 0.7")), all);
  EXPECT_EQ(lookups_for(replaced(kWorld, "seed = 5", "seed = 5\nblock_vertices = 32")), all)
      << "places are counted in blocks";
}

TEST(GridOverlay, IsRecomputedOnlyWhereTheGroundUnderItChanges) {
  GridOverlay grid;
  grid.set_spacing(2);  // 40 m on each side
  const core::WorldPosition eye{{6, 3}, {20, 10, 20}};
  const auto made_for = [&](const std::string& text) {
    const std::size_t before = grid.times_made();
    grid.note_world();
    EXPECT_FALSE(grid.lines(world_of(text), eye).empty());
    return grid.times_made() - before;
  };
  EXPECT_EQ(made_for(kWorld), 1U);
  EXPECT_EQ(made_for(replaced(kWorld, "count = 3", "count = 30")), 0U);
  EXPECT_EQ(made_for(with_road(20)), 0U) << "far from it";
  EXPECT_EQ(made_for(with_road(400)), 1U);
  EXPECT_EQ(made_for(with_road(400)), 0U);
  EXPECT_EQ(made_for(with_terrain("height = 0.7")), 1U);
}

}  // namespace
}  // namespace psygen::editor
