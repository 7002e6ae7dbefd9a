// Tests the causes of bad frames: from made-up profiles, and from flights with a system that works
// too much.
#include "engine/frametest/cause.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>

#include "engine/app/flight.hpp"
#include "engine/core/clock.hpp"
#include "engine/frametest/sampler.hpp"
#include "engine/scene/frame/clock.hpp"
#include "engine/scene/systems.hpp"
#include "tests/file_content.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::frametest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr std::uint64_t kMs = 1'000'000;  // in nanoseconds

// Eleven frames of 0.1 s with 1 ms of cache and 2 ms of paths. Frame 7 has 2 ms of cache and 9 ms
// of paths. Frame 0, before the warm-up, has much more.
FlightProfile made_up_profile() {
  FlightProfile profile;
  profile.systems = {"cache", "step paths", std::string(kOutside)};
  profile.flights = 2;
  for (std::uint64_t i = 0; i < 11; ++i)
    profile.frames.push_back(
        {.index = i, .time_s = 0.1 * static_cast<double>(i), .work = {1 * kMs, 2 * kMs, 0}});
  profile.frames[0].work = {500 * kMs, 500 * kMs, 0};
  profile.frames[7].work = {2 * kMs, 9 * kMs, 0};
  return profile;
}

void add_samples(FlightProfile& profile, std::uint32_t frame, std::uint32_t function, int count) {
  for (int i = 0; i < count; ++i)
    profile.samples.push_back({.frame = frame, .function = function, .system = 1});
}

TEST(Cause, NamesTheSystemWhoseWorkGrewMost) {
  const Cause cause = cause_of_frame(made_up_profile(), 7, 0.1);
  ASSERT_EQ(cause.systems.size(), 2u);
  EXPECT_EQ(cause.systems[0].name, "step paths");
  EXPECT_DOUBLE_EQ(cause.systems[0].now, 9);
  EXPECT_DOUBLE_EQ(cause.systems[0].usual, 2);
  EXPECT_DOUBLE_EQ(cause.systems[0].share, 7.0 / 8);
  EXPECT_EQ(cause.systems[1].name, "cache");
  EXPECT_EQ(to_text(cause),
            "'step paths' took 88 % of the difference (9 ms of processor time, usually 2 ms)");
}

TEST(Cause, HasNoneForAnUsualFrameAndAnUnknownOne) {
  EXPECT_THAT(cause_of_frame(made_up_profile(), 3, 0.1).systems, IsEmpty());
  EXPECT_THAT(cause_of_frame(made_up_profile(), 99, 0.1).systems, IsEmpty());
  EXPECT_EQ(to_text(cause_of_frame(made_up_profile(), 3, 0.1)), "");
  EXPECT_THAT(cause_of_frame({}, 0, 0).systems, IsEmpty());
}

TEST(Cause, IsNotNamedIfTheWorkGrewByLessThanATenth) {
  FlightProfile profile = made_up_profile();
  profile.frames[7].work = {1 * kMs, 2 * kMs + kMs / 5, 0};
  const Cause cause = cause_of_frame(profile, 7, 0.1);
  EXPECT_EQ(cause.systems.size(), 1u);
  EXPECT_EQ(to_text(cause), "");
  EXPECT_THAT(to_html(cause), HasSubstr("about as much work as usually"));
}

TEST(Cause, NamesTheFunctionWithMoreSamplesThanUsual) {
  FlightProfile profile = made_up_profile();
  profile.functions = {"sleep_well", "find_path", "rare"};
  for (std::uint32_t frame = 0; frame < 11; ++frame)
    add_samples(profile, frame, 0, 40);
  add_samples(profile, 7, 1, 30);
  add_samples(profile, 7, 2, 1);
  const Cause cause = cause_of_frame(profile, 7, 0.1);
  ASSERT_EQ(cause.functions.size(), 1u);
  EXPECT_EQ(cause.functions[0].name, "find_path");
  EXPECT_NEAR(cause.functions[0].now, 30 * 1000 / kSamplesPerSecond / 2, 1e-9);
  EXPECT_EQ(cause.functions[0].usual, 0);
  // Steps have no intervals of their own in a frame: their samples belong to the simulation.
  profile.systems.emplace_back("simulation");
  for (FunctionSample& sample : profile.samples)
    sample.system = 3;
  EXPECT_THAT(to_text(cause_of_frame(profile, 7, 0.1)), HasSubstr("mostly in find_path"));
}

TEST(Cause, ComparesTheMeanFrameWithThatOfABase) {
  const ProfileSummary base = summary_of(made_up_profile(), 0.1);
  EXPECT_EQ(base.frames, 10u);
  FlightProfile slow = made_up_profile();
  for (ProfiledFrame& frame : slow.frames)
    frame.work[0] += 5 * kMs;
  const auto cause = cause_against(base, summary_of(slow, 0.1));
  ASSERT_TRUE(cause);
  ASSERT_EQ(cause->systems.size(), 1u);
  EXPECT_EQ(cause->systems[0].name, "cache");
  EXPECT_NEAR(cause->systems[0].now - cause->systems[0].usual, 5, 1e-9);
  EXPECT_EQ(cause->systems[0].share, 1);
}

