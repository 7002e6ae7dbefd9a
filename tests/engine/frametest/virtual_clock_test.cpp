// Flights on the virtual clock write the same bytes in every run.
#include <atomic>
#include <fstream>
#include <iterator>
#include <thread>

#include "engine/app/virtual_frame.hpp"
#include "tests/engine/app/fixture.hpp"

namespace psygen::app {
namespace {

FlightOptions virtual_flight(const TemporaryFolder& folder) {
  FlightOptions options = short_flight();
  options.session.size = {160, 90};
  options.session.target_hz = 120;  // gives the governor work
  options.session.scene.budget_bytes = 16ull << 20;
  options.session.prefill = false;  // so that meshes are missing at first
  options.fixed_step_hz = 0;
  options.frames = 60;
  options.warmup_seconds = 0;
  options.out_folder = folder / "out";
  return options;
}

std::string frames_of(const FlightOptions& options, telemetry::Summary* summary = nullptr) {
  auto flight = Flight::create(options);
  EXPECT_TRUE(flight) << flight.error().message;
  auto report = (*flight)->run();
  EXPECT_TRUE(report) << report.error().message;
  if (summary != nullptr) *summary = report->summary;
  std::ifstream stream(options.out_folder / "frames.csv");
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

TEST(VirtualClock, FramesAreIdenticalForAnyNumberOfModelersAndUnderLoad) {
  const TemporaryFolder folder;
  FlightOptions options = virtual_flight(folder);
  telemetry::Summary summary;
  options.session.scene.modelers = 1;
  const std::string first = frames_of(options, &summary);
  EXPECT_EQ(std::ranges::count(first, '\n'), 61);
  EXPECT_GT(*summary.missing.coarse_max_percent, 0) << "no mesh is missing: the flight is too easy";
  EXPECT_GT(*summary.synthesis.models, 100u);
  EXPECT_GT(*summary.frame_ms.max, *summary.frame_ms.p50);
  for (const std::uint32_t modelers : {2u, 4u}) {
    options.session.scene.modelers = modelers;
    EXPECT_EQ(frames_of(options), first) << modelers << " modelers";
  }
  std::atomic<bool> stop{false};
  std::vector<std::jthread> load;
  for (int i = 0; i < 2; ++i)
    load.emplace_back([&stop] {
      while (!stop)
        ;
    });
  EXPECT_EQ(frames_of(options), first) << "under load";
  stop = true;
}

TEST(VirtualClock, TimesOfARealClockAreOmitted) {
  const TemporaryFolder folder;
  telemetry::Summary summary;
  FlightOptions options = virtual_flight(folder);
  options.frames = 30;
  (void)frames_of(options, &summary);
  EXPECT_TRUE(summary.frame_ms.p50.has_value());
  for (const telemetry::Figure& figure :
       {summary.wait_ms.all.p50, summary.record_ms.p50, summary.gpu_ms.p50,
        summary.system_ms.front().p50, summary.draw.floor_ratio})
    EXPECT_EQ(figure.reason, "the clock is virtual");
}

TEST(VirtualClock, AReferenceLoadChangesNoFrame) {
  const TemporaryFolder folder;
  FlightOptions options = virtual_flight(folder);
  options.frames = 10;
  telemetry::Summary without, with;
  const std::string frames = frames_of(options, &without);
  options.reference_load = true;
  EXPECT_EQ(frames_of(options, &with), frames);
  EXPECT_EQ(without.reference.pair.wall_s.reason, "not measured in this run");
  EXPECT_GT(*with.reference.arith.cpu_s, 0);
  EXPECT_GT(*with.reference.pair.wall_s, 0);
  EXPECT_GT(*telemetry::reference_ratios(with).cpu, 0);
}

TEST(VirtualClock, CostsMatchTheDocumentation) {
  EXPECT_NEAR(virtual_frame_ms(40'000, 500, {640, 360}), 0.5 + 4 + 1 + 1.8432, 1e-12);
  EXPECT_NEAR(virtual_frame_ms(40'000, 500, {640, 360}, 0.5), 0.5 + 4 + 1 + 0.4608, 1e-12);
}

TEST(VirtualClock, TheGpuPathIsRejected) {
  const TemporaryFolder folder;
  FlightOptions options = virtual_flight(folder);
  options.session.render_path = render::RenderPath::kGpu;
  const auto flight = Flight::create(options);
  ASSERT_FALSE(flight);
  EXPECT_THAT(flight.error().message,
              testing::StartsWith("the virtual clock needs the render path cpu"));
}

}  // namespace
}  // namespace psygen::app
