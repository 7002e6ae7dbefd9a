#include "ecs/schedule.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "ecs/check.hpp"

namespace psygen::ecs {
namespace {

bool touches_world(const SystemInfo& s) {
  return s.world != WorldAccess::kNone || std::ranges::any_of(s.accesses, &Access::is_component);
}
bool writes_world(const SystemInfo& s) {
  const auto writes = [](const Access& a) { return a.is_component && a.writes; };
  return s.world == WorldAccess::kWrites || std::ranges::any_of(s.accesses, writes);
}

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Refuses a system whose parameters name a resource twice: one of the two would be superfluous, or
// would write a resource that the other takes as constant. Readers are no resources: a system may
// read a queue and emit into it.
void expect_each_once(const SystemInfo& system) {
  const auto source = [](const Access& access) {
    return access.bundle.empty() ? std::string("by itself") : "in " + access.bundle;
  };
  const std::vector<Access>& all = system.accesses;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (all[i].type != all[k].type || all[i].is_component) continue;
      if (all[i].is_reader != all[k].is_reader) continue;
      throw detail::Refusal{"the system '" + system.name + "' takes " + all[i].name + " twice, " +
                            source(all[k]) + " and " + source(all[i])};
    }
  }
}

}  // namespace

std::string detail::without_namespace(std::string_view name) {
  const std::size_t arguments = name.find('<');
  const std::size_t colon = name.substr(0, arguments).rfind("::");
  return std::string(colon == std::string_view::npos ? name : name.substr(colon + 2));
}

bool conflict(const SystemInfo& a, const SystemInfo& b) {
  if (a.world == WorldAccess::kWrites && touches_world(b)) return true;
  if (b.world == WorldAccess::kWrites && touches_world(a)) return true;
  if (a.world == WorldAccess::kReads && writes_world(b)) return true;
  if (b.world == WorldAccess::kReads && writes_world(a)) return true;
  for (const Access& x : a.accesses) {
    for (const Access& y : b.accesses) {
      if (x.type == y.type && (x.writes || y.writes)) return true;
    }
  }
  return false;
}

// The order as a graph, and the threads that walk it. Every system is a step. A system that records
// commands has a second step, which applies them and has the world to itself.
struct Schedule::Parts {
  struct Resource {
    const void* type;
    void* object;
  };
  struct Step {
    std::size_t system;
    bool applies_commands;
    std::vector<std::size_t> followers;  // steps that must wait for this one
    std::size_t leader_count = 0;
    std::size_t leaders_left = 0;
  };

  World& world;
  std::vector<Resource> resources;
  std::vector<std::shared_ptr<void>> owned;  // resources of emplace(); they outlive the systems
  std::vector<System> systems;
  std::vector<SystemInfo> infos;
  std::vector<Step> steps;
  bool arranged = true;
  std::string refused;  // the first mistake of add() and provide()
  WorkCounter work_counter = nullptr;

  std::mutex mutex;
  std::condition_variable changed;
  std::vector<std::size_t> ready;  // steps that may run now
  std::size_t unfinished = 0;
  bool stopping = false;
  bool running = false;
  std::exception_ptr exception;  // of this run; no further step starts
  std::string threw;
  std::vector<std::thread> workers;

  explicit Parts(World& w) : world(w) {}
  ~Parts() {
    {
      const std::lock_guard lock(mutex);
      stopping = true;
    }
    changed.notify_all();
    for (std::thread& worker : workers)
      worker.join();
  }

  void expect_idle(std::string_view verb) const {
    if (running) detail::give_up("schedule: " + std::string(verb) + " from inside a system");
  }

  // Sorts the systems into this order and makes their steps.
  void reorder(std::span<const std::size_t> order) {
    std::vector<System> sorted;
    std::vector<SystemInfo> sorted_infos;
    for (const std::size_t i : order) {
      sorted.push_back(std::move(systems[i]));
      sorted_infos.push_back(std::move(infos[i]));
    }
    systems = std::move(sorted);
    infos = std::move(sorted_infos);
    steps.clear();
    for (std::size_t i = 0; i < systems.size(); ++i) {
      add_step(i, false);
      if (systems[i].info.records_commands) add_step(i, true);
    }
    arranged = true;
  }

  void add_step(std::size_t system, bool applies_commands) {
    const std::size_t index = steps.size();
    steps.push_back({system, applies_commands, {}, 0, 0});
    for (std::size_t before = 0; before < index; ++before) {
      if (!must_wait(steps[before], steps[index])) continue;
      steps[before].followers.push_back(index);
      ++steps[index].leader_count;
    }
  }
  bool must_wait(const Step& first, const Step& then) const {
    if (first.system == then.system) return true;
    return conflict(access_of(first), access_of(then));
  }
  SystemInfo access_of(const Step& step) const {
    if (!step.applies_commands) return infos[step.system];
    SystemInfo all;
    all.world = WorldAccess::kWrites;
    return all;
  }

  std::uint64_t read_work() const { return work_counter != nullptr ? work_counter() : 0; }

