// Unbounded queue from one modeler to the main thread: a chain of segments, written at the tail and
// read at the head. Wait-free for both sides except for the allocation of a segment every 64
// completions. Exactly one producer and one consumer.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/synthesis/request.hpp"

namespace psygen::synthesis {

// Destroy it only after both sides have stopped using it.
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

}  // namespace psygen::synthesis
