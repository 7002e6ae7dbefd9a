// Tests the report of a failed test about its worst frames.
#include "engine/frametest/failure.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "engine/app/flight.hpp"
#include "engine/image/compare.hpp"
#include "engine/image/image_io.hpp"
#include "tests/faults.hpp"
#include "tests/file_content.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::frametest {
namespace {

using testing::HasSubstr;

// A flight that begins with an empty cache, on the virtual clock: many meshes are missing at first.
std::filesystem::path write_test(const TemporaryFolder& folder, const std::string& budget) {
  std::ofstream(folder / "bare.toml")
      << "format = 1\n[flight]\nsize = [160, 90]\nview_distance = 1000\nframes = 12\n"
         "fixed_step = 30\nwarmup = 0.1\nclock = \"virtual\"\nprefill = false\nbudget_mib = 32\n"
      << budget;
  return folder / "bare.toml";
}

std::vector<std::string> pictures_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".png") names.push_back(entry.path().filename());
  std::ranges::sort(names);
  return names;
}

image::Image read(const std::filesystem::path& file) {
  auto image = image::read_image(file);
  EXPECT_TRUE(image) << image.error().message;
  return image ? *image : image::Image{};
}

TEST(Failure, ShowsTheWorstFrameAsDrawnAsExpectedAndTheDifference) {
  const TemporaryFolder folder;
  RunOptions options;
  options.files = {write_test(folder, "[equal]\nmissing.pixels_max_percent = 0\n")};
  options.out = folder / "out";
  options.junit = folder / "junit.xml";
  options.worst_frames = 1;
  ASSERT_EQ(run_frame_tests(options), kMissed);
  const auto out = options.out / "bare";
  const auto names = pictures_in(out);
  ASSERT_EQ(names.size(), 3u);
  const image::Image difference = read(out / names[0]), expected = read(out / names[1]),
                     seen = read(out / names[2]);
  EXPECT_GT(image::compare(seen, expected).share_over, 0.05);
  EXPECT_EQ(difference, *image::picture_of_difference(expected, seen));

  const std::string page = file_content(out / "failed.html");
  for (const std::string& name : names)
    EXPECT_THAT(page, HasSubstr(name));
  EXPECT_THAT(page, HasSubstr("missing.pixels_max_percent"));
  EXPECT_THAT(file_content(options.junit),
              HasSubstr("[[ATTACHMENT|" + (out / "failed.html").string()));

  // The same flight, with an image of every frame.
  auto test = load_frame_test(options.files.front());
  ASSERT_TRUE(test);
  app::FlightOptions flight = test->flight;
  flight.images_every = 1;
  flight.out_folder = folder / "images";
  auto flown = app::Flight::create(flight);
  ASSERT_TRUE(flown && (*flown)->run());
  const std::string number = names[2].substr(std::string("worst_").size(), 5);
  EXPECT_EQ(seen, read(folder / "images" / ("frame_" + number + ".png"))) << "not that frame";
  EXPECT_EQ(file_content(out / "frames.csv"), file_content(folder / "images" / "frames.csv"))
      << "images disturbed the virtual clock";
}

TEST(Failure, IsRemovedOnceTheTestHolds) {
  const TemporaryFolder folder;
  RunOptions options;
  options.files = {write_test(folder, "[equal]\nrun.frames = 12\n")};
  options.out = folder / "out";
  const auto out = options.out / "bare";
  std::filesystem::create_directories(out);
  for (const char* name : {"failed.html", "worst_00001_seen.png", "mine.png"})
    std::ofstream(out / name) << "old";
  EXPECT_EQ(run_frame_tests(options), kHeld);
  EXPECT_THAT(pictures_in(out), testing::ElementsAre("mine.png"));
  EXPECT_FALSE(std::filesystem::exists(out / "failed.html"));
}

TEST(Failure, SaysIfNoSingleFrameHasTheValue) {
  const TemporaryFolder folder;
  RunOptions options;
  options.files = {write_test(folder, "[equal]\nhash.world = \"0\"\n")};
  options.out = folder / "out";
  EXPECT_EQ(run_frame_tests(options), kMissed);
  EXPECT_THAT(file_content(options.out / "bare" / "failed.html"),
              HasSubstr("not measured per frame"));
  EXPECT_TRUE(pictures_in(options.out / "bare").empty());
}

TEST(Failure, AFullDiskIsAnErrorAndNotAMissedBudget) {
  const TemporaryFolder folder;
  RunOptions options;
  options.out = folder / "out";
  std::filesystem::create_directories(options.out / "bare");
  const auto file = write_test(folder, "[equal]\nmissing.pixels_max_percent = 0\n");
  const FullDisk full(options.out / "bare", 0);
  const TestResult result = run_frame_test({file, load_frame_test(file)}, options);
  ASSERT_TRUE(result.error);
  EXPECT_THAT(result.error->message, HasSubstr("summary.json"));
  EXPECT_THAT(result.error->message, HasSubstr("No space left"));
  EXPECT_EQ(exit_code_of({&result, 1}), kFailed);
}

TEST(Failure, StillReportsMissedBudgetsIfThePageCannotBeWritten) {
  const TemporaryFolder folder;
  RunOptions options;
  options.out = folder / "out";
  options.worst_frames = 1;
  const auto file = write_test(folder, "[equal]\nmissing.pixels_max_percent = 0\n");
  std::filesystem::create_directories(options.out / "bare");
  std::filesystem::create_directories(options.out / "bare/failed.html/in the way");
  const TestResult result = run_frame_test({file, load_frame_test(file)}, options);
  EXPECT_FALSE(result.error);
  EXPECT_FALSE(result.holds());
  EXPECT_TRUE(result.page.empty());
}

}  // namespace
}  // namespace psygen::frametest
