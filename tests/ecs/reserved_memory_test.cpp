#include "ecs/reserved_memory.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <cstdint>
#include <new>
#include <utility>
#include <vector>

namespace psygen::ecs::detail {
namespace {

TEST(ReservedMemory, ContentsNeverMoveWhileItGrows) {
  ReservedMemory memory(std::size_t{64} << 20, 320);
  memory.commit(1);
  std::byte* first = memory.data();
  *first = std::byte{42};
  for (std::size_t bytes = 1000; bytes < std::size_t{16} << 20; bytes *= 3) {
    memory.commit(bytes);
    ASSERT_GE(memory.committed_bytes(), bytes);
    memory.data()[bytes - 1] = std::byte{1};
  }
  EXPECT_EQ(memory.data(), first);
  EXPECT_EQ(*first, std::byte{42});
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(first) % 64, 0U);
}

TEST(ReservedMemory, FreshMemoryReadsAsZeroToItsLastByte) {
  ReservedMemory memory(std::size_t{1} << 20);
  memory.commit(memory.capacity_bytes());
  EXPECT_GE(memory.capacity_bytes(), std::size_t{1} << 20);
  EXPECT_EQ(memory.data()[memory.capacity_bytes() - 1], std::byte{0});
}

TEST(ReservedMemory, AnAbsurdReservationIsReducedToWhatTheSystemGrants) {
  ReservedMemory memory(std::size_t{1} << 60);
  EXPECT_GE(memory.capacity_bytes(), std::size_t{1} << 20);
  memory.commit(4096);
  memory.data()[4095] = std::byte{1};
}

TEST(ReservedMemory, CommittingMoreThanWasReservedThrows) {
  ReservedMemory memory(std::size_t{1} << 20);
  memory.commit(4096);
  EXPECT_THROW(memory.commit(memory.capacity_bytes() + 1), std::bad_alloc);
  EXPECT_GE(memory.committed_bytes(), 4096U);
  memory.data()[4095] = std::byte{1};
}

#ifdef PSYGEN_LIMITS_OF_MEMORY

TEST(ReservedMemory, WithLimitedAddressSpaceAReservationTakesASmallPart) {
  constexpr std::size_t kGiB = std::size_t{1} << 30;
  rlimit before{};
  getrlimit(RLIMIT_AS, &before);
  const rlimit limited{3 * kGiB, before.rlim_max};
  setrlimit(RLIMIT_AS, &limited);
  std::vector<ReservedMemory> columns;
  for (int i = 0; i < 40; ++i)
    columns.emplace_back(std::size_t{1} << 36);
  void* const rest = mmap(nullptr, kGiB, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  setrlimit(RLIMIT_AS, &before);
  EXPECT_NE(rest, MAP_FAILED);
  munmap(rest, kGiB);
  for (ReservedMemory& column : columns) {
    EXPECT_GE(column.capacity_bytes(), std::size_t{16} << 20);
    column.commit(column.capacity_bytes());
  }
}

#endif

TEST(ReservedMemory, MovingTransfersTheRange) {
  ReservedMemory memory(std::size_t{1} << 20);
  memory.commit(1);
  std::byte* data = memory.data();
  ReservedMemory other(std::move(memory));
  EXPECT_EQ(other.data(), data);
  other.data()[0] = std::byte{1};
}

}  // namespace
}  // namespace psygen::ecs::detail
