#include "engine/render/pipelines.hpp"

#include <array>
#include <span>

#include "engine/core/vertex_layout.hpp"
#include "engine/render/cloud_texture.hpp"
#include "shaders/shared.h"

namespace psygen::render {

using core::Result;

namespace {

constexpr std::uint32_t kTerrainVert[] =
#include "terrain_vert_spv.h"
    ;
constexpr std::uint32_t kTerrainPushedVert[] =
#include "terrain_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kModelVert[] =
#include "model_vert_spv.h"
    ;
constexpr std::uint32_t kModelPushedVert[] =
#include "model_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kSurfaceFrag[] =
#include "surface_frag_spv.h"
    ;
constexpr std::uint32_t kSkyVert[] =
#include "sky_vert_spv.h"
    ;
constexpr std::uint32_t kSkyFrag[] =
#include "sky_frag_spv.h"
    ;
constexpr std::uint32_t kOverlayVert[] =
#include "overlay_vert_spv.h"
    ;
constexpr std::uint32_t kOverlayFrag[] =
#include "overlay_frag_spv.h"
    ;

enum class Kind : std::uint8_t { kTerrain, kModel, kSky, kOverlay };

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

VkPipelineColorBlendAttachmentState blend_of(Kind kind) {
  VkPipelineColorBlendAttachmentState blend{};
  blend.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                         VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
  if (kind != Kind::kOverlay) return blend;
  blend.blendEnable = VK_TRUE;
  blend.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
  blend.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_ZERO;
  blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  return blend;
}

Result<UniquePipeline> make_pipeline(const Device& device, VkPipelineLayout layout,
                                     VkFormat colour_format, Kind kind,
                                     std::span<const std::uint32_t> vert,
                                     std::span<const std::uint32_t> frag) {
  Result<UniqueShaderModule> vert_module = make_module(device, vert);
  if (!vert_module) return tl::unexpected(vert_module.error());
  Result<UniqueShaderModule> frag_module = make_module(device, frag);
  if (!frag_module) return tl::unexpected(frag_module.error());
  const std::array stages{stage_of(VK_SHADER_STAGE_VERTEX_BIT, vert_module->get()),
                          stage_of(VK_SHADER_STAGE_FRAGMENT_BIT, frag_module->get())};

  const bool meshes = kind == Kind::kTerrain || kind == Kind::kModel;
  const bool terrain = kind == Kind::kTerrain;
  const VkVertexInputBindingDescription binding{
      0,
      core::vertex_stride_bytes(terrain ? core::VertexLayout::kTerrain
                                        : core::VertexLayout::kModel),
      VK_VERTEX_INPUT_RATE_VERTEX};
  // One fetch of whole words, unpacked in the shader: cheaper than four attributes.
  const VkVertexInputAttributeDescription attribute{
      0, 0, terrain ? VK_FORMAT_R32G32B32_UINT : VK_FORMAT_R32G32B32A32_UINT, 0};
  VkPipelineVertexInputStateCreateInfo input{};
  input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
  input.vertexBindingDescriptionCount = meshes ? 1 : 0;
  input.pVertexBindingDescriptions = &binding;
  input.vertexAttributeDescriptionCount = meshes ? 1 : 0;
  input.pVertexAttributeDescriptions = &attribute;

  VkPipelineInputAssemblyStateCreateInfo assembly{};
  assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkPipelineViewportStateCreateInfo viewport{};
  viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
  viewport.viewportCount = 1;
  viewport.scissorCount = 1;
  VkPipelineRasterizationStateCreateInfo raster{};
  raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
  raster.cullMode = terrain ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE;  // leaves have two sides
  raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
  raster.lineWidth = 1.0F;
  VkPipelineMultisampleStateCreateInfo samples{};
  samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  VkPipelineDepthStencilStateCreateInfo depth{};
  depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
  depth.depthTestEnable = kind != Kind::kOverlay;
  depth.depthWriteEnable = meshes;
  depth.depthCompareOp = meshes ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_GREATER_OR_EQUAL;
  const VkPipelineColorBlendAttachmentState attachment = blend_of(kind);
  VkPipelineColorBlendStateCreateInfo blend{};
  blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
  blend.attachmentCount = 1;
  blend.pAttachments = &attachment;
  const std::array dynamic_states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineDynamicStateCreateInfo dynamic{};
  dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
  dynamic.dynamicStateCount = static_cast<std::uint32_t>(dynamic_states.size());
  dynamic.pDynamicStates = dynamic_states.data();
  VkPipelineRenderingCreateInfo rendering{};
  rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachmentFormats = &colour_format;
  rendering.depthAttachmentFormat = kDepthFormat;

  VkGraphicsPipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
  info.pNext = &rendering;
  info.stageCount = static_cast<std::uint32_t>(stages.size());
  info.pStages = stages.data();
  info.pVertexInputState = &input;
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

Result<UniqueSampler> make_sampler(const Device& device, VkSamplerAddressMode mode) {
  VkSamplerCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
  info.magFilter = VK_FILTER_LINEAR;
  info.minFilter = VK_FILTER_LINEAR;
  info.addressModeU = mode;
  info.addressModeV = mode;
  info.addressModeW = mode;
  VkSampler sampler = VK_NULL_HANDLE;
  const VkResult result = device.vk.vkCreateSampler(device.handle, &info, nullptr, &sampler);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a sampler");
  return UniqueSampler(device.vk, device.handle, sampler);
}

Result<Image> make_texture(const Device& device, core::Extent size, VkFormat format,
                           std::span<const std::byte> texels) {
  Result<Image> image =
      make_image(device, size, format, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                 VK_IMAGE_ASPECT_COLOR_BIT);
  if (!image) return image;
  if (Result<void> filled = upload_image(device, *image, size, texels); !filled) {
    return tl::unexpected(filled.error());
  }
  return image;
}

}  // namespace

Result<void> Pipelines::create(const Device& device, VkFormat colour_format, const Overlay& overlay,
                               std::uint32_t sets) {
  return create_textures(device, overlay)
      .and_then([&] { return create_layouts(device, sets); })
      .and_then([&] { return create_pipelines(device, colour_format); });
}

Result<void> Pipelines::create_textures(const Device& device, const Overlay& overlay) {
  Result<UniqueSampler> clouds = make_sampler(device, VK_SAMPLER_ADDRESS_MODE_REPEAT);
  if (!clouds) return tl::unexpected(clouds.error());
  cloud_sampler_ = std::move(*clouds);
  Result<UniqueSampler> font = make_sampler(device, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  if (!font) return tl::unexpected(font.error());
  font_sampler_ = std::move(*font);
  Result<Image> cloud_image = make_texture(device, {kCloudTextureSize, kCloudTextureSize},
                                           VK_FORMAT_R8G8_UNORM, make_cloud_texture());
  if (!cloud_image) return tl::unexpected(cloud_image.error());
  clouds_ = std::move(*cloud_image);
  Result<Image> font_image =
      make_texture(device, overlay.atlas_size(), VK_FORMAT_R8_UNORM, overlay.atlas());
  if (!font_image) return tl::unexpected(font_image.error());
  font_ = std::move(*font_image);
  return {};
}

Result<void> Pipelines::create_layouts(const Device& device, std::uint32_t sets) {
  const VkShaderStageFlags both = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
  const std::array bindings{
      VkDescriptorSetLayoutBinding{PSYGEN_BINDING_FRAME, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, both,
                                   nullptr},
      VkDescriptorSetLayoutBinding{PSYGEN_BINDING_DRAWS, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1,
                                   VK_SHADER_STAGE_VERTEX_BIT, nullptr},
      VkDescriptorSetLayoutBinding{PSYGEN_BINDING_CLOUDS, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                   1, VK_SHADER_STAGE_FRAGMENT_BIT, cloud_sampler_.address()},
      VkDescriptorSetLayoutBinding{PSYGEN_BINDING_FONT, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                   1, VK_SHADER_STAGE_FRAGMENT_BIT, font_sampler_.address()},
      VkDescriptorSetLayoutBinding{PSYGEN_BINDING_GLYPHS, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1,
                                   VK_SHADER_STAGE_VERTEX_BIT, nullptr}};
  VkDescriptorSetLayoutCreateInfo set_info{};
  set_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  set_info.bindingCount = static_cast<std::uint32_t>(bindings.size());
  set_info.pBindings = bindings.data();
  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  VkResult result =
      device.vk.vkCreateDescriptorSetLayout(device.handle, &set_info, nullptr, &set_layout);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a descriptor set layout");
  set_layout_ = UniqueSetLayout(device.vk, device.handle, set_layout);

  const std::array sizes{VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, sets},
                         VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2 * sets},
                         VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2 * sets}};
  VkDescriptorPoolCreateInfo pool_info{};
  pool_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  pool_info.maxSets = sets;
  pool_info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
  pool_info.pPoolSizes = sizes.data();
  VkDescriptorPool pool = VK_NULL_HANDLE;
  result = device.vk.vkCreateDescriptorPool(device.handle, &pool_info, nullptr, &pool);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a descriptor pool");
  descriptor_pool_ = UniqueDescriptorPool(device.vk, device.handle, pool);

