// Holds the newest plan: an immutable array of requests with an atomic cursor. The main thread
// publishes and closes plans; any number of modelers claim. Each request is either claimed exactly
// once or returned by close(). Lock-free: a claim is one fetch_add. A plan is reused only when no
// modeler's reader names it (hazard pointers; Michael 2004). Some requests are also offered to
// remote modelers, which claim them in the same order; the first to set the request's flag owns it.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/synthesis/request.hpp"

namespace psygen::synthesis {

// Publishes plans to modelers.
class PlanQueue {
  struct Plan {
    std::vector<Request> requests;
    std::vector<std::uint32_t> offered;    // positions that remote modelers may claim
    std::vector<std::atomic<bool>> taken;  // by position; empty if nothing is offered
    alignas(64) std::atomic<std::uint64_t> cursor{0};
    alignas(64) std::atomic<std::uint64_t> remote_cursor{0};  // in `offered`

    // Returns true if the caller is the first to take the request.
    bool take(std::size_t position) {
      return taken.empty() || !taken[position].exchange(true, std::memory_order_acq_rel);
    }
  };

 public:
  // The plan that a modeler currently reads. One per modeler, made by add_reader().
  struct alignas(64) Reader {
    std::atomic<const Plan*> plan{nullptr};
  };

  // Main thread. A reader lives as long as its holder; the board shares ownership.
  std::shared_ptr<Reader> add_reader();
  void remove_reader(const std::shared_ptr<Reader>& reader);

  // Main thread: publishes a plan and wakes waiting readers, remote ones only if something is
  // offered. Requires that the previous plan is closed. `offered`: ascending positions of requests
  // that claim_offered() may return.
  void publish(std::vector<Request>&& requests, std::vector<std::uint32_t>&& offered = {});
  // Main thread: closes the current plan, appends its unclaimed requests in order, and returns the
  // number of claimed ones.
  std::size_t close(std::vector<Request>& unclaimed);

  // Modelers: claims the next request of the newest plan; false if there is none. `retries` counts
  // how often the plan was replaced during the claim; nothing else can delay it.
  bool claim(Reader& reader, Request& out, std::uint64_t& retries);
  // Claims the next request that is offered to remote modelers.
  bool claim_offered(Reader& reader, Request& out, std::uint64_t& retries);
  // Modelers: number of the newest plan; wait() sleeps until there is a newer one than `seen`.
  std::uint32_t epoch() const { return epoch_.load(std::memory_order_acquire); }
  void wait(std::uint32_t seen) const { epoch_.wait(seen, std::memory_order_acquire); }
  // Number of the newest plan that offers requests to remote modelers, and its wait.
  std::uint32_t offer_epoch() const { return offer_epoch_.load(std::memory_order_acquire); }
  void wait_for_offer(std::uint32_t seen) const {
    offer_epoch_.wait(seen, std::memory_order_acquire);
  }
  // Any thread: wakes all sleepers without a new plan; wake_remote() wakes only remote modelers.
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
