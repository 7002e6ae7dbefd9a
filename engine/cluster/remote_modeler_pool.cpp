#include "engine/cluster/remote_modeler_pool.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/cluster/mesh_messages.hpp"
#include "engine/core/clock.hpp"
#include "engine/core/headroom.hpp"
#include "engine/core/log.hpp"

namespace psygen::cluster {
namespace {

using synthesis::RemoteMesh;

constexpr unsigned kMaxPinged = 16;            // ranks, spread evenly
constexpr int kPings = 5;                      // of each size; the median counts
constexpr std::uint64_t kPingBytes = 1 << 20;  // size of the larger ones
constexpr double kSilence_s = 10;              // a rank silent for longer counts as stalled
constexpr double kFarewell_s = 20;             // at the end; a rank may finish its current mesh

}  // namespace

RemoteModelerPool::RemoteModelerPool(CompatibilityKey key, Peers& peers,
                                     const RemoteOptions& options)
    : key_(std::move(key)),
      peers_(peers),
      send_above_s_(options.send_above_s),
      is_lost_(peers.count()) {}

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

bool RemoteModelerPool::takes(const models::ModelType& type,
                              const synthesis::Request& request) const {
  const double min_s =
      send_above_s_ ? *send_above_s_ : way_.seconds(static_cast<double>(request.size.bytes()));
  if (!(request.cost.warm_s() > min_s) || request.edits || request.parameters.edits() != nullptr)
    return false;
  return std::ranges::any_of(key_.types, [&](const TypeFingerprint& known) {
    return known.name == type.name() && known.identity == type.identity();
  });
}

bool RemoteModelerPool::is_usable(unsigned place) const {
  const std::lock_guard lock(mutex_);
  return !places_[place].is_cancelled && !is_lost_[places_[place].rank];
}

void RemoteModelerPool::cancel(unsigned place, bool stalled) {
  {
    const std::lock_guard lock(mutex_);
    places_[place].is_cancelled = true;
    places_[place].changed.notify_one();
  }
  if (stalled) lose(places_[place].rank, "it does not respond");
}

// Answers for the other slots of this rank may still arrive.
void RemoteModelerPool::lose(unsigned rank, const std::string& why) {
  const std::lock_guard lock(mutex_);
  if (is_lost_[rank]) return;
  is_lost_[rank] = true;
  core::log_warning(fmt::format("rank {} is not used any more: {}", rank, why));
}

RemoteMesh RemoteModelerPool::make(unsigned number, const models::ModelType& type,
                                   const synthesis::Request& request) {
  Place& place = places_[number];
  MakeMessage message{0,
                      std::string(type.name()),
                      models::parameters_hash(type, request.parameters),
                      request.parameters,
                      request.key.level,
                      request.size};
  {
    const std::lock_guard lock(mutex_);
    if (place.is_cancelled || is_over_ || is_lost_[place.rank]) return {};
    message.ticket = place.ticket = ++ticket_;
    ++awaited_;
    wanted_.notify_all();
  }
  peers_.send(place.rank, make_message(message));
  RemoteMesh mesh;
  {
    std::unique_lock lock(mutex_);
    place.changed.wait(lock, [&] { return place.answer || place.is_cancelled; });
    place.ticket = 0;
    if (--awaited_ == 0 && is_over_) wanted_.notify_all();
    if (place.answer) mesh = *std::exchange(place.answer, std::nullopt);
  }
  using Answer = RemoteMesh::Answer;
  const bool made = mesh.answer == Answer::kMade;
  if (made && (mesh.bytes.size() != request.size.bytes() || !core::is_box(mesh.tight))) {
    lose(place.rank, "it sent an invalid mesh");
    mesh = {};
  }
  if (mesh.answer == Answer::kNone) given_back_.fetch_add(1, std::memory_order_relaxed);
  if (mesh.answer == Answer::kMade) {
    meshes_.fetch_add(1, std::memory_order_relaxed);
    bytes_.fetch_add(mesh.bytes.size(), std::memory_order_relaxed);
  }
  return mesh;
}

void RemoteModelerPool::receive_answers() {
  for (Nap nap;;) {
    {
      std::unique_lock lock(mutex_);
      if (awaited_ == 0) {
        wanted_.wait(lock, [this] { return is_over_ || awaited_ > 0; });
        nap.wake();
      }
      if (is_over_) return;
    }
    auto parcel = peers_.receive();
    if (!parcel) {
      nap.sleep();
      continue;
    }
    nap.wake();
    deliver(std::move(*parcel));
  }
}

// A late answer matches no waiting slot and is dropped.
void RemoteModelerPool::deliver(Parcel&& parcel) {
  const unsigned rank = parcel.from;
  auto message = read_message(std::move(parcel.bytes));
  const bool damaged = !message || message->kind != MessageKind::kAnswer;
  if (damaged || message->mesh.answer == RemoteMesh::Answer::kNone)
    lose(rank, damaged ? "its message is damaged" : message->mesh.error);
  const std::lock_guard lock(mutex_);
  for (Place& place : places_) {
    if (place.rank != rank || place.ticket == 0) continue;
    if (damaged || message->ticket == 0) {  // it may answer any of the requests
      place.answer.emplace();
    } else if (place.ticket == message->ticket) {
      place.answer = std::move(message->mesh);
    } else {
      continue;
    }
    place.changed.notify_one();
  }
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

RemoteStats RemoteModelerPool::figures() const {
  const std::lock_guard lock(mutex_);
  RemoteStats figures;
  figures.ranks = peers_.count() - 1;
  figures.lost = static_cast<unsigned>(std::ranges::count(is_lost_, true));
  figures.meshes = meshes_;
  figures.bytes = bytes_;
  figures.given_back = given_back_;
  figures.way = way_;
  return figures;
}

}  // namespace psygen::cluster
