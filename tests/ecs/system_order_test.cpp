// Where systems with a place run among the others.
#include "ecs/system_order.hpp"

#include <gtest/gtest.h>

namespace psygen::ecs::test {
namespace {

using detail::PlacedSystem;

// The names in order, or the error.
std::string ordered(const std::vector<PlacedSystem>& systems) {
  const detail::SystemOrder sorted = detail::order_systems(systems);
  if (!sorted.error.empty()) return sorted.error;
  std::string names;
  for (const std::size_t i : sorted.order)
    names += names.empty() ? systems[i].name : " " + systems[i].name;
  return names;
}

// Three systems in a row, and these.
std::string ordered_with(const std::vector<PlacedSystem>& more) {
  std::vector<PlacedSystem> systems{{"a", {}}, {"b", {}}, {"c", {}}};
  systems.insert(systems.end(), more.begin(), more.end());
  return ordered(systems);
}

TEST(SystemOrder, without_places_it_is_the_order_of_adding) {
  EXPECT_EQ(ordered({}), "");
  EXPECT_EQ(ordered_with({{"d", {}}}), "a b c d");
}

TEST(SystemOrder, a_place_is_right_before_or_right_after_a_system) {
  EXPECT_EQ(ordered_with({{"x", before("a")}}), "x a b c");
  EXPECT_EQ(ordered_with({{"x", before("c")}}), "a b x c");
  EXPECT_EQ(ordered_with({{"x", after("a")}}), "a x b c");
  EXPECT_EQ(ordered_with({{"x", after("c")}}), "a b c x");
}

TEST(SystemOrder, systems_of_one_place_keep_their_order) {
  EXPECT_EQ(ordered_with({{"x", before("b")}, {"y", before("b")}, {"z", after("a")}}),
            "a z x y b c");
  EXPECT_EQ(ordered_with({{"x", after("b")}, {"y", after("b")}}), "a b x y c");
}

TEST(SystemOrder, a_system_between_two_others_runs_as_soon_as_it_can) {
  EXPECT_EQ(ordered_with({{"x", {.before = {"c"}, .after = {"a"}}}}), "a x b c");
  EXPECT_EQ(ordered_with({{"x", {.after = {"a", "b"}}}}), "a b x c");
  EXPECT_EQ(ordered_with({{"x", {.before = {"b", "c"}}}}), "a x b c");
}

TEST(SystemOrder, places_may_name_systems_that_are_added_later_and_have_places) {
  EXPECT_EQ(ordered_with({{"x", before("y")}, {"y", before("b")}}), "a x y b c");
  EXPECT_EQ(ordered_with({{"x", after("y")}, {"y", after("b")}}), "a b y x c");
}

TEST(SystemOrder, an_unknown_name_is_named_with_those_that_there_are) {
  EXPECT_EQ(ordered_with({{"x", before("paint")}}),
            "the system 'x' should run before 'paint', but there is no such system; there are 'a', "
            "'b', 'c', 'x'");
  EXPECT_EQ(ordered_with({{"x", after("paint")}}).substr(0, 37),
            "the system 'x' should run after 'pain");
}

TEST(SystemOrder, a_name_cannot_be_given_twice) {
  EXPECT_EQ(ordered_with({{"b", {}}}), "two systems are called 'b'");
}

TEST(SystemOrder, a_cycle_is_named_from_system_to_system) {
  EXPECT_EQ(ordered_with({{"x", before("x")}}), "systems wait for each other: 'x' after 'x'");
  EXPECT_EQ(ordered_with({{"x", {.before = {"a"}, .after = {"b"}}}}),
            "systems wait for each other: 'a' after 'x' after 'b' after 'a'");
  EXPECT_EQ(ordered_with({{"x", after("y")}, {"y", after("x")}}),
            "systems wait for each other: 'x' after 'y' after 'x'");
}

}  // namespace
}  // namespace psygen::ecs::test
