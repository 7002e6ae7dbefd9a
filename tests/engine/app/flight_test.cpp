#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "engine/app/virtual_frame.hpp"
#include "engine/scene/frame/input.hpp"
#include "tests/engine/app/fixture.hpp"
#include "tests/faults.hpp"

namespace psygen::app {
namespace {

FlightReport fly(const FlightOptions& options) {
  auto flight = Flight::create(options);
  EXPECT_TRUE(flight) << flight.error().message;
  auto report = (*flight)->run();
  EXPECT_TRUE(report) << report.error().message;
  EXPECT_THAT(report->validation_messages, testing::IsEmpty());
  return std::move(*report);
}

nlohmann::json read_json(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return nlohmann::json::parse(stream);
}

TEST(Flight, WritesEveryOutputWithoutAValidationMessage) {
  const TemporaryFolder folder;
  FlightOptions options = short_flight();
  options.out_folder = folder / "out";
  options.images_every = 20;
  const FlightReport report = fly(options);
  for (const char* name : {"frames.csv", "summary.json", "trace.json", "report.html",
                           "frame_00000.png", "frame_00020.png"}) {
    EXPECT_TRUE(std::filesystem::exists(options.out_folder / name)) << name;
  }
  std::ifstream csv(options.out_folder / "frames.csv");
  const auto lines = std::count(std::istreambuf_iterator<char>(csv), {}, '\n');
  EXPECT_EQ(lines, 41);
  EXPECT_TRUE(read_json(options.out_folder / "trace.json").contains("traceEvents"));
}

// Rows of frames.csv by column name.
std::vector<std::map<std::string, std::string>> read_frames(const std::filesystem::path& file) {
  std::ifstream stream(file);
  const auto cells_of = [](const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream text(line + ",");
    for (std::string cell; std::getline(text, cell, ',');)
      cells.push_back(cell);
    return cells;
  };
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> names = cells_of(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(stream, line)) {
    const std::vector<std::string> cells = cells_of(line);
    EXPECT_EQ(cells.size(), names.size());
    for (std::size_t i = 0; i < names.size(); ++i)
      i == 0 ? rows.push_back({{names[0], cells[0]}}) : void(rows.back()[names[i]] = cells[i]);
  }
  return rows;
}

TEST(Flight, WrittenFramesAndTheNextTwoAreNotInTimingStatistics) {
  const TemporaryFolder folder;
  FlightOptions options = short_flight();
  options.session.scene.virtual_time = false;  // on the virtual clock images take no time
  options.out_folder = folder / "out";
  options.images_every = 10;
  const FlightReport report = fly(options);
  for (const auto& row : read_frames(options.out_folder / "frames.csv")) {
    const int frame = std::stoi(row.at("frame"));
    EXPECT_EQ(row.at("apart"), frame % 10 == 0  ? "picture"
                               : frame % 10 < 3 ? "after_idle"
                                                : "")
        << frame;
  }
  // From 0.2 s on, with a step of 1/30 s: frames 6 to 39.
  EXPECT_EQ(report.summary.run.measured_frames, 34u);
  EXPECT_EQ(report.summary.run.timed_frames, 25u);
  EXPECT_EQ(report.summary.run.apart_frames,
            (std::array<std::uint64_t, telemetry::kApartKinds>{25, 3, 6}));
}

TEST(Flight, AFrameInWhichAPluginCapturesAnImageIsExcluded) {
  const TemporaryFolder folder;
  FlightOptions options = short_flight();
  options.session.scene.virtual_time = false;
  options.out_folder = folder / "out";
  options.frames = 10;
  options.session.target_hz = 30;
  options.session.scene.watchdog_seconds = 1e6;
  std::vector<double> governed_ms;
  std::optional<WrongClock> clock;
  options.session.plugins.push_back(
      {.name = "photographer", .on_frame = [&](Session& session, double) {
         governed_ms.push_back(session.scene().input().frame_ms);
         if (governed_ms.size() != 6) return;
         EXPECT_TRUE(session.save_picture(options.out_folder / "picture.png"));
         clock.emplace(100, 0);  // the disk takes 100 s
       }});
  fly(options);
  clock.reset();
  const auto rows = read_frames(options.out_folder / "frames.csv");
  ASSERT_EQ(rows.size(), 10u);
  EXPECT_EQ(rows[4].at("apart"), "");
  EXPECT_EQ(rows[5].at("apart"), "picture");
  EXPECT_EQ(rows[6].at("apart"), "after_idle");
  EXPECT_EQ(rows[7].at("apart"), "after_idle");
  EXPECT_EQ(rows[8].at("apart"), "");
  // The governor sees the duration of the previous frame.
  for (std::size_t i = 1; i < governed_ms.size(); ++i)
    EXPECT_EQ(governed_ms[i] > 0, rows[i - 1].at("apart").empty()) << i;
}

TEST(Flight, AFrameWithASuspensionOrAClockThatGoesBackIsExcluded) {
  const TemporaryFolder folder;
  FlightOptions options = short_flight();
  options.session.scene.virtual_time = false;
  options.fixed_step_hz = 0;
  options.warmup_seconds = 0;
  options.out_folder = folder / "out";
  options.frames = 12;
  std::optional<WrongClock> clock;
  options.session.plugins.push_back(
      {.name = "clock", .on_frame = [&clock, frame = 0](Session&, double) mutable {
         ++frame;
         if (frame == 5) clock.emplace(0, 100);  // suspended for 100 s
         if (frame == 9) clock.emplace(-2, 98);  // and both go back by 2 s
       }});
  const FlightReport report = fly(options);
  clock.reset();
  double before_s = -1;
  for (const auto& row : read_frames(options.out_folder / "frames.csv")) {
    const int frame = std::stoi(row.at("frame"));
    const bool gap = frame == 4 || frame == 8;
    // The first two frames follow the filling of the cache.
    EXPECT_EQ(row.at("apart"), frame < 2 ? "after_idle" : gap ? "gap" : "") << frame;
    EXPECT_GT(std::stod(row.at("time_s")), before_s) << "the flight's clock advances";
    before_s = std::stod(row.at("time_s"));
  }
  EXPECT_EQ(report.summary.run.apart_frames.back(), 2u);
}

TEST(Gap, IsLongerThanAnyFrame) {
  EXPECT_FALSE(is_gap(4999, 10, 0));
  EXPECT_FALSE(is_gap(5001, 400, 0)) << "a slow machine";
  EXPECT_FALSE(is_gap(90'000, 0, 0)) << "the first frame";
  EXPECT_TRUE(is_gap(5001, 10, 0));
  EXPECT_TRUE(is_gap(10, 10, 1)) << "suspended";
  EXPECT_TRUE(is_gap(-1, 10, 0)) << "the clock went back";
}

TEST(Flight, WaitingAndGpuTimesAreSeparateFromTheSystems) {
  const TemporaryFolder folder;
  FlightOptions options = short_flight();
  options.session.scene.virtual_time = false;  // the virtual clock has no such times
  options.out_folder = folder / "out";
  const FlightReport report = fly(options);
  const auto rows = read_frames(options.out_folder / "frames.csv");
  ASSERT_EQ(rows.size(), 40u);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto ms = [&](const std::string& name) { return std::stod(rows[i].at(name)); };
    double all_ms = ms("wait_ms");
    for (const char* system : {"input", "daylight", "streaming", "visibility", "cache", "synthesis",
                               "upload", "render", "telemetry"})
      all_ms += ms(std::string(system) + "_ms");
    EXPECT_LE(all_ms, ms("frame_ms") + 0.01) << i;
    EXPECT_EQ(ms("wait_ms"), ms("device_wait_ms")) << "headless";
    EXPECT_GT(ms("record_ms"), 0);
    EXPECT_LE(ms("record_ms"), ms("render_ms") + 0.01);
    // Available four frames later, so the last frames have none.
    EXPECT_EQ(rows[i].at("gpu_ms").empty(), i >= 36) << i;
    EXPECT_EQ(rows[i].at("gpu_shadows_ms").empty(), i >= 36) << i;
  }
  EXPECT_GT(report.summary.gpu_ms.p50.value.value_or(0), 0);
  std::ifstream stream(options.out_folder / "trace.json");
  const std::string trace((std::istreambuf_iterator<char>(stream)), {});
  EXPECT_NE(trace.find("\"wait for the device\""), std::string::npos);
  EXPECT_NE(trace.find("\"device ms\""), std::string::npos);
}

TEST(Flight, TheSummaryHasEveryFieldOrAReason) {
  const TemporaryFolder folder;
  FlightOptions options = short_flight();
  options.out_folder = folder / "out";
  fly(options);
  const nlohmann::json summary = read_json(options.out_folder / "summary.json");
  const auto has = [&summary](const std::string& path) {
    const nlohmann::json::json_pointer pointer(path);
    if (!summary.contains(pointer)) return false;
    if (!summary.at(pointer).is_null()) return true;
    std::string dotted = path.substr(1);
    std::ranges::replace(dotted, '/', '.');
    return summary.at("reasons").contains(dotted);
  };
  for (const char* path : {"/schema",
                           "/world/name",
                           "/world/seed",
                           "/world/blocks",
                           "/world/triangles",
                           "/world/bytes_paper",
                           "/world/bytes",
                           "/device/name",
                           "/device/driver",
                           "/device/api",
                           "/run/paradigm",
                           "/run/policy",
                           "/run/modelers",
                           "/run/width",
                           "/run/height",
                           "/run/frames",
                           "/run/seconds",
                           "/run/lod",
                           "/run/fixed_step",
                           "/frame_ms/mean",
                           "/frame_ms/p50",
                           "/frame_ms/p95",
                           "/frame_ms/p99",
                           "/frame_ms/p999",
                           "/frame_ms/max",
                           "/low1_fps",
                           "/hitches",
                           "/stutter_percent",
                           "/missing/frames",
                           "/missing/nodes_p99",
                           "/missing/pixels_p99_percent",
                           "/missing/pixels_max_percent",
                           "/synthesis/share_drawn",
                           "/missing/time_to_visible_ms/p50",
                           "/missing/time_to_visible_ms/p99",
                           "/missing/time_to_visible_ms/max",
                           "/cache/budget_bytes",
                           "/cache/peak_bytes",
                           "/cache/hits",
                           "/cache/misses",
                           "/cache/evictions",
                           "/cache/regenerations",
                           "/cache/prefetch_hit_percent",
                           "/synthesis/models",
                           "/synthesis/triangles",
                           "/synthesis/bytes",
                           "/synthesis/seconds",
                           "/synthesis/triangles_per_second",
                           "/synthesis/cost_error_percent/p50",
                           "/synthesis/cost_error_percent/p95",
                           "/draw/triangles_p50",
                           "/draw/draws_p50",
                           "/draw/floor_ratio",
                           "/memory/peak_rss_bytes",
                           "/hash/world",
                           "/hash/images"}) {
    EXPECT_TRUE(has(path)) << path;
  }
  for (const char* system : {"input", "streaming", "visibility", "cache", "synthesis", "upload",
                             "render", "telemetry"}) {
    EXPECT_TRUE(has(std::string("/system_ms/") + system + "/p50")) << system;
  }
  EXPECT_GT(summary["world"]["triangles"].get<double>(), 3.0e10);
  EXPECT_GT(summary["world"]["bytes_paper"].get<double>(), 7.5e12);
  EXPECT_LE(summary["cache"]["peak_bytes"].get<std::uint64_t>(), 128ull << 20);
}

TEST(Flight, EachParadigmFlies) {
  for (const auto paradigm :
       {scene::Paradigm::kDataAmplification, scene::Paradigm::kLazyEvaluation}) {
    FlightOptions options = short_flight();
    options.frames = 4;
    options.warmup_seconds = 0;
    options.session.scene.paradigm = paradigm;
    options.session.scene.view_distance_m = 64;
    options.session.scene.budget_bytes = 512ull << 20;
    const FlightReport report = fly(options);
    EXPECT_EQ(report.summary.run.frames, 4u);
    EXPECT_EQ(report.summary.missing.frames.value.value_or(99), 0u);
    EXPECT_GT(report.summary.draw.draws_p50.value.value_or(0), 50.0);
  }
}

TEST(Flight, AnUnwritableOutputFolderIsAnErrorBeforeTheFlight) {
  FlightOptions options = short_flight();
  options.out_folder = "/proc/nowhere/out";
  const auto flight = Flight::create(options);
  ASSERT_FALSE(flight);
  EXPECT_EQ(flight.error().code, core::ErrorCode::kIo);
  EXPECT_NE(flight.error().message.find("/proc/nowhere"), std::string::npos);
}

TEST(Flight, AMissingWorldOrPathFileIsNamed) {
  FlightOptions options = short_flight();
  options.session.world_file = "no_such_world.toml";
  auto flight = Flight::create(options);
  ASSERT_FALSE(flight);
  EXPECT_NE(flight.error().message.find("no_such_world.toml"), std::string::npos);
  options = short_flight();
  options.path_file = "no_such_path.toml";
  flight = Flight::create(options);
  ASSERT_FALSE(flight);
  EXPECT_NE(flight.error().message.find("no_such_path.toml"), std::string::npos);
}

TEST(Flight, APathThatNeverComesNearTheWorldIsRejected) {
  const TemporaryFolder folder;
  FlightOptions options = short_flight();
  options.path_file = folder / "far.toml";
  std::ofstream(options.path_file)
      << "format = 1\n[path]\nname = \"far\"\norigin_block = [99999, 0]\n"
         "[[point]]\ntime_s = 0\nat_m = [0, 0]\nheight_m = 10\n";
  const auto flight = Flight::create(options);
  ASSERT_FALSE(flight);
  EXPECT_EQ(flight.error().code, core::ErrorCode::kInvalidArgument);
  EXPECT_NE(flight.error().message.find("far.toml: the world"), std::string::npos)
      << flight.error().message;
  EXPECT_NE(flight.error().message.find("is never in view"), std::string::npos)
      << flight.error().message;
}

TEST(Flight, AStopFlagEndsTheStart) {
  std::atomic<bool> stop{true};
  FlightOptions options = short_flight();
  options.session.stop = &stop;
  const auto flight = Flight::create(options);
  ASSERT_FALSE(flight);
  EXPECT_EQ(flight.error().code, core::ErrorCode::kInterrupted);
}

TEST(Flight, AStopFlagEndsTheFlightWhichStillWritesItsOutputs) {
  std::atomic<bool> stop{false};
  const TemporaryFolder folder;
  FlightOptions options = short_flight();
  options.out_folder = folder / "out";
  options.session.stop = &stop;
  options.camera = [&stop](Session& session, double) {
    stop = true;
    return session.home();
  };
  const FlightReport report = fly(options);
  EXPECT_EQ(report.summary.run.frames, 1u);
  EXPECT_TRUE(std::filesystem::exists(options.out_folder / "summary.json"));
}

FlightOptions wall_flight() {
  FlightOptions options = short_flight();
  options.session.scene.virtual_time = false;
  options.fixed_step_hz = 0;
  options.warmup_seconds = 0;
  options.frames = 25;
  return options;
}

TEST(Flight, MeasuresPresentsAnimationErrorPassesAndDeviceMemory) {
  FlightOptions options = wall_flight();
  options.session.pass_times = true;
  auto flight = Flight::create(options);
  ASSERT_TRUE(flight) << flight.error().message;
  const auto report = (*flight)->run();
  ASSERT_TRUE(report) << report.error().message;
  const telemetry::Summary& s = report->summary;
  EXPECT_GT(*s.between_presents_ms.p50, 0);
  EXPECT_GE(*s.between_presents_ms.max, *s.between_presents_ms.p50);
  EXPECT_GE(*s.animation_error_ms.mean, 0);
  EXPECT_GT(*s.memory.device_peak_bytes, 1u << 20);
  ASSERT_EQ(s.pass_ms.size(), render::kPassNames.size());
  EXPECT_EQ(s.pass_ms[1].name, "landscape");
  EXPECT_GT(*s.pass_ms[1].p50, 0);
  const auto frames = (*flight)->log().frames();
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const auto& r = frames[i];
    if (!r.between_presents_ms) continue;
    ASSERT_TRUE(r.animation_error_ms);
    const double step_ms = (r.time_s - frames[i - 1].time_s) * 1000;
    EXPECT_NEAR(*r.animation_error_ms, step_ms - *r.between_presents_ms, 1e-6);
  }
}

TEST(Flight, TellsWhyPresentsAndPassesWereNotMeasured) {
  FlightOptions options = wall_flight();
  options.fixed_step_hz = 30;
  options.session.pass_times = false;
  auto flight = Flight::create(options);
  ASSERT_TRUE(flight) << flight.error().message;
  auto report = (*flight)->run();
  ASSERT_TRUE(report);
  EXPECT_GT(*report->summary.between_presents_ms.p50, 0);
  EXPECT_EQ(report->summary.animation_error_ms.p50.reason, "the flight has a fixed step");
  EXPECT_EQ(report->summary.pass_ms[1].p50.reason, "passes were not measured (--pass-times)");
  options.session.scene.virtual_time = true;
  flight = Flight::create(options);
  ASSERT_TRUE(flight) << flight.error().message;
  report = (*flight)->run();
  ASSERT_TRUE(report);
  for (const telemetry::Figure& figure :
       {report->summary.between_presents_ms.p50, report->summary.animation_error_ms.p50,
        report->summary.pass_ms[1].p50})
    EXPECT_EQ(figure.reason, "the clock is virtual");
  EXPECT_EQ(report->summary.memory.device_peak_bytes.reason, "the clock is virtual");
}

}  // namespace
}  // namespace psygen::app
