#include "engine/render/compute_pipeline.hpp"

#include <utility>

#include "engine/render/descriptors.hpp"

namespace psygen::render {

using core::Result;

namespace {

Result<UniquePipeline> make_pipeline(const Device& device, VkPipelineLayout layout,
                                     std::span<const std::uint32_t> code) {
  VkShaderModuleCreateInfo module_info{};
  module_info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  module_info.codeSize = code.size_bytes();
  module_info.pCode = code.data();
  VkShaderModule module = VK_NULL_HANDLE;
  VkResult result = device.vk.vkCreateShaderModule(device.handle, &module_info, nullptr, &module);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a shader");
  const UniqueShaderModule owner(device.vk, device.handle, module);
  VkComputePipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
  info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = module;
  info.stage.pName = "main";
  info.layout = layout;
  VkPipeline pipeline = VK_NULL_HANDLE;
  result = device.vk.vkCreateComputePipelines(device.handle, VK_NULL_HANDLE, 1, &info, nullptr,
                                              &pipeline);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a pipeline");
  return UniquePipeline(device.vk, device.handle, pipeline);
}

}  // namespace

Result<void> ComputePipeline::create(const Device& device, std::span<const std::uint32_t> code,
                                     std::span<const VkDescriptorType> types,
                                     std::uint32_t push_bytes, std::uint32_t sets) {
  types_.assign(types.begin(), types.end());
  push_bytes_ = push_bytes;
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (std::uint32_t i = 0; i < types.size(); ++i)
    bindings.push_back({i, types[i], 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
  Result<UniqueSetLayout> set_layout = make_set_layout(device, bindings);
  if (!set_layout) return tl::unexpected(set_layout.error());
  set_layout_ = std::move(*set_layout);
  Result<UniqueDescriptorPool> pool = make_descriptor_pool(device, bindings, sets);
  if (!pool) return tl::unexpected(pool.error());
  pool_ = std::move(*pool);
  Result<UniquePipelineLayout> layout = make_pipeline_layout(
      device, {set_layout_.address(), 1}, {VK_SHADER_STAGE_COMPUTE_BIT, 0, push_bytes});
  if (!layout) return tl::unexpected(layout.error());
  layout_ = std::move(*layout);
  Result<UniquePipeline> pipeline = make_pipeline(device, layout_.get(), code);
  if (!pipeline) return tl::unexpected(pipeline.error());
  pipeline_ = std::move(*pipeline);

  auto allocated = allocate_sets(device, pool_.get(), set_layout_.get(), sets);
  if (!allocated) return tl::unexpected(allocated.error());
  sets_ = std::move(*allocated);
  return {};
}

void ComputePipeline::write(const Device& device, std::size_t set, std::uint32_t binding,
                            const VkDescriptorBufferInfo* buffer,
                            const VkDescriptorImageInfo* image) const {
  VkWriteDescriptorSet write{};
  write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
  write.dstSet = sets_[set];
  write.dstBinding = binding;
  write.descriptorCount = 1;
  write.descriptorType = types_[binding];
  write.pBufferInfo = buffer;
  write.pImageInfo = image;
  device.vk.vkUpdateDescriptorSets(device.handle, 1, &write, 0, nullptr);
}

void ComputePipeline::write_buffer(const Device& device, std::size_t set, std::uint32_t binding,
                                   VkBuffer buffer) const {
  const VkDescriptorBufferInfo info{buffer, 0, VK_WHOLE_SIZE};
  write(device, set, binding, &info, nullptr);
}

void ComputePipeline::write_image(const Device& device, std::size_t set, std::uint32_t binding,
                                  VkSampler sampler, VkImageView view, VkImageLayout layout) const {
  const VkDescriptorImageInfo info{sampler, view, layout};
  write(device, set, binding, nullptr, &info);
}

void ComputePipeline::bind(const Device& device, VkCommandBuffer commands, std::size_t set) const {
  device.vk.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
  device.vk.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.get(), 0, 1,
                                    &sets_[set], 0, nullptr);
}

void ComputePipeline::dispatch(const Device& device, VkCommandBuffer commands, const void* push,
                               std::uint32_t groups_x, std::uint32_t groups_y) const {
  device.vk.vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, push_bytes_,
                               push);
  device.vk.vkCmdDispatch(commands, groups_x, groups_y, 1);
}

}  // namespace psygen::render
