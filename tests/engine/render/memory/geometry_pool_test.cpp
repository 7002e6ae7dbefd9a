#include "engine/render/memory/geometry_pool.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <random>

namespace psygen::render {
namespace {

using core::GeometryRange;
using core::VertexLayout;

// Blocks on the heap, counted; `limit` blocks can be made.
struct HeapBlocks {
  std::vector<std::unique_ptr<std::byte[]>> blocks;
  std::size_t limit = SIZE_MAX;
  GeometryPool::BlockSource source() {
    return [this](std::uint64_t bytes) -> core::Result<std::byte*> {
      if (blocks.size() >= limit) return core::fail(core::ErrorCode::kOutOfMemory, "no block left");
      blocks.emplace_back(new std::byte[bytes]);
      return blocks.back().get();
    };
  }
};

TEST(GeometryPool, MakesNoBlockBeforeItIsNeeded) {
  HeapBlocks heap;
  GeometryPool pool(256ull << 20, heap.source());
  EXPECT_EQ(pool.block_count(), 0u);
  EXPECT_EQ(pool.capacity_bytes(), 256ull << 20);
  ASSERT_TRUE(pool.reserve(VertexLayout::kModel, 3, 3));
  EXPECT_EQ(pool.block_count(), 1u);
}

TEST(GeometryPool, PlacesVerticesAtWholeStridesAndIndicesBehindThem) {
  HeapBlocks heap;
  GeometryPool pool(1 << 20, heap.source());
  std::vector<std::pair<GeometryRange, std::byte>> held;
  for (const VertexLayout layout : {VertexLayout::kTerrain, VertexLayout::kModel}) {
    for (const std::uint32_t vertices : {1u, 3u, 5u, 7u, 11u, 64u}) {
      const auto reserved = pool.reserve(layout, vertices, 3 * vertices).value();
      const GeometryRange& range = reserved.range;
      const std::byte* base = heap.blocks[range.pool_block].get();
      EXPECT_EQ(reserved.vertices.data(),
                base + std::size_t{range.first_vertex} * vertex_stride_bytes(layout));
      EXPECT_EQ(reinterpret_cast<const std::byte*>(reserved.indices.data()),
                base + std::size_t{range.first_index} * 2);
      EXPECT_EQ(reserved.vertices.size(), vertices * vertex_stride_bytes(layout));
      EXPECT_EQ(reserved.indices.size(), 3 * vertices);
      EXPECT_EQ(range.bytes, pool.charged_bytes(layout, vertices, 3 * vertices));
      EXPECT_EQ(range.bytes % 16, 0u);
      // The neighbours in memory are left alone.
      const int mark = static_cast<int>(held.size()) + 1;
      std::memset(reserved.vertices.data(), mark, reserved.vertices.size());
      std::memset(reserved.indices.data(), mark, reserved.indices.size_bytes());
      pool.commit(range);
      for (const auto& [other, value] : held) {
        EXPECT_EQ(pool.vertex_bytes(other).front(), value);
        EXPECT_EQ(pool.indices(other).back() >> 8, static_cast<int>(value));
      }
      held.emplace_back(range, static_cast<std::byte>(mark));
    }
  }
}

TEST(GeometryPool, CountsAReleasedRangeUntilTheDeviceHasPassedIt) {
  HeapBlocks heap;
  GeometryPool pool(1 << 20, heap.source());
  const auto a = pool.reserve(VertexLayout::kModel, 10, 30).value().range;
  pool.commit(a);
  pool.frame_submitted(5);
  pool.release(a);
  EXPECT_EQ(pool.used_bytes(), a.bytes);
  pool.frames_finished(4);
  EXPECT_EQ(pool.used_bytes(), a.bytes);
  pool.frames_finished(5);
  EXPECT_EQ(pool.used_bytes(), 0u);
}

TEST(GeometryPool, FreesRangesThatNoFrameReadsImmediately) {
  HeapBlocks heap;
  GeometryPool pool(1 << 20, heap.source());
  pool.frame_submitted(5);
  const auto never_committed = pool.reserve(VertexLayout::kModel, 10, 30).value().range;
  pool.release(never_committed);
  EXPECT_EQ(pool.used_bytes(), 0u);
  pool.frames_finished(5);
  const auto committed = pool.reserve(VertexLayout::kModel, 10, 30).value().range;
  pool.commit(committed);
  pool.release(committed);
  EXPECT_EQ(pool.used_bytes(), 0u);
}

TEST(GeometryPool, NeverExceedsItsBudgetAndSaysSo) {
  HeapBlocks heap;
  GeometryPool pool(64 * 1024 + 7, heap.source());
  EXPECT_EQ(pool.capacity_bytes(), 64u * 1024);
  std::vector<GeometryRange> held;
  for (;;) {
    const auto reserved = pool.reserve(VertexLayout::kModel, 100, 300);
    if (!reserved) {
      EXPECT_EQ(reserved.error().code, core::ErrorCode::kOutOfMemory);
      break;
    }
    held.push_back(reserved->range);
    ASSERT_LE(pool.used_bytes(), pool.capacity_bytes());
  }
  EXPECT_EQ(held.size(), 64u * 1024 / held.front().bytes);
  EXPECT_LE(pool.block_bytes_total(), pool.capacity_bytes());
}

TEST(GeometryPool, GoesOnInASecondBlockWhenTheFirstIsFull) {
  HeapBlocks heap;
  GeometryPool pool(GeometryPool::kBlockBytes + (8 << 20), heap.source());
  std::size_t in_second = 0;
  while (auto reserved = pool.reserve(VertexLayout::kModel, 65'536, 65'536))
    in_second += reserved->range.pool_block == 1 ? 1 : 0;
  EXPECT_GT(in_second, 0u);
  EXPECT_EQ(pool.block_count(), 2u);
  EXPECT_EQ(pool.block_bytes_total(), pool.capacity_bytes());
}

TEST(GeometryPool, ReportsADeviceWithoutMemoryAndGoesOn) {
  HeapBlocks heap;
  heap.limit = 0;
  GeometryPool pool(1 << 20, heap.source());
  const auto failed = pool.reserve(VertexLayout::kModel, 10, 30);
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().code, core::ErrorCode::kOutOfMemory);
  EXPECT_EQ(pool.used_bytes(), 0u);
  heap.limit = 1;
  EXPECT_TRUE(pool.reserve(VertexLayout::kModel, 10, 30));
}

TEST(GeometryPool, TakesSmallerBlocksWhereThereIsNoMemoryForWholeOnes) {
  std::uint64_t left = 100ull << 20;
  std::vector<std::unique_ptr<std::byte[]>> blocks;
  GeometryPool pool(256ull << 20, [&](std::uint64_t bytes) -> core::Result<std::byte*> {
    if (bytes > left) return core::fail(core::ErrorCode::kOutOfMemory, "no memory left");
    left -= bytes;
    return blocks.emplace_back(new std::byte[bytes]).get();
  });
  ASSERT_TRUE(pool.make_first_block());
  EXPECT_EQ(pool.capacity_bytes(), 256ull << 20);
  while (pool.reserve(VertexLayout::kModel, 60'000, 60'000)) {
  }
  EXPECT_EQ(pool.block_bytes_total(), (64ull + 32 + 4) << 20);
  EXPECT_EQ(pool.capacity_bytes(), pool.block_bytes_total());  // and not what was hoped for
  left = 64ull << 20;
  while (pool.reserve(VertexLayout::kModel, 60'000, 60'000)) {
  }
  EXPECT_EQ(pool.block_bytes_total(), (64ull + 32 + 4 + 64) << 20);
}

TEST(GeometryPool, WithoutAnyMemoryTheFirstBlockIsAnError) {
  HeapBlocks heap;
  heap.limit = 0;
  GeometryPool pool(256ull << 20, heap.source());
  const auto made = pool.make_first_block();
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().message, "no block left");
}

