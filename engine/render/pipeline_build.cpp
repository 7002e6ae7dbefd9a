#include "engine/render/pipeline_build.hpp"

#include <array>
#include <cstddef>

#include "shaders/shared.h"

static_assert(PSYGEN_BILLBOARD_BIT == psygen::core::kBillboardBit);
static_assert(PSYGEN_BILLBOARD_REACH_M == psygen::core::kBillboardReachM);

namespace psygen::render {

using core::Result;

namespace {

Result<UniqueShaderModule> make_module(const Device& device, std::span<const std::uint32_t> code) {
  VkShaderModuleCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  info.codeSize = code.size_bytes();
  info.pCode = code.data();
  VkShaderModule made = VK_NULL_HANDLE;
  const VkResult result = device.vk.vkCreateShaderModule(device.handle, &info, nullptr, &made);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a shader");
  return UniqueShaderModule(device.vk, device.handle, made);
}

VkPipelineShaderStageCreateInfo stage_of(VkShaderStageFlagBits stage, VkShaderModule shader) {
  VkPipelineShaderStageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage = stage;
  info.module = shader;
  info.pName = "main";
  return info;
}

VkPipelineColorBlendAttachmentState blend_of(const PipelineShape& shape) {
  const PipelineKind kind = shape.kind;
  VkPipelineColorBlendAttachmentState blend{};
  blend.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                         VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
  const bool multiplied = kind == PipelineKind::kParticles || kind == PipelineKind::kWater;
  if (kind != PipelineKind::kOverlay && kind != PipelineKind::kSun && !multiplied) return blend;
  blend.blendEnable = VK_TRUE;
  blend.srcColorBlendFactor = multiplied ? VK_BLEND_FACTOR_ONE : VK_BLEND_FACTOR_SRC_ALPHA;
  blend.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_ZERO;
  blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  return blend;
}

VkPrimitiveTopology topology_of(PipelineKind kind) {
  switch (kind) {
    case PipelineKind::kWater:
    case PipelineKind::kDome:
    case PipelineKind::kSun:
      return VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
    case PipelineKind::kLines:
      return VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
    default:
      return VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  }
}

bool draws_meshes(PipelineKind kind) {
  return kind == PipelineKind::kTerrain || kind == PipelineKind::kModel ||
         kind == PipelineKind::kObject;
}

// What a vertex shader of one kind reads. Stays where it is made: `info` points into it.
struct VertexInput {
  explicit VertexInput(PipelineKind kind) {
    const bool terrain = kind == PipelineKind::kTerrain, object = kind == PipelineKind::kObject;
    binding = {0,
               core::vertex_stride_bytes(terrain  ? core::VertexLayout::kTerrain
                                         : object ? core::VertexLayout::kObject
                                                  : core::VertexLayout::kModel),
               VK_VERTEX_INPUT_RATE_VERTEX};
    // One fetch of whole words, which the shader unpacks, is cheaper than four attributes.
    attributes = {VkVertexInputAttributeDescription{
                      0, 0, terrain ? VK_FORMAT_R32G32B32_UINT : VK_FORMAT_R32G32B32A32_UINT, 0},
                  VkVertexInputAttributeDescription{1, 0, VK_FORMAT_R32G32_SFLOAT,
                                                    offsetof(core::ObjectVertex, uv)}};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    info.vertexBindingDescriptionCount = draws_meshes(kind) ? 1 : 0;
    info.pVertexBindingDescriptions = &binding;
    info.vertexAttributeDescriptionCount = object ? 2 : draws_meshes(kind) ? 1 : 0;
    info.pVertexAttributeDescriptions = attributes.data();
  }
  VertexInput(const VertexInput&) = delete;
  VertexInput& operator=(const VertexInput&) = delete;

