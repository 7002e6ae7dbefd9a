#include "engine/synthesis/schedule_simulator.hpp"

#include <algorithm>
#include <numeric>
#include <queue>

#include "engine/core/assert.hpp"

namespace psygen::synthesis {

SimulationResult simulate(std::span<const SimulatedJob> jobs, unsigned modelers, Policy policy) {
  PSYGEN_CHECK(modelers >= 1, "a simulation needs at least one modeler");
  std::vector<std::size_t> arriving(jobs.size());
  std::iota(arriving.begin(), arriving.end(), std::size_t{0});
  std::stable_sort(arriving.begin(), arriving.end(), [&](std::size_t a, std::size_t b) {
    return jobs[a].arrival_s < jobs[b].arrival_s;
  });
  const auto later = [&](std::size_t a, std::size_t b) {
    const auto key = [&](std::size_t i) {
      const SimulatedJob& j = jobs[i];
      return ScheduleKey{j.rank, static_cast<float>(j.deadline_s), j.seconds, i};
    };
    return served_before(policy, key(b), key(a));
  };
  std::priority_queue<std::size_t, std::vector<std::size_t>, decltype(later)> waiting(later);
  std::vector<double> free_at(modelers, 0.0);
  SimulationResult result;
  result.runs.resize(jobs.size());
  double busy_seconds = 0, now = 0;
  for (std::size_t next = 0; next < arriving.size() || !waiting.empty();) {
    const auto modeler = std::min_element(free_at.begin(), free_at.end());
    // A modeler that was idle starts now, not when it became free.
    now = std::max(now, *modeler);
    if (waiting.empty()) now = std::max(now, jobs[arriving[next]].arrival_s);
    while (next < arriving.size() && jobs[arriving[next]].arrival_s <= now)
      waiting.push(arriving[next++]);
    const std::size_t i = waiting.top();
    waiting.pop();
    const double finish = now + jobs[i].seconds;
    result.runs[i] = {now, finish, static_cast<std::uint32_t>(modeler - free_at.begin())};
    *modeler = finish;
    busy_seconds += jobs[i].seconds;
    result.makespan_s = std::max(result.makespan_s, finish);
    const double lateness = std::max(0.0, finish - jobs[i].deadline_s);
    result.mean_wait_s += finish - jobs[i].arrival_s;
    result.mean_lateness_s += lateness;
    result.max_lateness_s = std::max(result.max_lateness_s, lateness);
  }
  if (!jobs.empty()) {
    result.mean_wait_s /= static_cast<double>(jobs.size());
    result.mean_lateness_s /= static_cast<double>(jobs.size());
  }
  result.idle_seconds = std::max(0.0, result.makespan_s * modelers - busy_seconds);
  return result;
}

}  // namespace psygen::synthesis
