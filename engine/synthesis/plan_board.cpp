#include "engine/synthesis/plan_board.hpp"

#include <algorithm>
#include <utility>

#include "engine/core/assert.hpp"

namespace psygen::synthesis {

std::shared_ptr<PlanBoard::Reader> PlanBoard::add_reader() {
  return readers_.emplace_back(std::make_shared<Reader>());
}

void PlanBoard::remove_reader(const std::shared_ptr<Reader>& reader) {
  std::erase(readers_, reader);
}

// A plan without readers, to reuse its memory, or a new one.
std::unique_ptr<PlanBoard::Plan> PlanBoard::take_plan() {
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

void PlanBoard::publish(std::vector<Request>&& requests) {
  PSYGEN_CHECK(current_.load(std::memory_order_relaxed) == nullptr, "the last plan is not closed");
  if (requests.empty()) return;
  std::unique_ptr<Plan> plan = take_plan();
  plan->requests = std::move(requests);
  plan->cursor.store(0, std::memory_order_relaxed);
  current_.store(plan.get(), std::memory_order_seq_cst);
  plans_.push_back(std::move(plan));
  wake_all();
}

std::size_t PlanBoard::close(std::vector<Request>& unclaimed) {
  Plan* plan = current_.load(std::memory_order_relaxed);
  if (plan == nullptr) return 0;
  const std::uint64_t claimed = std::min<std::uint64_t>(
      plan->cursor.exchange(kClosed, std::memory_order_acq_rel), plan->requests.size());
  current_.store(nullptr, std::memory_order_seq_cst);
  unclaimed.insert(unclaimed.end(), plan->requests.begin() + static_cast<std::ptrdiff_t>(claimed),
                   plan->requests.end());
  return claimed;
}

bool PlanBoard::claim(Reader& reader, Request& out, std::uint64_t& retries) {
  Plan* plan = current_.load(std::memory_order_seq_cst);
  for (;;) {
    reader.plan.store(plan, std::memory_order_seq_cst);
    Plan* now = current_.load(std::memory_order_seq_cst);
    if (now == plan) break;
    plan = now;
    ++retries;
  }
  bool claimed = false;
  // Looking first keeps idle modelers from moving the cursor of an exhausted plan.
  if (plan != nullptr && plan->cursor.load(std::memory_order_relaxed) < plan->requests.size()) {
    const std::uint64_t i = plan->cursor.fetch_add(1, std::memory_order_acq_rel);
    if (i < plan->requests.size()) {
      out = plan->requests[i];
      claimed = true;
    }
  }
  reader.plan.store(nullptr, std::memory_order_release);
  return claimed;
}

void PlanBoard::wake_all() {
  epoch_.fetch_add(1, std::memory_order_acq_rel);
  epoch_.notify_all();
}

}  // namespace psygen::synthesis
