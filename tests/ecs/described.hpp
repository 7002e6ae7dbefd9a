// Component types with described fields, for the tests of fields and snapshots. Together they have
// a field of every kind.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tests/ecs/components.hpp"

namespace psygen::ecs::test {

// An enumeration, as a field.
enum class Mood : std::uint8_t { kCalm, kCross };

// A struct that other types have as a field.
struct Vec {
  float x = 0, y = 0, z = 0;
  friend bool operator==(const Vec&, const Vec&) = default;
};

// One field of every kind.
struct Creature {
  std::string name;
  Vec place;
  std::array<std::int16_t, 3> sizes{1, 2, 3};
  std::vector<Vec> path;
  std::vector<std::string> titles;
  Entity friend_of;
  double age_s = 0.5;
  Mood mood = Mood::kCalm;
  bool awake = true;
  std::int64_t debt = -1;
  int secret = 5;  // not described
  friend bool operator==(const Creature&, const Creature&) = default;
};

// Elements of half a kilobyte, and a component with a list of them.
struct Item {
  std::array<double, 64> values{};
};
struct Crate {
  std::vector<Item> items;
};

}  // namespace psygen::ecs::test

template <>
struct psygen::ecs::ComponentTraits<psygen::ecs::test::Vec> {
  using Vec = psygen::ecs::test::Vec;
  static constexpr auto fields =
      std::tuple{field("x", &Vec::x), field("y", &Vec::y), field("z", &Vec::z)};
};
template <>
struct psygen::ecs::ComponentTraits<psygen::ecs::test::Creature> {
  using Creature = psygen::ecs::test::Creature;
  static constexpr std::string_view name = "creature";
  static constexpr bool tracked = true;
  static constexpr auto fields = std::tuple{
      field("name", &Creature::name),
      field("place", &Creature::place, {.unit = "m", .doc = "its position"}),
      field("sizes", &Creature::sizes),
      field("path", &Creature::path),
      field("titles", &Creature::titles),
      field("friend_of", &Creature::friend_of),
      field("age", &Creature::age_s, {.unit = "s", .min = 0, .max = 100}),
      field("mood", &Creature::mood),
      field("awake", &Creature::awake),
      field("debt", &Creature::debt),
  };
};
template <>
struct psygen::ecs::ComponentTraits<psygen::ecs::test::Item> {
  static constexpr auto fields = std::tuple{field("values", &psygen::ecs::test::Item::values)};
};
template <>
struct psygen::ecs::ComponentTraits<psygen::ecs::test::Crate> {
  static constexpr std::string_view name = "crate";
  static constexpr auto fields = std::tuple{field("items", &psygen::ecs::test::Crate::items)};
};
