// Orders in which requests are served. The planner and the simulator share one comparison, so
// simulated and real schedules agree. All orders are total for distinct `arrival`, hence
// deterministic.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "engine/synthesis/rank.hpp"

namespace psygen::synthesis {

// Order in which requests are synthesised.
enum class Policy : std::uint8_t {
  kFifo,      // first come, first served (the paper's prototype)
  kPlp,       // by rank: group, PLP key, distance; then the shorter request
  kShortest,  // shortest predicted time first: finishes most models soon
  kLongest,   // longest predicted time first: balances the modelers when nothing is urgent
  kDeadline,  // group, then earliest deadline, then rank, then the shorter request
};
inline constexpr Policy kAllPolicies[] = {Policy::kFifo, Policy::kPlp, Policy::kShortest,
                                          Policy::kLongest, Policy::kDeadline};

// Names of policies on the command line; policy_from() returns nullopt for other names.
std::string_view name_of(Policy policy);  // "fifo", "plp", "shortest", "longest", "deadline"
std::optional<Policy> policy_from(std::string_view name);

// Values by which policies sort requests.
struct ScheduleKey {
  Rank rank;
  float deadline_s = 0;  // seconds until it is visible; 0 if it is in view
  double predicted_seconds = 0;
  std::uint64_t arrival = 0;
};

// Returns true if `a` is served before `b`. A strict weak order.
bool served_before(Policy policy, const ScheduleKey& a, const ScheduleKey& b);

}  // namespace psygen::synthesis
