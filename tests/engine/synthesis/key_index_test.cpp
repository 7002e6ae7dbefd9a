#include "engine/synthesis/key_index.hpp"

#include <gtest/gtest.h>

#include <map>

namespace psygen::synthesis {
namespace {

TEST(KeyIndex, BehavesLikeAMapUnderRandomInsertsAndErasesWithCollisions) {
  KeyIndex index;
  std::map<std::uint64_t, Slot> model;  // key number → slot
  std::vector<std::uint64_t> number_of_slot(4096, UINT64_MAX);
  core::RandomStream random(1, 0, 0, 0, core::Purpose::kParameters);
  // Few distinct hashes, so that probe sequences overlap and wrap around the end of the table.
  const auto hash = [](std::uint64_t number) { return 60 + number % 17; };
  const auto find = [&](std::uint64_t number) {
    return index.find(hash(number), [&](Slot s) { return number_of_slot[s] == number; });
  };
  Slot next = 0;
  for (int step = 0; step < 4000; ++step) {
    const std::uint64_t number = random.next_u64() % 200;
    const auto there = model.find(number);
    ASSERT_EQ(find(number), there == model.end() ? kNoSlot : there->second);
    if (there == model.end()) {
      number_of_slot[next] = number;
      index.insert(hash(number), next);
      model[number] = next++;
    } else {
      index.erase(hash(number), there->second);
      number_of_slot[there->second] = UINT64_MAX;
      model.erase(there);
    }
    ASSERT_EQ(index.size(), model.size());
  }
  for (const auto& [number, slot] : model)
    EXPECT_EQ(find(number), slot);
}

TEST(KeyIndex, KeysThatDifferInOneFieldHaveDifferentHashes) {
  const MeshKey key{{1, 2}, 3, 4, 5, 6};
  for (const MeshKey& other :
       {MeshKey{{2, 2}, 3, 4, 5, 6}, MeshKey{{1, 1}, 3, 4, 5, 6}, MeshKey{{1, 2}, 4, 4, 5, 6},
        MeshKey{{1, 2}, 3, 5, 5, 6}, MeshKey{{1, 2}, 3, 4, 4, 6}, MeshKey{{1, 2}, 3, 4, 5, 7}}) {
    EXPECT_NE(hash_of(key), hash_of(other));
    EXPECT_FALSE(key == other);
  }
}

}  // namespace
}  // namespace psygen::synthesis
