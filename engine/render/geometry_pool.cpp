#include "engine/render/geometry_pool.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "engine/core/assert.hpp"

namespace psygen::render {

using core::ErrorCode;
using core::GeometryRange;
using core::GeometryReservation;
using core::Result;
using core::VertexLayout;

namespace {

// The largest distance in bytes from the start of a slot, at a whole unit, to its first vertex, at
// a multiple of the stride.
std::uint32_t max_padding(std::uint32_t stride) {
  return stride - std::gcd(stride, GeometryPool::kUnitBytes);
}

std::uint32_t whole_strides(std::uint32_t offset, std::uint32_t stride) {
  return (offset + stride - 1) / stride * stride;
}

}  // namespace

GeometryPool::GeometryPool(std::uint64_t budget_bytes, BlockSource source)
    : budget_bytes_(budget_bytes / kUnitBytes * kUnitBytes), source_(std::move(source)) {}

std::uint32_t GeometryPool::charged_bytes(VertexLayout layout, std::uint32_t vertex_count,
                                          std::uint32_t index_count) const {
  const std::uint32_t stride = vertex_stride_bytes(layout);
  const std::uint64_t bytes = max_padding(stride) + std::uint64_t{vertex_count} * stride +
                              std::uint64_t{index_count} * sizeof(std::uint16_t);
  const std::uint64_t whole =
      std::max<std::uint64_t>((bytes + kUnitBytes - 1) / kUnitBytes * kUnitBytes, kUnitBytes);
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(whole, UINT32_MAX));
}

Result<void> GeometryPool::add_block(std::uint32_t min_bytes) {
  std::uint64_t bytes = std::min(kBlockBytes, budget_bytes_ - block_bytes_total_);
  if (bytes < min_bytes) {
    return core::fail(ErrorCode::kOutOfMemory,
                      "the geometry budget is used up or too fragmented for this mesh");
  }
  Result<std::byte*> mapped = source_(bytes);
  while (!mapped && mapped.error().code == ErrorCode::kOutOfMemory &&
         bytes / 2 >= std::max<std::uint64_t>(kMinBlockBytes, min_bytes)) {
    bytes /= 2;
    mapped = source_(bytes);
  }
  no_more_blocks_ = !mapped;
  if (!mapped) return tl::unexpected(mapped.error());
  blocks_.push_back({*mapped, OffsetAllocator(static_cast<std::uint32_t>(bytes / kUnitBytes))});
  block_bytes_total_ += bytes;
  return {};
}

Result<std::uint32_t> GeometryPool::allocate_slot(std::uint32_t bytes) {
  const std::uint32_t units = bytes / kUnitBytes;
  for (std::size_t block = 0; block <= blocks_.size(); ++block) {
    if (block == blocks_.size()) {
      if (Result<void> added = add_block(bytes); !added) return tl::unexpected(added.error());
    }
    const auto allocation = blocks_[block].allocator.allocate(units);
    if (!allocation) continue;
    std::uint32_t id = static_cast<std::uint32_t>(slots_.size());
    if (spare_slots_.empty()) {
      slots_.emplace_back();
    } else {
      id = spare_slots_.back();
      spare_slots_.pop_back();
    }
    slots_[id].block = static_cast<std::uint32_t>(block);
    slots_[id].node = allocation->node;
    slots_[id].offset_bytes = allocation->offset * kUnitBytes;
    return id;
  }
  return core::fail(ErrorCode::kOutOfMemory, "a new block of geometry memory has no room");
}

Result<GeometryReservation> GeometryPool::reserve(VertexLayout layout, std::uint32_t vertex_count,
                                                  std::uint32_t index_count) {
  const std::uint32_t bytes = charged_bytes(layout, vertex_count, index_count);
  if (bytes > kBlockBytes || used_bytes_ + bytes > budget_bytes_) {
    return core::fail(ErrorCode::kOutOfMemory, "the geometry budget has no room for this mesh");
  }
  const Result<std::uint32_t> id = allocate_slot(bytes);
  if (!id) return tl::unexpected(id.error());
  Slot& slot = slots_[*id];
  const std::uint32_t stride = vertex_stride_bytes(layout);
  slot.offset_bytes = whole_strides(slot.offset_bytes, stride);
  slot.vertex_bytes = vertex_count * stride;
  slot.index_count = index_count;
  slot.bytes = bytes;
  slot.state = SlotState::kReserved;
  used_bytes_ += bytes;

  GeometryReservation reservation;
  GeometryRange& range = reservation.range;
  range.id = *id;
  range.pool_block = slot.block;
  range.first_vertex = slot.offset_bytes / stride;
  range.first_index =
      (slot.offset_bytes + slot.vertex_bytes) / static_cast<std::uint32_t>(sizeof(std::uint16_t));
  range.vertex_count = vertex_count;
  range.index_count = index_count;
  range.bytes = bytes;
  range.layout = layout;
  std::byte* place = blocks_[slot.block].mapped + slot.offset_bytes;
  reservation.vertices = {place, slot.vertex_bytes};
  reservation.indices = {reinterpret_cast<std::uint16_t*>(place + slot.vertex_bytes), index_count};
  return reservation;
}

void GeometryPool::commit(const GeometryRange& range) {
  PSYGEN_CHECK(range.id < slots_.size() && slots_[range.id].state == SlotState::kReserved,
               "commit of a range that is not reserved");
  slots_[range.id].state = SlotState::kCommitted;
}

void GeometryPool::release(const GeometryRange& range) {
  PSYGEN_CHECK(range.id < slots_.size() && (slots_[range.id].state == SlotState::kReserved ||
                                            slots_[range.id].state == SlotState::kCommitted),
               "release of a range that is not held");
  Slot& slot = slots_[range.id];
  const bool may_be_read = slot.state == SlotState::kCommitted && finished_ < submitted_;
  slot.state = SlotState::kReleased;
  if (may_be_read) {
    pending_.push_back({submitted_, range.id});
  } else {
    free_slot(range.id);
  }
}

void GeometryPool::free_slot(std::uint32_t id) {
  Slot& slot = slots_[id];
  blocks_[slot.block].allocator.free(slot.node);
  used_bytes_ -= slot.bytes;
  slot.state = SlotState::kFree;
  spare_slots_.push_back(id);
}

void GeometryPool::frames_finished(std::uint64_t value) {
  finished_ = std::max(finished_, value);
  while (!pending_.empty() && pending_.front().value <= finished_) {
    free_slot(pending_.front().id);
    pending_.pop_front();
  }
}

bool GeometryPool::is_committed(const GeometryRange& range) const {
  return range.id < slots_.size() && slots_[range.id].state == SlotState::kCommitted;
}

std::span<const std::byte> GeometryPool::vertex_bytes(const GeometryRange& range) const {
  PSYGEN_CHECK(is_committed(range), "reading a range that is not committed");
  const Slot& slot = slots_[range.id];
  return {blocks_[slot.block].mapped + slot.offset_bytes, slot.vertex_bytes};
}

std::span<const std::uint16_t> GeometryPool::indices(const GeometryRange& range) const {
  PSYGEN_CHECK(is_committed(range), "reading a range that is not committed");
  const Slot& slot = slots_[range.id];
  const std::byte* place = blocks_[slot.block].mapped + slot.offset_bytes + slot.vertex_bytes;
  return {reinterpret_cast<const std::uint16_t*>(place), slot.index_count};
}

}  // namespace psygen::render
