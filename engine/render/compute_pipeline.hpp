// A compute shader with the layout of its one descriptor set, and the sets that were asked for.
// Private to engine/render.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/render/memory.hpp"

namespace psygen::render {

class ComputePipeline {
 public:
  // Binding i of the set has the type types[i]. `push_bytes` of push constants, from 0. `sets` sets
  // are made, named 0 to sets − 1.
  core::Result<void> create(const Device& device, std::span<const std::uint32_t> code,
                            std::span<const VkDescriptorType> types, std::uint32_t push_bytes,
                            std::uint32_t sets);

  // No command that uses the set may be unfinished.
  void write_buffer(const Device& device, std::size_t set, std::uint32_t binding,
                    VkBuffer buffer) const;
  void write_image(const Device& device, std::size_t set, std::uint32_t binding, VkSampler sampler,
                   VkImageView view, VkImageLayout layout) const;

  void bind(const Device& device, VkCommandBuffer commands, std::size_t set) const;
  // `push` has push_bytes.
  void dispatch(const Device& device, VkCommandBuffer commands, const void* push,
                std::uint32_t groups_x, std::uint32_t groups_y) const;

 private:
  void write(const Device& device, std::size_t set, std::uint32_t binding,
             const VkDescriptorBufferInfo* buffer, const VkDescriptorImageInfo* image) const;

  UniqueSetLayout set_layout_;
  UniqueDescriptorPool pool_;
  UniquePipelineLayout layout_;
  UniquePipeline pipeline_;
  std::vector<VkDescriptorType> types_;
  std::vector<VkDescriptorSet> sets_;
  std::uint32_t push_bytes_ = 0;
};

}  // namespace psygen::render
