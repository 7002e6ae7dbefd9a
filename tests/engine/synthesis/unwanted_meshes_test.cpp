#include <gtest/gtest.h>

#include "engine/synthesis/geometry_cache.hpp"

namespace psygen::synthesis {
namespace {

TEST(UnwantedMeshes, LeaveInTheOrderInWhichTheyBecameUnwanted) {
  UnwantedMeshes meshes;
  for (const std::uint32_t slot : {5u, 1u, 3u})
    meshes.push({slot, 7});
  meshes.push({5, 7});  // wanted temporarily
  for (const std::uint32_t slot : {1u, 3u, 5u})
    EXPECT_EQ(meshes.pop(), (MeshHandle{slot, 7}));
  EXPECT_FALSE(meshes.pop());
}

TEST(UnwantedMeshes, TheNextMeshOfASlotIsNotHiddenByAFreedOne) {
  UnwantedMeshes meshes;
  meshes.push({2, 1});
  meshes.push({4, 1});
  meshes.push({2, 2});
  EXPECT_EQ(meshes.pop(), (MeshHandle{4, 1}));
  EXPECT_EQ(meshes.pop(), (MeshHandle{2, 2}));
  EXPECT_FALSE(meshes.pop());
}

TEST(UnwantedMeshes, MeshesWantedAgainAndAgainNeedNoMoreMemory) {
  UnwantedMeshes meshes;
  for (std::uint32_t i = 0; i < 100'000; ++i)
    meshes.push({i % 10, 1});
  EXPECT_LE(meshes.entries(), 20u);
  for (std::uint32_t slot = 0; slot < 10; ++slot)
    EXPECT_EQ(meshes.pop(), (MeshHandle{slot, 1}));
  EXPECT_FALSE(meshes.pop());
}

}  // namespace
}  // namespace psygen::synthesis