TEST(GeometryPool, RefusesAMeshLargerThanABlockWithoutOverflow) {
  HeapBlocks heap;
  GeometryPool pool(1ull << 32, heap.source());
  EXPECT_FALSE(pool.reserve(VertexLayout::kModel, UINT32_MAX, UINT32_MAX));
  EXPECT_EQ(pool.block_count(), 0u);
}

TEST(GeometryPool, KeepsMeshesWhileOthersAreReservedAndReleased) {
  HeapBlocks heap;
  GeometryPool pool(1 << 20, heap.source());
  struct Held {
    GeometryRange range;
    std::byte fill;
  };
  std::vector<Held> held;
  std::mt19937 random(11);
  const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  std::uint64_t frame = 0;
  for (int step = 0; step < 3000; ++step) {
    if (below(2) == 0) {
      const auto reserved = pool.reserve(VertexLayout::kModel, 1 + below(200), below(600));
      if (reserved) {
        const auto fill = static_cast<std::byte>(step & 0xFF);
        std::memset(reserved->vertices.data(), static_cast<int>(fill), reserved->vertices.size());
        pool.commit(reserved->range);
        held.push_back({reserved->range, fill});
      }
    } else if (!held.empty()) {
      const std::size_t i = below(static_cast<std::uint32_t>(held.size()));
      const auto bytes = pool.vertex_bytes(held[i].range);
      ASSERT_EQ(bytes.front(), held[i].fill);
      ASSERT_EQ(bytes.back(), held[i].fill);
      pool.release(held[i].range);
      held[i] = held.back();
      held.pop_back();
    }
    if (step % 7 == 0) pool.frame_submitted(++frame);
    if (step % 7 == 3 && frame > 2) pool.frames_finished(frame - 2);
    ASSERT_LE(pool.used_bytes(), pool.capacity_bytes());
  }
  for (const Held& h : held)
    pool.release(h.range);
  pool.frames_finished(frame);
  EXPECT_EQ(pool.used_bytes(), 0u);
}

}  // namespace
}  // namespace psygen::render
