// A compute shader with the layout of its one descriptor set, and a fixed number of such sets. Owns
// its Vulkan objects and records no barriers. Main thread. Private to engine/render.
#pragma once

#include <cstdint>
#include <span>

#include "engine/render/device/descriptors.hpp"
#include "engine/render/device/pipeline_build.hpp"

namespace psygen::render {

// Empty until create(). The device must outlive it.
class ComputePipeline {
 public:
  // Creates everything. Binding i of the set has the type types[i]. Push constants have
  // `push_bytes` from offset 0. The sets are numbered 0 … sets − 1. Fails as vulkan_error() says.
  core::Result<void> create(const Device& device, Shader shader,
                            std::span<const VkDescriptorType> types, std::uint32_t push_bytes,
                            std::size_t sets);
  // The sets, to name buffers and images in.
  const DescriptorSets& sets() const { return sets_; }

  // Records the binding of the pipeline and a set.
  void bind(const Device& device, VkCommandBuffer commands, std::size_t set) const;
  // Records a dispatch of groups_x · groups_y workgroups. `push` points to push_bytes; requires
  // bind() before.
  void dispatch(const Device& device, VkCommandBuffer commands, const void* push,
                std::uint32_t groups_x, std::uint32_t groups_y) const;

 private:
  DescriptorSets sets_;
  UniquePipelineLayout layout_;
  UniquePipeline pipeline_;
  std::uint32_t push_bytes_ = 0;
};

}  // namespace psygen::render
