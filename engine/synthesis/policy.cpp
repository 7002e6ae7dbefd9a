#include "engine/synthesis/policy.hpp"

#include <algorithm>
#include <array>

namespace psygen::synthesis {
namespace {
constexpr std::array<std::string_view, 5> kNames{"fifo", "plp", "shortest", "longest", "deadline"};

// Compares two values; equal values fall through to the next criterion.
template <class T>
int compare(const T& a, const T& b) {
  return a < b ? -1 : (b < a ? 1 : 0);
}
int by_deadline(const ScheduleKey& a, const ScheduleKey& b) {
  if (const int c = compare(a.rank.group(), b.rank.group())) return c;
  return is_visible(a.rank.group()) ? 0 : compare(a.deadline_s, b.deadline_s);
}
}  // namespace

std::string_view name_of(Policy policy) {
  return kNames[static_cast<std::size_t>(policy)];
}

std::optional<Policy> policy_from(std::string_view name) {
  const auto found = std::ranges::find(kNames, name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<Policy>(found - kNames.begin());
}

bool served_before(Policy policy, const ScheduleKey& a, const ScheduleKey& b) {
  const int rank = compare(a.rank, b.rank);
  const int shorter = compare(a.predicted_seconds, b.predicted_seconds);
  std::array<int, 3> order{};
  switch (policy) {
    case Policy::kFifo:
      break;
    case Policy::kPlp:
      order = {rank, shorter, 0};
      break;
    case Policy::kShortest:
      order = {shorter, rank, 0};
      break;
    case Policy::kLongest:
      order = {-shorter, rank, 0};
      break;
    case Policy::kDeadline:
      order = {by_deadline(a, b), rank, shorter};
      break;
  }
  for (const int c : order) {
    if (c != 0) return c < 0;
  }
  return a.arrival < b.arrival;
}

}  // namespace psygen::synthesis
