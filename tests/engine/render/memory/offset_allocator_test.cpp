#include "engine/render/memory/offset_allocator.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace psygen::render {
namespace {

TEST(OffsetAllocator, AllocatesTheWholeLineInOneRange) {
  OffsetAllocator allocator(1000);
  const auto all = allocator.allocate(1000);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->offset, 0u);
  EXPECT_EQ(allocator.free_units(), 0u);
  EXPECT_FALSE(allocator.allocate(1));
  allocator.free(all->node);
  EXPECT_EQ(allocator.free_units(), 1000u);
}

TEST(OffsetAllocator, MergesNeighboursInAnyOrderOfFreeing) {
  for (const std::array<int, 3> order :
       {std::array{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}) {
    OffsetAllocator allocator(300);
    std::array<OffsetAllocator::Allocation, 3> parts;
    for (auto& part : parts)
      part = allocator.allocate(100).value();
    for (const int i : order)
      allocator.free(parts[static_cast<std::size_t>(i)].node);
    EXPECT_TRUE(allocator.allocate(300)) << "the line must be one range again";
  }
}

// Against a map of what is allocated: no overlap, nothing outside, exact counts, all comes back.
TEST(OffsetAllocator, BehavesLikeASimpleModelUnderRandomOperations) {
  constexpr std::uint32_t kSize = 100'000;
  for (const unsigned seed : {1u, 2u, 3u}) {
    std::mt19937 random(seed);
    const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
    OffsetAllocator allocator(kSize);
    std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> held;  // offset → size, node
    std::uint32_t used = 0;
    for (int step = 0; step < 20'000; ++step) {
      const bool grow = held.empty() || below(100) < 55;
      if (grow) {
        const std::uint32_t size = 1 + below(below(10) == 0 ? 5000 : 200);
        const auto got = allocator.allocate(size);
        if (!got) continue;
        ASSERT_LE(got->offset + size, kSize);
        const auto after = held.lower_bound(got->offset);
        if (after != held.end()) {
          ASSERT_LE(got->offset + size, after->first);
        }
        if (after != held.begin()) {
          const auto before = std::prev(after);
          ASSERT_LE(before->first + before->second.first, got->offset);
        }
        held[got->offset] = {size, got->node};
        used += size;
      } else {
        auto victim = held.lower_bound(below(kSize));
        if (victim == held.end()) victim = held.begin();
        allocator.free(victim->second.second);
        used -= victim->second.first;
        held.erase(victim);
      }
      ASSERT_EQ(allocator.free_units(), kSize - used);
    }
    for (const auto& [offset, entry] : held)
      allocator.free(entry.second);
    EXPECT_EQ(allocator.allocate(kSize).has_value(), true) << "everything merges into one range";
  }
}

TEST(OffsetAllocatorDeathTest, NoticesARangeThatIsFreedTwice) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  OffsetAllocator allocator(64);
  const auto part = allocator.allocate(8).value();
  allocator.free(part.node);
  EXPECT_DEATH(allocator.free(part.node), "not allocated");
}

}  // namespace
}  // namespace psygen::render
