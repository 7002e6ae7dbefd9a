#include "engine/render/device/pipeline_build.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "shaders/shared.h"

namespace psygen::render {

using core::Result;

namespace {

using ShaderCode = std::span<const std::uint32_t>;
#include "shader_code.h"

VkPipelineColorBlendAttachmentState blend_of(const PipelineShape& shape) {
  VkPipelineColorBlendAttachmentState blend{};
  blend.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                         VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
  if (shape.blend == Blend::kNone) return blend;
  blend.blendEnable = VK_TRUE;
  blend.srcColorBlendFactor =
      shape.blend == Blend::kPremultiplied ? VK_BLEND_FACTOR_ONE : VK_BLEND_FACTOR_SRC_ALPHA;
  blend.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_ZERO;
  blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  return blend;
}

// Input of a vertex shader. Stays where it is made: `info` points into it.
struct VertexInput {
  explicit VertexInput(std::optional<core::VertexLayout> layout) {
    const core::VertexLayout read = layout.value_or(core::VertexLayout::kModel);
    const bool terrain = read == core::VertexLayout::kTerrain;
    binding = {0, core::vertex_stride_bytes(read), VK_VERTEX_INPUT_RATE_VERTEX};
    // One fetch of whole words, which the shader unpacks, is cheaper than four attributes.
    attributes = {VkVertexInputAttributeDescription{
                      0, 0, terrain ? VK_FORMAT_R32G32B32_UINT : VK_FORMAT_R32G32B32A32_UINT, 0},
                  VkVertexInputAttributeDescription{1, 0, VK_FORMAT_R32G32_SFLOAT,
                                                    offsetof(core::ObjectVertex, uv)}};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    info.vertexBindingDescriptionCount = layout ? 1 : 0;
    info.pVertexBindingDescriptions = &binding;
    info.vertexAttributeDescriptionCount = !layout                               ? 0
                                           : read == core::VertexLayout::kObject ? 2
                                                                                 : 1;
    info.pVertexAttributeDescriptions = attributes.data();
  }
  VertexInput(const VertexInput&) = delete;
  VertexInput& operator=(const VertexInput&) = delete;

