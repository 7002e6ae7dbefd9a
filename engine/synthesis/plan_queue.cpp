#include "engine/synthesis/plan_queue.hpp"

#include <algorithm>
#include <utility>

#include "engine/core/assert.hpp"

namespace psygen::synthesis {

std::shared_ptr<PlanQueue::Reader> PlanQueue::add_reader(Side side) {
  return readers_.emplace_back(std::make_shared<Reader>(side));
}

void PlanQueue::remove_reader(const std::shared_ptr<Reader>& reader) {
  std::erase(readers_, reader);
}

// Returns a plan without readers, to reuse its memory, or a new one.
std::unique_ptr<PlanQueue::Plan> PlanQueue::take_plan() {
  for (auto& plan : plans_) {
    const bool read = std::any_of(readers_.begin(), readers_.end(), [&](const auto& reader) {
      return reader->plan.load(std::memory_order_seq_cst) == plan.get();
    });
    if (read || plan.get() == current_.load(std::memory_order_relaxed)) continue;
    std::unique_ptr<Plan> taken = std::move(plan);
    std::erase(plans_, nullptr);
    return taken;
  }
  return std::make_unique<Plan>();
}

void PlanQueue::publish(std::vector<Request>&& requests, std::vector<std::uint32_t>&& offered) {
  PSYGEN_CHECK(current_.load(std::memory_order_relaxed) == nullptr,
               "the previous plan is not closed");
  if (requests.empty()) return;
  std::unique_ptr<Plan> plan = take_plan();
  plan->requests = std::move(requests);
  plan->offered = std::move(offered);
  plan->taken = std::vector<std::atomic<bool>>(plan->offered.empty() ? 0 : plan->requests.size());
  for (Plan::Cursor& cursor : plan->cursors)
    cursor.next.store(0, std::memory_order_relaxed);
  const bool offers = !plan->offered.empty();
  current_.store(plan.get(), std::memory_order_seq_cst);
  plans_.push_back(std::move(plan));
  wake(Side::kLocal);
  if (offers) wake(Side::kRemote);
}

// Takes every remaining request, so that each request is taken exactly once: by a modeler, or here.
std::size_t PlanQueue::close(std::vector<Request>& unclaimed) {
  Plan* plan = current_.load(std::memory_order_relaxed);
  if (plan == nullptr) return 0;
  const std::size_t before = unclaimed.size();
  const std::uint64_t passed = std::min<std::uint64_t>(
      plan->cursors[0].next.exchange(kClosed, std::memory_order_acq_rel), plan->requests.size());
  plan->cursors[1].next.store(kClosed, std::memory_order_release);
  current_.store(nullptr, std::memory_order_seq_cst);
  for (std::size_t i = passed; i < plan->requests.size(); ++i) {
    if (plan->take(i)) unclaimed.push_back(plan->requests[i]);
  }
  return plan->requests.size() - (unclaimed.size() - before);
}

// Returns the newest plan and protects it from reuse while the reader names it; null if there is
// none.
PlanQueue::Plan* PlanQueue::hold_newest(Reader& reader, std::uint64_t& retries) const {
  Plan* plan = current_.load(std::memory_order_seq_cst);
  for (;;) {
    reader.plan.store(plan, std::memory_order_seq_cst);
    Plan* now = current_.load(std::memory_order_seq_cst);
    if (now == plan) return plan;
    plan = now;
    ++retries;
  }
}

bool PlanQueue::claim(Reader& reader, Request& out, std::uint64_t& retries) {
  Plan* plan = hold_newest(reader, retries);
  bool claimed = false;
  if (plan != nullptr) {
    const bool remote = reader.side == Side::kRemote;
    const std::size_t count = remote ? plan->offered.size() : plan->requests.size();
    auto& next = plan->cursors[index(reader.side)].next;
    // Checking first keeps idle modelers from advancing the cursor of an exhausted plan.
    while (!claimed && next.load(std::memory_order_relaxed) < count) {
      const std::uint64_t i = next.fetch_add(1, std::memory_order_acq_rel);
      if (i >= count) break;
      const std::size_t at = remote ? plan->offered[i] : i;
      claimed = plan->take(at);
      if (claimed) out = plan->requests[at];
    }
  }
  reader.plan.store(nullptr, std::memory_order_release);
  return claimed;
}

void PlanQueue::wake(Side side) {
  epochs_[index(side)].fetch_add(1, std::memory_order_acq_rel);
  epochs_[index(side)].notify_all();
}

}  // namespace psygen::synthesis
