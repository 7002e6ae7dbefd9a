// The order of systems: those without a place run in the order in which they were added, the others
// before and after systems that they name. Not a scheduler: what runs at the same time is decided
// by accesses (schedule.hpp). Pure functions.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace psygen::ecs {

// Where a system runs, by the names of others. Without any name: after every system that was added
// before it without a place. With `after`: as soon as those have run. With `before` alone: as late
// as possible. Systems with the same place run in the order in which they were added.
struct Place {
  std::vector<std::string> before = {};
  std::vector<std::string> after = {};
};
// A place right before or right after one system.
inline Place before(std::string system) {
  return {.before = {std::move(system)}};
}
inline Place after(std::string system) {
  return {.after = {std::move(system)}};
}

namespace detail {

struct PlacedSystem {
  std::string name;
  Place place;
};
struct SystemOrder {
  std::vector<std::size_t> order;  // positions in what was given; empty with an error
  std::string error;               // empty, or a sentence that names the systems
};

// Errors: two systems of one name, a name that there is not, a cycle. O(systems²).
SystemOrder order_systems(std::span<const PlacedSystem> systems);

}  // namespace detail
}  // namespace psygen::ecs
