// Outputs of a flight when not everything can be written.
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/engine/app/fixture.hpp"
#include "tests/full_disk.hpp"

namespace psygen::app {
namespace {

// Limits the size of files during its lifetime.
class FileLimit {
 public:
  explicit FileLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit small{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~FileLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileLimit(const FileLimit&) = delete;
  FileLimit& operator=(const FileLimit&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

FlightOptions flight_into(const std::filesystem::path& folder) {
  FlightOptions options = short_flight();
  options.out_folder = folder;
  options.images_every = 2;
  options.frames = 7;
  return options;
}

std::vector<std::string> names_of(const FlightReport& report, const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const core::Error& failure : report.failures) {
    const std::string& sentence = failure.message;
    EXPECT_EQ(sentence.find(folder.string() + "/"), 0u) << sentence;
    const std::size_t first = folder.string().size() + 1;
    names.push_back(sentence.substr(first, sentence.find(": cannot ") - first));
  }
  return names;
}

TEST(Outputs, AnImageThatCannotBeWrittenIsNamedAndIsTheLastOne) {
  const TemporaryFolder folder;
  auto flight = Flight::create(flight_into(folder.path()));
  ASSERT_TRUE(flight) << flight.error().message;
  const FileLimit limit(5000);  // less than any image
  const auto report = (*flight)->run();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->summary.run.frames, 7u);
  EXPECT_EQ(names_of(*report, folder.path()).front(), "frame_00000.png");
  EXPECT_EQ(std::ranges::count_if(names_of(*report, folder.path()),
                                  [](const std::string& name) { return name.ends_with(".png"); }),
            1);
  EXPECT_FALSE(report->summary.hash.images.value);
  EXPECT_EQ(report->summary.hash.images.reason, "an image was not written");
}

TEST(Outputs, FilesThatFitAreWrittenCompletely) {
  const TemporaryFolder folder;
  auto flight = Flight::create(flight_into(folder.path()));
  ASSERT_TRUE(flight) << flight.error().message;
  // Calls for the first image (made, written, flushed, closed, renamed, the folder flushed and
  // closed) and the begin of the next.
  const FullDisk full(folder.path(), 8);
  const auto report = (*flight)->run();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->files, (std::vector{folder / "frame_00000.png"}));
  EXPECT_THAT(names_of(*report, folder.path()),
              testing::ElementsAre("frame_00002.png", "summary.json", "report.html", "frames.csv",
                                   "trace.json"));
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(Outputs, ALargeFileThatDoesNotFitAffectsNoSmallerOne) {
  const TemporaryFolder folder;
  FlightOptions options = flight_into(folder.path());
  options.images_every = 0;
  options.session.scene.virtual_time = false;  // modelers' jobs are traced
  auto flight = Flight::create(options);
  ASSERT_TRUE(flight) << flight.error().message;
  const FileLimit limit(20'000);
  const auto report = (*flight)->run();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_THAT(names_of(*report, folder.path()), testing::ElementsAre("report.html", "trace.json"));
  EXPECT_EQ(folder.file_count(), 2u);
  std::ifstream summary(folder / "summary.json");
  EXPECT_TRUE(nlohmann::json::accept(summary));
}

// psygen throws nothing, but libraries do when memory runs out, and so does the plugin here.
TEST(Outputs, OutOfMemoryFailsTheFlightWhichStillWritesItsMeasurements) {
  const TemporaryFolder folder;
  FlightOptions options = flight_into(folder.path());
  options.session.plugins.push_back(
      {.name = "hungry", .on_frame = [frame = 0](Session&, double) mutable {
         if (++frame == 4) throw std::bad_alloc();
       }});
  auto flight = Flight::create(options);
  ASSERT_TRUE(flight) << flight.error().message;
  const auto report = (*flight)->run();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, core::ErrorCode::kOutOfMemory);
  EXPECT_EQ(report.error().message.find("plugin hungry: on_frame: memory ran out ("), 0u);
  std::ifstream file(folder / "summary.json");
  const auto summary = nlohmann::json::parse(file);
  EXPECT_EQ(summary["run"]["frames"], 3);
  EXPECT_EQ(summary["reasons"]["hash.world"], "the flight failed");
  EXPECT_TRUE(std::filesystem::exists(folder / "trace.json"));
}

}  // namespace
}  // namespace psygen::app
