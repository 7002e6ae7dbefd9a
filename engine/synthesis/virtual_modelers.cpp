#include "engine/synthesis/virtual_modelers.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "engine/core/assert.hpp"

namespace psygen::synthesis {
namespace {
// Sorts by end, then by modeler.
void sort_by_end(std::vector<VirtualModelers::Job>& jobs) {
  std::ranges::sort(jobs, [](const VirtualModelers::Job& a, const VirtualModelers::Job& b) {
    return std::pair(a.finished_s, a.modeler) < std::pair(b.finished_s, b.modeler);
  });
}
}  // namespace

void VirtualModelers::publish(std::vector<Request>&& plan, double now_s) {
  PSYGEN_ASSERT(next_ == plan_.size(), "reclaim the previous plan before publishing");
  plan_ = std::move(plan);
  next_ = 0;
  published_s_ = now_s;
}

// The modeler that is free first claims next. A claimed request always finishes.
void VirtualModelers::claim_until(double now_s) {
  while (next_ < plan_.size()) {
    const auto first = std::ranges::min_element(free_s_);
    const double start_s = std::max(*first, published_s_);
    if (!(start_s < now_s)) return;
    Request& request = plan_[next_++];
    *first = start_s + request.cost.warm_s();
    running_.push_back(
        {std::move(request), static_cast<std::uint32_t>(first - free_s_.begin()), start_s, *first});
  }
}

std::vector<Request> VirtualModelers::reclaim(double now_s) {
  claim_until(now_s);
  std::vector<Request> unclaimed(
      std::make_move_iterator(plan_.begin() + static_cast<std::ptrdiff_t>(next_)),
      std::make_move_iterator(plan_.end()));
  plan_.clear();
  next_ = 0;
  return unclaimed;
}

std::vector<VirtualModelers::Job> VirtualModelers::take_finished(double now_s) {
  claim_until(now_s);
  const auto runs = [now_s](const Job& job) { return job.finished_s > now_s; };
  const auto first = std::partition(running_.begin(), running_.end(), runs);
  std::vector<Job> finished(std::make_move_iterator(first),
                            std::make_move_iterator(running_.end()));
  running_.erase(first, running_.end());
  sort_by_end(finished);
  return finished;
}

std::vector<VirtualModelers::Job> VirtualModelers::finish_all(double now_s) {
  std::vector<Job> finished = take_finished(std::numeric_limits<double>::infinity());
  std::ranges::fill(free_s_, now_s);
  return finished;
}

}  // namespace psygen::synthesis
