// Component types that the tests of ecs share: plain, tracked, sparse, empty, over-aligned,
// move-only and throwing ones; and copies of entities. Not thread-safe: Throwing counts in plain
// static members.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include "ecs/ecs.hpp"

namespace psygen::ecs::test {

// Limits of worlds in tests that make thousands: the default ones. QEMU never frees its tables of
// reserved pages, so they are small in builds for other processors.
#ifdef PSYGEN_SMALL_WORLDS
constexpr WorldLimits kTestLimits{.max_entities = 1 << 16, .max_rows_per_table = 1 << 16};
#else
constexpr WorldLimits kTestLimits{};
#endif

// Plain values in columns.
struct Position {
  float x = 0, y = 0, z = 0;
};
struct Velocity {
  float x = 0, y = 0, z = 0;
};
// Tracked. New rows must carry the default, which is not zero.
struct Health {
  std::int32_t points = 100;
};
// Tracked, with an explicit name.
struct Mesh {
  std::uint64_t id = 0;
};
// Without a value, kept in tables.
struct Hidden {};
// At the largest alignment that a component may have.
struct alignas(64) Aligned {
  std::uint8_t byte = 0;
};
// Move-only.
struct Owner {
  std::unique_ptr<int> value;
};

// Sparse, without a value.
struct Selected {};
// Sparse and tracked, with a value.
struct Edited {
  std::uint32_t version = 1;
};

// Counts its living objects. The constructor call after `fuse` further ones throws
// std::runtime_error.
struct Throwing {
  // Throws once `fuse` reaches 0; moving never throws.
  Throwing() {
    if (fuse >= 0 && fuse-- == 0) throw std::runtime_error("fuse");
    ++alive;
  }
  Throwing(Throwing&& other) noexcept : value(other.value) { ++alive; }
  Throwing& operator=(Throwing&& other) noexcept = default;
  ~Throwing() { --alive; }
  int value = 7;
  // Living objects, and constructor calls left before one throws; -1 never throws.
  static inline int alive = 0;
  static inline int fuse = -1;
};

// Sparse.
struct Fused : Throwing {};
// Two types with the same name.
struct Twin {};
struct OtherTwin {};

// Copies entities, because the world's own spans end with its next change.
inline std::vector<Entity> copy(std::span<const Entity> entities) {
  return {entities.begin(), entities.end()};
}

}  // namespace psygen::ecs::test

template <>
struct psygen::ecs::ComponentTraits<psygen::ecs::test::Mesh> {
  static constexpr std::string_view name = "mesh";
  static constexpr bool tracked = true;
};
template <>
struct psygen::ecs::ComponentTraits<psygen::ecs::test::Health> {
  static constexpr bool tracked = true;
};
template <>
struct psygen::ecs::ComponentTraits<psygen::ecs::test::Selected> {
  static constexpr bool sparse = true;
};
template <>
struct psygen::ecs::ComponentTraits<psygen::ecs::test::Edited> {
  static constexpr std::string_view name = "edited";
  static constexpr bool sparse = true;
  static constexpr bool tracked = true;
  static constexpr auto fields = std::tuple{field("version", &psygen::ecs::test::Edited::version)};
};
template <>
struct psygen::ecs::ComponentTraits<psygen::ecs::test::Fused> {
  static constexpr bool sparse = true;
};
template <>
struct psygen::ecs::ComponentTraits<psygen::ecs::test::Twin> {
  static constexpr std::string_view name = "twin";
};
template <>
struct psygen::ecs::ComponentTraits<psygen::ecs::test::OtherTwin> {
  static constexpr std::string_view name = "twin";
};
