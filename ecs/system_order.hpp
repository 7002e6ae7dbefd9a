// The order of systems: systems without constraints run in the order of add(), others before and
// after the systems that they name. Not a scheduler: accesses decide which systems run at the same
// time (schedule.hpp). Pure functions.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace psygen::ecs {

// Constraints on a system's position, by names of other systems. Without names: after every system
// that was added before it without constraints. With `after`: as soon as those have run. With
// `before` alone: as late as possible. Systems with equal constraints run in the order of add().
struct Place {
  std::vector<std::string> before = {};
  std::vector<std::string> after = {};
};
// Makes a constraint: right before or right after one system.
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
  std::vector<std::size_t> order;  // indices into the argument; empty after an error
  std::string error;               // empty, or a message that names the systems
};

// Errors: two systems of one name, an unknown name, a cycle. O(systems²).
SystemOrder order_systems(std::span<const PlacedSystem> systems);

}  // namespace detail
}  // namespace psygen::ecs
