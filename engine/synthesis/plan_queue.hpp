// Holds the newest plan: an immutable array of requests with an atomic cursor. The main thread
// publishes and closes plans; any number of modelers claim. Each request is either claimed exactly
// once or returned by close(). Lock-free: a claim is one fetch_add. A plan is reused only when no
// modeler's reader names it (hazard pointers; Michael 2004). Some requests are also offered to
// remote modelers, which claim them in the same order; the first to set the request's flag owns it.
#pragma once

#include <array>
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
    struct alignas(64) Cursor {
      std::atomic<std::uint64_t> next{0};
    };
    std::array<Cursor, 2> cursors;  // by side: in `requests`, in `offered`

    // Returns true if the caller is the first to take the request.
    bool take(std::size_t position) {
      return taken.empty() || !taken[position].exchange(true, std::memory_order_acq_rel);
    }
  };

 public:
  // Local modelers claim any request, remote ones only those that are offered to them.
  enum class Side : std::uint8_t { kLocal, kRemote };

  // The plan that a modeler currently reads. One per modeler, made by add_reader().
  struct alignas(64) Reader {
    explicit Reader(Side of) : side(of) {}
    const Side side;
    std::atomic<const Plan*> plan{nullptr};
  };

  // Main thread. A reader lives as long as its holder; the board shares ownership.
  std::shared_ptr<Reader> add_reader(Side side = Side::kLocal);
  void remove_reader(const std::shared_ptr<Reader>& reader);

  // Main thread: publishes a plan and wakes waiting readers, remote ones only if something is
  // offered. Requires that the previous plan is closed. `offered`: ascending positions of requests
  // for remote modelers.
  void publish(std::vector<Request>&& requests, std::vector<std::uint32_t>&& offered = {});
  // Main thread: closes the current plan, appends its unclaimed requests in order, and returns the
  // number of claimed ones.
  std::size_t close(std::vector<Request>& unclaimed);

  // Modelers: claims the next request of the newest plan; false if there is none. `retries` counts
  // how often the plan was replaced during the claim; nothing else can delay it.
  bool claim(Reader& reader, Request& out, std::uint64_t& retries);
  // Modelers: number of the newest plan for the reader's side; wait() sleeps until there is a newer
  // one than `seen`.
  std::uint32_t epoch(const Reader& reader) const {
    return epochs_[index(reader.side)].load(std::memory_order_acquire);
  }
  void wait(const Reader& reader, std::uint32_t seen) const {
    epochs_[index(reader.side)].wait(seen, std::memory_order_acquire);
  }
  // Any thread: wakes all sleepers of a side without a new plan.
  void wake(Side side);

 private:
  static constexpr std::uint64_t kClosed = std::uint64_t{1} << 62;
  static std::size_t index(Side side) { return static_cast<std::size_t>(side); }
  std::unique_ptr<Plan> take_plan();
  Plan* hold_newest(Reader& reader, std::uint64_t& retries) const;

  alignas(64) std::atomic<Plan*> current_{nullptr};
  alignas(64) std::array<std::atomic<std::uint32_t>, 2> epochs_{};  // by side
  std::vector<std::unique_ptr<Plan>> plans_;  // the current one is last; others may still be read
  std::vector<std::shared_ptr<Reader>> readers_;
};

}  // namespace psygen::synthesis
