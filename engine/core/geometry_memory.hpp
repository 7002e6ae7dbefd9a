// Memory for mesh data: reserve, write, commit, release. The interface between synthesis (which
// writes) and rendering (which draws). Render implements it over mapped device memory, or over the
// heap with copies to the device. HeapGeometryMemory implements it over the heap for tests and
// tools. Main thread, except for the spans of a reservation: any one thread may write them until
// commit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/core/vertex_layout.hpp"

namespace psygen::core {

// Location of one mesh. Offsets count vertices and indices of the pool block, as draw calls need
// them.
struct GeometryRange {
  std::uint32_t id = UINT32_MAX;   // identifies the range in its memory; UINT32_MAX: none
  std::uint32_t pool_block = 0;    // the buffer pair to bind
  std::uint32_t first_vertex = 0;  // in strides of the range's layout
  std::uint32_t first_index = 0;   // in 16-bit indices
  std::uint32_t vertex_count = 0;
  std::uint32_t index_count = 0;
  std::uint32_t bytes = 0;  // charged to the budget, padding included
  VertexLayout layout = VertexLayout::kModel;
  friend bool operator==(const GeometryRange&, const GeometryRange&) = default;
};
// Marks a range without memory.
inline constexpr std::uint32_t kNoGeometry = UINT32_MAX;

// Indices [first, first + count) of a list.
struct IndexPart {
  std::uint32_t first = 0, count = 0;
};

// A range and the memory to write it to. The spans are valid until commit or release.
struct GeometryReservation {
  GeometryRange range;
  std::span<std::byte> vertices;     // vertex_count · stride bytes, 16-byte aligned
  std::span<std::uint16_t> indices;  // index_count
};

// A range comes from reserve() of the same memory, and is released once.
class GeometryMemory {
 public:
  // Invalidates every range.
  virtual ~GeometryMemory() = default;

  // Reserves space for a mesh. Fails with kOutOfMemory if capacity or fragmentation does not allow
  // it.
  virtual Result<GeometryReservation> reserve(VertexLayout layout, std::uint32_t vertex_count,
                                              std::uint32_t index_count) = 0;
  // Declares the spans fully written. From the next frame on, the range may be drawn.
  virtual void commit(const GeometryRange& range) = 0;
  // Returns a range, committed or not, to the memory. Its bytes are reused once no frame in flight
  // reads them.
  virtual void release(const GeometryRange& range) = 0;

  // Bytes that a reservation of this shape would charge to the budget.
  virtual std::uint32_t charged_bytes(VertexLayout layout, std::uint32_t vertex_count,
                                      std::uint32_t index_count) const = 0;
  // Bytes that are reserved, committed, or released but still read by a frame in flight.
  virtual std::uint64_t used_bytes() const = 0;
  // Upper limit of used_bytes(). Less than requested if the system has less memory.
  virtual std::uint64_t capacity_bytes() const = 0;
  // True if the GPU (or, on a software device, the CPU) reads the memory that was written.
  virtual bool zero_copy() const = 0;
  // Contents of a committed range, for tests; empty if they cannot be read. Slow on some devices:
  // the modeler records facts about a mesh that the program needs later (synthesis::Annotate).
  virtual std::span<const std::byte> vertex_bytes(const GeometryRange& range) const = 0;
  virtual std::span<const std::uint16_t> indices(const GeometryRange& range) const = 0;
};

// On the heap: one allocation per mesh. For tests, tools and the null renderer, not for devices.
// Released ranges are free at once. Every function is O(1). Main thread only. An unknown range
// aborts the program.
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
