// A communicator whose ranks are threads of one process, without MPI.
#pragma once

#include <atomic>
#include <barrier>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "engine/cluster/peers.hpp"

namespace psygen::cluster {

class ThreadsAsRanks {
 public:
  explicit ThreadsAsRanks(unsigned count)
      : texts_(count), boxes_(count), barrier_(static_cast<std::ptrdiff_t>(count)) {}

  // Called with a message before it leaves its rank, from several threads; may change the message.
  std::function<void(unsigned from, Bytes&)> on_send;

  // Calls `rank` once for each rank, all at the same time.
  void run(const std::function<void(Peers&)>& rank) {
    std::vector<std::jthread> threads;
    for (unsigned i = 0; i < texts_.size(); ++i)
      threads.emplace_back([this, i, &rank] {
        One peers(*this, i);
        rank(peers);
      });
  }

 private:
  class One final : public Peers {
   public:
    One(ThreadsAsRanks& all, unsigned rank) : all_(all), rank_(rank) {}
    unsigned rank() const override { return rank_; }
    unsigned count() const override { return static_cast<unsigned>(all_.texts_.size()); }
    unsigned count_here() const override { return count(); }
    std::string host() const override { return "host" + std::to_string(rank_); }
    std::vector<std::string> exchange(const std::string& mine) override {
      ++messages_;
      all_.texts_[rank_] = mine;
      all_.barrier_.arrive_and_wait();
      std::vector<std::string> texts = all_.texts_;
      all_.barrier_.arrive_and_wait();
      return texts;
    }
    std::uint64_t claim() override {
      ++messages_;
      return all_.claimed_.fetch_add(1);
    }
    void progress() override {}
    void send(unsigned rank, Bytes bytes) override {
      ++messages_;
      if (all_.on_send) all_.on_send(rank_, bytes);
      Box& box = all_.boxes_[rank];
      const std::lock_guard lock(box.mutex);
      box.parcels.push_back({rank_, std::move(bytes)});
    }
    std::optional<Parcel> receive() override {
      Box& box = all_.boxes_[rank_];
      const std::lock_guard lock(box.mutex);
      if (box.parcels.empty()) return std::nullopt;
      Parcel parcel = std::move(box.parcels.front());
      box.parcels.pop_front();
      return parcel;
    }
    std::uint64_t messages() const override { return messages_; }
    void finish() override {}
    void abort() override {}

   private:
    ThreadsAsRanks& all_;
    unsigned rank_;
    std::atomic<std::uint64_t> messages_{0};
  };

  struct Box {
    std::mutex mutex;
    std::deque<Parcel> parcels;
  };

  std::vector<std::string> texts_;
  std::vector<Box> boxes_;
  std::barrier<> barrier_;
  std::atomic<std::uint64_t> claimed_{0};
};

}  // namespace psygen::cluster
