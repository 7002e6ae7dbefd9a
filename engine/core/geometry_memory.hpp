// Where mesh data lives: reserve, write, commit, release. The seam between synthesis (which writes)
// and rendering (which draws): render implements it over mapped device memory, or over the heap
// with copies to the device; HeapGeometryMemory over the heap for tests and tools. Main thread, but
// for the spans of a reservation, which any one thread may write until commit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/core/error.hpp"
#include "engine/core/vertex_layout.hpp"

namespace psygen::core {

// One mesh's place. Offsets count in vertices and indices of the pool block, as draw calls want
// them.
struct GeometryRange {
  std::uint32_t id = UINT32_MAX;   // names the range to its memory; UINT32_MAX is none
  std::uint32_t pool_block = 0;    // which buffer pair to bind
  std::uint32_t first_vertex = 0;  // in strides of the range's layout
  std::uint32_t first_index = 0;   // in 16-bit indices
  std::uint32_t vertex_count = 0;
  std::uint32_t index_count = 0;
  std::uint32_t bytes = 0;  // what the budget is charged, padding included
  VertexLayout layout = VertexLayout::kModel;
  friend bool operator==(const GeometryRange&, const GeometryRange&) = default;
};
inline constexpr std::uint32_t kNoGeometry = UINT32_MAX;

// Indices [first, first + count) of a list.
struct IndexPart {
  std::uint32_t first = 0, count = 0;
};

struct GeometryReservation {
  GeometryRange range;
  std::span<std::byte> vertices;     // vertex_count · stride bytes, 16-byte aligned
  std::span<std::uint16_t> indices;  // index_count
};

class GeometryMemory {
 public:
  virtual ~GeometryMemory() = default;

  // Space for a mesh. Fails with kOutOfMemory when capacity or fragmentation does not allow it.
  virtual Result<GeometryReservation> reserve(VertexLayout layout, std::uint32_t vertex_count,
                                              std::uint32_t index_count) = 0;
  // The spans are fully written; the range may be drawn from the next frame on.
  virtual void commit(const GeometryRange& range) = 0;
  // Gives a range back, committed or not; its bytes are reused once no frame in flight reads them.
  virtual void release(const GeometryRange& range) = 0;

  // Bytes that a reservation of this shape will be charged, before making it.
  virtual std::uint32_t charged_bytes(VertexLayout layout, std::uint32_t vertex_count,
                                      std::uint32_t index_count) const = 0;
  // Bytes reserved, committed, or released but still read by a frame in flight.
  virtual std::uint64_t used_bytes() const = 0;
  // What used_bytes() may become: less than was asked for where the system has no more memory.
  virtual std::uint64_t capacity_bytes() const = 0;
  // True where GPU (or, on a software device, the CPU) reads the very memory that was written.
  virtual bool zero_copy() const = 0;
  // The bytes of a committed range, for tests; empty where they cannot be read. Slow on some
  // devices: what must be known of a mesh its modeler notes (synthesis::Annotate).
  virtual std::span<const std::byte> vertex_bytes(const GeometryRange& range) const = 0;
  virtual std::span<const std::uint16_t> indices(const GeometryRange& range) const = 0;
};

}  // namespace psygen::core
