#include "engine/frametest/cause_report.hpp"

#include <fmt/format.h>

#include <optional>

#include "engine/core/replace_file.hpp"

namespace psygen::frametest {
namespace {

core::Result<FlightProfile> write_profile(const FrameTest& test, double flight_s,
                                          const RunOptions& options, const Hooks& hooks) {
  constexpr double kLongFlightS = 60;
  auto profile = profile_flight(test, options, hooks, flight_s > kLongFlightS ? 1 : 3);
  if (!profile) return profile;
  const auto written =
      core::replace_file(options.out / test.name / kProfileFile,
                         to_json(summary_of(*profile, test.flight.warmup_seconds)));
  if (!written) return tl::unexpected(written.error());
  return profile;
}

void add_line(CauseReport& report, std::string_view place, const Cause& cause) {
  if (const std::string text = to_text(cause); !text.empty())
    report.lines.push_back(fmt::format("{}: {}", place, text));
}

void compare_with_base(const core::Result<ProfileSummary>& base, const ProfileSummary& now,
                       CauseReport& report) {
  const auto cause =
      base.and_then([&](const ProfileSummary& before) { return cause_against(before, now); });
  if (!cause) {
    report.missing.push_back("no comparison with the base: " + cause.error().message);
    return;
  }
  add_line(report, "against the base", *cause);
  report.base_html = "<h2>Against the base</h2>\n" + to_html(*cause);
}

}  // namespace

CauseReport find_causes(const FrameTest& test, std::span<const WorstFrame> frames,
                        const std::filesystem::path& base, double flight_s,
                        const RunOptions& options, const Hooks& hooks) {
  CauseReport report;
  report.frames_html.resize(frames.size());
  std::optional<core::Result<ProfileSummary>> before;  // read before this run may replace it
  if (!base.empty()) before = read_profile(base / kProfileFile);
  const auto profile = write_profile(test, flight_s, options, hooks);
  if (!profile) {
    report.missing.push_back("no causes: " + profile.error().message);
    return report;
  }
  if (!profile->no_samples.empty())
    report.missing.push_back("no functions: " + profile->no_samples);
  const double warmup_s = test.flight.warmup_seconds;
  if (before) compare_with_base(*before, summary_of(*profile, warmup_s), report);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Cause cause = cause_of_frame(*profile, frames[i].index, warmup_s);
    add_line(report, fmt::format("frame {}", frames[i].index), cause);
    report.frames_html[i] = to_html(cause);
  }
  return report;
}

}  // namespace psygen::frametest