  // An exception also ends the step.
  void run_step(std::size_t index) {
    try {
      try_step(index);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (exception == nullptr) {
        exception = std::current_exception();
        threw = infos[steps[index].system].name;
      }
    }
  }
  void try_step(std::size_t index) {
    System& system = systems[steps[index].system];
    SystemInfo& info = infos[steps[index].system];
    const double start_s = now_s();
    const std::uint64_t start_work = read_work();
    if (steps[index].applies_commands) {
      system.commands->apply(world);
      info.last_seconds += now_s() - start_s;
      info.last_work += read_work() - start_work;
    } else {
      system.runner->run();
      info.last_start_s = start_s;
      info.last_seconds = now_s() - start_s;
      info.last_work = read_work() - start_work;
    }
  }

  // Returns the first ready step that this thread may run; steps.size() if there is none.
  std::size_t take(bool calling_thread) {
    std::size_t best = steps.size();
    for (const std::size_t step : ready) {
      const bool allowed =
          calling_thread || infos[steps[step].system].runs_on == RunsOn::kAnyThread;
      if (allowed) best = std::min(best, step);
    }
    std::erase(ready, best);
    return best;
  }

  // Runs steps until `done`; the lock is held before and after.
  template <class Done>
  void work(std::unique_lock<std::mutex>& lock, bool calling_thread, Done done) {
    while (!done()) {
      const std::size_t step = take(calling_thread);
      if (step == steps.size()) {
        changed.wait(lock);
        continue;
      }
      if (exception == nullptr) {
        lock.unlock();
        run_step(step);
        lock.lock();
      }
      --unfinished;
      for (const std::size_t follower : steps[step].followers) {
        if (--steps[follower].leaders_left == 0) ready.push_back(follower);
      }
      changed.notify_all();
    }
  }
};

Schedule::Schedule(World& world, std::size_t threads)
    : world_(world), parts_(std::make_unique<Parts>(world)) {
  constexpr std::size_t kMaxThreads = 64;
  const std::size_t wanted = std::clamp<std::size_t>(threads, 1, kMaxThreads) - 1;
  parts_->workers.reserve(wanted);
  try {
    while (parts_->workers.size() < wanted) {
      parts_->workers.emplace_back([parts = parts_.get()] {
        std::unique_lock lock(parts->mutex);
        parts->work(lock, false, [parts] { return parts->stopping; });
      });
    }
  } catch (const std::exception&) {  // the operating system grants no more threads: run on these
  }
}

Schedule::~Schedule() = default;

std::span<const SystemInfo> Schedule::systems() const {
  return parts_->infos;
}

std::size_t Schedule::threads() const {
  return parts_->workers.size() + 1;
}

void Schedule::provide_one(const void* type, std::string label, void* resource) {
  parts_->expect_idle("provide");
  for (const Parts::Resource& known : parts_->resources) {
    if (known.type == type) return refuse("a second " + label + " is provided");
  }
  parts_->resources.push_back({type, resource});
}

void* Schedule::resource(const System& asker, const void* type, const std::string& label) const {
  for (const Parts::Resource& known : parts_->resources) {
    if (known.type == type) return known.object;
  }
  throw detail::Refusal{"the system '" + asker.info.name + "' wants a " + label +
                        ", which was not provided before it"};
}

void Schedule::refuse(std::string sentence) {
  if (parts_->refused.empty()) parts_->refused = std::move(sentence);
}

void Schedule::own(std::shared_ptr<void> resource) {
  parts_->owned.push_back(std::move(resource));
}

void Schedule::append(System system) {
  parts_->expect_idle("add");
  expect_each_once(system.info);
  parts_->infos.push_back(system.info);
  parts_->systems.push_back(std::move(system));
  parts_->arranged = false;
}

std::string Schedule::arrange() {
  parts_->expect_idle("arrange");
  if (!parts_->refused.empty()) return parts_->refused;
  if (parts_->arranged) return {};
  std::vector<detail::PlacedSystem> placed;
  for (const System& system : parts_->systems)
    placed.push_back({system.info.name, system.place});
  detail::SystemOrder sorted = detail::order_systems(placed);
  if (!sorted.error.empty()) return std::move(sorted.error);
  const std::lock_guard lock(parts_->mutex);
  parts_->reorder(sorted.order);
  return {};
}

void Schedule::run() {
  parts_->expect_idle("run");
  if (const std::string error = arrange(); !error.empty()) detail::give_up("schedule: " + error);
  parts_->running = true;
  parts_->threw.clear();
  if (parts_->workers.empty()) {
    for (std::size_t i = 0; i < parts_->steps.size() && parts_->exception == nullptr; ++i)
      parts_->run_step(i);
  } else {
    run_on_threads();
  }
  parts_->running = false;
  if (parts_->exception == nullptr) return;
  for (System& system : parts_->systems)
    if (system.commands != nullptr) *system.commands = Commands();
  std::rethrow_exception(std::exchange(parts_->exception, nullptr));
}

void Schedule::count_work(WorkCounter read) {
  parts_->expect_idle("count_work");
  parts_->work_counter = read;
}

const std::string& Schedule::threw() const {
  return parts_->threw;
}

void Schedule::run_on_threads() {
  std::unique_lock lock(parts_->mutex);
  parts_->unfinished = parts_->steps.size();
  for (std::size_t i = 0; i < parts_->steps.size(); ++i) {
    Parts::Step& step = parts_->steps[i];
    step.leaders_left = step.leader_count;
    if (step.leader_count == 0) parts_->ready.push_back(i);
  }
  parts_->changed.notify_all();
  parts_->work(lock, true, [this] { return parts_->unfinished == 0; });
}

}  // namespace psygen::ecs
