// The index lists that many meshes share (terrain: one per level; rocks: one per subdivision), in
// one small buffer outside the geometry budget. Lists are never removed. Main thread. Private to
// engine/render.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/render/draw_list.hpp"
#include "engine/render/memory.hpp"

namespace psygen::render {

// Empty until create(). The device must outlive it.
class SharedIndexLists {
 public:
  static constexpr std::uint64_t kBytes = 4ull << 20;
  // The buffer starts with zeroed bytes that belong to no list: an empty mesh for the warm-up.
  static constexpr std::uint32_t kBlankBytes = 64;

  // Creates the buffer, once.
  core::Result<void> create(const Device& device);
  // Copies a list and returns its id, which is >= 1. Fails with kInvalidArgument for an empty list,
  // and with kOutOfMemory when the buffer is full.
  core::Result<std::uint32_t> add(std::span<const std::uint16_t> indices);

  // The lists, indexed by id − 1, and their buffer.
  std::span<const IndexList> lists() const { return lists_; }
  VkBuffer buffer() const { return buffer_.buffer.get(); }

 private:
  Buffer buffer_;
  std::uint64_t used_bytes_ = kBlankBytes;
  std::vector<IndexList> lists_;
};

}  // namespace psygen::render