TEST(Cause, RefusesABaseInAnotherUnit) {
  ProfileSummary base = summary_of(made_up_profile(), 0.1);
  base.unit = telemetry::WorkUnit::kInstructions;
  const auto cause = cause_against(base, summary_of(made_up_profile(), 0.1));
  ASSERT_FALSE(cause);
  EXPECT_THAT(cause.error().message, HasSubstr("the base has instructions"));
}

TEST(Cause, IsShownAsEscapedHtml) {
  FlightProfile profile = made_up_profile();
  profile.systems[1] = "a<b>\x1b[31m";
  const std::string html = to_html(cause_of_frame(profile, 7, 0.1));
  EXPECT_THAT(html, HasSubstr("a&lt;b&gt;"));
  EXPECT_THAT(html, Not(HasSubstr("\x1b")));
}

TEST(ProfileFile, IsReadAsItWasWritten) {
  FlightProfile profile = made_up_profile();
  profile.functions = {"operator<<(std::ostream&, char const*)"};
  add_samples(profile, 5, 0, 12);
  const ProfileSummary summary = summary_of(profile, 0.1);
  const auto read = parse_profile(to_json(summary), "profile.json");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->unit, summary.unit);
  EXPECT_EQ(read->frames, summary.frames);
  ASSERT_EQ(read->systems.size(), summary.systems.size());
  EXPECT_EQ(read->systems[1].name, "step paths");
  EXPECT_EQ(read->systems[1].usual, summary.systems[1].usual);
  ASSERT_EQ(read->functions.size(), 1u);
  EXPECT_EQ(read->functions[0].system, "step paths");
}

TEST(ProfileFile, IsRefusedWithTheReasonIfItIsNone) {
  const auto message = [](std::string_view text) {
    const auto read = parse_profile(text, "base/profile.json");
    return read ? std::string("read") : read.error().message;
  };
  EXPECT_THAT(message(""), HasSubstr("base/profile.json: it is no profile"));
  EXPECT_THAT(message("[]"), HasSubstr("it is no profile"));
  EXPECT_THAT(message(R"({"schema":"psygen.summary/1"})"), HasSubstr("schema is not"));
  EXPECT_THAT(message(R"({"schema":"psygen.profile/1","unit":"cows"})"),
              HasSubstr("its unit is unknown"));
  EXPECT_THAT(message(R"({"schema":"psygen.profile/1","unit":"instructions","frames":1,)"
                      R"("systems":[{"name":1}],"functions":[]})"),
              HasSubstr("it is no profile"));
}

TEST(Samples, AreReadFromTheTextOfPerf) {
  const auto samples = parse_samples(
      "45651.133096:      7fcf70cb23e0 update_active.constprop.0\n"
      "45651.133296:  ffffffff8162c1d5 [unknown]\n"
      "   7.5: 1 std::vector<int, std::allocator<int> >::push_back(int const&)\n"
      "\nno sample\n12\n13:\n14: 7fcf70cb23e0\n15: 7fcf70cb23e0 cut");
  ASSERT_EQ(samples.size(), 4u);
  EXPECT_DOUBLE_EQ(samples[0].time_s, 45651.133096);
  EXPECT_EQ(samples[0].function, "update_active.constprop.0");
  EXPECT_EQ(samples[1].function, "[unknown]");
  EXPECT_EQ(samples[2].function, "std::vector<int, std::allocator<int> >::push_back(int const&)");
  EXPECT_EQ(samples[3].function, "cut");
}

