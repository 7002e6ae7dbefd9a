#include "engine/cluster/model_server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "engine/cluster/mesh_messages.hpp"
#include "engine/core/clock.hpp"
#include "engine/core/headroom.hpp"
#include "engine/synthesis/synthesise.hpp"

namespace psygen::cluster {
namespace {

using synthesis::RemoteMesh;

constexpr unsigned kFlyer = 0;  // the rank that sends requests
constexpr std::chrono::milliseconds kLongestNap{1};
constexpr std::uint64_t kMaxPong = 1 << 24;  // bytes

// State shared by the threads of a rank. Each thread holds it, so that a hung thread never uses
// freed memory.
struct Shop {
  const models::Registry* registry = nullptr;
  Peers* peers = nullptr;
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<MakeMessage> queue;
  bool is_closed = false;
  unsigned threads = 0;  // that have not ended
  std::mutex sending;    // is_silent
  bool is_silent = false;
  std::condition_variable answered;  // has_answered; under `mutex`
  bool has_answered = false;
  std::atomic<std::uint64_t> made{0}, failed{0}, refused{0};

  void send(Bytes bytes) {
    const std::lock_guard lock(sending);
    if (!is_silent) peers->send(kFlyer, std::move(bytes));
  }
};

// Returns the reason why this rank cannot serve a request; empty if it can.
std::string objection(const models::Registry& registry, const MakeMessage& make) {
  const int at = registry.find(make.type);
  if (at < 0) return "it lacks the model type " + make.type;
  const models::ModelType& type = registry[static_cast<models::ModelIndex>(at)];
  if (models::parameters_hash(type, make.parameters) != make.parameters_hash ||
      make.level >= type.level_count())
    return "it has a different version of the model type " + make.type;
  const auto size = synthesis::mesh_size_guarded(type, make.parameters, make.level);
  if (!size || !(*size == make.size)) return "its meshes of " + make.type + " have another size";
  return {};
}

Bytes answer_to(const MakeMessage& make, Shop& shop) {
  const double begin_s = core::thread_cpu_seconds();
  const std::string reason = objection(*shop.registry, make);
  if (!reason.empty()) {
    ++shop.refused;
    return failed_message(make.ticket, RemoteMesh::Answer::kNone, reason);
  }
  auto writer = AnswerWriter::make(make.ticket, make.size);
  if (!writer) {
    ++shop.failed;
    return failed_message(make.ticket, RemoteMesh::Answer::kNone, writer.error().message);
  }
  const auto& type =
      (*shop.registry)[static_cast<models::ModelIndex>(shop.registry->find(make.type))];
  synthesis::SynthesisOutcome outcome =
      synthesis::synthesise_guarded(type, make.parameters, make.level, writer->mesh());
  if (!outcome.ok) {
    ++shop.failed;
    const auto answer =
        outcome.out_of_memory ? RemoteMesh::Answer::kNone : RemoteMesh::Answer::kFailed;
    return failed_message(make.ticket, answer, outcome.error);
  }
  ++shop.made;
  return std::move(*writer).finish(outcome.tight, core::thread_cpu_seconds() - begin_s);
}

// Runs at the lowest priority: on a shared machine, the frames of rank 0 come first.
void work(Shop& shop) {
  core::lower_priority_of_this_thread();
  for (;;) {
    MakeMessage make;
    {
      std::unique_lock lock(shop.mutex);
      shop.changed.wait(lock, [&] { return shop.is_closed || !shop.queue.empty(); });
      if (shop.is_closed) break;
      make = std::move(shop.queue.front());
      shop.queue.pop_front();
    }
    shop.send(answer_to(make, shop));
    const std::lock_guard lock(shop.mutex);
    shop.has_answered = true;
    shop.answered.notify_one();
  }
  const std::lock_guard lock(shop.mutex);
  --shop.threads;
  shop.changed.notify_all();
}

// The threads of a rank. Threads that hang are detached and outlive it.
class Threads {
 public:
  Threads(std::shared_ptr<Shop> shop, double patience_s)
      : shop_(std::move(shop)), patience_s_(patience_s) {}
  ~Threads() { close(); }

  core::Result<void> start(unsigned count) {
    while (threads_.size() < count) {
      {
        const std::lock_guard lock(shop_->mutex);
        ++shop_->threads;
      }
      auto thread = core::start_thread([shop = shop_] { work(*shop); });
      if (!thread) {
        const std::lock_guard lock(shop_->mutex);
        --shop_->threads;
        return core::fail(thread.error().code,
                          fmt::format("started only {} of {} modeler threads: {}", threads_.size(),
                                      count, thread.error().message));
      }
      threads_.push_back(std::move(*thread));
    }
    return {};
  }

  // Waits for the threads to finish their current meshes. Returns false if one hangs.
  bool close() {
    if (threads_.empty()) return true;
    bool all = true;
    {
      std::unique_lock lock(shop_->mutex);
      shop_->is_closed = true;
      shop_->changed.notify_all();
      const auto until =
          std::chrono::system_clock::now() + std::chrono::duration<double>(patience_s_);
      all = shop_->changed.wait_until(lock, until, [this] { return shop_->threads == 0; });
    }
    for (std::thread& thread : std::exchange(threads_, {}))
      all ? thread.join() : thread.detach();
    const std::lock_guard lock(shop_->sending);
    shop_->is_silent = true;
    return all;
  }

 private:
  std::shared_ptr<Shop> shop_;
  const double patience_s_;
  std::vector<std::thread> threads_;
};

// Wakes early after an answer: the next request usually follows soon.
void sleep(Shop& shop, Nap& nap) {
  std::unique_lock lock(shop.mutex);
  const auto until = std::chrono::system_clock::now() + nap.length();
  if (shop.answered.wait_until(lock, until, [&] { return shop.has_answered; })) nap.wake();
  shop.has_answered = false;
}

// Handles one message. Returns false once no more requests follow.
bool take(Parcel&& parcel, Shop& shop) {
  auto message = read_message(std::move(parcel.bytes));
  if (message && message->kind == MessageKind::kEnd) return false;
  if (message && message->kind == MessageKind::kMake) {
    const std::lock_guard lock(shop.mutex);
    shop.queue.push_back(std::move(message->make));
    shop.changed.notify_one();
  } else if (message && message->kind == MessageKind::kPing) {
    shop.send(pong_message(message->ticket, std::min(message->wanted_bytes, kMaxPong)));
  } else {
    ++shop.refused;
    shop.send(failed_message(0, RemoteMesh::Answer::kNone, "it received a damaged request"));
  }
  return true;
}

}  // namespace

core::Result<ServeReport> run_model_server(const models::Registry& registry, unsigned threads,
                                           Peers& peers, double patience_s) {
  const auto shop = std::make_shared<Shop>();
  shop->registry = &registry;
  shop->peers = &peers;
  Threads workers(shop, patience_s);
  if (auto ok = workers.start(threads); !ok) return tl::unexpected(ok.error());
  for (Nap nap(kLongestNap);;) {
    auto parcel = peers.receive();
    if (!parcel) {
      sleep(*shop, nap);
      continue;
    }
    nap.wake();
    if (!take(std::move(*parcel), *shop)) break;
  }
  const bool all = workers.close();
  peers.send(kFlyer, plain_message(MessageKind::kBye));
  return ServeReport{shop->made, shop->failed, shop->refused, !all};
}

}  // namespace psygen::cluster
