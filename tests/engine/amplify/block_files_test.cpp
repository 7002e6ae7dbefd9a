#include "engine/amplify/block_files.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/engine/amplify/throwing_type.hpp"
#include "tests/engine/world/shipped.hpp"
#include "tests/file_content.hpp"
#include "tests/full_disk.hpp"

namespace psygen::amplify {
namespace {

using exchange::Format;
using world::testing::kSmallWorld;
using world::testing::parsed;
using world::testing::registry;

constexpr Region kRegion{1, 1, 4, 3};

struct Made {
  Report report;
  std::uint64_t written, skipped;
};

core::Result<Made> make_files(const world::World& world, const std::filesystem::path& folder,
                              Format format, const std::atomic<bool>* stop = nullptr,
                              const models::Registry& types = registry()) {
  auto files = BlockFolder::open(folder, world, types, format);
  if (!files) return tl::unexpected(files.error());
  Options options;
  options.threads = 2;
  options.stop = stop;
  options.make_sink = [&] { return (*files)->make_sink(); };
  auto report = amplify(world, types, kRegion, options);
  if (!report) return tl::unexpected(report.error());
  return Made{*report, (*files)->written(), (*files)->skipped()};
}

TEST(BlockFiles, WritesOneFilePerBlockAndTheWorldNextToThem) {
  const TemporaryFolder folder;
  const auto made = make_files(parsed(kSmallWorld), folder.path(), Format::kGlb);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->written, 6u);
  EXPECT_EQ(folder.file_count(), 8u);  // with the world and the hash of a sample
  for (int x = 1; x < 4; ++x) {
    for (int z = 1; z < 3; ++z) {
      const std::string name = "block_" + std::to_string(x) + "_" + std::to_string(z) + ".glb";
      EXPECT_EQ(file_content(folder / name).substr(0, 4), "glTF") << name;
    }
  }
}

TEST(BlockFiles, ExistingFilesAreNotWrittenAgainAndTheHashCoversAllBlocks) {
  const TemporaryFolder folder;
  const world::World world = parsed(kSmallWorld);
  const auto first = make_files(world, folder.path(), Format::kGlb);
  ASSERT_TRUE(first);
  const std::string complete = file_content(folder / "block_2_2.glb");
  std::filesystem::remove(folder / "block_2_2.glb");
  std::ofstream(folder / "block_1_1.glb") << "mine";
  const auto second = make_files(world, folder.path(), Format::kGlb);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->written, 1u);
  EXPECT_EQ(second->skipped, 5u);
  EXPECT_EQ(file_content(folder / "block_2_2.glb"), complete);
  EXPECT_EQ(file_content(folder / "block_1_1.glb"), "mine");
  EXPECT_EQ(second->report.totals.hash.value(), first->report.totals.hash.value());
}

TEST(BlockFiles, ABlockThatLacksAMeshHasNoFileUntilItIsWhole) {
  const TemporaryFolder folder;
  ThrowingWorld throwing;
  const auto run = [&] {
    return make_files(throwing.world, folder.path(), Format::kGlb, nullptr, throwing.registry);
  };
  const auto broken = run();
  ASSERT_TRUE(broken) << broken.error().message;
  EXPECT_EQ(broken->written, 0u);
  EXPECT_FALSE(broken->report.complete);
  EXPECT_EQ(folder.file_count(), 1u);
  throwing.throws = false;
  const auto mended = run();
  ASSERT_TRUE(mended) << mended.error().message;
  EXPECT_EQ(mended->written, 6u);
  EXPECT_EQ(mended->skipped, 0u);
  EXPECT_TRUE(mended->report.complete);
  EXPECT_EQ(folder.file_count(), 8u);
}

TEST(BlockFiles, HalfWrittenFilesOfAKilledRunAreRemoved) {
  const TemporaryFolder folder;
  std::ofstream(folder / ".block_1_1.glb.99999999-0.partial") << "half";
  ASSERT_TRUE(make_files(parsed(kSmallWorld), folder.path(), Format::kGlb));
  EXPECT_EQ(folder.file_count(), 8u);
}

TEST(BlockFiles, AnInterruptedRunLeavesWholeFilesOnly) {
  const TemporaryFolder folder;
  const std::atomic<bool> stop{true};
  const auto made = make_files(parsed(kSmallWorld), folder.path(), Format::kObj, &stop);
  ASSERT_TRUE(made);
  EXPECT_FALSE(made->report.complete);
  EXPECT_EQ(folder.file_count(), 2u);  // the world and the hash of a sample
}

TEST(BlockFiles, TheBlocksOfAnotherWorldAreNotMixedIn) {
  const TemporaryFolder folder;
  world::World world = parsed(kSmallWorld);
  ASSERT_TRUE(make_files(world, folder.path(), Format::kObj));
  EXPECT_EQ(folder.file_count(), 20u);  // with an .mtl and a .png for each .obj
  world.seed += 1;
  const auto other = make_files(world, folder.path(), Format::kObj);
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("another world"), std::string::npos);
}

TEST(BlockFiles, TheBlocksOfAnotherVersionOfTheEngineAreNotMixedIn) {
  const TemporaryFolder folder;
  const world::World world = parsed(kSmallWorld);
  ASSERT_TRUE(make_files(world, folder.path(), Format::kGlb));
  const std::string hash = file_content(folder / "sample_glb.hash");
  ASSERT_EQ(hash.size(), 17u);
  std::filesystem::remove(folder / "block_2_2.glb");
  std::ofstream(folder / "sample_glb.hash") << "0123456789abcdef\n";
  const auto other = make_files(world, folder.path(), Format::kGlb);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, core::ErrorCode::kInvalidArgument);
  EXPECT_NE(other.error().message.find("sample_glb.hash"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "block_2_2.glb"));
  std::ofstream(folder / "sample_glb.hash") << hash;
  EXPECT_TRUE(make_files(world, folder.path(), Format::kGlb));
  EXPECT_TRUE(make_files(world, folder.path(), Format::kObj)) << "another format has its own";
}