  const VkPushConstantRange push{VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(shaders::DrawData)};
  VkPipelineLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  info.setLayoutCount = 1;
  info.pSetLayouts = set_layout_.address();
  info.pushConstantRangeCount = 1;
  info.pPushConstantRanges = &push;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  result = device.vk.vkCreatePipelineLayout(device.handle, &info, nullptr, &layout);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a pipeline layout");
  layout_ = UniquePipelineLayout(device.vk, device.handle, layout);
  return {};
}

Result<void> Pipelines::create_pipelines(const Device& device, VkFormat colour_format) {
  using Code = std::span<const std::uint32_t>;
  const auto make = [&](UniquePipeline& place, Kind kind, Code vert, Code frag) -> Result<void> {
    Result<UniquePipeline> made =
        make_pipeline(device, layout_.get(), colour_format, kind, vert, frag);
    if (!made) return tl::unexpected(made.error());
    place = std::move(*made);
    return {};
  };
  const auto both = [&](UniquePipeline& buffered, UniquePipeline& pushed, Kind kind, Code vert,
                        Code pushed_vert) {
    return make(buffered, kind, vert, kSurfaceFrag).and_then([&] {
      return make(pushed, kind, pushed_vert, kSurfaceFrag);
    });
  };
  return both(terrain_, terrain_pushed_, Kind::kTerrain, kTerrainVert, kTerrainPushedVert)
      .and_then(
          [&] { return both(model_, model_pushed_, Kind::kModel, kModelVert, kModelPushedVert); })
      .and_then([&] { return make(sky_, Kind::kSky, kSkyVert, kSkyFrag); })
      .and_then([&] { return make(overlay_, Kind::kOverlay, kOverlayVert, kOverlayFrag); });
}

