// The descriptor set of a pass: a layout, a set for each frame in flight, and the layout of the
// pass's pipelines. Its images and buffers belong to others. Main thread. Private to engine/render.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/render/memory/memory.hpp"

namespace psygen::render {

// A binding of the set; its number is its place in the list.
struct PassBinding {
  VkDescriptorType type;
  VkShaderStageFlags stages;
  const VkSampler* sampler = nullptr;  // of images; immutable
};

// The push constants of all pipelines: shaders::DrawData and the number of a cascade.
VkPushConstantRange push_range();

// Empty until create(). The device must outlive it.
class PassSet {
 public:
  // Creates `slots` sets. `before`: the layouts of the sets with lower numbers
  // (FrameSets::shared(), or none).
  core::Result<void> create(const Device& device, std::size_t slots,
                            std::span<const PassBinding> bindings,
                            std::span<const VkDescriptorSetLayout> before);
  bool exists() const { return !sets_.empty(); }
  // The layout of pipelines with this set.
  VkPipelineLayout layout() const { return layout_.get(); }

  // Names a buffer, or an image, in a slot's set that no unfinished commands use.
  void write(const Device& device, std::size_t slot, std::uint32_t binding, const Buffer& buffer,
             VkDeviceSize bytes = VK_WHOLE_SIZE) const;
  void write(const Device& device, std::size_t slot, std::uint32_t binding,
             const VkDescriptorImageInfo& image) const;
  // Binds the set of a slot. `offset`: of the dynamic buffer, if the set has one.
  void bind(const Device& device, VkCommandBuffer commands, std::size_t slot,
            std::optional<std::uint32_t> offset = {}) const;

 private:
  void write(const Device& device, std::size_t slot, std::uint32_t binding,
             VkWriteDescriptorSet named) const;

  std::vector<VkDescriptorType> types_;
  UniqueSetLayout set_layout_;
  UniqueDescriptorPool pool_;
  UniquePipelineLayout layout_;
  std::vector<VkDescriptorSet> sets_;
  std::uint32_t number_ = 0;
};

}  // namespace psygen::render
