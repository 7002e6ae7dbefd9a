#include "engine/render/frame/pass_set.hpp"

#include <vector>

namespace psygen::render {

using core::Result;

Result<void> PassSet::create(const PassSetup& setup, std::span<const SetBinding> bindings,
                             std::span<const VkDescriptorSetLayout> before) {
  number_ = static_cast<std::uint32_t>(before.size());
  return sets_.create(setup.device, bindings, setup.sets.slots())
      .and_then([&] {
        std::vector<VkDescriptorSetLayout> layouts(before.begin(), before.end());
        layouts.push_back(sets_.layout());
        return make_pipeline_layout(setup.device, layouts, push_range());
      })
      .map(into(layout_));
}

void PassSet::write(const Device& device, std::uint32_t binding, const SlotBuffer& buffers,
                    VkDeviceSize bytes) const {
  for (std::size_t slot = 0; slot < sets_.count(); ++slot)
    sets_.write(device, slot, binding, buffers.at(slot).buffer.get(), bytes);
}

Result<void> PassSet::fill(const Device& device, std::size_t slot, std::uint32_t binding,
                           SlotBuffer& buffers, std::span<const std::byte> bytes) const {
  return buffers.write(device, slot, bytes).map([&](bool replaced) {
    if (replaced) write(device, slot, binding, buffers.at(slot));
  });
}

void PassSet::bind(const Device& device, VkCommandBuffer commands, std::size_t slot,
                   std::optional<std::uint32_t> offset) const {
  device.vk.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.get(),
                                    number_, 1, &sets_[slot], offset ? 1 : 0,
                                    offset ? &*offset : nullptr);
}

}  // namespace psygen::render
