#include "editor/flights/flight_run.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <QEventLoop>
#include <QProcess>
#include <cmath>

#include "editor/flights/flight_process.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/frametest/frame_test.hpp"
#include "engine/telemetry/frame_log.hpp"
#include "engine/world/camera_path.hpp"
#include "engine/world/files/path_file.hpp"
#include "engine/world/files/text_file.hpp"
#include "engine/world/files/world_file.hpp"
#include "tests/source_file.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::editor {
namespace {

using ::testing::HasSubstr;

constexpr const char* kSummary = R"({"schema": "psygen.summary/1", "run": {"modelers": 2},
  "frame_ms": {"p50": 3.14159, "p99": null}, "cache": {"peak_bytes": 1048577},
  "missing": {"frames": 0, "pixels_max_percent": 0.0}, "hash": {"world": "0123456789abcdef"}})";

// A frames.csv as written by flights.
std::string frames_csv(const TemporaryFolder& folder, int frames) {
  telemetry::FrameLog log({"cache", "render"});
  for (int i = 0; i < frames; ++i) {
    telemetry::FrameRecord record;
    record.index = static_cast<std::uint64_t>(i);
    record.time_s = i * 0.1;
    record.frame_ms = 10 + i;
    record.requests_queued = 7;
    record.cache_bytes = 3 << 20;
    record.error_pixels = 4;
    record.synthesis_seconds = 0.1;  // one of two modelers, all the time
    record.main_cpu_ms = NAN;
    log.add(record);
  }
  EXPECT_TRUE(telemetry::write_frames_csv(folder / "frames.csv", log));
  return world::read_text_file(folder / "frames.csv").value();
}

TEST(FlightRun, HasTheCurvesOfItsFrames) {
  const TemporaryFolder folder;
  const auto run = parse_flight_run(frames_csv(folder, 20), kSummary, {});
  ASSERT_TRUE(run) << run.error().message;
  ASSERT_EQ(run->time_s.size(), 20U);
  EXPECT_NEAR(run->time_s[5], 0.5, 1e-9);
  EXPECT_EQ(run->frame_ms[5], 15);
  EXPECT_EQ(run->queued[5], 7);
  EXPECT_EQ(run->cache_mib[5], 3);
  EXPECT_EQ(run->error_pixels[5], 4);
  EXPECT_EQ(run->missing_percent[5], 0);
  EXPECT_NEAR(run->busy_percent[15], 50, 15);
}

TEST(FlightRun, RejectsInvalidFiles) {
  const TemporaryFolder folder;
  const std::string whole = frames_csv(folder, 3);
  const auto error = [](const std::string& csv, const std::string& summary = kSummary) {
    const auto run = parse_flight_run(csv, summary, {});
    return run ? "accepted" : run.error().message;
  };
  EXPECT_EQ(error(whole), "accepted");
  EXPECT_THAT(error(""), HasSubstr("frames.csv"));
  EXPECT_THAT(error(whole.substr(0, whole.size() - 4)), HasSubstr("truncated"));
  EXPECT_THAT(error(whole.substr(0, whole.find('\n') + 1)), HasSubstr("no frame"));
  EXPECT_THAT(error("time_s,frame_ms\n0,1\n"), HasSubstr("missing"));
  EXPECT_THAT(error(whole, "{}"), HasSubstr("summary.json"));
  EXPECT_THAT(error(whole, "nonsense"), HasSubstr("summary.json"));
  std::string late = whole;
  late.replace(late.find("0.200000"), 8, "0.000001");
  EXPECT_THAT(error(late), HasSubstr("backwards"));
  std::string word = whole;
  word.replace(word.find("0.200000"), 8, "soonish!");
  EXPECT_THAT(error(word), HasSubstr("frames.csv:4"));
}

TEST(FlightRun, MakesAFrameTestThatItPasses) {
  const TemporaryFolder folder;
  auto run = parse_flight_run(frames_csv(folder, 20), kSummary, {});
  ASSERT_TRUE(run) << run.error().message;
  run->settings.policy = synthesis::Policy::kFifo;
  run->settings.modelers = 3;
  const std::string text = frame_test_text(*run, "a \"test\"", "w.toml", "p.toml");
  const auto test = frametest::parse_frame_test(text, "a.toml");
  ASSERT_TRUE(test) << test.error().message << "\n" << text;
  EXPECT_EQ(test->name, "a \"test\"");
  EXPECT_EQ(test->flight.session.scene.policy, synthesis::Policy::kFifo);
  EXPECT_EQ(test->flight.session.scene.modelers, 3U);
  EXPECT_TRUE(test->flight.session.scene.virtual_time);
  EXPECT_THAT(text, HasSubstr("frame_ms.p50 = 3.15"));
  EXPECT_THAT(text, ::testing::Not(HasSubstr("frame_ms.p99")));  // not measured
  EXPECT_THAT(text, HasSubstr("hash.world = \"0123456789abcdef\""));
  run->settings.virtual_clock = false;
  EXPECT_THAT(frame_test_text(*run, "a", "w", "p"), HasSubstr("frame_ms.p50 = 4.7"));
}

// From a recording to `psygen test`, like a user.
TEST(FlightProcess, RendersARecordingWhoseFrameTestPasses) {
  const TemporaryFolder folder;
  const auto world_file = source_file("game/worlds/paper.toml");
  models::Registry registry = models::make_standard_registry();
  const auto world = world::load_world(world_file, registry);
  ASSERT_TRUE(world) << world.error().message;
  std::vector<world::TimedPose> poses;
  for (int i = 0; i < 8; ++i)
    poses.push_back({i * 0.1, {{{256, 256}, {10.0 + i, 120, 10}}, 0.1 * i, -0.2}});
  ASSERT_TRUE(core::replace_file(
      folder / "path.toml",
      world::write_camera_path(world::recorded_path("recording", poses, *world))));
  FlightSettings settings;
  settings.size = {160, 90};
  settings.warmup_s = 0.1;
  FlightProcess process;
  QEventLoop loop;
  std::optional<FlightRun> run;
  QString failure;
  QObject::connect(&process, &FlightProcess::flown, [&](const FlightRun& flown) {
    run = flown;
    loop.quit();
  });
  QObject::connect(&process, &FlightProcess::failed, [&](const QString& sentence) {
    failure = sentence;
    loop.quit();
  });
  process.fly(settings, world_file, folder / "path.toml", folder / "run");
  loop.exec();
  ASSERT_TRUE(run) << failure.toStdString();
  EXPECT_GT(run->time_s.size(), 5U);
  ASSERT_TRUE(core::replace_file(folder / "test.toml",
                                 frame_test_text(*run, "recording", world_file, "path.toml")));
  QProcess test;
  test.setProcessChannelMode(QProcess::MergedChannels);
  test.start(psygen_program(), {"test", QString::fromStdString((folder / "test.toml").string())});
  ASSERT_TRUE(test.waitForFinished(-1));
  EXPECT_EQ(test.exitCode(), 0) << test.readAll().toStdString();
}

TEST(FlightProcess, ReportsTheErrorOfAFlight) {
  const TemporaryFolder folder;
  FlightProcess process;
  QEventLoop loop;
  QString failure;
  QObject::connect(&process, &FlightProcess::failed, [&](const QString& sentence) {
    failure = sentence;
    loop.quit();
  });
  process.fly({}, folder / "no_world.toml", folder / "no_path.toml", folder / "run");
  loop.exec();
  EXPECT_THAT(failure.toStdString(), HasSubstr("no_world.toml"));
}

}  // namespace
}  // namespace psygen::editor
