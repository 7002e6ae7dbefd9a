#include "engine/synthesis/synthesis_manager.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <map>
#include <utility>

#include "engine/core/clock.hpp"
#include "engine/core/headroom.hpp"
#include "engine/core/log.hpp"
#include "engine/core/processors.hpp"

namespace psygen::synthesis {
namespace {
// Interval at which a blocked main thread runs the watchdog.
constexpr std::chrono::milliseconds kWatchdogPeriod{20};
// A waiting thread that makes meshes asks as often whether it should go on.
constexpr double kAskedSeconds = 0.02;
constexpr std::chrono::microseconds kExitPeriod{100};

// A virtual clock has one modeler, however many threads execute its requests: their number must
// change nothing.
constexpr unsigned kVirtualModelers = 1;
}  // namespace

unsigned modeler_count_for(unsigned requested) {
  if (requested > 0) return requested;
  return std::max(core::usable_processors(), 2u) - 1;
}

// A delegating constructor, so that an exception in it runs the destructor and no threads stay
// behind.
SynthesisManager::SynthesisManager(const models::Registry& registry,
                                   const SynthesisOptions& options)
    : SynthesisManager(registry, options,
                       modeler_count_for(options.modelers) +
                           (options.remote != nullptr ? options.remote->count() : 0)) {
  while (active_.size() < modeler_count_for(options.modelers)) {
    if (auto ok = start_modeler(); !ok) {
      shortage_ = ok.error().message;
      break;
    }
  }
  if (options.remote != nullptr && !virtual_) start_remote(*options.remote);
}

SynthesisManager::SynthesisManager(const models::Registry& registry,
                                   const SynthesisOptions& options, unsigned most)
    : workshop_(std::make_shared<Workshop>()),
      virtual_clock_(options.virtual_clock),
      watchdog_seconds_(options.watchdog_seconds),
      replacements_left_(options.max_replacements) {
  workshop_->registry = &registry;
  workshop_->clock = options.clock ? options.clock : core::monotonic_seconds;
  workshop_->hash_content = options.hash_content;
  workshop_->annotate = options.annotate;
  if (virtual_clock_) virtual_.emplace(kVirtualModelers);
  active_.reserve(most);
}

SynthesisManager::~SynthesisManager() {
  close_plan();
  workshop_->stop.store(true, std::memory_order_release);
  workshop_->board.wake(PlanQueue::Side::kLocal);
  workshop_->board.wake(PlanQueue::Side::kRemote);
  for (Worker& w : active_)
    leave(w);
  for (Worker& w : retired_)
    leave(w);
}

void SynthesisManager::leave(Worker& worker) {
  const RemoteSlot& place = worker.modeler->place();
  if (place.modelers != nullptr) {  // it no longer waits for an answer
    place.modelers->cancel(place.number, false);
    worker.thread.join();
    return;
  }
  while (!worker.modeler->exited()) {
    const bool hangs =
        watchdog_seconds_ > 0 && worker.modeler->is_older(workshop_->clock() - watchdog_seconds_);
    if (hangs || worker.modeler->is_given_up()) {
      worker.thread.detach();
      return;
    }
    std::this_thread::sleep_for(kExitPeriod);
  }
  worker.thread.join();
}

// Requires space for one more in active_.
core::Result<void> SynthesisManager::start_modeler(RemoteSlot place) {
  Worker worker;
  const auto side = place.modelers != nullptr ? PlanQueue::Side::kRemote : PlanQueue::Side::kLocal;
  worker.modeler =
      std::make_shared<Modeler>(next_number_, workshop_->board.add_reader(side), place);
  auto thread = core::start_thread(
      [workshop = workshop_, modeler = worker.modeler] { modeler->run(*workshop); });
  if (!thread) {
    workshop_->board.remove_reader(worker.modeler->reader());
    return tl::unexpected(thread.error());
  }
  worker.thread = std::move(*thread);
  ++next_number_;
  active_.push_back(std::move(worker));
  return {};
}

// If the system has fewer threads than slots, the other slots stay idle.
void SynthesisManager::start_remote(RemoteModelers& remote) {
  bool any = remote.count() == 0;
  for (unsigned place = 0; place < remote.count() && !any; ++place)
    any = remote.is_usable(place);
  if (!any) {
    core::log_warning(
        "no remote modeler is usable: their ranks were lost, or they have already served a "
        "session");
    return;
  }
  remote_ = &remote;
  for (unsigned place = 0; place < remote.count(); ++place) {
    if (auto ok = start_modeler({&remote, place}); !ok) {
      core::log_warning(fmt::format("using only {} of {} remote modelers: {}", place,
                                    remote.count(), ok.error().message));
      break;
    }
  }
}

unsigned SynthesisManager::local_count() const {
  return static_cast<unsigned>(
      std::ranges::count_if(active_, [](const Worker& w) { return !w.modeler->is_remote(); }));
}

bool SynthesisManager::is_offered_remotely(const Request& request) const {
  return remote_ != nullptr && !request.stays_here &&
         remote_->takes((*workshop_->registry)[request.key.model], request);
}

void SynthesisManager::publish(std::vector<Request>&& plan) {
  if (virtual_) {
    virtual_->publish(std::move(plan), virtual_clock_());
  } else {
    publish_to_threads(std::move(plan));
  }
}

void SynthesisManager::publish_to_threads(std::vector<Request>&& plan) {
  close_plan();
  published_ += plan.size();
  std::vector<std::uint32_t> offered;
  if (remote_count() > 0) {
    for (std::uint32_t i = 0; i < plan.size(); ++i) {
      if (is_offered_remotely(plan[i])) offered.push_back(i);
    }
  }
  workshop_->board.publish(std::move(plan), std::move(offered));
}

void SynthesisManager::execute_here(const Request& request) {
  here_.perform(*workshop_, request);
}

void SynthesisManager::close_plan() {
  const std::size_t before = unclaimed_.size();
  workshop_->board.close(unclaimed_);
  reclaimed_ += unclaimed_.size() - before;
}

std::vector<Request> SynthesisManager::reclaim() {
  if (virtual_) {
    std::vector<Request> unclaimed = virtual_->reclaim(virtual_clock_());
    drain();
    return unclaimed;
  }
  close_plan();
  drain();
  std::ranges::move(std::exchange(returned_, {}), std::back_inserter(unclaimed_));
  return std::exchange(unclaimed_, {});
}

std::size_t SynthesisManager::collect(std::vector<Completion>& out) {
  const std::size_t before = out.size();
  drain();
  std::ranges::move(std::exchange(arrived_, {}), std::back_inserter(out));
  return out.size() - before;
}

void SynthesisManager::drain() {
  if (virtual_) {
    execute_jobs(virtual_->take_finished(virtual_clock_()));
  } else {
    drain_threads(arrived_);
  }
}

void SynthesisManager::drain_threads(std::vector<Completion>& out) {
  run_watchdog();
  std::ranges::move(std::exchange(abandoned_, {}), std::back_inserter(out));
  here_.queue().drain(out);
  for (Worker& w : active_)
    w.modeler->queue().drain(out);
  drain_retired(out);
}

// Any thread may execute any request at any time. Completions come in the order of the virtual
// clock, after those of execute_here(), with that clock's durations. Returns false if no modeler
// was left for some requests; these have failed.
bool SynthesisManager::execute_jobs(const std::vector<VirtualModelers::Job>& jobs) {
  std::vector<Request> plan;
  std::map<Slot, std::size_t> order;
  for (const VirtualModelers::Job& job : jobs) {
    plan.push_back(job.request);
    order[job.request.handle.slot] = plan.size();
  }
  if (!plan.empty()) publish_to_threads(std::move(plan));
  const bool all = wait_for_threads();
  std::vector<Completion> done;
  drain_threads(done);
  if (!all) {
    close_plan();
    for (const Request& request : std::exchange(unclaimed_, {})) {
      done.push_back(completion_of(request, 0));
      done.back().error = "no modeler is left";
    }
  }
  const auto place = [&order](const Completion& c) {
    const auto found = order.find(c.handle.slot);
    return found == order.end() ? 0 : found->second;
  };
  std::ranges::stable_sort(done, {}, place);
  for (Completion& c : done) {
    c.started_s = c.finished_s = virtual_clock_();
    if (const std::size_t number = place(c); number > 0) {
      const VirtualModelers::Job& job = jobs[number - 1];
      c.modeler = job.modeler;
      c.started_s = job.started_s;
      c.finished_s = job.finished_s;
      c.predicted_seconds = job.request.cost.warm_s();
    }
    c.warmth = Warmth::kWarm;
    c.seconds = c.predicted_seconds;
  }
  std::ranges::move(done, std::back_inserter(arrived_));
  return all;
}

std::uint64_t SynthesisManager::outstanding() const {
  return virtual_ ? virtual_->outstanding() : outstanding_in_threads();
}

std::uint64_t SynthesisManager::outstanding_in_threads() const {
  std::uint64_t done = reclaimed_ + given_up_ + buried_finished_;
  for (const Worker& w : active_)
    done += w.modeler->finished();
  for (const Worker& w : retired_)
    done += w.modeler->finished();
  return published_ - done;
}

bool SynthesisManager::wait_all(const std::function<bool()>& go_on, bool helps) {
  if (!virtual_) return wait_for_threads(go_on, helps);
  return execute_jobs(virtual_->finish_all(virtual_clock_()));
}

bool SynthesisManager::wait_for_threads(const std::function<bool()>& go_on, bool helps) {
  workshop_->waiting.store(true, std::memory_order_seq_cst);
  helps = helps && remote_count() == 0;  // it would leave them nothing
  bool all = true;
  double asked_s = workshop_->clock();
  while (outstanding_in_threads() > 0 || publish_returned()) {
    if (local_count() == 0) {
      all = false;
      break;
    }
    helps = helps && make_next_here();
    const bool waited = !helps && await_finished();
    const double now_s = workshop_->clock();
    if (!waited && now_s < asked_s + kAskedSeconds) continue;
    if (!waited) run_watchdog();
    asked_s = now_s;
    if (go_on && !go_on()) {
      all = false;
      break;
    }
  }
  workshop_->waiting.store(false, std::memory_order_seq_cst);
  return all;
}

// Makes the next request in this thread. False if there is none, or if its type may run only in
// modelers: then it is published again, before the others.
bool SynthesisManager::make_next_here() {
  if (own_reader_ == nullptr) own_reader_ = workshop_->board.add_reader();
  Request request;
  std::uint64_t retries = 0;
  if (!workshop_->board.claim(*own_reader_, request, retries)) return false;
  ++reclaimed_;  // from the modelers
  if ((*workshop_->registry)[request.key.model].may_run_on_main_thread()) {
    execute_here(request);
    return true;
  }
  std::vector<Request> earlier = std::exchange(unclaimed_, {});  // of earlier plans
  close_plan();
  std::vector<Request> plan{std::move(request)};
  std::ranges::move(std::exchange(unclaimed_, std::move(earlier)), std::back_inserter(plan));
  publish_to_threads(std::move(plan));
  return false;
}

// Waits briefly until the modelers find no more work. Returns false if all was finished before.
bool SynthesisManager::await_finished() {
  {
    // A modeler that finds no more work notifies under the lock, so no notification is lost between
    // the check and the wait.
    std::unique_lock lock(workshop_->mutex);
    if (outstanding_in_threads() == 0) return false;
    workshop_->finished.wait_until(lock, std::chrono::system_clock::now() + kWatchdogPeriod);
  }
  run_watchdog();
  return true;
}

std::vector<Request> SynthesisManager::quiesce() {
  if (virtual_) {
    wait_all();
    return {};
  }
  workshop_->waiting.store(true, std::memory_order_seq_cst);
  while (outstanding_in_threads() > 0 && !active_.empty())
    await_finished();
  workshop_->waiting.store(false, std::memory_order_seq_cst);
  return std::exchange(returned_, {});
}

ModelerStats SynthesisManager::stats_of(const Modeler& modeler) {
  const ModelerCounters& c = modeler.counters();
  return {modeler.number(),
          c.models.load(std::memory_order_relaxed),
          c.failed.load(std::memory_order_relaxed),
          c.triangles.load(std::memory_order_relaxed),
          c.bytes.load(std::memory_order_relaxed),
          c.cpu_seconds.load(std::memory_order_relaxed),
          c.busy_seconds.load(std::memory_order_relaxed),
          c.locks.load(std::memory_order_relaxed),
          c.retries.load(std::memory_order_relaxed),
          modeler.is_remote()};
}

SynthesisStats SynthesisManager::stats() const {
  SynthesisStats s;
  s.published = published_;
  s.reclaimed = reclaimed_;
  s.given_up = given_up_;
  s.modelers = buried_;
  if (here_.finished() > 0) s.modelers.push_back(stats_of(here_));
  for (const Worker& w : active_)
    s.modelers.push_back(stats_of(*w.modeler));
  for (const Worker& w : retired_)
    s.modelers.push_back(stats_of(*w.modeler));
  std::sort(s.modelers.begin(), s.modelers.end(),
            [](const ModelerStats& a, const ModelerStats& b) { return a.modeler < b.modeler; });
  for (const ModelerStats& m : s.modelers) {
    s.models += m.models;
    s.failed += m.failed;
    s.triangles += m.triangles;
    s.bytes += m.bytes;
    s.cpu_seconds += m.cpu_seconds;
  }
  return s;
}

}  // namespace psygen::synthesis
