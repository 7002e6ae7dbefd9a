#include "editor/pictures/export_file.hpp"

#include <gtest/gtest.h>

#include "engine/world/placement.hpp"
#include "tests/editor/pictures/worlds.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::editor {
namespace {

ParsedWorldPtr endless_world() {
  return *parse_world_text(testing::world_text("endless"), "", {});
}

TEST(ExportFile, AModelAndABlockAreWritten) {
  const TemporaryFolder folder;
  const ParsedWorldPtr parsed = endless_world();
  std::vector<world::Placement> placements;
  world::place_models(parsed->world, parsed->registry, {3, 4}, placements);
  ASSERT_FALSE(placements.empty());
  const auto model = export_model(*parsed, {3, 4}, placements.back().index, 0, folder / "a.glb");
  ASSERT_TRUE(model.has_value()) << model.error().message;
  EXPECT_TRUE(model->starts_with("1 object, ")) << *model;
  const auto block = export_block(*parsed, {3, 4}, 3, folder / "b.obj");
  ASSERT_TRUE(block.has_value()) << block.error().message;
  for (const char* file : {"a.glb", "b.obj", "b.mtl"})
    EXPECT_TRUE(std::filesystem::is_regular_file(folder / file)) << file;
}

TEST(ExportFile, MissingBlocksAndModelsAreErrors) {
  const TemporaryFolder folder;
  const ParsedWorldPtr parsed = endless_world();
  EXPECT_FALSE(export_model(*parsed, {0, 0}, 999'999, 0, folder / "a.glb").has_value());
  EXPECT_FALSE(export_block(*parsed, {0, 0}, 3, folder / "a.txt").has_value());
  EXPECT_EQ(folder.file_count(), 0U);
}

}  // namespace
}  // namespace psygen::editor
