// Where the newest plan hangs: an immutable array of requests with an atomic cursor. The main
// thread publishes and closes; any number of modelers claim. Each request is claimed exactly once
// or returned by close(), never both. Lock-free: a claim is one fetch_add; a plan is reused only
// when no modeler's reader names it (hazard pointers; Michael 2004). Some requests may be offered
// to remote modelers too, which claim in the same order among these: who sets their flag has them.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/synthesis/request.hpp"

namespace psygen::synthesis {

// The board on which the newest plan is published.
class PlanBoard {
  struct Plan {
    std::vector<Request> requests;
    std::vector<std::uint32_t> offered;    // positions of those that remote modelers may claim
    std::vector<std::atomic<bool>> taken;  // by position; none where nothing is offered
    alignas(64) std::atomic<std::uint64_t> cursor{0};
    alignas(64) std::atomic<std::uint64_t> remote_cursor{0};  // in `offered`

    // Whether nobody else has it.
    bool take(std::size_t position) {
      return taken.empty() || !taken[position].exchange(true, std::memory_order_acq_rel);
    }
  };

 public:
  // The plan that a modeler is looking at. One per modeler, made by add_reader().
  struct alignas(64) Reader {
    std::atomic<const Plan*> plan{nullptr};
  };

  // Main thread. A reader lives as long as its holder; the board shares it.
  std::shared_ptr<Reader> add_reader();
  void remove_reader(const std::shared_ptr<Reader>& reader);

  // Main thread: publishes a plan and wakes waiting readers, remote ones only if something is
  // offered. Requires that the last one is closed. `offered`: growing positions of requests that
  // claim_offered() may return.
  void publish(std::vector<Request>&& requests, std::vector<std::uint32_t>&& offered = {});
  // Main thread: closes the current plan, appends its unclaimed requests in order, and returns how
  // many were claimed from it.
  std::size_t close(std::vector<Request>& unclaimed);

  // Modelers: the next request of the newest plan, or false when there is none. Counts how often it
  // had to look again because the plan was replaced meanwhile; nothing else can delay it.
  bool claim(Reader& reader, Request& out, std::uint64_t& retries);
  // The same of those that are offered to remote modelers.
  bool claim_offered(Reader& reader, Request& out, std::uint64_t& retries);
  // Modelers: number of the newest plan, and sleeping until there is a newer one than `seen`.
  std::uint32_t epoch() const { return epoch_.load(std::memory_order_acquire); }
  void wait(std::uint32_t seen) const { epoch_.wait(seen, std::memory_order_acquire); }
  // The same for remote modelers, of plans that offer something.
  std::uint32_t offer_epoch() const { return offer_epoch_.load(std::memory_order_acquire); }
  void wait_for_offer(std::uint32_t seen) const {
    offer_epoch_.wait(seen, std::memory_order_acquire);
  }
  // Any thread: wakes every sleeper although there is no new plan; or remote modelers only.
  void wake_all();
  void wake_remote();

 private:
  static constexpr std::uint64_t kClosed = std::uint64_t{1} << 62;
  std::unique_ptr<Plan> take_plan();
  void wake_local();
  Plan* hold_newest(Reader& reader, std::uint64_t& retries) const;

  alignas(64) std::atomic<Plan*> current_{nullptr};
  alignas(64) std::atomic<std::uint32_t> epoch_{0};
  std::atomic<std::uint32_t> offer_epoch_{0};
  std::vector<std::unique_ptr<Plan>> plans_;  // the current one is last; others may still be read
  std::vector<std::shared_ptr<Reader>> readers_;
};

}  // namespace psygen::synthesis
