#include "engine/frametest/cause.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "engine/core/utf8.hpp"
#include "engine/frametest/judge.hpp"
#include "engine/frametest/sampler.hpp"

namespace psygen::frametest {
namespace {

constexpr double kMsPerSample = 1000 / kSamplesPerSecond;
constexpr std::size_t kMaxRows = 10;
// A function with fewer samples than these in a frame may be there by chance.
constexpr double kMinSamples = 3;

// In the units of WorkChange: instructions, or ms.
double shown_work(std::uint64_t work, telemetry::WorkUnit unit) {
  const auto value = static_cast<double>(work);
  return unit == telemetry::WorkUnit::kInstructions ? value : value * 1e-6;
}

// Sorts by growth, leaves out what did not grow, and sets the shares. Returns the growth of all in
// parts of the usual sum.
double rank(std::vector<WorkChange>& changes) {
  double usual = 0;
  for (const WorkChange& change : changes)
    usual += change.usual;
  std::erase_if(changes, [](const WorkChange& c) { return c.now <= c.usual; });
  const auto growth = [](const WorkChange& c) { return c.now - c.usual; };
  std::ranges::stable_sort(changes, std::greater<>(), growth);
  double sum = 0;
  for (const WorkChange& change : changes)
    sum += growth(change);
  for (WorkChange& change : changes)
    change.share = growth(change) / sum;
  return usual > 0 ? sum / usual : sum > 0 ? 1 : 0;
}

struct Function {
  std::uint32_t function = 0, system = 0;
  auto operator<=>(const Function&) const = default;
};

// Sampled times of functions after the warm-up.
struct FunctionTimes {
  std::map<Function, double> in_frame;  // samples in one frame
  std::map<Function, double> elsewhere;
  double frames_elsewhere = 0;
};

// `frame` is a position; one past the end: all samples are elsewhere.
FunctionTimes function_times(const FlightProfile& profile, std::size_t frame, double warmup_s) {
  FunctionTimes times;
  for (const FunctionSample& sample : profile.samples) {
    if (sample.frame >= profile.frames.size()) continue;
    const Function key{sample.function, sample.system};
    if (sample.frame == frame) {
      ++times.in_frame[key];
    } else if (profile.frames[sample.frame].time_s >= warmup_s) {
      ++times.elsewhere[key];
    }
  }
  for (std::size_t f = 0; f < profile.frames.size(); ++f)
    times.frames_elsewhere += f != frame && profile.frames[f].time_s >= warmup_s;
  return times;
}

std::vector<WorkChange> functions_of_frame(const FlightProfile& profile, std::size_t frame,
                                           double warmup_s) {
  std::vector<WorkChange> changes;
  const FunctionTimes times = function_times(profile, frame, warmup_s);
  for (const auto& [key, samples] : times.in_frame) {
    if (samples < kMinSamples) continue;
    const auto elsewhere = times.elsewhere.find(key);
    const double usual = elsewhere == times.elsewhere.end() || times.frames_elsewhere == 0
                             ? 0
                             : elsewhere->second / times.frames_elsewhere;
    const double ms = kMsPerSample / std::max(profile.flights, 1);
    changes.push_back({.name = profile.functions[key.function],
                       .system = profile.systems[key.system],
                       .now = samples * ms,
                       .usual = usual * ms});
  }
  rank(changes);
  return changes;
}

// The entries of both, by name and system, not ranked; those of one side alone have 0 on the other.
std::vector<WorkChange> paired(std::span<const WorkChange> base, std::span<const WorkChange> now) {
  std::map<std::pair<std::string, std::string>, WorkChange> all;
  const auto entry = [&](const WorkChange& c) -> WorkChange& {
    return all.try_emplace({c.system, c.name}, WorkChange{.name = c.name, .system = c.system})
        .first->second;
  };
  for (const WorkChange& change : base)
    entry(change).usual = change.usual;
  for (const WorkChange& change : now)
    entry(change).now = change.usual;
  std::vector<WorkChange> changes;
  for (auto& [key, change] : all)
    changes.push_back(std::move(change));
  return changes;
}

std::string work_text(double value, telemetry::WorkUnit unit) {
  return unit == telemetry::WorkUnit::kInstructions ? fmt::format("{:.0f}", value)
                                                    : fmt::format("{:.3g} ms", value);
}

std::string table(std::string_view title, std::span<const WorkChange> changes,
                  telemetry::WorkUnit unit) {
  if (changes.empty()) return {};
  std::string html = fmt::format(
      "<table><tr><th>{}</th><th>now</th><th>usually</th><th>of the difference</th></tr>\n", title);
  for (const WorkChange& c : changes.first(std::min(changes.size(), kMaxRows))) {
    const std::string place = c.system.empty() ? "" : fmt::format(" in {}", c.system);
    html += fmt::format("<tr><td>{}{}</td><td>{}</td><td>{}</td><td>{:.0f} %</td></tr>\n",
                        escaped(c.name), escaped(place), work_text(c.now, unit),
                        work_text(c.usual, unit), 100 * c.share);
  }
  return html + "</table>\n";
}

}  // namespace

Cause cause_of_frame(const FlightProfile& profile, std::uint64_t index, double warmup_s) {
  Cause cause{.unit = profile.unit, .systems = {}, .functions = {}};
  const auto found = std::ranges::find(profile.frames, index, &ProfiledFrame::index);
  if (found == profile.frames.end()) return cause;
  for (std::size_t s = 0; s < std::min(profile.systems.size(), found->work.size()); ++s) {
    std::vector<double> others;
    for (const ProfiledFrame& frame : profile.frames)
      if (&frame != &*found && frame.time_s >= warmup_s && s < frame.work.size())
        others.push_back(shown_work(frame.work[s], profile.unit));
    cause.systems.push_back({.name = profile.systems[s],
                             .system = {},
                             .now = shown_work(found->work[s], profile.unit),
                             .usual = others.empty() ? 0 : quantile_of(std::move(others), 0.5)});
  }
  cause.growth = rank(cause.systems);
  const auto frame = static_cast<std::size_t>(found - profile.frames.begin());
  cause.functions = functions_of_frame(profile, frame, warmup_s);
  return cause;
}

ProfileSummary summary_of(const FlightProfile& profile, double warmup_s) {
  ProfileSummary summary{.unit = profile.unit, .frames = 0, .systems = {}, .functions = {}};
  std::vector<double> sums(profile.systems.size());
  for (const ProfiledFrame& frame : profile.frames) {
    if (frame.time_s < warmup_s) continue;
    ++summary.frames;
    for (std::size_t s = 0; s < std::min(sums.size(), frame.work.size()); ++s)
      sums[s] += shown_work(frame.work[s], profile.unit);
  }
  const double frames = static_cast<double>(std::max<std::uint64_t>(summary.frames, 1));
  for (std::size_t s = 0; s < sums.size(); ++s)
    summary.systems.push_back(
        {.name = profile.systems[s], .system = {}, .usual = sums[s] / frames});
  const FunctionTimes times = function_times(profile, profile.frames.size(), warmup_s);
  for (const auto& [key, samples] : times.elsewhere) {
    if (samples < kMinSamples) continue;
    summary.functions.push_back(
        {.name = profile.functions[key.function],
         .system = profile.systems[key.system],
         .usual = samples * kMsPerSample / (frames * std::max(profile.flights, 1))});
  }
  return summary;
}

core::Result<Cause> cause_against(const ProfileSummary& base, const ProfileSummary& now) {
  if (base.unit != now.unit)
    return core::invalid_argument(
        fmt::format("the base has {}, this run {}", name_of(base.unit), name_of(now.unit)));
  Cause cause{.unit = now.unit,
              .systems = paired(base.systems, now.systems),
              .functions = base.functions.empty() ? std::vector<WorkChange>()
                                                  : paired(base.functions, now.functions)};
  cause.growth = rank(cause.systems);
  rank(cause.functions);
  return cause;
}

std::string to_text(const Cause& cause) {
  if (cause.systems.empty() || cause.growth < kClearGrowth) return {};
  const WorkChange& first = cause.systems.front();
  std::string text = fmt::format(
      "'{}' took {:.0f} % of the difference ({}{}, usually {})", core::shown(first.name),
      100 * first.share, work_text(first.now, cause.unit),
      cause.unit == telemetry::WorkUnit::kInstructions ? " instructions" : " of processor time",
      work_text(first.usual, cause.unit));
  // Samples of steps tell only that the simulation ran.
  const std::string_view name = first.name;
  const std::string_view system = name.starts_with("step ") ? "simulation" : name;
  const auto function = std::ranges::find(cause.functions, system, &WorkChange::system);
  if (function != cause.functions.end()) text += ", mostly in " + core::shown(function->name);
  return text;
}

std::string to_html(const Cause& cause) {
  const std::string text = to_text(cause);
  const std::string unit = cause.unit == telemetry::WorkUnit::kInstructions
                               ? "system (instructions)"
                               : "system (processor time)";
  const std::string lead =
      text.empty() ? "The main thread did about as much work as usually" : text;
  return fmt::format("<p>{}.</p>\n", escaped(lead)) + table(unit, cause.systems, cause.unit) +
         table("function", cause.functions, telemetry::WorkUnit::kProcessorTime);
}

}  // namespace psygen::frametest
