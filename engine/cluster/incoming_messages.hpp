// Incoming messages still being received, in the order in which their transfers began. A small
// message never overtakes a larger one that the same rank sent earlier. A rank that stops in the
// middle of a message delays no other rank. `Request` is the handle that tells if a transfer is
// complete. One thread.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <list>
#include <optional>
#include <utility>

#include "engine/cluster/peers.hpp"

namespace psygen::cluster {

// The incoming messages of all ranks.
template <class Request>
class IncomingMessages {
 public:
  using Clock = std::chrono::steady_clock;
  struct Coming {
    Parcel parcel;
    Request request{};
    Clock::time_point begun{};
  };

  // Adds a message of `bytes` from rank `from` whose transfer begins now. The reference stays valid
  // until the message is taken.
  Coming& begin(unsigned from, std::size_t bytes, Clock::time_point now = Clock::now()) {
    return coming_.emplace_back(Coming{{from, Bytes(bytes)}, {}, now});
  }

  // Removes and returns the first message for which `is_whole` is true. Later messages of a rank
  // wait for its unfinished one.
  template <class IsWhole>
  std::optional<Parcel> take_whole(const IsWhole& is_whole) {
    for (auto at = coming_.begin(); at != coming_.end(); ++at) {
      const bool waits = std::any_of(coming_.begin(), at, [&](const Coming& earlier) {
        return earlier.parcel.from == at->parcel.from;
      });
      if (waits || !is_whole(at->request)) continue;
      Parcel parcel = std::move(at->parcel);
      coming_.erase(at);
      return parcel;
    }
    return std::nullopt;
  }

  // Returns true if a transfer began after `time`.
  bool any_since(Clock::time_point time) const {
    return !coming_.empty() && coming_.back().begun > time;
  }

 private:
  std::list<Coming> coming_;
};

}  // namespace psygen::cluster
