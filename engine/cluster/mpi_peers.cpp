// Communicator over MPI. Only this file includes MPI; it forms a library (libpsygen_mpi), so that
// psygen runs without MPI. MPI errors end the job, as MPI does by default.
#include <fmt/format.h>
#include <mpi.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <mutex>
#include <thread>

#include "engine/cluster/incoming_messages.hpp"
#include "engine/cluster/peers.hpp"

namespace psygen::cluster {
namespace {

class MpiPeers final : public Peers {
 public:
  MpiPeers() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &count_);
    MPI_Comm here = MPI_COMM_NULL;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
    MPI_Comm_size(here, &count_here_);
    MPI_Comm_free(&here);
    std::uint64_t* counter = nullptr;
    const MPI_Aint bytes = rank_ == 0 ? sizeof(std::uint64_t) : 0;
    MPI_Win_allocate(bytes, sizeof(std::uint64_t), MPI_INFO_NULL, MPI_COMM_WORLD, &counter,
                     &window_);
    MPI_Win_lock_all(MPI_MODE_NOCHECK, window_);
    if (rank_ == 0) {
      *counter = 0;
      MPI_Win_sync(window_);
    }
    MPI_Barrier(MPI_COMM_WORLD);
  }

  unsigned rank() const override { return static_cast<unsigned>(rank_); }
  unsigned count() const override { return static_cast<unsigned>(count_); }
  unsigned count_here() const override { return static_cast<unsigned>(count_here_); }

  std::string host() const override {
    char name[MPI_MAX_PROCESSOR_NAME] = "";
    int length = 0;
    MPI_Get_processor_name(name, &length);
    return {name, static_cast<std::size_t>(length)};
  }

  std::vector<std::string> exchange(const std::string& mine) override {
    const std::lock_guard lock(mutex_);
    messages_.fetch_add(2, std::memory_order_relaxed);
    const auto ranks = static_cast<std::size_t>(count_);
    const int bytes = static_cast<int>(mine.size());
    std::vector<int> lengths(ranks), begins(ranks);
    MPI_Allgather(&bytes, 1, MPI_INT, lengths.data(), 1, MPI_INT, MPI_COMM_WORLD);
    int total = 0;
    for (std::size_t i = 0; i < ranks; ++i) {
      begins[i] = total;
      total += lengths[i];
    }
    std::string all(static_cast<std::size_t>(total), '\0');
    MPI_Allgatherv(mine.data(), bytes, MPI_CHAR, all.data(), lengths.data(), begins.data(),
                   MPI_CHAR, MPI_COMM_WORLD);
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < ranks; ++i)
      texts.push_back(
          all.substr(static_cast<std::size_t>(begins[i]), static_cast<std::size_t>(lengths[i])));
    return texts;
  }

  std::uint64_t claim() override {
    const std::lock_guard lock(mutex_);
    messages_.fetch_add(1, std::memory_order_relaxed);
    const std::uint64_t one = 1;
    std::uint64_t before = 0;
    MPI_Fetch_and_op(&one, &before, MPI_UINT64_T, 0, 0, MPI_SUM, window_);
    MPI_Win_flush(0, window_);
    return before;
  }

  void progress() override {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) return;  // the owner of the lock makes progress too
    int arrived = 0;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &arrived, MPI_STATUS_IGNORE);
  }

  // Small messages leave at once. A large one waits until the receiver polls; other threads may
  // call in the meantime.
  void send(unsigned rank, Bytes bytes) override {
    messages_.fetch_add(1, std::memory_order_relaxed);
    MPI_Request request = MPI_REQUEST_NULL;
    int is_sent = 0;
    for (Nap nap; is_sent == 0; nap.sleep()) {
      const std::lock_guard lock(mutex_);
      if (request == MPI_REQUEST_NULL)
        MPI_Isend(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, static_cast<int>(rank),
                  kParcel, MPI_COMM_WORLD, &request);
      MPI_Test(&request, &is_sent, MPI_STATUS_IGNORE);
      if (is_sent != 0) return;
    }
  }

  std::optional<Parcel> receive() override {
    for (int look = 0; look < kLooks; ++look) {
      {
        const std::lock_guard lock(mutex_);
        begin_to_receive();
        if (auto parcel = coming_.take_whole(is_whole)) return parcel;
        if (!coming_.any_since(std::chrono::steady_clock::now() - kComesSoon)) break;
      }
      std::this_thread::yield();
    }
    return std::nullopt;
  }

  std::uint64_t messages() const override { return messages_.load(std::memory_order_relaxed); }

  void finish() override {
    MPI_Win_unlock_all(window_);
    MPI_Win_free(&window_);
    MPI_Finalize();
  }

  void abort() override { MPI_Abort(MPI_COMM_WORLD, 1); }

 private:
  static constexpr int kParcel = 1;  // tag
  // About 100 µs: messages through shared memory arrive within this time.
  static constexpr int kLooks = 100;
  // A transfer that takes longer is polled with pauses: its rank may have stopped.
  static constexpr std::chrono::milliseconds kComesSoon{5};

  void begin_to_receive() {
    int is_there = 0;
    MPI_Message message = MPI_MESSAGE_NULL;
    MPI_Status status;
    MPI_Improbe(MPI_ANY_SOURCE, kParcel, MPI_COMM_WORLD, &is_there, &message, &status);
    if (is_there == 0) return;
    int bytes = 0;
    MPI_Get_count(&status, MPI_BYTE, &bytes);
    auto& coming =
        coming_.begin(static_cast<unsigned>(status.MPI_SOURCE), static_cast<std::size_t>(bytes));
    MPI_Imrecv(coming.parcel.bytes.data(), bytes, MPI_BYTE, &message, &coming.request);
  }

  static bool is_whole(MPI_Request& request) {
    int is = 0;
    MPI_Test(&request, &is, MPI_STATUS_IGNORE);
    return is != 0;
  }

  IncomingMessages<MPI_Request> coming_;
  int rank_ = 0, count_ = 1, count_here_ = 1;
  MPI_Win window_ = MPI_WIN_NULL;
  std::mutex mutex_;  // MPI_THREAD_SERIALIZED
  std::atomic<std::uint64_t> messages_{0};
};

}  // namespace
}  // namespace psygen::cluster

extern "C" __attribute__((visibility("default"))) psygen::cluster::Peers* psygen_join_mpi(
    std::string& error) {
  int provided = MPI_THREAD_SINGLE;
  if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided) != MPI_SUCCESS) {
    error = "MPI cannot be started";
    return nullptr;
  }
  if (provided < MPI_THREAD_SERIALIZED) {
    error = fmt::format("this MPI lets only one thread call it (MPI_THREAD_SERIALIZED is needed)");
    return nullptr;
  }
  return new psygen::cluster::MpiPeers();
}
