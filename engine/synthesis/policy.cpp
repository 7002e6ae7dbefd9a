#include "engine/synthesis/policy.hpp"

#include <array>
#include <utility>

namespace psygen::synthesis {
namespace {
constexpr std::array<std::pair<Policy, std::string_view>, 5> kNames{
    {{Policy::kFifo, "fifo"},
     {Policy::kPlp, "plp"},
     {Policy::kShortest, "shortest"},
     {Policy::kLongest, "longest"},
     {Policy::kDeadline, "deadline"}}};

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
  for (const auto& [value, name] : kNames) {
    if (value == policy) return name;
  }
  return "unknown";
}

std::optional<Policy> policy_from(std::string_view name) {
  for (const auto& [value, text] : kNames) {
    if (text == name) return value;
  }
  return std::nullopt;
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