// Takes this much processor time, whatever else the machine does.
extern "C" [[gnu::noinline]] void psygen_test_burn(double seconds) {
  const double end_s = core::thread_cpu_seconds() + seconds;
  volatile double sum = 0;
  while (core::thread_cpu_seconds() < end_s)
    for (int i = 0; i < 10'000; ++i)
      sum = sum + std::sqrt(static_cast<double>(i));
}

// A short flight on the virtual clock, whose frames take some ms.
std::filesystem::path write_walk(const TemporaryFolder& folder, double budget_ms) {
  std::ofstream(folder / "walk.toml")
      << "format = 1\n[flight]\nsize = [64, 36]\nview_distance = 200\nframes = 24\n"
         "fixed_step = 30\nwarmup = 0.1\nclock = \"virtual\"\nbudget_mib = 32\n"
         "[at_most]\nframe_ms.mean = "
      << budget_ms << "\n";
  return folder / "walk.toml";
}

// Adds a system that burns 30 ms in each frame from this time on, for a duration.
Hooks burning(double from_s, double seconds) {
  Hooks hooks;
  hooks.prepare = [=](app::SessionOptions& session) -> core::Result<void> {
    app::Plugin plugin;
    plugin.name = "burning";
    plugin.add_systems = [=](scene::Systems& systems) -> core::Result<void> {
      systems.frame.add("burn", [=](const scene::Clock& clock) {
        if (clock.now_s > from_s && clock.now_s < from_s + seconds) psygen_test_burn(0.03);
      });
      return {};
    };
    session.plugins.push_back(std::move(plugin));
    return {};
  };
  return hooks;
}

// Tries perf itself, so that a broken sampler is not taken for a machine without it.
bool perf_runs(const TemporaryFolder& folder) {
  const std::string command = "perf record --quiet -k CLOCK_MONOTONIC -e cpu-clock -o '" +
                              (folder / "perf.data").string() + "' -- true >/dev/null 2>&1";
  return std::system(command.c_str()) == 0;
}

TEST(Profile, FindsTheSystemAndTheFunctionThatWorkInABadFrame) {
  const TemporaryFolder folder;
  auto test = load_frame_test(write_walk(folder, 1));
  ASSERT_TRUE(test) << test.error().message;
  RunOptions options;
  options.out = folder / "out";
  std::filesystem::create_directories(options.out / test->name);
  const auto profile = profile_flight(*test, options, burning(19.5 / 30, 1.0 / 30), 2);
  ASSERT_TRUE(profile) << profile.error().message;
  ASSERT_EQ(profile->frames.size(), 24u);
  const Cause cause = cause_of_frame(*profile, 20, 0.1);
  ASSERT_THAT(cause.systems, Not(IsEmpty()));
  EXPECT_EQ(cause.systems[0].name, "burn");
  if (profile->unit == telemetry::WorkUnit::kProcessorTime) {
    EXPECT_GT(cause.systems[0].now, 29);
    EXPECT_LT(cause.systems[0].usual, 5);
  }
  EXPECT_TRUE(std::filesystem::is_empty(options.out / test->name)) << "files of perf are left";
  if (perf_runs(folder)) {
    EXPECT_EQ(profile->no_samples, "");
    ASSERT_THAT(cause.functions, Not(IsEmpty()));
    EXPECT_EQ(cause.functions[0].system, "burn");
    EXPECT_THAT(to_text(cause), HasSubstr("mostly in "));
  } else {
    EXPECT_THAT(profile->no_samples, HasSubstr("perf cannot sample functions: "));
    EXPECT_THAT(cause.functions, IsEmpty());
  }
}

TEST(Profile, RefusesFlightsWhoseFramesAreNotNumbered) {
  const TemporaryFolder folder;
  auto test = load_frame_test(write_walk(folder, 1));
  ASSERT_TRUE(test);
  test->flight.session.scene.virtual_time = false;
  test->flight.fixed_step_hz = 0;
  const auto profile = profile_flight(*test, {}, {}, 1);
  ASSERT_FALSE(profile);
  EXPECT_EQ(profile.error().code, core::ErrorCode::kInvalidArgument);
  EXPECT_THAT(profile.error().message, HasSubstr("fixed_step"));
}

TEST(Profile, OfABaseTellsTheSystemThatASlowerProgramSpendsItsTimeIn) {
  const TemporaryFolder folder;
  RunOptions options;
  const auto file = write_walk(folder, 1000);
  options.out = folder / "base";
  options.profile = true;
  options.worst_frames = 1;
  options.files = {file};
  options.junit = folder / "junit.xml";
  ASSERT_EQ(run_frame_tests(options), kHeld);
  ASSERT_TRUE(std::filesystem::exists(folder / "base" / "walk" / "profile.json"));
  options.base = options.out;
  options.out = folder / "now";
  write_walk(folder, 1e-3);
  ASSERT_EQ(run_frame_tests(options, burning(0, 10)), kMissed);
  EXPECT_THAT(file_content(options.junit), HasSubstr("against the base: &#39;burn&#39; took"));
  const std::string page = file_content(options.out / "walk" / "failed.html");
  EXPECT_THAT(page, HasSubstr("<h2>Against the base</h2>"));
  EXPECT_THAT(page, HasSubstr("<td>burn</td>"));
  std::ofstream(folder / "base" / "walk" / "profile.json") << "{";
  ASSERT_EQ(run_frame_tests(options), kMissed);
  EXPECT_THAT(file_content(options.out / "walk" / "failed.html"),
              HasSubstr("no comparison with the base: "));
}

TEST(WorkCounter, GrowsWithTheWorkOfTheThread) {
  const std::uint64_t before = telemetry::work_of_thread();
  psygen_test_burn(0.002);
  const std::uint64_t after = telemetry::work_of_thread();
  EXPECT_GE(after - before, telemetry::work_unit() == telemetry::WorkUnit::kProcessorTime
                                ? std::uint64_t{2} * kMs
                                : std::uint64_t{100'000});
}

}  // namespace
}  // namespace psygen::frametest
