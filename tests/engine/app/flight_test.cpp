#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/engine/app/fixture.hpp"

namespace psygen::app {
namespace {

FlightReport fly(const Options& options) {
  auto app = App::create(options);
  EXPECT_TRUE(app) << app.error().message;
  auto report = (*app)->run();
  EXPECT_TRUE(report) << report.error().message;
  EXPECT_THAT(report->validation_messages, testing::IsEmpty());
  return std::move(*report);
}

nlohmann::json read_json(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return nlohmann::json::parse(stream);
}

TEST(Flight, WritesEveryOutputWithoutAValidationMessage) {
  Options options = short_flight();
  options.out_folder = fresh_folder();
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

TEST(Flight, TheSummaryCarriesEveryFieldOrSaysWhyNot) {
  Options options = short_flight();
  options.out_folder = fresh_folder();
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
    Options options = short_flight();
    options.frames = 4;
    options.warmup_seconds = 0;
    options.scene.paradigm = paradigm;
    options.scene.view_distance_m = 64;
    options.scene.budget_bytes = 512ull << 20;
    const FlightReport report = fly(options);
    EXPECT_EQ(report.summary.run.frames, 4u);
    EXPECT_EQ(report.summary.missing.frames.value.value_or(99), 0u);
    EXPECT_GT(report.summary.draw.draws_p50.value.value_or(0), 50.0);
  }
}

TEST(Flight, AnUnwritableOutputFolderIsAnErrorBeforeTheFlight) {
  Options options = short_flight();
  options.out_folder = "/proc/nowhere/out";
  const auto app = App::create(options);
  ASSERT_FALSE(app);
  EXPECT_EQ(app.error().code, core::ErrorCode::kIo);
  EXPECT_NE(app.error().message.find("/proc/nowhere"), std::string::npos);
}

TEST(Flight, AMissingWorldOrPathFileIsNamed) {
  Options options = short_flight();
  options.world_file = "no_such_world.toml";
  auto app = App::create(options);
  ASSERT_FALSE(app);
  EXPECT_NE(app.error().message.find("no_such_world.toml"), std::string::npos);
  options = short_flight();
  options.path_file = "no_such_path.toml";
  app = App::create(options);
  ASSERT_FALSE(app);
  EXPECT_NE(app.error().message.find("no_such_path.toml"), std::string::npos);
}

TEST(Flight, StoppingFromOutsideEndsTheFlightAndStillWritesItsOutputs) {
  std::atomic<bool> stop{true};
  Options options = short_flight();
  options.out_folder = fresh_folder();
  options.stop = &stop;
  const FlightReport report = fly(options);
  EXPECT_EQ(report.summary.run.frames, 0u);
  EXPECT_TRUE(std::filesystem::exists(options.out_folder / "summary.json"));
}

}  // namespace
}  // namespace psygen::app