TEST(BlockFiles, BlocksOfUnknownOriginAreNotClaimed) {
  const world::World world = parsed(kSmallWorld);
  for (const char* lost : {"world.toml", "sample_glb.hash"}) {
    const TemporaryFolder folder;
    ASSERT_TRUE(make_files(world, folder.path(), Format::kGlb));
    std::filesystem::remove(folder / lost);
    const auto made = make_files(world, folder.path(), Format::kGlb);
    ASSERT_FALSE(made) << lost;
    EXPECT_NE(made.error().message.find(lost), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder / lost));
    std::filesystem::resize_file(folder / "block_2_2.glb", 0);
    std::ofstream(folder / lost) << "";
    EXPECT_FALSE(make_files(world, folder.path(), Format::kGlb)) << lost;
    EXPECT_EQ(std::filesystem::file_size(folder / "block_2_2.glb"), 0u);
  }
}

TEST(BlockFiles, TruncatedOriginFilesStillIdentifyTheBlocks) {
  const world::World world = parsed(kSmallWorld);
  const TemporaryFolder folder;
  ASSERT_TRUE(make_files(world, folder.path(), Format::kGlb));
  for (const char* file : {"world.toml", "sample_glb.hash"}) {
    const std::string whole = file_content(folder / file);
    std::filesystem::resize_file(folder / file, 10);
    const auto made = make_files(world, folder.path(), Format::kGlb);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(file_content(folder / file), whole);
  }
}

TEST(BlockFiles, TruncatedFilesAreWrittenAgain) {
  for (const Format format : {Format::kGlb, Format::kObj}) {
    const TemporaryFolder folder;
    const world::World world = parsed(kSmallWorld);
    ASSERT_TRUE(make_files(world, folder.path(), format));
    const auto file = folder / fmt::format("block_2_2.{}", name_of(format));
    const std::string whole = file_content(file);
    for (const std::size_t left : {std::size_t{0}, std::size_t{9}, whole.size() - 1}) {
      std::filesystem::resize_file(file, left);
      const auto again = make_files(world, folder.path(), format);
      ASSERT_TRUE(again);
      EXPECT_EQ(again->written, 1u) << left;
      EXPECT_EQ(again->skipped, 5u) << left;
      EXPECT_EQ(file_content(file), whole) << left;
    }
  }
}

TEST(BlockFiles, AFolderThatCannotBeWrittenIsNamed) {
  const auto made = make_files(parsed(kSmallWorld), "/proc/nowhere", Format::kGlb);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find("/proc/nowhere"), std::string::npos);
}

TEST(BlockFiles, ADocumentHasAllModelsOfTheBlockAtTheirPositions) {
  const world::World world = parsed(kSmallWorld);
  const auto document = block_document(world, registry(), {2, 1}, 0);
  ASSERT_TRUE(document);
  Totals totals;
  BlockSynthesiser(world, registry()).synthesise({2, 1}, totals);
  EXPECT_EQ(document->triangle_count(), totals.triangles);
  ASSERT_EQ(document->objects.size(), 9u);
  std::vector<world::Placement> placements;
  world::place_models(world, registry(), {2, 1}, placements);
  for (std::size_t i = 0; i < placements.size(); ++i)
    EXPECT_EQ(document->objects[i + 1].position, placements[i].position);
  EXPECT_LT(block_document(world, registry(), {2, 1}, 3)->triangle_count(), totals.triangles / 10);
}

TEST(BlockFiles, GroundAtTheWaterIsSandAsItIsDrawn) {
  world::World world = parsed(kSmallWorld);
  const auto red = [&] {
    double sum = 0;
    const auto document = block_document(world, registry(), {2, 1}, 0);
    for (const glm::vec3& colour : document->objects[0].parts[0].colours)
      sum += static_cast<double>(colour.x);
    return sum;
  };
  const double dry = red();
  world.water.level_m = 200;  // above all ground
  EXPECT_GT(red(), 1.5 * dry);
}

// The disk fills at each possible call; a later run writes the missing files.
TEST(BlockFiles, WhereverTheDiskFillsFilesAreWholeAndALaterRunWritesTheRest) {
  const TemporaryFolder top;
  const world::World world = parsed(kSmallWorld);
  for (const Format format : {Format::kGlb, Format::kObj}) {
    std::filesystem::remove_all(top / "whole");
    ASSERT_TRUE(make_files(world, top / "whole", format));
    const FileContents whole = contents_of(top / "whole");
    bool all_fits = false;
    for (std::size_t calls = 0; !all_fits; calls += 7) {
      std::filesystem::remove_all(top / "cut");
      {
        const FullDisk full(top / "cut", calls);
        const auto made = make_files(world, top / "cut", format);
        all_fits = !full.was_met();
        if (!made) {
          EXPECT_EQ(made.error().message.find((top / "cut").string()), 0u) << made.error().message;
        }
      }
      for (const auto& [name, content] : contents_of(top / "cut"))
        EXPECT_TRUE(whole.contains(name) && whole.at(name) == content) << name << ", " << calls;
      ASSERT_TRUE(make_files(world, top / "cut", format));
      EXPECT_TRUE(contents_of(top / "cut") == whole) << calls;
    }
  }
}

}  // namespace
}  // namespace psygen::amplify
