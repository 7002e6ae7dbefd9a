// A worker thread that executes one request at a time (paper, section 5.1: Modeler). It claims a
// request from the plan, writes into the request's destination, and queues a completion; it
// accesses nothing else. If its model hangs, the main thread abandons it: it then only reports when
// it releases the destination, and ends. A remote modeler's mesh is made on another rank
// (remote_modelers.hpp): its thread writes the destination only after the bytes have arrived, so
// the destination of an abandoned request is free at once. Takes no locks between requests, except
// when a remote mesh is requested or returned.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "engine/synthesis/plan_queue.hpp"
#include "engine/synthesis/remote_modelers.hpp"
#include "engine/synthesis/request.hpp"

namespace psygen::synthesis {

// Unbounded queue from one modeler to the main thread: a chain of segments, written at the tail and
// read at the head. Wait-free for both sides except for the allocation of a segment every 64
// completions. Exactly one producer and one consumer. Destroy it only after both sides have stopped
// using it.
class CompletionQueue {
 public:
  CompletionQueue() : tail_(new Segment), head_(tail_) {}
  ~CompletionQueue() {
    while (head_ != nullptr)
      delete std::exchange(head_, head_->next.load(std::memory_order_relaxed));
  }
  CompletionQueue(const CompletionQueue&) = delete;
  CompletionQueue& operator=(const CompletionQueue&) = delete;

  // Producer.
  void push(Completion&& completion) {
    std::uint32_t n = tail_->written.load(std::memory_order_relaxed);
    if (n == kSegmentSize) {
      auto* next = new Segment;
      tail_->next.store(next, std::memory_order_release);
      tail_ = next;
      n = 0;
    }
    tail_->items[n] = std::move(completion);
    tail_->written.store(n + 1, std::memory_order_release);
  }

  // Consumer: appends all queued completions, oldest first; returns their number.
  std::size_t drain(std::vector<Completion>& out) {
    std::size_t count = 0;
    for (;;) {
      const std::uint32_t written = head_->written.load(std::memory_order_acquire);
      for (; read_ < written; ++read_, ++count)
        out.push_back(std::move(head_->items[read_]));
      if (read_ < kSegmentSize) return count;
      Segment* next = head_->next.load(std::memory_order_acquire);
      if (next == nullptr) return count;
      delete std::exchange(head_, next);
      read_ = 0;
    }
  }

 private:
  static constexpr std::uint32_t kSegmentSize = 64;
  struct Segment {
    std::array<Completion, kSegmentSize> items;
    std::atomic<std::uint32_t> written{0};
    std::atomic<Segment*> next{nullptr};
  };
  alignas(64) Segment* tail_;  // producer's
  alignas(64) Segment* head_;  // consumer's
  std::uint32_t read_ = 0;
};

// Number of the modeler that runs on the main thread (SynthesisManager::execute_here).
inline constexpr std::uint32_t kMainThreadModeler = UINT32_MAX;

// State shared by all modelers. Each of them holds it, so that a hung modeler can safely outlive
// the manager.
struct Workshop {
  const models::Registry* registry = nullptr;
  std::function<double()> clock;  // called from all threads
  bool hash_content = false;
  std::vector<Annotate> annotate;  // by model; see SynthesisOptions
  PlanQueue board;
  std::atomic<bool> stop{false};
  // Modelers lower their priority before the next request; a thread cannot raise it again.
  std::atomic<bool> lowest_priority{false};
  // For a main thread that waits for completions: a modeler locks only while `waiting` is set and
  // it found nothing more to do. Never between two requests.
  std::atomic<bool> waiting{false};
  std::mutex mutex;
  std::condition_variable finished;
  // Requests that remote modelers returned without a mesh, for the main thread; under `mutex`.
  std::vector<Request> returned;
  std::atomic<bool> has_returned{false};
};

// Slot of a remote modeler; null for local ones.
struct RemoteSlot {
  RemoteModelers* modelers = nullptr;
  unsigned number = 0;
};

// Counters written by one modeler and readable from any thread.
struct ModelerCounters {
  std::atomic<std::uint64_t> models{0}, failed{0}, triangles{0}, bytes{0};
  std::atomic<double> cpu_seconds{0}, busy_seconds{0};
  // Possible contention between modelers: locks taken, and claims retried because the plan was
  // replaced.
  std::atomic<std::uint64_t> locks{0}, retries{0};
};

// One modeler. Its functions are for its own thread unless stated otherwise.
class Modeler {
 public:
  Modeler(std::uint32_t number, std::shared_ptr<PlanQueue::Reader> reader, RemoteSlot place = {})
      : number_(number), reader_(std::move(reader)), place_(place) {}

