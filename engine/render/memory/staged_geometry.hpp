// Geometry memory for devices whose own memory the CPU cannot write. Meshes are written to CPU
// memory that mirrors the pool's blocks. Committed meshes are copied through a ring of staging
// memory into the device's blocks, on a transfer queue if there is one, before the next frame that
// could draw them. A frame that commits more than the ring holds waits for parts of it. It
// allocates no ranges itself (geometry_pool.hpp). Main thread. Private to engine/render.
#pragma once

#include <array>
#include <deque>
#include <memory>
#include <vector>

#include "engine/render/memory/geometry_pool.hpp"
#include "engine/render/memory/memory.hpp"

namespace psygen::render {

// Adds the copies to a GeometryPool.
class StagedGeometry final : public core::GeometryMemory {
 public:
  static constexpr std::uint64_t kPartBytes = 4ull << 20;
  static constexpr std::size_t kParts = 3;  // of the ring

  // `pool` must outlive this object and take its blocks from add_block().
  explicit StagedGeometry(GeometryPool& pool) : pool_(pool) {}

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

  // core::GeometryMemory, by the pool.
  core::Result<core::GeometryReservation> reserve(core::VertexLayout layout,
                                                  std::uint32_t vertex_count,
                                                  std::uint32_t index_count) override {
    return pool_.reserve(layout, vertex_count, index_count);
  }
  void commit(const core::GeometryRange& range) override;
  void release(const core::GeometryRange& range) override;
  std::uint32_t charged_bytes(core::VertexLayout layout, std::uint32_t vertex_count,
                              std::uint32_t index_count) const override {
    return pool_.charged_bytes(layout, vertex_count, index_count);
  }
  std::uint64_t used_bytes() const override { return pool_.used_bytes(); }
  std::uint64_t capacity_bytes() const override { return pool_.capacity_bytes(); }
  bool zero_copy() const override { return false; }
  std::span<const std::byte> vertex_bytes(const core::GeometryRange& range) const override {
    return pool_.vertex_bytes(range);
  }
  std::span<const std::uint16_t> indices(const core::GeometryRange& range) const override {
    return pool_.indices(range);
  }

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

  GeometryPool& pool_;
  std::vector<std::unique_ptr<std::byte[]>> mirrors_;
  std::deque<Piece> pending_;
  std::array<Part, kParts> parts_;
  std::size_t next_ = 0;
  UniqueSemaphore timeline_;
  std::uint64_t value_ = 0;
};

}  // namespace psygen::render
