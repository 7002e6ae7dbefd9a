// Geometry memory for devices whose own memory the CPU cannot write. Meshes are written to CPU
// memory that mirrors the pool's blocks. Committed meshes are copied through a ring of staging
// memory into the device's blocks, on a transfer queue if there is one, before the next frame that
// could draw them. A frame that commits more than the ring holds waits for parts of it. Main
// thread. Private to engine/render.
#pragma once

#include <array>
#include <deque>
#include <memory>
#include <vector>

#include "engine/render/memory/geometry_pool.hpp"
#include "engine/render/memory/memory.hpp"

namespace psygen::render {

// A pool with these copies.
class StagedGeometry final : public GeometryPool {
 public:
  static constexpr std::uint64_t kPartBytes = 4ull << 20;
  static constexpr std::size_t kParts = 3;  // of the ring

  // The source of its blocks returns add_block().
  using GeometryPool::GeometryPool;

  // Creates the ring, once, before flush().
  core::Result<void> create(const Device& device);
  // Allocates the mirror of the next block, which the CPU writes. Fails with kOutOfMemory.
  core::Result<std::byte*> add_block(std::uint64_t bytes);

  // Submits copies of everything committed since the last call. Records into `commands`, of the
  // next frame, the barriers that make them readable. That frame must wait for timeline() to reach
  // value() before it reads vertices and indices. `blocks` are the device's.
  core::Result<void> flush(const Device& device, std::span<const Buffer> blocks,
                           VkCommandBuffer commands);
  VkSemaphore timeline() const { return timeline_.get(); }
  std::uint64_t value() const { return value_; }

  // core::GeometryMemory.
  void commit(const core::GeometryRange& range) override;
  void release(const core::GeometryRange& range) override;
  bool zero_copy() const override { return false; }

 private:
  struct Part {
    Buffer staging;
    Commands commands;
    std::uint64_t value = 0;  // timeline value when its copies are done
  };
  // Bytes of a mesh that are not copied yet.
  struct Piece {
    std::uint32_t id = 0, block = 0;
    std::uint64_t offset = 0, bytes = 0;
  };

  std::vector<Piece> fill(Part& part);
  core::Result<void> submit(const Device& device, std::span<const Buffer> blocks, Part& part,
                            std::span<const Piece> pieces);

  std::vector<std::unique_ptr<std::byte[]>> mirrors_;
  std::deque<Piece> pending_;
  std::array<Part, kParts> parts_;
  std::size_t next_ = 0;
  UniqueSemaphore timeline_;
  std::uint64_t value_ = 0;
};

}  // namespace psygen::render
