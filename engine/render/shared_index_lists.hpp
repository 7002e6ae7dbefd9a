// The index lists that many meshes use (terrain: one per level; rocks: one per subdivision), in one
// small buffer of their own, outside the geometry budget. Lists are kept for good. Private to
// engine/render.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/render/draw_list.hpp"
#include "engine/render/memory.hpp"

namespace psygen::render {

class SharedIndexLists {
 public:
  static constexpr std::uint64_t kBytes = 4ull << 20;
  // The buffer starts with zeroed bytes that are nobody's list: a mesh of nothing to warm up with.
  static constexpr std::uint32_t kBlankBytes = 64;

  core::Result<void> create(const Device& device);
  core::Result<std::uint32_t> add(std::span<const std::uint16_t> indices);

  std::span<const IndexList> lists() const { return lists_; }
  VkBuffer buffer() const { return buffer_.buffer.get(); }

 private:
  Buffer buffer_;
  std::uint64_t used_bytes_ = kBlankBytes;
  std::vector<IndexList> lists_;
};

}  // namespace psygen::render
