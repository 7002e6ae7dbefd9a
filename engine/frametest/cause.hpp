// The cause of a bad frame: the systems and functions whose work grew most, compared with the other
// frames of the flight, or with the profile of a base. Plain values; any thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/frametest/profile.hpp"

namespace psygen::frametest {

// The work of one system or function: now, and usually.
struct WorkChange {
  std::string name;
  std::string system;  // that a function ran in; empty for systems
  double now = 0;      // of a frame: instructions or ms of processor time; functions always ms
  double usual = 0;
  double share = 0;  // of all growth, 0 … 1
};

// The largest growth first; systems and functions that did not grow are left out.
struct Cause {
  telemetry::WorkUnit unit = telemetry::WorkUnit::kProcessorTime;
  std::vector<WorkChange> systems;
  std::vector<WorkChange> functions;  // empty without samples
  double growth = 0;                  // of all systems that grew, in parts of their usual sum
};

// A cause with less growth is noise: to_text() is empty, and to_html() says so.
inline constexpr double kClearGrowth = 0.1;

// Compares a frame with the median of the frames after the warm-up; functions with their mean. The
// index is ProfiledFrame::index; an unknown one has no cause.
Cause cause_of_frame(const FlightProfile& profile, std::uint64_t index, double warmup_s);

// The mean work of a frame after the warm-up, as profile.json stores it.
struct ProfileSummary {
  telemetry::WorkUnit unit = telemetry::WorkUnit::kProcessorTime;
  std::uint64_t frames = 0;
  std::vector<WorkChange> systems, functions;  // `usual` alone is set
};
ProfileSummary summary_of(const FlightProfile& profile, double warmup_s);

// Compares the mean frame with that of a base. Fails with kInvalidArgument if the units differ.
core::Result<Cause> cause_against(const ProfileSummary& base, const ProfileSummary& now);

// profile.json, schema "psygen.profile/1". The reader fails with kParse; `file` is for messages.
std::string to_json(const ProfileSummary& summary);
core::Result<ProfileSummary> parse_profile(std::string_view json, const std::string& file);
// Also fails with kIo, and with kOverBudget for files over 16 MiB.
core::Result<ProfileSummary> read_profile(const std::filesystem::path& file);

// "'step paths' took 91 % of the difference (3.1 ms of processor time in this frame, usually 0.42),
// mostly in game::find_path". Empty without a clear growth.
std::string to_text(const Cause& cause);
// Tables of at most ten systems and functions.
std::string to_html(const Cause& cause);

}  // namespace psygen::frametest