Result<VkDescriptorSet> Pipelines::make_set(const Device& device) {
  VkDescriptorSetAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
  info.descriptorPool = descriptor_pool_.get();
  info.descriptorSetCount = 1;
  info.pSetLayouts = set_layout_.address();
  VkDescriptorSet set = VK_NULL_HANDLE;
  const VkResult result = device.vk.vkAllocateDescriptorSets(device.handle, &info, &set);
  if (result != VK_SUCCESS) return vulkan_failure(result, "allocating a descriptor set");
  return set;
}

void Pipelines::write_set(const Device& device, VkDescriptorSet set, const Buffer& frame,
                          const Buffer& draws, const Buffer& glyphs) const {
  const VkDescriptorBufferInfo frame_info{frame.buffer.get(), 0, VK_WHOLE_SIZE};
  const VkDescriptorBufferInfo draws_info{draws.buffer.get(), 0, VK_WHOLE_SIZE};
  const VkDescriptorBufferInfo glyphs_info{glyphs.buffer.get(), 0, VK_WHOLE_SIZE};
  const VkDescriptorImageInfo clouds_info{VK_NULL_HANDLE, clouds_.view.get(),
                                          VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  const VkDescriptorImageInfo font_info{VK_NULL_HANDLE, font_.view.get(),
                                        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  const auto write = [&](std::uint32_t binding, VkDescriptorType type,
                         const VkDescriptorBufferInfo* buffer, const VkDescriptorImageInfo* image) {
    VkWriteDescriptorSet w{};
    w.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    w.dstSet = set;
    w.dstBinding = binding;
    w.descriptorCount = 1;
    w.descriptorType = type;
    w.pBufferInfo = buffer;
    w.pImageInfo = image;
    return w;
  };
  const VkDescriptorType texture = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  const VkDescriptorType storage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  const std::array writes{
      write(PSYGEN_BINDING_FRAME, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, &frame_info, nullptr),
      write(PSYGEN_BINDING_DRAWS, storage, &draws_info, nullptr),
      write(PSYGEN_BINDING_CLOUDS, texture, nullptr, &clouds_info),
      write(PSYGEN_BINDING_FONT, texture, nullptr, &font_info),
      write(PSYGEN_BINDING_GLYPHS, storage, &glyphs_info, nullptr)};
  device.vk.vkUpdateDescriptorSets(device.handle, static_cast<std::uint32_t>(writes.size()),
                                   writes.data(), 0, nullptr);
}

}  // namespace psygen::render
