#include "ecs/system_order.hpp"

#include <algorithm>
#include <cstdint>
#include <unordered_map>

namespace psygen::ecs::detail {
namespace {

constexpr std::size_t kNone = SIZE_MAX;

bool is_placed(const PlacedSystem& system) {
  return !system.place.before.empty() || !system.place.after.empty();
}

// Visits every system after those that must run before it.
class Sorting {
 public:
  explicit Sorting(std::span<const PlacedSystem> systems)
      : systems_(systems), leaders_(systems.size()), state_(systems.size(), State::kNew) {}

  SystemOrder run() {
    if (find_names() && find_leaders()) {
      for (std::size_t i = 0; i < systems_.size(); ++i)
        if (!is_placed(systems_[i]) && !visit(i)) break;
      for (std::size_t i = 0; i < systems_.size() && result_.error.empty(); ++i)
        visit(i);
    }
    if (!result_.error.empty()) result_.order.clear();
    return std::move(result_);
  }

 private:
  enum class State : std::uint8_t { kNew, kUnderWay, kDone };

  bool find_names() {
    for (std::size_t i = 0; i < systems_.size(); ++i) {
      if (positions_.emplace(systems_[i].name, i).second) continue;
      result_.error = "two systems are called '" + systems_[i].name + "'";
      return false;
    }
    return true;
  }

  // Returns the position of a named system; kNone with an error if it is unknown.
  std::size_t find(const std::string& name, const PlacedSystem& asker, const char* side) {
    const auto found = positions_.find(name);
    if (found != positions_.end()) return found->second;
    result_.error = "the system '" + asker.name + "' should run " + side + " '" + name +
                    "', but there is no such system; there are";
    const char* separator = " ";
    for (const PlacedSystem& system : systems_) {
      result_.error += separator + ("'" + system.name + "'");
      separator = ", ";
    }
    return kNone;
  }

  bool find_leaders() {
    std::size_t last = kNone;
    for (std::size_t i = 0; i < systems_.size(); ++i) {
      const PlacedSystem& system = systems_[i];
      for (const std::string& name : system.place.after) {
        const std::size_t leader = find(name, system, "after");
        if (leader == kNone) return false;
        leaders_[i].push_back(leader);
      }
      for (const std::string& name : system.place.before) {
        const std::size_t follower = find(name, system, "before");
        if (follower == kNone) return false;
        leaders_[follower].push_back(i);
      }
      if (is_placed(system)) continue;
      if (last != kNone) leaders_[i].push_back(last);
      last = i;
    }
    for (std::vector<std::size_t>& leaders : leaders_)
      std::ranges::sort(leaders);
    return true;
  }

  bool visit(std::size_t system) {
    if (state_[system] == State::kDone) return true;
    path_.push_back(system);
    if (state_[system] == State::kUnderWay) return fail_with_cycle();
    state_[system] = State::kUnderWay;
    for (const std::size_t leader : leaders_[system])
      if (!visit(leader)) return false;
    path_.pop_back();
    state_[system] = State::kDone;
    result_.order.push_back(system);
    return visit_followers();
  }

  // Runs systems that waited only for the last one right after it.
  bool visit_followers() {
    for (std::size_t i = 0; i < systems_.size(); ++i) {
      const auto done = [this](std::size_t leader) { return state_[leader] == State::kDone; };
      if (systems_[i].place.after.empty() || state_[i] != State::kNew) continue;
      if (std::ranges::all_of(leaders_[i], done) && !visit(i)) return false;
    }
    return true;
  }

  bool fail_with_cycle() {
    const auto start = std::ranges::find(path_, path_.back());
    result_.error = "systems wait for each other: ";
    for (auto system = start; system != path_.end(); ++system) {
      if (system != start) result_.error += " after ";
      result_.error += "'" + systems_[*system].name + "'";
    }
    return false;
  }

  std::span<const PlacedSystem> systems_;
  std::unordered_map<std::string, std::size_t> positions_;
  std::vector<std::vector<std::size_t>> leaders_;  // systems that must run before each
  std::vector<State> state_;
  std::vector<std::size_t> path_;  // being visited, each a leader of the one before
  SystemOrder result_;
};

}  // namespace

SystemOrder order_systems(std::span<const PlacedSystem> systems) {
  return Sorting(systems).run();
}

}  // namespace psygen::ecs::detail
