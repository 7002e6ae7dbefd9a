// Tests the handshake of ranks that disagree.
#include "engine/cluster/meeting.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "tests/engine/cluster/threads_as_ranks.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::cluster {
namespace {

TEST(Meeting, RanksThatMakeOtherMeshesAreRejectedWithTheirNumberAndMachine) {
  const models::Registry standard = models::make_standard_registry();
  const world::World world = world::testing::parsed(world::testing::kSmallWorld);
  const auto sentence = [&](const std::function<void(CompatibilityKey&)>& change) {
    std::string said;
    ThreadsAsRanks(3).run([&](Peers& peers) {
      CompatibilityKey key = compatibility_key(world, standard, "0.1.0");
      if (peers.rank() == 2) change(key);
      const auto met = meet(key, peers.rank() + 1, peers);
      if (peers.rank() == 1) said = met ? std::string() : met.error().message;
      if (met) {
        EXPECT_EQ(*met, (std::vector<unsigned>{1, 2, 3}));
      }
    });
    return said;
  };
  EXPECT_EQ(sentence([](CompatibilityKey&) {}), "");
  EXPECT_EQ(sentence([](CompatibilityKey& key) { key.version = "0.2.0"; }),
            "rank 2 (host2) does not match rank 0 (host0): it has psygen 0.2.0 instead of 0.1.0");
  EXPECT_EQ(sentence([](CompatibilityKey& key) { key.types.pop_back(); }),
            "rank 2 (host2) does not match rank 0 (host0): it has 3 model types instead of 4");
  EXPECT_EQ(
      sentence([](CompatibilityKey& key) { key.types[2].sample_hash ^= 1; }),
      "rank 2 (host2) does not match rank 0 (host0): it has a different version of the model type "
      "tree, which makes other meshes");
  EXPECT_EQ(sentence([](CompatibilityKey& key) { key.world_hash ^= 1; }),
            "rank 2 (host2) does not match rank 0 (host0): it has a different version of the world "
            "small");
}

}  // namespace
}  // namespace psygen::cluster
