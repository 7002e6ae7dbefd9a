#include "engine/cluster/remote_modeler_pool.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/cluster/mesh_messages.hpp"
#include "engine/cluster/poll_backoff.hpp"
#include "engine/core/log.hpp"

namespace psygen::cluster {
using synthesis::RemoteMesh;

RemoteModelerPool::RemoteModelerPool(CompatibilityKey key, Peers& peers,
                                     const RemoteOptions& options)
    : key_(std::move(key)),
      peers_(peers),
      send_above_s_(options.send_above_s),
      is_lost_(peers.count()) {}

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
