// Typed events in batches. A queue keeps an event until every one of its readers has drained it, in
// the order of emission; without readers it keeps nothing. A reader that does not drain costs at
// most `most` events: then the oldest are dropped and counted. Not a callback list, and not a
// change log of components (change_reader.hpp). A queue and its readers belong to one thread at a
// time, which a schedule guarantees.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace psygen::ecs {

template <class T>
class EventReader;

// The events of one type. Emitting is amortised O(events).
template <class T>
class EventQueue {
 public:
  // Keeps at most `most` (> 0) events that a reader has not drained.
  explicit EventQueue(std::size_t most = std::size_t{1} << 20) : kept_(std::make_shared<Kept>()) {
    kept_->most = most;
  }
  EventQueue(EventQueue&&) noexcept = default;
  EventQueue& operator=(EventQueue&&) noexcept = default;

  // True if the queue has readers. Without readers, collecting events is unnecessary.
  bool has_readers() const { return !kept_->readers.empty(); }
  // Appends events. Not inside a drain of this queue.
  void emit(std::span<const T> events) {
    if (has_readers()) kept_->append(events);
  }
  void emit(const T& event) { emit(std::span(&event, 1)); }
  // Makes a reader that sees events from this call on. It may outlive the queue.
  EventReader<T> reader() { return EventReader<T>(kept_); }
  // Number of events that were dropped because a reader did not drain them.
  std::uint64_t dropped() const { return kept_->dropped; }
  // Number of events kept for readers that have not drained them.
  std::size_t size() const { return kept_->events.size(); }

 private:
  friend class EventReader<T>;

  // Positions count all events since the first; `first` is the position of events[0].
  struct Kept {
    std::size_t most = 0;
    std::vector<T> events;
    std::uint64_t first = 0;
    std::uint64_t dropped = 0;
    std::vector<const EventReader<T>*> readers;

    std::uint64_t end() const { return first + events.size(); }
    void append(std::span<const T> more) {
      if (events.size() + more.size() > most) forget_drained();
      if (more.size() > most) {
        dropped += more.size() - most;
        first += more.size() - most;
        more = more.last(most);
      }
      if (events.size() + more.size() > most) {
        // Drops half of the bound at least: dropping one by one would be quadratic.
        const std::size_t needed = events.size() + more.size() - most;
        const std::size_t gone = std::min(events.size(), std::max(needed, most / 2));
        dropped += gone;
        forget(gone);
      }
      events.insert(events.end(), more.begin(), more.end());
    }
    void forget(std::size_t count) {
      events.erase(events.begin(), events.begin() + static_cast<std::ptrdiff_t>(count));
      first += count;
    }
    void forget_drained() {
      std::uint64_t next = end();
      for (const EventReader<T>* reader : readers)
        next = std::min(next, reader->next_);
      if (next > first) forget(static_cast<std::size_t>(next - first));
    }
  };

  std::shared_ptr<Kept> kept_;
};

// One consumer of a queue: sees every event once. Made by EventQueue::reader, or a parameter of a
// system.
template <class T>
class EventReader {
 public:
  EventReader(const EventReader&) = delete;
  EventReader& operator=(const EventReader&) = delete;
  // Movable. A moved-from reader may only be assigned to or destroyed.
  EventReader(EventReader&& other) noexcept { *this = std::move(other); }
  EventReader& operator=(EventReader&& other) noexcept {
    if (kept_) std::erase(kept_->readers, this);
    kept_ = std::exchange(other.kept_, nullptr);
    next_ = other.next_;
    if (kept_) std::ranges::replace(kept_->readers, &other, this);
    return *this;
  }
  // Detaches the reader: the queue keeps nothing for it.
  ~EventReader() {
    if (!kept_) return;
    std::erase(kept_->readers, this);
    kept_->forget_drained();
  }

  // Calls f(std::span<const T>) with the events since the last drain, unless there are none, and
  // returns their number. `f` must not emit into this queue.
  template <class F>
  std::size_t drain(F&& f) {
    const std::uint64_t from = std::max(next_, kept_->first);
    const auto events =
        std::span<const T>(kept_->events).subspan(static_cast<std::size_t>(from - kept_->first));
    if (!events.empty()) f(events);
    next_ = kept_->end();
    const std::size_t count = events.size();
    kept_->forget_drained();
    return count;
  }

 private:
  friend class EventQueue<T>;
  using Kept = typename EventQueue<T>::Kept;
  explicit EventReader(std::shared_ptr<Kept> kept) : kept_(std::move(kept)), next_(kept_->end()) {
    kept_->readers.push_back(this);
  }

  std::shared_ptr<Kept> kept_;
  std::uint64_t next_ = 0;
};

}  // namespace psygen::ecs
