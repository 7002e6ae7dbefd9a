#include "engine/frametest/profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

#include "ecs/schedule.hpp"
#include "engine/app/flight.hpp"
#include "engine/core/clock.hpp"
#include "engine/frametest/sampler.hpp"
#include "engine/scene/scene.hpp"

namespace psygen::frametest {
namespace {

struct Interval {
  double begin_s = 0, end_s = 0;  // core::monotonic_seconds()
};

// One flight's frames with the intervals of their systems, which the samples need.
struct FlownFrame {
  Interval whole;
  std::vector<Interval> systems;  // of the tick
};
struct Flown {
  std::vector<std::string> systems;
  std::vector<ProfiledFrame> frames;
  std::vector<FlownFrame> times;
};

// Counts the work of each frame. Runs after the game's plugins, so that their hooks count for the
// same frame.
class Recorder {
 public:
  explicit Recorder(Flown& flown) : flown_(flown) {}

  void start(app::Session& session) {
    flown_.systems = session.scene().system_names();
    flown_.systems.emplace_back(kOutside);
    session.scene().count_work(telemetry::work_of_thread);
  }
  // A frame lasts from the end of the one before; the first one from its first system.
  void frame(app::Session& session, double dt_s) {
    const scene::Scene& scene = session.scene();
    const auto work = scene.system_work();
    const std::uint64_t now_work = telemetry::work_of_thread();
    const std::uint64_t in_systems = std::accumulate(work.begin(), work.end(), std::uint64_t{0});
    const std::uint64_t in_all = now_work - work_before_.value_or(now_work);
    ProfiledFrame frame{.index = flown_.frames.size(),
                        .time_s = session.now_s() - dt_s,
                        .work = {work.begin(), work.end()}};
    frame.work.push_back(in_all - std::min(in_systems, in_all));
    flown_.frames.push_back(std::move(frame));
    FlownFrame times{.whole = {end_s_, core::monotonic_seconds()}, .systems = {}};
    for (const ecs::SystemInfo& system : scene.frame_systems())
      times.systems.push_back({system.last_start_s, system.last_start_s + system.last_seconds});
    if (!work_before_ && !times.systems.empty()) times.whole.begin_s = times.systems[0].begin_s;
    end_s_ = times.whole.end_s;
    flown_.times.push_back(std::move(times));
    work_before_ = now_work;
  }

 private:
  Flown& flown_;
  double end_s_ = 0;  // of the last frame
  std::optional<std::uint64_t> work_before_;
};

core::Result<Flown> fly(const FrameTest& test, const RunOptions& options, const Hooks& hooks) {
  Flown flown;
  Recorder recorder(flown);
  app::Plugin plugin;
  plugin.name = "work of each system";
  plugin.on_start = [&](app::Session& session) { recorder.start(session); };
  plugin.on_frame = [&](app::Session& session, double dt_s) { recorder.frame(session, dt_s); };
  app::FlightOptions flight = test.flight;
  flight.images_every = 0;
  flight.hash_world = false;
  flight.reference_load = false;
  auto made = start_flight(std::move(flight), options, hooks, plugin);
  if (!made) return tl::unexpected(made.error());
  const auto report = (*made)->run();
  if (!report) return tl::unexpected(report.error());
  if ((*made)->session().stopped())
    return core::fail(core::ErrorCode::kInterrupted, "the flight was stopped");
  return flown;
}

// Keeps the least work of each system in each frame.
void merge(const Flown& flown, FlightProfile& profile) {
  if (profile.flights == 0) {
    profile.systems = flown.systems;
    profile.frames = flown.frames;
  }
  const std::size_t frames = std::min(profile.frames.size(), flown.frames.size());
  profile.frames.resize(frames);
  for (std::size_t f = 0; f < frames; ++f) {
    std::vector<std::uint64_t>& least = profile.frames[f].work;
    const std::vector<std::uint64_t>& work = flown.frames[f].work;
    for (std::size_t s = 0; s < std::min(least.size(), work.size()); ++s)
      least[s] = std::min(least[s], work[s]);
  }
  ++profile.flights;
}

// Position of the system that ran at this time; the last one, kOutside, if none did.
std::uint32_t system_at(const FlownFrame& frame, double time_s, std::size_t outside) {
  const auto runs = [&](const Interval& i) { return time_s >= i.begin_s && time_s <= i.end_s; };
  const auto found = std::ranges::find_if(frame.systems, runs);
  return static_cast<std::uint32_t>(found == frame.systems.end()
                                        ? outside
                                        : static_cast<std::size_t>(found - frame.systems.begin()));
}

// Finds the frame and the system of each sample.
void add_samples(const Flown& flown, std::span<const Sample> samples, FlightProfile& profile) {
  std::map<std::string, std::uint32_t, std::less<>> known;
  for (std::uint32_t i = 0; i < profile.functions.size(); ++i)
    known.emplace(profile.functions[i], i);
  for (const Sample& sample : samples) {
    const auto frame = std::ranges::upper_bound(flown.times, sample.time_s, {},
                                                [](const FlownFrame& f) { return f.whole.end_s; });
    if (frame == flown.times.end() || sample.time_s < frame->whole.begin_s) continue;
    const auto next = static_cast<std::uint32_t>(profile.functions.size());
    const auto [function, is_new] = known.emplace(sample.function, next);
    if (is_new) profile.functions.push_back(sample.function);
    profile.samples.push_back(
        {.frame = static_cast<std::uint32_t>(frame - flown.times.begin()),
         .function = function->second,
         .system = system_at(*frame, sample.time_s, profile.systems.size() - 1)});
  }
}

}  // namespace

bool is_numbered(const app::FlightOptions& flight) {
  return flight.session.scene.virtual_time || flight.fixed_step_hz > 0;
}

core::Result<FlightProfile> profile_flight(const FrameTest& test, const RunOptions& options,
                                           const Hooks& hooks, int flights) {
  if (!is_numbered(test.flight))
    return core::fail(core::ErrorCode::kInvalidArgument,
                      "frames of two flights are comparable only with fixed_step or on the virtual "
                      "clock");
  FlightProfile profile;
  profile.unit = telemetry::work_unit();
  for (int i = 0; i < flights; ++i) {
    auto sampler = profile.no_samples.empty()
                       ? Sampler::start(options.out / test.name)
                       : core::fail(core::ErrorCode::kNoDevice, profile.no_samples);
    const auto flown = fly(test, options, hooks);
    if (!flown) return tl::unexpected(flown.error());
    merge(*flown, profile);
    const auto samples = sampler ? sampler->stop() : tl::unexpected(sampler.error());
    if (samples) {
      add_samples(*flown, *samples, profile);
    } else {
      profile.no_samples = samples.error().message;
    }
  }
  return profile;
}

}  // namespace psygen::frametest
