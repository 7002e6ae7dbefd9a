// Start and end of remote modelers, while no other thread receives: measures the round trip, and
// tells the ranks that no more requests follow.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/cluster/mesh_messages.hpp"
#include "engine/cluster/poll_backoff.hpp"
#include "engine/cluster/remote_modeler_pool.hpp"
#include "engine/core/clock.hpp"
#include "engine/core/log.hpp"
#include "engine/core/start_thread.hpp"

namespace psygen::cluster {
namespace {

constexpr unsigned kMaxPinged = 16;            // ranks, spread evenly
constexpr int kPings = 5;                      // of each size; the median counts
constexpr std::uint64_t kPingBytes = 1 << 20;  // size of the larger ones
constexpr double kSilence_s = 10;              // a rank silent for longer counts as stalled
constexpr double kFarewell_s = 20;             // at the end; a rank may finish its current mesh

}  // namespace

core::Result<std::unique_ptr<RemoteModelerPool>> RemoteModelerPool::start(
    CompatibilityKey key, const std::vector<unsigned>& threads, Peers& peers,
    const RemoteOptions& options) {
  std::unique_ptr<RemoteModelerPool> models(new RemoteModelerPool(std::move(key), peers, options));
  models->add_places(threads, options.max_places);
  models->measure_round_trip();
  auto receiver = core::start_thread([m = models.get()] { m->receive_answers(); });
  if (!receiver) return tl::unexpected(receiver.error());
  models->receiver_ = std::move(*receiver);
  return models;
}

RemoteModelerPool::~RemoteModelerPool() {
  end();
}

// Adds the first thread of every rank, then the second, and so on, so that a limit leaves slots to
// all ranks.
void RemoteModelerPool::add_places(const std::vector<unsigned>& threads, unsigned most) {
  const unsigned rounds = threads.empty() ? 0 : *std::ranges::max_element(threads);
  for (unsigned round = 0; round < rounds; ++round) {
    for (unsigned rank = 1; rank < threads.size() && places_.size() < most; ++rank) {
      if (round < threads[rank]) places_.emplace_back().rank = rank;
    }
  }
}

// Returns the seconds until the answer arrives; nullopt if none does.
std::optional<double> RemoteModelerPool::ping_s(unsigned rank, std::uint64_t bytes) {
  const double begin_s = core::monotonic_seconds();
  peers_.send(rank, ping_message(++ticket_, bytes));
  for (Nap nap; core::monotonic_seconds() - begin_s < kSilence_s; nap.sleep()) {
    auto parcel = peers_.receive();
    if (!parcel || parcel->from != rank) continue;
    const auto message = read_message(std::move(parcel->bytes));
    if (!message) return std::nullopt;
    if (message->kind == MessageKind::kPong && message->ticket == ticket_)
      return core::monotonic_seconds() - begin_s;
  }
  return std::nullopt;
}

void RemoteModelerPool::measure_round_trip() {
  const unsigned others = peers_.count() - 1, pinged = std::min(others, kMaxPinged);
  double slowest_s = 0;
  for (unsigned i = 0; i < pinged; ++i) {
    const unsigned rank = 1 + i * others / pinged;
    double medians_s[2];
    for (const std::uint64_t size : {std::uint64_t{0}, kPingBytes}) {
      std::vector<double> times_s;
      for (int n = 0; n < kPings; ++n) {
        const auto time_s = ping_s(rank, size);
        if (!time_s) break;
        times_s.push_back(*time_s);
      }
      if (times_s.size() < kPings) {
        lose(rank, "it does not respond");
        break;
      }
      std::ranges::nth_element(times_s, times_s.begin() + kPings / 2);
      medians_s[size == 0 ? 0 : 1] = times_s[kPings / 2];
    }
    if (is_lost_[rank]) continue;
    way_.latency_s = std::max(way_.latency_s, medians_s[0]);
    slowest_s = std::max(slowest_s, medians_s[1] - medians_s[0]);
  }
  if (slowest_s > 0) way_.bytes_per_second = kPingBytes / slowest_s;
}

bool RemoteModelerPool::end() {
  if (std::exchange(has_ended_, true)) return true;
  {
    std::unique_lock lock(mutex_);
    is_over_ = true;
    for (Place& place : places_) {  // where a modeler hangs, other modelers may still work
      place.is_cancelled = true;
      place.changed.notify_one();
    }
    wanted_.notify_all();
    wanted_.wait(lock, [this] { return awaited_ == 0; });
  }
  if (receiver_.joinable()) receiver_.join();
  for (unsigned rank = 1; rank < peers_.count(); ++rank)
    peers_.send(rank, plain_message(MessageKind::kEnd));
  return wait_for_shutdown();
}

bool RemoteModelerPool::wait_for_shutdown() {
  unsigned silent = peers_.count() - 1;
  const double begin_s = core::monotonic_seconds();
  for (Nap nap; silent > 0 && core::monotonic_seconds() - begin_s < kFarewell_s;) {
    auto parcel = peers_.receive();
    if (!parcel) {
      nap.sleep();
      continue;
    }
    nap.wake();
    const auto message = read_message(std::move(parcel->bytes));
    if (message && message->kind == MessageKind::kBye) --silent;
  }
  if (silent > 0)
    core::log_warning(fmt::format("{} ranks do not respond; the job ends without them", silent));
  return silent == 0;
}

}  // namespace psygen::cluster
