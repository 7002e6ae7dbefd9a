// Makes descriptor set layouts, pools and sets, and layouts of pipelines. Writes no sets. Main
// thread. Private to engine/render.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/render/device.hpp"

namespace psygen::render {

// All fail as vulkan_error() says.
core::Result<UniqueSetLayout> make_set_layout(
    const Device& device, std::span<const VkDescriptorSetLayoutBinding> bindings);
// Of pipelines with these sets, which are pushed such constants.
core::Result<UniquePipelineLayout> make_pipeline_layout(const Device& device,
                                                        std::span<const VkDescriptorSetLayout> sets,
                                                        const VkPushConstantRange& push);
// A pool for so many sets of this layout.
core::Result<UniqueDescriptorPool> make_descriptor_pool(
    const Device& device, std::span<const VkDescriptorSetLayoutBinding> bindings,
    std::uint32_t sets);
// Sets of a pool; they live as long as it.
core::Result<std::vector<VkDescriptorSet>> allocate_sets(const Device& device,
                                                         VkDescriptorPool pool,
                                                         VkDescriptorSetLayout layout,
                                                         std::uint32_t count);

}  // namespace psygen::render
