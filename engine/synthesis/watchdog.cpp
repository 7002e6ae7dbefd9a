// The manager's watchdog: handles requests that never end, modelers that hang on them, and requests
// that remote modelers return without a mesh.
#include <fmt/format.h>

#include <iterator>
#include <utility>

#include "engine/core/log.hpp"
#include "engine/synthesis/synthesis_manager.hpp"

namespace psygen::synthesis {

void SynthesisManager::run_watchdog() {
  take_returned();
  const double now = workshop_->clock();
  for (std::size_t i = 0; i < active_.size();) {
    const Worker& worker = active_[i];
    const bool gone =
        worker.modeler->is_remote() ? give_up_remote(worker, now) : give_up_local(worker, now);
    if (!gone) {
      ++i;
      continue;
    }
    const bool replaced = !worker.modeler->is_remote() && replacements_left_ > 0;
    retired_.push_back(std::move(active_[i]));
    active_.erase(active_.begin() + static_cast<std::ptrdiff_t>(i));
    if (!replaced) continue;
    if (auto ok = start_modeler(); !ok) {
      core::log_warning(fmt::format("cannot replace the hung modeler: {}", ok.error().message));
    } else {
      --replacements_left_;
    }
  }
}

bool SynthesisManager::give_up_local(const Worker& worker, double now_s) {
  Completion c;
  if (watchdog_seconds_ <= 0 ||
      !worker.modeler->give_up_if_older(now_s - watchdog_seconds_, now_s, c))
    return false;
  c.error = fmt::format("{} {}", (*workshop_->registry)[c.key.model].name(), c.error);
  core::log_warning(fmt::format("modeler {} hangs: {}", c.modeler, c.error));
  hung_.push_back({c.handle, c.key, c.owner, c.modeler, c.started_s});
  abandoned_.push_back(std::move(c));
  ++given_up_;
  return true;
}

// Returns its request to be made here. Returns true also for modelers that left by themselves.
bool SynthesisManager::give_up_remote(const Worker& worker, double now_s) {
  Completion c;
  if (watchdog_seconds_ <= 0 ||
      !worker.modeler->give_up_if_older(now_s - watchdog_seconds_, now_s, c))
    return worker.modeler->exited();
  returned_.push_back(worker.modeler->abandoned());
  returned_.back().stays_here = true;
  ++reclaimed_;
  worker.modeler->place().modelers->cancel(worker.modeler->place().number, true);
  workshop_->board.wake(PlanQueue::Side::kRemote);  // other slots of its rank may be lost
  core::log_warning(fmt::format("remote modeler {} does not respond: {} {}, made here instead",
                                c.modeler, (*workshop_->registry)[c.key.model].name(), c.error));
  return true;
}

void SynthesisManager::take_returned() {
  if (!workshop_->has_returned.load(std::memory_order_acquire)) return;
  const std::lock_guard lock(workshop_->mutex);
  workshop_->has_returned.store(false, std::memory_order_relaxed);
  reclaimed_ += workshop_->returned.size();
  for (Request& request : std::exchange(workshop_->returned, {})) {
    request.stays_here = true;
    returned_.push_back(std::move(request));
  }
  workshop_->board.wake(PlanQueue::Side::kRemote);
}

// Publishes requests that remote modelers have returned again, for local modelers. Returns false if
// there are none.
bool SynthesisManager::publish_returned() {
  take_returned();
  if (returned_.empty()) return false;
  close_plan();
  published_ += returned_.size();
  workshop_->board.publish(std::exchange(returned_, {}));
  return true;
}

// Hung modelers may have earlier completions; those that returned are joined and counted.
void SynthesisManager::drain_retired(std::vector<Completion>& out) {
  std::erase_if(retired_, [&](Worker& w) {
    const bool exited = w.modeler->exited();  // read first: nothing is queued after it
    w.modeler->queue().drain(out);
    if (!exited) return false;
    w.thread.join();
    workshop_->board.remove_reader(w.modeler->reader());
    buried_.push_back(stats_of(*w.modeler));
    buried_finished_ += w.modeler->finished();
    std::erase_if(hung_, [&](const HungRequest& h) { return h.modeler == w.modeler->number(); });
    return true;
  });
}

}  // namespace psygen::synthesis
