#include "engine/save/world_identity.hpp"

#include <gtest/gtest.h>

#include "tests/engine/world/shipped.hpp"

namespace psygen::save {
namespace {

using world::testing::kSmallWorld;
using world::testing::parsed;
using world::testing::registry;
using world::testing::replaced;

TEST(WorldIdentity, IsTheSameForTheSameWorld) {
  const WorldIdentity one = identity_of(parsed(kSmallWorld), registry());
  EXPECT_EQ(one.name, "small");
  EXPECT_EQ(one, identity_of(parsed(kSmallWorld), registry()));
}

TEST(WorldIdentity, DiffersWhereThingsStandElsewhere) {
  const auto hash = identity_of(parsed(kSmallWorld), registry()).hash;
  for (const auto& [from, to] : {std::pair{"seed = 5", "seed = 6"},
                                 {"count = 3", "count = 4"},
                                 {"relief_m = 60", "relief_m = 61"},
                                 {"[8, 4]", "[8, 5]"}})
    EXPECT_NE(identity_of(parsed(replaced(kSmallWorld, from, to)), registry()).hash, hash) << to;
}

TEST(WorldIdentity, IsNoMatterOfColoursAndOfTheName) {
  const auto hash = identity_of(parsed(kSmallWorld), registry()).hash;
  world::World world = parsed(kSmallWorld);
  world.sky.start_hour = 17;
  world.palette.grass.x = 0.5F;
  world.name = "other";
  EXPECT_EQ(identity_of(world, registry()), (WorldIdentity{"other", hash}));
}

}  // namespace
}  // namespace psygen::save
