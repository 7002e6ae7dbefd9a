// Order of systems with constraints among the others.
#include "ecs/system_order.hpp"

#include <gtest/gtest.h>

namespace psygen::ecs::test {
namespace {

using detail::PlacedSystem;

// Returns the names in order, or the error.
std::string ordered(const std::vector<PlacedSystem>& systems) {
  const detail::SystemOrder sorted = detail::order_systems(systems);
  if (!sorted.error.empty()) return sorted.error;
  std::string names;
  for (const std::size_t i : sorted.order)
    names += names.empty() ? systems[i].name : " " + systems[i].name;
  return names;
}

// Three systems in a row, and `more`.
std::string ordered_with(const std::vector<PlacedSystem>& more) {
  std::vector<PlacedSystem> systems{{"a", {}}, {"b", {}}, {"c", {}}};
  systems.insert(systems.end(), more.begin(), more.end());
  return ordered(systems);
}

TEST(SystemOrder, WithoutConstraintsIsTheOrderOfAdding) {
  EXPECT_EQ(ordered({}), "");
  EXPECT_EQ(ordered_with({{"d", {}}}), "a b c d");
}

TEST(SystemOrder, AConstraintIsRightBeforeOrRightAfterASystem) {
  EXPECT_EQ(ordered_with({{"x", before("a")}}), "x a b c");
  EXPECT_EQ(ordered_with({{"x", before("c")}}), "a b x c");
  EXPECT_EQ(ordered_with({{"x", after("a")}}), "a x b c");
  EXPECT_EQ(ordered_with({{"x", after("c")}}), "a b c x");
}

TEST(SystemOrder, SystemsWithEqualConstraintsKeepTheirOrder) {
  EXPECT_EQ(ordered_with({{"x", before("b")}, {"y", before("b")}, {"z", after("a")}}),
            "a z x y b c");
  EXPECT_EQ(ordered_with({{"x", after("b")}, {"y", after("b")}}), "a b x y c");
}

TEST(SystemOrder, ASystemBetweenTwoOthersRunsAsSoonAsItCan) {
  EXPECT_EQ(ordered_with({{"x", {.before = {"c"}, .after = {"a"}}}}), "a x b c");
  EXPECT_EQ(ordered_with({{"x", {.after = {"a", "b"}}}}), "a b x c");
  EXPECT_EQ(ordered_with({{"x", {.before = {"b", "c"}}}}), "a x b c");
}

TEST(SystemOrder, ConstraintsMayNameLaterSystemsWithConstraints) {
  EXPECT_EQ(ordered_with({{"x", before("y")}, {"y", before("b")}}), "a x y b c");
  EXPECT_EQ(ordered_with({{"x", after("y")}, {"y", after("b")}}), "a b y x c");
}

TEST(SystemOrder, AnUnknownNameIsReportedWithTheKnownNames) {
  EXPECT_EQ(ordered_with({{"x", before("paint")}}),
            "the system 'x' should run before 'paint', but there is no such system; there are 'a', "
            "'b', 'c', 'x'");
  EXPECT_EQ(ordered_with({{"x", after("paint")}}).substr(0, 37),
            "the system 'x' should run after 'pain");
}

TEST(SystemOrder, ANameIsUnique) {
  EXPECT_EQ(ordered_with({{"b", {}}}), "two systems are called 'b'");
}

TEST(SystemOrder, ACycleIsReportedFromSystemToSystem) {
  EXPECT_EQ(ordered_with({{"x", before("x")}}), "systems wait for each other: 'x' after 'x'");
  EXPECT_EQ(ordered_with({{"x", {.before = {"a"}, .after = {"b"}}}}),
            "systems wait for each other: 'a' after 'x' after 'b' after 'a'");
  EXPECT_EQ(ordered_with({{"x", after("y")}, {"y", after("x")}}),
            "systems wait for each other: 'x' after 'y' after 'x'");
}

}  // namespace
}  // namespace psygen::ecs::test
