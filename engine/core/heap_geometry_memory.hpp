// GeometryMemory on the heap: one allocation per mesh. For tests, tools and the null renderer, not
// for devices. Released ranges are free at once. Every function is O(1). Main thread only.
#pragma once

#include <memory>
#include <vector>

#include "engine/core/geometry_memory.hpp"

namespace psygen::core {

// GeometryMemory has the contracts. An unknown range aborts the program.
class HeapGeometryMemory final : public GeometryMemory {
 public:
  // Uses at most `capacity_bytes` at a time; allocates nothing before reserve().
  explicit HeapGeometryMemory(std::uint64_t capacity_bytes) : capacity_bytes_(capacity_bytes) {}

  // As in GeometryMemory. reserve() also fails with kOutOfMemory if the heap has no memory.
  // vertex_bytes() and indices() require a committed range.
  Result<GeometryReservation> reserve(VertexLayout layout, std::uint32_t vertex_count,
                                      std::uint32_t index_count) override;
  void commit(const GeometryRange& range) override;
  void release(const GeometryRange& range) override;
  std::uint32_t charged_bytes(VertexLayout layout, std::uint32_t vertex_count,
                              std::uint32_t index_count) const override;
  std::uint64_t used_bytes() const override { return used_bytes_; }
  std::uint64_t capacity_bytes() const override { return capacity_bytes_; }
  bool zero_copy() const override { return true; }
  std::span<const std::byte> vertex_bytes(const GeometryRange& range) const override;
  std::span<const std::uint16_t> indices(const GeometryRange& range) const override;

 private:
  struct Slot {
    std::unique_ptr<std::byte[]> bytes;  // vertices, then indices
    std::uint32_t charged_bytes = 0;
    std::uint32_t vertex_bytes = 0;
    bool committed = false;
  };
  const Slot& slot_of(const GeometryRange& range) const;

  std::uint64_t capacity_bytes_;
  std::uint64_t used_bytes_ = 0;
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> free_slots_;
};

}  // namespace psygen::core