  // Thread function: works until workshop.stop, or until it is abandoned.
  void run(Workshop& workshop);

  // Executes one request in the calling thread; for a modeler without a thread.
  void perform(Workshop& workshop, const Request& request);

  // Main thread. Abandons the current request if it started before `limit_s` (workshop clock), and
  // fills `out` with its failed completion.
  bool give_up_if_older(double limit_s, double now_s, Completion& out);
  // Main thread: returns true if the current request started before `limit_s`.
  bool is_older(double limit_s) const;
  // Main thread, after a remote modeler was abandoned: its request. No thread accesses the
  // request's destination.
  const Request& abandoned() const { return current_; }

  // True if the main thread has abandoned it: the request and the objects that its annotation
  // refers to may be destroyed. Any thread.
  bool is_given_up() const {
    return (state_.load(std::memory_order_acquire) & kPhaseMask) == kGivenUp;
  }

  // Its number, slot, plan reader, completions and counters.
  std::uint32_t number() const { return number_; }
  bool is_remote() const { return place_.modelers != nullptr; }
  const RemoteSlot& place() const { return place_; }
  const std::shared_ptr<PlanQueue::Reader>& reader() const { return reader_; }
  CompletionQueue& queue() { return queue_; }
  const ModelerCounters& counters() const { return counters_; }
  // Number of queued completions, without late ones.
  std::uint64_t finished() const { return finished_.load(std::memory_order_seq_cst); }
  // True once the thread accesses nothing any more and can be joined at once.
  bool exited() const { return exited_.load(std::memory_order_acquire); }

 private:
  // kWriting: a remote mesh has arrived; it finishes soon and is not abandoned.
  enum Phase : std::uint64_t {
    kIdle = 0,
    kWorking = 1,
    kGivenUp = 2,
    kWriting = 3,
    kPhaseMask = 3
  };
  bool claim(Workshop& workshop);
  // The current request when it begins. `annotate` is null for types without annotations.
  struct Job {
    Completion completion;
    const models::ModelType& type;
    const Annotate* annotate;
  };
  Job begin(const Workshop& workshop);
  // Returns false if the request was abandoned during execution.
  bool execute(Workshop& workshop);
  bool execute_there(Workshop& workshop);
  void give_back(Workshop& workshop);
  void finish(Completion&& c);
  void write_remote_mesh(const Workshop& workshop, const Annotate* annotate, RemoteMesh& mesh,
                         Completion& c);
  Warmth warmth_at(double now_s);
  bool write_mesh(const models::ModelType& type, const models::MeshView& mesh, Completion& c);
  void write_noted_mesh(const models::ModelType& type, const Annotate& annotate, Completion& c);
  models::MeshView scratch();
  void wake_waiting(Workshop& workshop);
  void count(const Completion& completion);

  const std::uint32_t number_;
  const std::shared_ptr<PlanQueue::Reader> reader_;
  const RemoteSlot place_;
  Request current_;  // written while idle only
  std::uint64_t serial_ = 0;
  std::vector<std::size_t> warm_;  // codes run since it last slept
  double finished_s_ = 0;          // end of the last request, by the workshop's clock
  double cpu_s_ = 0;  // the thread's processor time at the start of the current request
  std::vector<std::byte> scratch_;                       // memory for meshes that are annotated
  alignas(64) std::atomic<std::uint64_t> state_{kIdle};  // serial number of the request · 4 + phase
  std::atomic<double> started_s_{0};
  std::atomic<std::uint64_t> finished_{0};
  std::atomic<bool> exited_{false};
  ModelerCounters counters_;
  CompletionQueue queue_;
};

}  // namespace psygen::synthesis
