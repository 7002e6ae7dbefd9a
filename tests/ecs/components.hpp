// Component types that the tests of ecs share.
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>

#include "ecs/ecs.hpp"

namespace psygen::ecs::test {

struct Position {
  float x = 0, y = 0, z = 0;
};
struct Velocity {
  float x = 0, y = 0, z = 0;
};
struct Health {
  std::int32_t points = 100;  // not zero: new rows must carry it
};
struct Mesh {
  std::uint64_t id = 0;
};
struct Hidden {};
struct alignas(64) Aligned {
  std::uint8_t byte = 0;
};
struct Owner {  // move-only
  std::unique_ptr<int> value;
};

struct Selected {};  // sparse, without a value
struct Edited {      // sparse, tracked, with one
  std::uint32_t version = 1;
};

// Counts how many are alive and throws from the `fuse`-th constructor on.
struct Throwing {
  Throwing() {
    if (fuse >= 0 && fuse-- == 0) throw std::runtime_error("fuse");
    ++alive;
  }
  Throwing(Throwing&& other) noexcept : value(other.value) { ++alive; }
  Throwing& operator=(Throwing&& other) noexcept = default;
  ~Throwing() { --alive; }
  int value = 7;
  static inline int alive = 0;
  static inline int fuse = -1;  // -1 never throws
};

struct Fused : Throwing {};  // sparse
struct Twin {};
struct OtherTwin {};  // of the same name

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
