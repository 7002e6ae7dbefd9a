#include "engine/render/memory/staged_geometry.hpp"

#include <algorithm>
#include <cstring>
#include <new>

#include "engine/core/out_of_memory.hpp"

namespace psygen::render {

using core::ErrorCode;
using core::Result;

namespace {

// Records barriers that release buffer ranges to another queue family, or acquire them.
void hand_over(const Device& device, VkCommandBuffer commands,
               std::span<const VkBufferMemoryBarrier2> barriers) {
  const VkDependencyInfo dependency{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
      .bufferMemoryBarrierCount = static_cast<std::uint32_t>(barriers.size()),
      .pBufferMemoryBarriers = barriers.data()};
  device.vk.vkCmdPipelineBarrier2(commands, &dependency);
}

VkBufferMemoryBarrier2 ownership_of(const Device& device, VkBuffer buffer, std::uint64_t offset,
                                    std::uint64_t bytes) {
  return {.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2,
          .srcQueueFamilyIndex = device.transfer_family,
          .dstQueueFamilyIndex = device.queue_family,
          .buffer = buffer,
          .offset = offset,
          .size = bytes};
}

}  // namespace

Result<void> StagedGeometry::create(const Device& device) {
  Result<void> made = make_timeline(device).map(into(timeline_));
  for (Part& part : parts_) {
    if (!made) return made;
    made = make_buffer(device, kPartBytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::kRead)
               .map(into(part.staging))
               .and_then([&] { return part.commands.create(device, device.transfer_family); });
  }
  return made;
}

Result<std::byte*> StagedGeometry::add_block(std::uint64_t bytes) {
  // Not initialised, because pages that are never written take no memory.
  std::unique_ptr<std::byte[]> mirror(new (std::nothrow) std::byte[bytes]);
  if (!mirror) {
    return core::fail(ErrorCode::kOutOfMemory,
                      core::out_of_memory("the mirror of geometry memory"));
  }
  mirrors_.push_back(std::move(mirror));
  return mirrors_.back().get();
}

void StagedGeometry::commit(const core::GeometryRange& range) {
  GeometryPool::commit(range);
  const std::uint64_t first = std::uint64_t{range.first_vertex} * vertex_stride_bytes(range.layout);
  const std::uint64_t end =
      (std::uint64_t{range.first_index} + range.index_count) * sizeof(std::uint16_t);
  if (end > first) pending_.push_back({range.id, range.pool_block, first, end - first});
}

void StagedGeometry::release(const core::GeometryRange& range) {
  // From here on its bytes may belong to another mesh.
  std::erase_if(pending_, [&](const Piece& piece) { return piece.id == range.id; });
  GeometryPool::release(range);
}

// Fills a part with pending bytes, in order. The last mesh may be split.
std::vector<StagedGeometry::Piece> StagedGeometry::fill(Part& part) {
  std::vector<Piece> pieces;
  std::uint64_t used = 0;
  while (!pending_.empty() && used < kPartBytes) {
    Piece& first = pending_.front();
    Piece piece = first;
    piece.bytes = std::min(first.bytes, kPartBytes - used);
    std::memcpy(part.staging.mapped + used, mirrors_[piece.block].get() + piece.offset,
                piece.bytes);
    used += piece.bytes;
    first.offset += piece.bytes;
    first.bytes -= piece.bytes;
    pieces.push_back(piece);
    if (first.bytes == 0) pending_.pop_front();
  }
  return pieces;
}

Result<void> StagedGeometry::submit(const Device& device, std::span<const Buffer> blocks,
                                    Part& part, std::span<const Piece> pieces) {
  if (Result<void> begun = part.commands.begin(device); !begun) return begun;
  const VkCommandBuffer commands = part.commands.get();
  std::vector<VkBufferMemoryBarrier2> given;
  std::uint64_t from = 0;
  for (const Piece& piece : pieces) {
    const VkBuffer target = blocks[piece.block].buffer.get();
    const VkBufferCopy copy{from, piece.offset, piece.bytes};
    device.vk.vkCmdCopyBuffer(commands, part.staging.buffer.get(), target, 1, &copy);
    from += piece.bytes;
    given.push_back(ownership_of(device, target, piece.offset, piece.bytes));
    given.back().srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;
    given.back().srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
  }
  if (device.transfer_family != device.queue_family) hand_over(device, commands, given);
  return part.commands.end(device)
      .and_then([&] {
        const std::array signals{
            semaphore_info(timeline_.get(), value_ + 1, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT)};
        return device.submit(device.transfer_queue, commands, {}, signals,
                             "submitting copies of meshes");
      })
      .map([&] { part.value = ++value_; });
}

Result<void> StagedGeometry::flush(const Device& device, std::span<const Buffer> blocks,
                                   VkCommandBuffer commands) {
  std::vector<VkBufferMemoryBarrier2> taken;
  while (!pending_.empty()) {
    Part& part = parts_[next_];
    next_ = (next_ + 1) % kParts;
    Result<void> waited = device.wait(timeline_.get(), part.value, "waiting for copies of meshes");
    if (!waited) return waited;
    const std::vector<Piece> pieces = fill(part);
    if (Result<void> sent = submit(device, blocks, part, pieces); !sent) return sent;
    for (const Piece& piece : pieces) {
      taken.push_back(
          ownership_of(device, blocks[piece.block].buffer.get(), piece.offset, piece.bytes));
      // The stage at which the frame waits for the copies.
      taken.back().srcStageMask = VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT;
      taken.back().dstStageMask = VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT;
      taken.back().dstAccessMask =
          VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT | VK_ACCESS_2_INDEX_READ_BIT;
    }
  }
  if (device.transfer_family != device.queue_family && !taken.empty()) {
    hand_over(device, commands, taken);
  }
  return {};
}

}  // namespace psygen::render
