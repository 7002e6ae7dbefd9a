#include "engine/render/device/compute_pipeline.hpp"

namespace psygen::render {

using core::Result;

Result<void> ComputePipeline::create(const Device& device, Shader shader,
                                     std::span<const VkDescriptorType> types,
                                     std::uint32_t push_bytes, std::size_t sets) {
  push_bytes_ = push_bytes;
  std::vector<SetBinding> bindings;
  for (const VkDescriptorType type : types)
    bindings.push_back({type, VK_SHADER_STAGE_COMPUTE_BIT});
  const Result<void> made =
      sets_.create(device, bindings, sets)
          .and_then([&] {
            const VkDescriptorSetLayout layout = sets_.layout();
            return make_pipeline_layout(device, {&layout, 1},
                                        {VK_SHADER_STAGE_COMPUTE_BIT, 0, push_bytes});
          })
          .map(into(layout_));
  if (!made) return made;
  const Result<UniqueShaderModule> module = make_module(device, shader);
  if (!module) return tl::unexpected(module.error());
  VkComputePipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
  info.stage = stage_of(VK_SHADER_STAGE_COMPUTE_BIT, module->get());
  info.layout = layout_.get();
  VkPipeline pipeline = VK_NULL_HANDLE;
  const VkResult result = device.vk.vkCreateComputePipelines(device.handle, VK_NULL_HANDLE, 1,
                                                             &info, nullptr, &pipeline);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a pipeline");
  pipeline_ = UniquePipeline(device.vk, device.handle, pipeline);
  return {};
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
