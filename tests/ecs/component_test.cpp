#include "ecs/component.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "tests/ecs/components.hpp"

namespace psygen::ecs {
namespace {

struct ThrowingMove {
  ThrowingMove() = default;
  ThrowingMove(ThrowingMove&&) {}
};
struct alignas(128) TooAligned {
  int value = 0;
};

static_assert(Component<test::Position> && Component<test::Owner> && Component<test::Throwing>);
static_assert(Component<test::Aligned>);
static_assert(!Component<const test::Position> && !Component<int&> && !Component<int[4]>);
static_assert(!Component<ThrowingMove> && !Component<TooAligned> && !Component<std::atomic<int>>);

TEST(Component, ANameComesFromTheTraitsOrFromTheType) {
  EXPECT_EQ(component_name<test::Mesh>(), "mesh");
  EXPECT_EQ(component_name<test::Position>(), "psygen::ecs::test::Position");
}

TEST(Component, TrackingIsOffUnlessTheTraitsSaySo) {
  EXPECT_TRUE(is_tracked<test::Mesh>());
  EXPECT_FALSE(is_tracked<test::Position>());
}

TEST(Component, UsedMemoryIsValueInitialisedAgain) {
  std::vector<test::Mesh> meshes(8, test::Mesh{5});
  detail::kComponentInfo<test::Mesh>.construct(reinterpret_cast<std::byte*>(meshes.data()), 2, 4,
                                               false);
  EXPECT_EQ(meshes[1].id, 5U);
  EXPECT_EQ(meshes[2].id, 0U);
  EXPECT_EQ(meshes[5].id, 0U);
  EXPECT_EQ(meshes[6].id, 5U);
}

TEST(Component, FreshMemoryStillGetsDefaultsThatAreNotZero) {
  std::vector<test::Health> rows(4, test::Health{0});
  detail::kComponentInfo<test::Health>.construct(reinterpret_cast<std::byte*>(rows.data()), 0, 4,
                                                 true);
  EXPECT_EQ(rows[3].points, 100);
}

}  // namespace
}  // namespace psygen::ecs
