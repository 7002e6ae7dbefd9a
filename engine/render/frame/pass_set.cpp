#include "engine/render/frame/pass_set.hpp"

#include <utility>

#include "engine/render/device/descriptors.hpp"
#include "shaders/shared.h"

namespace psygen::render {

using core::Result;

VkPushConstantRange push_range() {
  return {VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(shaders::DrawData) + sizeof(std::uint32_t)};
}

Result<void> PassSet::create(const Device& device, std::size_t slots,
                             std::span<const PassBinding> bindings,
                             std::span<const VkDescriptorSetLayout> before) {
  std::vector<VkDescriptorSetLayoutBinding> all;
  for (const PassBinding& binding : bindings) {
    all.push_back(
        {static_cast<std::uint32_t>(all.size()), binding.type, 1, binding.stages, binding.sampler});
    types_.push_back(binding.type);
  }
  number_ = static_cast<std::uint32_t>(before.size());
  const auto count = static_cast<std::uint32_t>(slots);
  Result<UniqueSetLayout> set_layout = make_set_layout(device, all);
  if (!set_layout) return tl::unexpected(set_layout.error());
  set_layout_ = std::move(*set_layout);
  std::vector<VkDescriptorSetLayout> layouts(before.begin(), before.end());
  layouts.push_back(set_layout_.get());
  Result<UniquePipelineLayout> layout = make_pipeline_layout(device, layouts, push_range());
  if (!layout) return tl::unexpected(layout.error());
  layout_ = std::move(*layout);
  Result<UniqueDescriptorPool> pool = make_descriptor_pool(device, all, count);
  if (!pool) return tl::unexpected(pool.error());
  pool_ = std::move(*pool);
  auto sets = allocate_sets(device, pool_.get(), set_layout_.get(), count);
  if (!sets) return tl::unexpected(sets.error());
  sets_ = std::move(*sets);
  return {};
}

void PassSet::write(const Device& device, std::size_t slot, std::uint32_t binding,
                    const Buffer& buffer, VkDeviceSize bytes) const {
  const VkDescriptorBufferInfo info{buffer.buffer.get(), 0, bytes};
  VkWriteDescriptorSet named{};
  named.pBufferInfo = &info;
  write(device, slot, binding, named);
}

void PassSet::write(const Device& device, std::size_t slot, std::uint32_t binding,
                    const VkDescriptorImageInfo& image) const {
  VkWriteDescriptorSet named{};
  named.pImageInfo = &image;
  write(device, slot, binding, named);
}

void PassSet::write(const Device& device, std::size_t slot, std::uint32_t binding,
                    VkWriteDescriptorSet named) const {
  named.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
  named.dstSet = sets_[slot];
  named.dstBinding = binding;
  named.descriptorCount = 1;
  named.descriptorType = types_[binding];
  device.vk.vkUpdateDescriptorSets(device.handle, 1, &named, 0, nullptr);
}

void PassSet::bind(const Device& device, VkCommandBuffer commands, std::size_t slot,
                   std::optional<std::uint32_t> offset) const {
  device.vk.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.get(),
                                    number_, 1, &sets_[slot], offset ? 1 : 0,
                                    offset ? &*offset : nullptr);
}

}  // namespace psygen::render
