// Parcels that have begun to come, in the order in which they began. A large one may be whole after
// a small one of the same rank that was sent later: that one waits. A rank that stops in the middle
// of one holds up no other rank. `Request`: what tells whether a parcel is whole. One thread.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <list>
#include <optional>
#include <utility>

#include "engine/cluster/peers.hpp"

namespace psygen::cluster {

template <class Request>
class ComingParcels {
 public:
  using Clock = std::chrono::steady_clock;
  struct Coming {
    Parcel parcel;
    Request request{};
    Clock::time_point begun{};
  };

  // Room for `bytes` of rank `from`, which begin to come now. Stays where it is until it is taken.
  Coming& begin(unsigned from, std::size_t bytes, Clock::time_point now = Clock::now()) {
    return coming_.emplace_back(Coming{{from, Bytes(bytes)}, {}, now});
  }

  // The first that `is_whole` is true of; with an unfinished one goes all that its rank sent later.
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

  // Whether one has begun after `time`.
  bool any_since(Clock::time_point time) const {
    return !coming_.empty() && coming_.back().begun > time;
  }

 private:
  std::list<Coming> coming_;
};

}  // namespace psygen::cluster
