#include "ecs/entity_slots.hpp"

#include <gtest/gtest.h>

#include <array>

namespace psygen::ecs::detail {
namespace {

TEST(EntitySlots, AFreedSlotIsReusedWithTheNextGeneration) {
  EntitySlots slots(100, 1);
  std::array<Entity, 3> first{};
  slots.issue(first, 4096);
  EXPECT_EQ(first[2], (Entity{2, 1}));
  slots.release(*slots.find(first[1]));
  EXPECT_EQ(slots.find(first[1]), nullptr);
  std::array<Entity, 2> second{};
  slots.issue(second, 8199);
  EXPECT_EQ(second[0], (Entity{1, 2}));
  EXPECT_EQ(second[1], (Entity{3, 1}));
  EXPECT_EQ(slots.find(second[1])->location, 8200U);
  EXPECT_EQ(slots.living(), 4U);
}

TEST(EntitySlots, ASlotWhoseGenerationsAreUsedUpRetires) {
  EntitySlots slots(100, UINT32_MAX - 1);
  std::array<Entity, 1> entity{};
  slots.issue(entity, 4096);
  EXPECT_EQ(entity[0], (Entity{0, UINT32_MAX - 1}));
  slots.release(*slots.find(entity[0]));
  slots.issue(entity, 4096);
  EXPECT_EQ(entity[0], (Entity{0, UINT32_MAX}));
  slots.release(*slots.find(entity[0]));
  EXPECT_EQ(slots.retired(), 1U);
  EXPECT_EQ(slots.find({0, UINT32_MAX}), nullptr);
  slots.issue(entity, 4096);
  EXPECT_EQ(entity[0].index, 1U);
  EXPECT_EQ(slots.living(), 1U);
}

TEST(EntitySlots, HandlesThatWereNeverIssuedAreNotFound) {
  EntitySlots slots(100, 1);
  std::array<Entity, 1> entity{};
  slots.issue(entity, 4096);
  EXPECT_EQ(slots.find(kNullEntity), nullptr);
  EXPECT_EQ(slots.find({1, 1}), nullptr);
  EXPECT_EQ(slots.find({0, 0}), nullptr);
  EXPECT_EQ(slots.find({0, 2}), nullptr);
}

}  // namespace
}  // namespace psygen::ecs::detail
