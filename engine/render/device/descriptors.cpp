#include "engine/render/device/descriptors.hpp"

namespace psygen::render {

using core::Result;

Result<void> DescriptorSets::create(const Device& device, std::span<const SetBinding> bindings,
                                    std::size_t count) {
  const auto sets = static_cast<std::uint32_t>(count);
  std::vector<VkDescriptorSetLayoutBinding> all;
  std::vector<VkDescriptorPoolSize> sizes;
  for (const SetBinding& binding : bindings) {
    all.push_back(
        {static_cast<std::uint32_t>(all.size()), binding.type, 1, binding.stages, binding.sampler});
    sizes.push_back({binding.type, sets});
    types_.push_back(binding.type);
  }
  const VkDescriptorSetLayoutCreateInfo layout{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
      .bindingCount = static_cast<std::uint32_t>(all.size()),
      .pBindings = all.data()};
  const VkDescriptorPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                        .maxSets = sets,
                                        .poolSizeCount = static_cast<std::uint32_t>(sizes.size()),
                                        .pPoolSizes = sizes.data()};
  const Result<void> made =
      device
          .make<UniqueSetLayout>(&VolkDeviceTable::vkCreateDescriptorSetLayout, layout,
                                 "creating a descriptor set layout")
          .map(into(layout_))
          .and_then([&] {
            return device.make<UniqueDescriptorPool>(&VolkDeviceTable::vkCreateDescriptorPool, pool,
                                                     "creating a descriptor pool");
          })
          .map(into(pool_));
  if (!made) return made;
  const std::vector<VkDescriptorSetLayout> layouts(count, layout_.get());
  std::vector<VkDescriptorSet> allocated(count);
  const VkDescriptorSetAllocateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                         .descriptorPool = pool_.get(),
                                         .descriptorSetCount = sets,
                                         .pSetLayouts = layouts.data()};
  const VkResult result =
      device.vk.vkAllocateDescriptorSets(device.handle, &info, allocated.data());
  if (result != VK_SUCCESS) return vulkan_failure(result, "allocating descriptor sets");
  sets_ = std::move(allocated);
  return {};
}

void DescriptorSets::write(const Device& device, std::size_t set, std::uint32_t binding,
                           VkBuffer buffer, VkDeviceSize bytes) const {
  const VkDescriptorBufferInfo info{buffer, 0, bytes};
  write(device, set, binding, VkWriteDescriptorSet{.pBufferInfo = &info});
}

void DescriptorSets::write(const Device& device, std::size_t set, std::uint32_t binding,
                           const VkDescriptorImageInfo& image) const {
  write(device, set, binding, VkWriteDescriptorSet{.pImageInfo = &image});
}

void DescriptorSets::write(const Device& device, std::size_t set, std::uint32_t binding,
                           VkWriteDescriptorSet named) const {
  named.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
  named.dstSet = sets_[set];
  named.dstBinding = binding;
  named.descriptorCount = 1;
  named.descriptorType = types_[binding];
  device.vk.vkUpdateDescriptorSets(device.handle, 1, &named, 0, nullptr);
}

Result<UniquePipelineLayout> make_pipeline_layout(const Device& device,
                                                  std::span<const VkDescriptorSetLayout> sets,
                                                  const VkPushConstantRange& push) {
  const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                        .setLayoutCount = static_cast<std::uint32_t>(sets.size()),
                                        .pSetLayouts = sets.data(),
                                        .pushConstantRangeCount = 1,
                                        .pPushConstantRanges = &push};
  return device.make<UniquePipelineLayout>(&VolkDeviceTable::vkCreatePipelineLayout, info,
                                           "creating a pipeline layout");
}

}  // namespace psygen::render