  VkVertexInputBindingDescription binding{};
  std::array<VkVertexInputAttributeDescription, 2> attributes{};
  VkPipelineVertexInputStateCreateInfo info{};
};

VkPipelineRasterizationStateCreateInfo raster_of(const PipelineShape& shape) {
  VkPipelineRasterizationStateCreateInfo raster{};
  raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
  raster.polygonMode = shape.wireframe ? VK_POLYGON_MODE_LINE : VK_POLYGON_MODE_FILL;
  // Leaves are two-sided.
  raster.cullMode =
      shape.kind == PipelineKind::kTerrain ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE;
  raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
  raster.lineWidth = 1.0F;
  return raster;
}

VkPipelineDepthStencilStateCreateInfo depth_of(const PipelineShape& shape) {
  const bool writes = draws_meshes(shape.kind) || shape.kind == PipelineKind::kWater;
  VkPipelineDepthStencilStateCreateInfo depth{};
  depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
  depth.depthTestEnable =
      shape.kind != PipelineKind::kOverlay && shape.kind != PipelineKind::kScaleUp;
  depth.depthWriteEnable = writes;
  depth.depthCompareOp = shape.shadow ? VK_COMPARE_OP_LESS
                         : writes     ? VK_COMPARE_OP_GREATER
                                      : VK_COMPARE_OP_GREATER_OR_EQUAL;
  return depth;
}

// The specialisation constants, by number.
constexpr std::array kConstants{
    VkSpecializationMapEntry{0, 0, sizeof(VkBool32)},
    VkSpecializationMapEntry{1, sizeof(VkBool32), sizeof(VkBool32)},
    VkSpecializationMapEntry{2, 2 * sizeof(VkBool32), sizeof(VkBool32)}};

}  // namespace

Result<UniquePipeline> make_pipeline(const Device& device, VkPipelineLayout layout,
                                     const PipelineShape& shape) {
  Result<UniqueShaderModule> vert_module = make_module(device, shape.vert);
  if (!vert_module) return tl::unexpected(vert_module.error());
  Result<UniqueShaderModule> frag_module;
  if (!shape.frag.empty()) frag_module = make_module(device, shape.frag);
  if (!frag_module) return tl::unexpected(frag_module.error());
  std::array stages{stage_of(VK_SHADER_STAGE_VERTEX_BIT, vert_module->get()),
                    stage_of(VK_SHADER_STAGE_FRAGMENT_BIT, frag_module->get())};
  const VkSpecializationInfo constants{kConstants.size(), kConstants.data(),
                                       sizeof(shape.constants), shape.constants.data()};
  stages[0].pSpecializationInfo = stages[1].pSpecializationInfo = &constants;

  const VertexInput vertices(shape.kind);
  VkPipelineInputAssemblyStateCreateInfo assembly{};
  assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
  assembly.topology = topology_of(shape.kind);
  VkPipelineViewportStateCreateInfo viewport{};
  viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
  viewport.viewportCount = 1;
  viewport.scissorCount = 1;
  const VkPipelineRasterizationStateCreateInfo raster = raster_of(shape);
  VkPipelineMultisampleStateCreateInfo samples{};
  samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
  samples.rasterizationSamples = shape.shadow || shape.flat ? VK_SAMPLE_COUNT_1_BIT : shape.samples;
  const VkPipelineDepthStencilStateCreateInfo depth = depth_of(shape);
  const VkPipelineColorBlendAttachmentState attachment = blend_of(shape);
  VkPipelineColorBlendStateCreateInfo blend{};
  blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
  blend.attachmentCount = shape.shadow ? 0 : 1;
  blend.pAttachments = &attachment;
  const std::array dynamic_states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineDynamicStateCreateInfo dynamic{};
  dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
  dynamic.dynamicStateCount = static_cast<std::uint32_t>(dynamic_states.size());
  dynamic.pDynamicStates = dynamic_states.data();
  VkPipelineRenderingCreateInfo rendering{};
  rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
  rendering.colorAttachmentCount = shape.shadow ? 0 : 1;
  rendering.pColorAttachmentFormats = &shape.colour_format;
  rendering.depthAttachmentFormat = shape.flat ? VK_FORMAT_UNDEFINED : kDepthFormat;

  VkGraphicsPipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
  info.pNext = &rendering;
  info.stageCount = shape.frag.empty() ? 1 : static_cast<std::uint32_t>(stages.size());
  info.pStages = stages.data();
  info.pVertexInputState = &vertices.info;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &blend;
  info.pDynamicState = &dynamic;
  info.layout = layout;
  VkPipeline pipeline = VK_NULL_HANDLE;
  const VkResult result = device.vk.vkCreateGraphicsPipelines(device.handle, VK_NULL_HANDLE, 1,
                                                              &info, nullptr, &pipeline);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a pipeline");
  return UniquePipeline(device.vk, device.handle, pipeline);
}

}  // namespace psygen::render
