// Fixtures of the ecs benchmarks: components of a typical moving object, the same layout as
// hand-written arrays, and shuffled orders. Every benchmark has a counterpart on the arrays, the
// floor.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "ecs/ecs.hpp"

namespace psygen::ecs::bench {

// Entities per benchmark.
inline constexpr std::size_t kEntities = 1'000'000;

// The columns of the moving object; Mesh is tracked.
struct Position {
  float x, y, z;
};
struct Velocity {
  float x, y, z;
};
struct Mass {
  float kilograms;
};
struct Mesh {
  std::uint64_t id;
  std::uint32_t state;
};

// The same component, sparse and in tables.
struct Selected {
  std::uint32_t since;
};
struct Moved {
  std::uint32_t since;
};
// A component whose value snapshots store.
struct Described {
  float health;
  std::uint32_t kind;
  double age_s;
};

// The numbers 0 to count - 1 in a random order that `seed` fixes.
inline std::vector<std::uint32_t> shuffled(std::size_t count, std::uint32_t seed) {
  std::vector<std::uint32_t> order(count);
  for (std::size_t i = 0; i < count; ++i)
    order[i] = static_cast<std::uint32_t>(i);
  std::ranges::shuffle(order, std::mt19937(seed));
  return order;
}

// Returns a copy of the values in the order of shuffled().
template <class T>
std::vector<T> permuted(std::span<const T> values, std::uint32_t seed) {
  std::vector<T> result;
  result.reserve(values.size());
  for (const std::uint32_t i : shuffled(values.size(), seed))
    result.push_back(values[i]);
  return result;
}

}  // namespace psygen::ecs::bench

template <>
struct psygen::ecs::ComponentTraits<psygen::ecs::bench::Mesh> {
  static constexpr std::string_view name = "mesh";
  static constexpr bool tracked = true;
};
template <>
struct psygen::ecs::ComponentTraits<psygen::ecs::bench::Selected> {
  static constexpr bool sparse = true;
};
template <>
struct psygen::ecs::ComponentTraits<psygen::ecs::bench::Described> {
  using C = psygen::ecs::bench::Described;
  static constexpr std::string_view name = "described";
  static constexpr auto fields = std::tuple{field("health", &C::health), field("kind", &C::kind),
                                            field("age", &C::age_s, {.unit = "s"})};
};