  VkVertexInputBindingDescription binding{};
  std::array<VkVertexInputAttributeDescription, 2> attributes{};
  VkPipelineVertexInputStateCreateInfo info{};
};

VkPipelineRasterizationStateCreateInfo raster_of(const PipelineShape& shape) {
  // Leaves and objects are two-sided.
  const bool one_sided = shape.vertices == core::VertexLayout::kTerrain;
  return {.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
          .polygonMode = shape.wireframe ? VK_POLYGON_MODE_LINE : VK_POLYGON_MODE_FILL,
          .cullMode = one_sided ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE,
          .frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE,
          .lineWidth = 1.0F};
}

VkPipelineDepthStencilStateCreateInfo depth_of(const PipelineShape& shape) {
  const bool writes = shape.depth == DepthUse::kWrite;
  return {.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
          .depthTestEnable = shape.depth != DepthUse::kNone,
          .depthWriteEnable = writes,
          .depthCompareOp = shape.target == DrawTarget::kShadowMap ? VK_COMPARE_OP_LESS
                            : writes                               ? VK_COMPARE_OP_GREATER
                                     : VK_COMPARE_OP_GREATER_OR_EQUAL};
}

// The map entries of all specialisation constants.
constexpr auto kConstants = [] {
  std::array<VkSpecializationMapEntry, PipelineShape{}.constants.size()> entries{};
  for (std::uint32_t i = 0; i < entries.size(); ++i)
    entries[i] = {i, static_cast<std::uint32_t>(i * sizeof(VkBool32)), sizeof(VkBool32)};
  return entries;
}();

// The largest number of pipelines of a preset, for the progress.
constexpr double kMaxPipelines = 34;

Result<UniquePipeline> make_pipeline(const Device& device, VkPipelineLayout layout,
                                     const PipelineShape& shape, const PipelineTargets& targets) {
  Result<UniqueShaderModule> vert_module = make_module(device, shape.vert);
  if (!vert_module) return tl::unexpected(vert_module.error());
  Result<UniqueShaderModule> frag_module;
  if (shape.frag) frag_module = make_module(device, *shape.frag);
  if (!frag_module) return tl::unexpected(frag_module.error());
  std::array stages{stage_of(VK_SHADER_STAGE_VERTEX_BIT, vert_module->get()),
                    stage_of(VK_SHADER_STAGE_FRAGMENT_BIT, frag_module->get())};
  const VkSpecializationInfo constants{kConstants.size(), kConstants.data(),
                                       sizeof(shape.constants), shape.constants.data()};
  stages[0].pSpecializationInfo = stages[1].pSpecializationInfo = &constants;

  const bool has_colour = shape.target != DrawTarget::kShadowMap;
  const VertexInput vertices(shape.vertices);
  const VkPipelineInputAssemblyStateCreateInfo assembly{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
      .topology = shape.topology};
  const VkPipelineViewportStateCreateInfo viewport{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
      .viewportCount = 1,
      .scissorCount = 1};
  const VkPipelineRasterizationStateCreateInfo raster = raster_of(shape);
  const VkPipelineMultisampleStateCreateInfo samples{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
      .rasterizationSamples =
          shape.target == DrawTarget::kLandscape ? targets.samples : VK_SAMPLE_COUNT_1_BIT};
  const VkPipelineDepthStencilStateCreateInfo depth = depth_of(shape);
  const VkPipelineColorBlendAttachmentState attachment = blend_of(shape);
  const VkPipelineColorBlendStateCreateInfo blend{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
      .attachmentCount = has_colour ? 1U : 0U,
      .pAttachments = &attachment};
  const std::array dynamic_states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  const VkPipelineDynamicStateCreateInfo dynamic{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
      .dynamicStateCount = static_cast<std::uint32_t>(dynamic_states.size()),
      .pDynamicStates = dynamic_states.data()};
  const VkPipelineRenderingCreateInfo rendering{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
      .colorAttachmentCount = has_colour ? 1U : 0U,
      .pColorAttachmentFormats = &targets.colour_format,
      .depthAttachmentFormat =
          shape.target == DrawTarget::kPicture ? VK_FORMAT_UNDEFINED : kDepthFormat};

  const VkGraphicsPipelineCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
      .pNext = &rendering,
      .stageCount = shape.frag ? static_cast<std::uint32_t>(stages.size()) : 1,
      .pStages = stages.data(),
      .pVertexInputState = &vertices.info,
      .pInputAssemblyState = &assembly,
      .pViewportState = &viewport,
      .pRasterizationState = &raster,
      .pMultisampleState = &samples,
      .pDepthStencilState = &depth,
      .pColorBlendState = &blend,
      .pDynamicState = &dynamic,
      .layout = layout};
  VkPipeline pipeline = VK_NULL_HANDLE;
  const VkResult result = device.vk.vkCreateGraphicsPipelines(device.handle, VK_NULL_HANDLE, 1,
                                                              &info, nullptr, &pipeline);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a pipeline");
  return UniquePipeline(device.vk, device.handle, pipeline);
}

}  // namespace

Result<UniqueShaderModule> make_module(const Device& device, Shader shader) {
  const ShaderCode code = kShaders[static_cast<std::size_t>(shader)];
  const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                      .codeSize = code.size_bytes(),
                                      .pCode = code.data()};
  return device.make<UniqueShaderModule>(&VolkDeviceTable::vkCreateShaderModule, info,
                                         "creating a shader");
}

VkPipelineShaderStageCreateInfo stage_of(VkShaderStageFlagBits stage, VkShaderModule shader) {
  return {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
          .stage = stage,
          .module = shader,
          .pName = "main"};
}

Result<void> PipelineMaker::make(VkPipelineLayout layout, const PipelineShape& shape,
                                 UniquePipeline& out) {
  return make_pipeline(device_, layout, shape, targets_).map(into(out)).and_then([&] {
    return go_on(progress_, std::min(++made_ / kMaxPipelines, 1.0));
  });
}

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
  const VkComputePipelineCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
      .stage = stage_of(VK_SHADER_STAGE_COMPUTE_BIT, module->get()),
      .layout = layout_.get()};
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
