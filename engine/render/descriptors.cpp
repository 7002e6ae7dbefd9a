#include "engine/render/descriptors.hpp"

namespace psygen::render {

using core::Result;

Result<UniqueSetLayout> make_set_layout(const Device& device,
                                        std::span<const VkDescriptorSetLayoutBinding> bindings) {
  VkDescriptorSetLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  info.bindingCount = static_cast<std::uint32_t>(bindings.size());
  info.pBindings = bindings.data();
  VkDescriptorSetLayout made = VK_NULL_HANDLE;
  const VkResult result =
      device.vk.vkCreateDescriptorSetLayout(device.handle, &info, nullptr, &made);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a descriptor set layout");
  return UniqueSetLayout(device.vk, device.handle, made);
}

Result<UniquePipelineLayout> make_pipeline_layout(const Device& device,
                                                  std::span<const VkDescriptorSetLayout> sets,
                                                  const VkPushConstantRange& push) {
  VkPipelineLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  info.setLayoutCount = static_cast<std::uint32_t>(sets.size());
  info.pSetLayouts = sets.data();
  info.pushConstantRangeCount = 1;
  info.pPushConstantRanges = &push;
  VkPipelineLayout made = VK_NULL_HANDLE;
  const VkResult result = device.vk.vkCreatePipelineLayout(device.handle, &info, nullptr, &made);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a pipeline layout");
  return UniquePipelineLayout(device.vk, device.handle, made);
}

Result<UniqueDescriptorPool> make_descriptor_pool(
    const Device& device, std::span<const VkDescriptorSetLayoutBinding> bindings,
    std::uint32_t sets) {
  std::vector<VkDescriptorPoolSize> sizes;
  for (const VkDescriptorSetLayoutBinding& binding : bindings)
    sizes.push_back({binding.descriptorType, binding.descriptorCount * sets});
  VkDescriptorPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  info.maxSets = sets;
  info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
  info.pPoolSizes = sizes.data();
  VkDescriptorPool made = VK_NULL_HANDLE;
  const VkResult result = device.vk.vkCreateDescriptorPool(device.handle, &info, nullptr, &made);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a descriptor pool");
  return UniqueDescriptorPool(device.vk, device.handle, made);
}

Result<std::vector<VkDescriptorSet>> allocate_sets(const Device& device, VkDescriptorPool pool,
                                                   VkDescriptorSetLayout layout,
                                                   std::uint32_t count) {
  const std::vector<VkDescriptorSetLayout> layouts(count, layout);
  std::vector<VkDescriptorSet> sets(count);
  VkDescriptorSetAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
  info.descriptorPool = pool;
  info.descriptorSetCount = count;
  info.pSetLayouts = layouts.data();
  const VkResult result = device.vk.vkAllocateDescriptorSets(device.handle, &info, sets.data());
  if (result != VK_SUCCESS) return vulkan_failure(result, "allocating descriptor sets");
  return sets;
}

}  // namespace psygen::render
