#include <gtest/gtest.h>

#include <algorithm>

#include "engine/core/geometry_memory.hpp"

namespace psygen::core {
namespace {

TEST(HeapGeometryMemory, ReturnsWritableSpansOfTheRequestedSizes) {
  HeapGeometryMemory memory(1 << 20);
  const auto reservation = memory.reserve(VertexLayout::kModel, 10, 33);
  ASSERT_TRUE(reservation);
  EXPECT_EQ(reservation->vertices.size(), 160u);
  EXPECT_EQ(reservation->indices.size(), 33u);
  std::ranges::fill(reservation->vertices, std::byte{7});
  std::ranges::fill(reservation->indices, std::uint16_t{9});
  memory.commit(reservation->range);
  EXPECT_EQ(memory.vertex_bytes(reservation->range)[159], std::byte{7});
  EXPECT_EQ(memory.indices(reservation->range)[32], 9);
}

TEST(HeapGeometryMemory, RejectsMeshesThatDoNotFitAndCountsExactly) {
  HeapGeometryMemory memory(1500);
  const std::uint32_t bytes = memory.charged_bytes(VertexLayout::kTerrain, 50, 3);
  const auto first = memory.reserve(VertexLayout::kTerrain, 50, 3);
  ASSERT_TRUE(first);
  EXPECT_EQ(memory.used_bytes(), bytes);
  ASSERT_TRUE(memory.reserve(VertexLayout::kTerrain, 50, 3));
  const auto third = memory.reserve(VertexLayout::kTerrain, 50, 3);
  ASSERT_FALSE(third);
  EXPECT_EQ(third.error().code, ErrorCode::kOutOfMemory);
  memory.release(first->range);
  EXPECT_EQ(memory.used_bytes(), bytes);
  EXPECT_TRUE(memory.reserve(VertexLayout::kTerrain, 50, 3));
}

TEST(HeapGeometryMemory, CountsItsOwnReservationsWhateverTheRangeSays) {
  HeapGeometryMemory memory(1 << 20);
  const auto kept = memory.reserve(VertexLayout::kModel, 10, 3);
  const auto released = memory.reserve(VertexLayout::kModel, 20, 3);
  ASSERT_TRUE(kept && released);
  GeometryRange range = released->range;
  range.bytes = 1;
  memory.release(range);
  EXPECT_EQ(memory.used_bytes(), kept->range.bytes);
}

TEST(HeapGeometryMemory, RejectsMeshesOfMoreThan32BitsOfBytes) {
  HeapGeometryMemory memory(UINT64_MAX / 2);
  // 2^28 vertices of 16 bytes are 2^32 bytes, which would be 0.
  EXPECT_EQ(memory.charged_bytes(VertexLayout::kModel, 1u << 28, 0), UINT32_MAX);
  const auto refused = memory.reserve(VertexLayout::kModel, 1u << 28, 0);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kOutOfMemory);
  EXPECT_EQ(memory.used_bytes(), 0u);
}

}  // namespace
}  // namespace psygen::core
