// In which order requests are served. One comparison for the planner and the simulator, so that
// what is simulated is what runs. All orders are total for distinct `arrival`, hence deterministic.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "engine/synthesis/rank.hpp"

namespace psygen::synthesis {

// In which order requests are synthesised.
enum class Policy : std::uint8_t {
  kFifo,      // first come, first served (the paper's prototype)
  kPlp,       // by rank: group, PLP key, distance; then the shorter one
  kShortest,  // least predicted time first: most models soon
  kLongest,   // most predicted time first: balances the modelers when nothing is urgent
  kDeadline,  // group, then what becomes visible first, then rank, then the shorter one
};
inline constexpr Policy kAllPolicies[] = {Policy::kFifo, Policy::kPlp, Policy::kShortest,
                                          Policy::kLongest, Policy::kDeadline};

// The names of policies on the command line; policy_from() gives nothing for others.
std::string_view name_of(Policy policy);  // "fifo", "plp", "shortest", "longest", "deadline"
std::optional<Policy> policy_from(std::string_view name);

// The values of a request that policies sort by.
struct ScheduleKey {
  Rank rank;
  float deadline_s = 0;  // seconds from now until it is visible; 0 for what is in view
  double predicted_seconds = 0;
  std::uint64_t arrival = 0;
};

// Whether `a` is served before `b`. A strict weak order.
bool served_before(Policy policy, const ScheduleKey& a, const ScheduleKey& b);

}  // namespace psygen::synthesis
