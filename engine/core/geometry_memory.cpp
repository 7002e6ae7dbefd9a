#include "engine/core/geometry_memory.hpp"

#include <algorithm>
#include <new>

#include "engine/core/assert.hpp"

namespace psygen::core {
namespace {
// The charge for a mesh that is too large for any memory.
constexpr std::uint32_t kTooManyBytes = UINT32_MAX;
}  // namespace

std::uint32_t HeapGeometryMemory::charged_bytes(VertexLayout layout, std::uint32_t vertex_count,
                                                std::uint32_t index_count) const {
  const std::uint64_t bytes =
      std::uint64_t{vertex_count} * vertex_stride_bytes(layout) + std::uint64_t{index_count} * 2;
  return static_cast<std::uint32_t>(std::min<std::uint64_t>((bytes + 15) / 16 * 16, kTooManyBytes));
}

Result<GeometryReservation> HeapGeometryMemory::reserve(VertexLayout layout,
                                                        std::uint32_t vertex_count,
                                                        std::uint32_t index_count) {
  const std::uint32_t bytes = charged_bytes(layout, vertex_count, index_count);
  if (bytes == kTooManyBytes || used_bytes_ + bytes > capacity_bytes_) {
    return fail(ErrorCode::kOutOfMemory, "geometry memory is full");
  }
  std::unique_ptr<std::byte[]> memory(new (std::nothrow) std::byte[bytes]);
  if (!memory) return fail(ErrorCode::kOutOfMemory, "the heap has no memory for a mesh");
  std::uint32_t id = static_cast<std::uint32_t>(slots_.size());
  if (free_slots_.empty()) {
    slots_.emplace_back();
  } else {
    id = free_slots_.back();
    free_slots_.pop_back();
  }
  Slot& slot = slots_[id];
  slot.bytes = std::move(memory);
  slot.charged_bytes = bytes;
  slot.vertex_bytes = vertex_count * vertex_stride_bytes(layout);
  slot.committed = false;
  used_bytes_ += bytes;
  GeometryReservation reservation;
  reservation.range = {id, id, 0, 0, vertex_count, index_count, bytes, layout};
  reservation.vertices = {slot.bytes.get(), slot.vertex_bytes};
  reservation.indices = {reinterpret_cast<std::uint16_t*>(slot.bytes.get() + slot.vertex_bytes),
                         index_count};
  return reservation;
}

void HeapGeometryMemory::commit(const GeometryRange& range) {
  PSYGEN_CHECK(range.id < slots_.size() && slots_[range.id].bytes,
               "commit of a range not reserved");
  slots_[range.id].committed = true;
}

void HeapGeometryMemory::release(const GeometryRange& range) {
  PSYGEN_CHECK(range.id < slots_.size() && slots_[range.id].bytes,
               "release of a range not reserved");
  used_bytes_ -= slots_[range.id].charged_bytes;
  slots_[range.id] = {};
  free_slots_.push_back(range.id);
}

const HeapGeometryMemory::Slot& HeapGeometryMemory::slot_of(const GeometryRange& range) const {
  PSYGEN_CHECK(range.id < slots_.size() && slots_[range.id].committed,
               "reading a range not committed");
  return slots_[range.id];
}

std::span<const std::byte> HeapGeometryMemory::vertex_bytes(const GeometryRange& range) const {
  const Slot& slot = slot_of(range);
  return {slot.bytes.get(), slot.vertex_bytes};
}

std::span<const std::uint16_t> HeapGeometryMemory::indices(const GeometryRange& range) const {
  const Slot& slot = slot_of(range);
  return {reinterpret_cast<const std::uint16_t*>(slot.bytes.get() + slot.vertex_bytes),
          range.index_count};
}

}  // namespace psygen::core
