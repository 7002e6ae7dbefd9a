#include <gtest/gtest.h>

#include <fstream>

#include "engine/exchange/write_document.hpp"
#include "tests/engine/exchange/synthesised.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::exchange {
namespace {

const char* const kName = "rock";

class CutShort : public ::testing::TestWithParam<Format> {
 protected:
  CutShort() { EXPECT_TRUE(write_scene(file(), GetParam(), {kName, {synthesised("rock", 0)}})); }
  std::filesystem::path file() const { return folder_ / "rock.file"; }
  bool is_short() const { return is_cut_short(file(), GetParam(), kName); }

 private:
  const TemporaryFolder folder_;
};

TEST_P(CutShort, AFileWithoutItsLastByteIsCutShort) {
  EXPECT_FALSE(is_short());
  for (std::uintmax_t size = std::filesystem::file_size(file()); size > 0;) {
    size = size > 40 ? size - size / 7 : size - 1;  // every length near the start
    std::filesystem::resize_file(file(), size);
    EXPECT_TRUE(is_short()) << size;
  }
}

TEST_P(CutShort, ForeignAndMissingFilesAreNotCutShort) {
  std::ofstream(file()) << "mine";
  EXPECT_FALSE(is_short());
  std::filesystem::remove(file());
  EXPECT_FALSE(is_short());
}

INSTANTIATE_TEST_SUITE_P(Formats, CutShort, ::testing::Values(Format::kGlb, Format::kObj),
                         [](const auto& format) { return std::string(name_of(format.param)); });

TEST(CutShortObj, NeedsItsMaterialsAndTheirColours) {
  const TemporaryFolder folder;
  const auto obj = folder / "rock.obj", mtl = folder / "rock.mtl";
  const auto png = folder / "rock.colours.png";
  ASSERT_TRUE(write_scene(obj, Format::kObj, {kName, {synthesised("rock", 0)}}));
  EXPECT_FALSE(is_cut_short(obj, Format::kObj, kName));
  EXPECT_FALSE(is_cut_short(obj, Format::kObj, "another"));
  std::ofstream(mtl, std::ios::app) << "Kd 1 0 0\n";  // an addition by the user
  std::ofstream(obj, std::ios::app) << "o mine\n";
  EXPECT_FALSE(is_cut_short(obj, Format::kObj, kName));
  std::filesystem::rename(png, folder / "away.png");
  EXPECT_TRUE(is_cut_short(obj, Format::kObj, kName));
  std::filesystem::rename(folder / "away.png", png);
  EXPECT_FALSE(is_cut_short(obj, Format::kObj, kName));
  std::filesystem::resize_file(mtl, 0);
  EXPECT_TRUE(is_cut_short(obj, Format::kObj, kName));
  std::filesystem::remove(mtl);
  EXPECT_TRUE(is_cut_short(obj, Format::kObj, kName));
  EXPECT_FALSE(is_cut_short(obj, Format::kObj, "another"));  // not this document's file
}

TEST(CutShortFile, UnreadableFilesAreNotCutShort) {
  const TemporaryFolder folder;
  for (const Format format : {Format::kGlb, Format::kObj}) {
    std::filesystem::create_symlink("itself", folder / "itself");
    EXPECT_FALSE(is_cut_short(folder / "itself", format, kName));
    std::filesystem::remove(folder / "itself");
    EXPECT_FALSE(is_cut_short(folder.path(), format, kName));
  }
}

TEST(CutShortGlb, AFileWithExtraBytesIsWhole) {
  const TemporaryFolder folder;
  const auto glb = folder / "rock.glb";
  ASSERT_TRUE(write_scene(glb, Format::kGlb, {kName, {synthesised("rock", 0)}}));
  std::ofstream(glb, std::ios::binary | std::ios::app) << "more";
  EXPECT_FALSE(is_cut_short(glb, Format::kGlb, kName));
}

}  // namespace
}  // namespace psygen::exchange
