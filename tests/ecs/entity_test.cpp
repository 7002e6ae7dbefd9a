#include "ecs/entity.hpp"

#include <gtest/gtest.h>

#include <unordered_set>

namespace psygen::ecs {
namespace {

TEST(Entity, TheNullEntityEqualsOnlyItself) {
  EXPECT_EQ(Entity{}, kNullEntity);
  EXPECT_NE((Entity{0, 1}), kNullEntity);
  EXPECT_NE((Entity{0, 1}), (Entity{0, 2}));
}

TEST(Entity, HashesOfNeighbouringHandlesDiffer) {
  std::unordered_set<std::size_t> hashes;
  for (std::uint32_t index = 0; index < 1000; ++index) {
    for (std::uint32_t generation = 1; generation < 10; ++generation) {
      hashes.insert(std::hash<Entity>{}({index, generation}));
    }
  }
  EXPECT_EQ(hashes.size(), 9000U);
}

}  // namespace
}  // namespace psygen::ecs
