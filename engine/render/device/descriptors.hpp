// Descriptor sets of one layout, and layouts of pipelines. The images and buffers that sets name
// belong to others. Main thread. Private to engine/render.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/render/device/device.hpp"

namespace psygen::render {

// A binding of a set; its number is its place in the list.
struct SetBinding {
  VkDescriptorType type;
  VkShaderStageFlags stages;
  const VkSampler* sampler = nullptr;  // of images; immutable
};

// Empty until create(). The device must outlive it.
class DescriptorSets {
 public:
  // Creates `count` sets with these bindings. Fails as vulkan_error() says.
  core::Result<void> create(const Device& device, std::span<const SetBinding> bindings,
                            std::size_t count);
  bool exists() const { return !sets_.empty(); }
  std::size_t count() const { return sets_.size(); }
  VkDescriptorSetLayout layout() const { return layout_.get(); }
  // The handle of a set, and its address for Vulkan's arrays.
  const VkDescriptorSet& operator[](std::size_t set) const { return sets_[set]; }

  // Name a buffer from its start on, or an image, in a set that no unfinished commands use.
  void write(const Device& device, std::size_t set, std::uint32_t binding, VkBuffer buffer,
             VkDeviceSize bytes = VK_WHOLE_SIZE) const;
  void write(const Device& device, std::size_t set, std::uint32_t binding,
             const VkDescriptorImageInfo& image) const;

 private:
  void write(const Device& device, std::size_t set, std::uint32_t binding,
             VkWriteDescriptorSet named) const;

  std::vector<VkDescriptorType> types_;  // of the bindings
  UniqueSetLayout layout_;
  UniqueDescriptorPool pool_;
  std::vector<VkDescriptorSet> sets_;
};

// The layout of pipelines with these sets, which are pushed such constants. Fails as vulkan_error()
// says.
core::Result<UniquePipelineLayout> make_pipeline_layout(const Device& device,
                                                        std::span<const VkDescriptorSetLayout> sets,
                                                        const VkPushConstantRange& push);

}  // namespace psygen::render
