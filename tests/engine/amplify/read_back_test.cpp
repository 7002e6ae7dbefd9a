// Whole blocks of the game's worlds, read by another library.
#include "tests/engine/exchange/read_back.hpp"

#include <gtest/gtest.h>

#include "engine/amplify/block_files.hpp"
#include "engine/world/files/world_file.hpp"
#include "tests/engine/world/shipped.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::amplify {
namespace {

using exchange::Format;

void expect_counts(const std::filesystem::path& file, const exchange::Document& document) {
  const exchange::ReadBack back(file);
  ASSERT_NE(back.scene(), nullptr) << back.error();
  EXPECT_EQ(exchange::counts_of(*back.scene()).triangles, document.triangle_count());
  EXPECT_GT(document.triangle_count(), 8000u);
}

TEST(BlockReadBack, TheFilesOfAmplifyHoldTheBlocksOfEveryWorld) {
  const core::BlockCoord block{3, 4};
  for (const auto& entry :
       std::filesystem::directory_iterator(world::testing::game_file("worlds"))) {
    SCOPED_TRACE(entry.path());
    models::Registry registry = models::make_standard_registry();
    const auto world = world::load_world(entry.path(), registry);
    ASSERT_TRUE(world);
    const auto document = block_document(*world, registry, block, 0);
    ASSERT_TRUE(document);
    for (const Format format : {Format::kGlb, Format::kObj}) {
      const TemporaryFolder folder;
      auto files = BlockFolder::open(folder.path(), *world, registry, format);
      ASSERT_TRUE(files);
      Options options;
      options.make_sink = [&] { return (*files)->make_sink(); };
      ASSERT_TRUE(amplify(*world, registry, {block.x, block.z, block.x + 1, block.z + 1}, options));
      expect_counts((*files)->file_of(block), *document);
    }
  }
}

}  // namespace
}  // namespace psygen::amplify
