#include "engine/render/pipelines.hpp"

#include <array>
#include <span>
#include <vector>

#include "engine/render/cloud_texture.hpp"
#include "engine/render/pipeline_build.hpp"
#include "engine/render/progress.hpp"
#include "shaders/shared.h"

namespace psygen::render {

using core::Result;

namespace {

// Largest number of pipelines of a preset, for the progress.
constexpr double kMostPipelines = 33;

constexpr VkBool32 on(bool yes) {
  return yes ? VK_TRUE : VK_FALSE;
}

Result<UniqueSampler> make_plain_sampler(const Device& device, VkFilter filter,
                                         VkSamplerAddressMode mode) {
  VkSamplerCreateInfo info{};
  info.magFilter = filter;
  info.minFilter = filter;
  info.addressModeU = mode;
  info.addressModeV = mode;
  info.addressModeW = mode;
  return make_sampler(device, info);
}

Result<Image> make_texture(const Device& device, core::Extent size, VkFormat format,
                           std::span<const std::byte> texels) {
  Result<Image> image =
      make_image(device, size, format, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                 VK_IMAGE_ASPECT_COLOR_BIT);
  if (!image) return image;
  if (Result<void> filled = upload_image(device, *image, size, {&texels, 1}); !filled) {
    return tl::unexpected(filled.error());
  }
  return image;
}

}  // namespace

Result<void> Pipelines::create(const Device& device, VkFormat colour_format,
                               const PresetTraits& traits, const Overlay& overlay,
                               std::uint32_t sets, const MaterialTable& materials,
                               const ModelPictures& pictures,
                               std::span<const GroundPicture> ground) {
  materials_ = &materials;
  pictures_ = &pictures;
  traits_ = traits;
  samples_ = device.samples_for(traits.samples);
  colour_format_ = colour_format;
  return create_textures(device, overlay, ground)
      .and_then([&] { return shadows_.create(device, traits); })
      .and_then([&] { return create_layouts(device, sets); })
      .and_then([&] { return create_sets(device, sets); })
      .and_then([&] {
        const Progress nobody;
        Making alone{device, nobody};
        PipelineShape shape = usual_shape();
        shape.kind = PipelineKind::kOverlay;
        shape.vert = other_code().overlay_vert;
        shape.frag = other_code().overlay_frag;
        if (Result<void> made = make(alone, shape, overlay_); !made) return made;
        shape.flat = true;
        return make(alone, shape, overlay_over_coarse_);
      });
}

Result<void> Pipelines::create_textures(const Device& device, const Overlay& overlay,
                                        std::span<const GroundPicture> ground) {
  constexpr VkSamplerAddressMode kClamp = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  Result<UniqueSampler> clouds =
      make_plain_sampler(device, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT);
  if (!clouds) return tl::unexpected(clouds.error());
  cloud_sampler_ = std::move(*clouds);
  Result<UniqueSampler> smooth = make_plain_sampler(device, VK_FILTER_LINEAR, kClamp);
  if (!smooth) return tl::unexpected(smooth.error());
  smooth_sampler_ = std::move(*smooth);
  Result<UniqueSampler> depth = make_plain_sampler(device, VK_FILTER_NEAREST, kClamp);
  if (!depth) return tl::unexpected(depth.error());
  depth_sampler_ = std::move(*depth);
  const std::vector<std::uint16_t> texels = make_cloud_texture();
  Result<Image> cloud_image =
      make_texture(device, {kCloudTextureSize, kCloudTextureSize}, VK_FORMAT_R16G16_SFLOAT,
                   std::as_bytes(std::span(texels)));
  if (!cloud_image) return tl::unexpected(cloud_image.error());
  clouds_ = std::move(*cloud_image);
  Result<Image> font_image =
      make_texture(device, overlay.atlas_size(), VK_FORMAT_R8_UNORM, overlay.atlas());
  if (!font_image) return tl::unexpected(font_image.error());
  font_ = std::move(*font_image);
  return ground_.create(device, traits_, ground);
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
                                   1, VK_SHADER_STAGE_FRAGMENT_BIT, smooth_sampler_.address()},
      VkDescriptorSetLayoutBinding{PSYGEN_BINDING_GLYPHS, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1,
                                   VK_SHADER_STAGE_VERTEX_BIT, nullptr},
      VkDescriptorSetLayoutBinding{PSYGEN_BINDING_SHADOWS,
                                   VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1,
                                   VK_SHADER_STAGE_FRAGMENT_BIT, shadows_.sampler()},
      VkDescriptorSetLayoutBinding{PSYGEN_BINDING_MATERIALS, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1,
                                   both, nullptr},
      VkDescriptorSetLayoutBinding{PSYGEN_BINDING_GROUND, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                   1, VK_SHADER_STAGE_FRAGMENT_BIT, ground_.sampler()},
      VkDescriptorSetLayoutBinding{PSYGEN_BINDING_PICTURES,
                                   VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1,
                                   VK_SHADER_STAGE_FRAGMENT_BIT, pictures_->sampler()},
      VkDescriptorSetLayoutBinding{PSYGEN_BINDING_SHADE, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, both,
                                   nullptr},
      VkDescriptorSetLayoutBinding{PSYGEN_BINDING_EMITTER,
                                   VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 1,
                                   VK_SHADER_STAGE_VERTEX_BIT, nullptr},
      VkDescriptorSetLayoutBinding{PSYGEN_BINDING_MIRROR, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                   1, VK_SHADER_STAGE_FRAGMENT_BIT, smooth_sampler_.address()},
      VkDescriptorSetLayoutBinding{PSYGEN_BINDING_MIRROR_DEPTH,
                                   VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1,
                                   VK_SHADER_STAGE_FRAGMENT_BIT, depth_sampler_.address()}};
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
                         VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, sets},
                         VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 4 * sets},
                         VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 7 * sets}};
  VkDescriptorPoolCreateInfo pool_info{};
  pool_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  pool_info.maxSets = sets;
  pool_info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
  pool_info.pPoolSizes = sizes.data();
  VkDescriptorPool pool = VK_NULL_HANDLE;
  result = device.vk.vkCreateDescriptorPool(device.handle, &pool_info, nullptr, &pool);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a descriptor pool");
  descriptor_pool_ = UniqueDescriptorPool(device.vk, device.handle, pool);

  const VkPushConstantRange push{VK_SHADER_STAGE_VERTEX_BIT, 0,
                                 sizeof(shaders::DrawData) + sizeof(std::uint32_t)};
  VkPipelineLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  const std::array set_layouts{set_layout_.get(), materials_->set_layout()};
  info.setLayoutCount = static_cast<std::uint32_t>(set_layouts.size());
  info.pSetLayouts = set_layouts.data();
  info.pushConstantRangeCount = 1;
  info.pPushConstantRanges = &push;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  result = device.vk.vkCreatePipelineLayout(device.handle, &info, nullptr, &layout);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a pipeline layout");
  layout_ = UniquePipelineLayout(device.vk, device.handle, layout);
  return {};
}

PipelineShape Pipelines::usual_shape() const {
  PipelineShape shape;
  shape.colour_format = colour_format_;
  shape.samples = samples_;
  return shape;
}

Result<void> Pipelines::make(Making& making, const PipelineShape& shape, UniquePipeline& out) {
  Result<UniquePipeline> made = make_pipeline(making.device, layout_.get(), shape);
  if (!made) return tl::unexpected(made.error());
  out = std::move(*made);
  const double fraction = static_cast<double>(++making.count) / kMostPipelines;
  return go_on(making.progress, fraction);
}

Result<void> Pipelines::create_meshes(Making& making, PipelineShape shape, MeshLook look,
                                      MeshPipelines& out) {
  for (const auto layout : {core::VertexLayout::kTerrain, core::VertexLayout::kModel}) {
    const bool terrain = layout == core::VertexLayout::kTerrain;
    shape.kind = terrain ? PipelineKind::kTerrain : PipelineKind::kModel;
    if (look == MeshLook::kLit) shape.frag = lit_frag(terrain);
    for (const bool pushed : {false, true}) {
      shape.vert = mesh_vertex_code(layout, look, pushed);
      const Result<void> made = make(making, shape, out.whole[terrain ? 0 : 1][pushed ? 1 : 0]);
      if (!made) return made;
    }
  }
  return {};
}

// Where light is per vertex, near ground has a texture. Where it is per pixel and not rich, only
// near ground has the textures of its kinds.
Result<void> Pipelines::create_near_ground(Making& making, PipelineShape shape,
                                           MeshPipelines& out) {
  if (traits_.fine_grain) return {};
  const OtherCode& code = other_code();
  const bool lit = traits_.pixel_light;
  shape.kind = PipelineKind::kTerrain;
  shape.frag = lit ? code.ground_lit_near_frag : code.ground_detail_frag;
  for (const bool pushed : {false, true}) {
    shape.vert = lit      ? mesh_vertex_code(core::VertexLayout::kTerrain, MeshLook::kLit, pushed)
                 : pushed ? code.terrain_detail_pushed_vert
                          : code.terrain_detail_vert;
    const Result<void> made = make(making, shape, out.near_ground[pushed ? 1 : 0]);
    if (!made) return made;
  }
  return {};
}

// The fragment shader of meshes whose light is per pixel.
ShaderCode Pipelines::lit_frag(bool terrain) const {
  const OtherCode& code = other_code();
  if (!terrain) return code.surface_lit_frag;
  return traits_.fine_grain ? code.ground_lit_near_frag : code.ground_lit_frag;
}

// Pipelines for models that cover only some of their pixels: that fade, or that have pictures.
// `shape` is that of the same models without either.
Result<void> Pipelines::create_fading(Making& making, PipelineShape shape, MeshLook look,
                                      MeshPipelines& out) {
  const OtherCode& code = other_code();
  shape.kind = PipelineKind::kModel;
  shape.frag = look == MeshLook::kLit      ? code.surface_lit_fading_frag
               : look == MeshLook::kShadow ? code.shadow_fading_frag
                                           : code.surface_fading_frag;
  for (const bool pushed : {false, true}) {
    shape.vert = fading_vertex_code(look, pushed);
    if (Result<void> made = make(making, shape, out.fading[pushed ? 1 : 0]); !made) return made;
  }
  shape.frag = look == MeshLook::kLit          ? code.surface_lit_picture_frag
               : look == MeshLook::kDrawColour ? code.surface_coloured_picture_frag
               : look == MeshLook::kShadow     ? code.shadow_picture_frag
                                               : code.surface_picture_frag;
  for (const bool pushed : {false, true}) {
    shape.vert = picture_vertex_code(look, pushed);
    if (Result<void> made = make(making, shape, out.pictured[pushed ? 1 : 0]); !made) return made;
  }
  return {};
}

Result<void> Pipelines::create_others(const Device& device, const Progress& progress) {
  Making making{device, progress};
  return create_landscape(making, false, landscape_, water_)
      .and_then([&] { return create_views(making); })
      .and_then([&]() -> Result<void> {
        if (traits_.cascades == 0) return {};
        PipelineShape shadow = usual_shape();
        shadow.shadow = true;
        return create_meshes(making, shadow, MeshLook::kShadow, shadow_).and_then([&] {
          return create_fading(making, shadow, MeshLook::kShadow, shadow_);
        });
      })
      .and_then([&] { return create_sky(making); });
}

// Pipelines for ground, models and water.
Result<void> Pipelines::create_landscape(Making& making, bool lamps, MeshPipelines& out,
                                         UniquePipeline& water_out) {
  const OtherCode& code = other_code();
  const bool lit = traits_.pixel_light;
  PipelineShape meshes = usual_shape();
  meshes.frag = lit ? code.surface_lit_frag : code.surface_frag;
  meshes.constants = {on(traits_.fine_grain), on(traits_.cascades > 0), on(lamps)};
  const MeshLook look = lit ? MeshLook::kLit : MeshLook::kColour;
  PipelineShape water = usual_shape();
  water.kind = PipelineKind::kWater;
  water.vert = lit ? code.water_lit_vert : code.water_vert;
  water.frag = !lit ? code.surface_frag : mirrors() ? code.water_mirror_frag : code.water_frag;
  water.see_through = lit;
  water.constants = {on(traits_.waves), VK_FALSE, on(lamps)};
  return create_meshes(making, meshes, look, out)
      .and_then([&] { return create_near_ground(making, meshes, out); })
      .and_then([&] { return create_fading(making, meshes, look, out); })
      .and_then([&] { return make(making, water, water_out); });
}

Result<void> Pipelines::create_sky(Making& making) {
  const OtherCode& code = other_code();
  const bool dome = !traits_.pixel_light;
  PipelineShape shape = usual_shape();
  shape.kind = dome ? PipelineKind::kDome : PipelineKind::kSky;
  shape.vert = dome ? code.sky_dome_vert : code.sky_vert;
  shape.frag = dome ? code.sky_dome_frag : code.sky_frag;
  shape.constants = {VK_FALSE, on(traits_.fine_grain)};
  if (Result<void> made = make(making, shape, sky_); !made || !dome) return made;
  shape.vert = code.sky_below_vert;
  shape.frag = code.sky_frag;
  if (Result<void> made = make(making, shape, sky_below_); !made) return made;
  shape.kind = PipelineKind::kSun;
  shape.vert = code.sun_vert;
  shape.constants = {VK_TRUE, VK_FALSE};
  return make(making, shape, sun_);
}

// Pipelines for debugging views: draws in their debug colour, edges, lines.
Result<void> Pipelines::create_views(Making& making) {
  PipelineShape shape = usual_shape();
  shape.frag = other_code().surface_frag;
  return create_meshes(making, shape, MeshLook::kDrawColour, coloured_)
      .and_then([&] { return create_fading(making, shape, MeshLook::kDrawColour, coloured_); })
      .and_then([&] {
        PipelineShape lines = shape;
        lines.kind = PipelineKind::kLines;
        lines.vert = other_code().line_vert;
        return make(making, lines, lines_);
      })
      .and_then([&]() -> Result<void> {
        if (!making.device.info.wireframe) return {};
        shape.wireframe = true;
        return create_meshes(making, shape, MeshLook::kColour, wireframe_);
      });
}

VkPipeline Pipelines::mesh(core::VertexLayout layout, bool pushed, Coverage coverage, bool lamps,
                           View view) const {
  const bool edges = view == View::kWireframe && wireframe_.whole[0][0].get() != VK_NULL_HANDLE;
  const MeshPipelines& all = edges                 ? wireframe_
                             : colours_draws(view) ? coloured_
                             : lamps               ? lamplit_
                                                   : landscape_;
  return all.of(layout, pushed, edges ? Coverage::kWhole : coverage);
}

// The eight pipelines of a look. Those of kColour light textured objects per pixel.
Result<void> Pipelines::create_objects(Making& making, MeshLook look, bool wireframe, bool lamps,
                                       std::vector<UniquePipeline>& out) {
  const OtherCode& code = other_code();
  const bool views = wireframe || look == MeshLook::kDrawColour;
  for (std::size_t i = 0; i < 8; ++i) {
    const bool pushed = (i & 1U) != 0, textured = (i & 2U) != 0, fading = (i & 4U) != 0;
    out.emplace_back();
    if (textured && views) continue;
    PipelineShape shape = usual_shape();
    shape.kind = PipelineKind::kObject;
    shape.wireframe = wireframe;
    shape.shadow = look == MeshLook::kShadow;
    shape.constants = {VK_FALSE, on(traits_.cascades > 0), on(lamps)};
    const bool lit = look == MeshLook::kLit || (look == MeshLook::kColour && textured);
    if (shape.shadow) {
      shape.frag = !fading    ? ShaderCode{}
                   : textured ? code.object_shadow_frag
                              : code.shadow_fading_frag;
    } else if (lit) {
      shape.frag = textured
                       ? (fading ? code.object_textured_fading_frag : code.object_textured_frag)
                       : (fading ? code.object_fading_frag : code.object_frag);
    } else {
      shape.frag = fading ? code.surface_fading_frag : code.surface_frag;
    }
    shape.vert = object_vertex_code(lit ? MeshLook::kLit : look, pushed);
    if (Result<void> made = make(making, shape, out.back()); !made) return made;
  }
  return {};
}

Result<void> Pipelines::create_objects(const Device& device) {
  if (has_objects()) return {};
  const Progress nobody;
  Making making{device, nobody};
  ObjectPipelines made;
  const MeshLook look = traits_.pixel_light ? MeshLook::kLit : MeshLook::kColour;
  return create_objects(making, look, false, false, made.whole)
      .and_then([&] {
        return create_objects(making, MeshLook::kDrawColour, false, false, made.coloured);
      })
      .and_then([&]() -> Result<void> {
        if (!device.info.wireframe) return {};
        return create_objects(making, MeshLook::kColour, true, false, made.wireframe);
      })
      .and_then([&]() -> Result<void> {
        if (traits_.cascades == 0) return {};
        return create_objects(making, MeshLook::kShadow, false, false, made.shadow);
      })
      .and_then([&]() -> Result<void> {
        objects_ = std::move(made);
        return has_lamps() ? create_lamplit_objects(device) : Result<void>{};
      });
}

Result<void> Pipelines::create_lamplit_objects(const Device& device) {
  const Progress nobody;
  Making making{device, nobody};
  objects_.lamplit.clear();
  return create_objects(making, traits_.pixel_light ? MeshLook::kLit : MeshLook::kColour, false,
                        true, objects_.lamplit);
}

Result<void> Pipelines::create_lamps(const Device& device) {
  if (has_lamps()) return {};
  const Progress nobody;
  Making making{device, nobody};
  MeshPipelines made;
  UniquePipeline water;
  return create_landscape(making, true, made, water).and_then([&]() -> Result<void> {
    lamplit_ = std::move(made);
    if (has_objects()) {
      if (Result<void> objects = create_lamplit_objects(device); !objects) return objects;
    }
    lamplit_water_ = std::move(water);
    return {};
  });
}

Result<void> Pipelines::create_particles(const Device& device) {
  if (has_particles()) return {};
  const Progress nobody;
  Making making{device, nobody};
  PipelineShape shape = usual_shape();
  shape.kind = PipelineKind::kParticles;
  shape.vert = other_code().particle_vert;
  shape.constants[2] = VK_TRUE;
  shape.frag = other_code().particle_textured_frag;
  if (Result<void> made = make(making, shape, particles_[1]); !made) return made;
  shape.frag = other_code().particle_frag;
  return make(making, shape, particles_[0]);
}

VkPipeline Pipelines::object(bool pushed, bool textured, bool fading, bool lamps, View view) const {
  if (colours_draws(view)) return objects_.coloured[index_of_object(pushed, false, fading)].get();
  if (view == View::kWireframe && !objects_.wireframe.empty())
    return objects_.wireframe[index_of_object(pushed, false, false)].get();
  return (lamps ? objects_.lamplit : objects_.whole)[index_of_object(pushed, textured, fading)]
      .get();
}

Result<void> Pipelines::create_sets(const Device& device, std::uint32_t count) {
  const std::vector<VkDescriptorSetLayout> layouts(count, set_layout_.get());
  sets_.resize(count);
  VkDescriptorSetAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
  info.descriptorPool = descriptor_pool_.get();
  info.descriptorSetCount = count;
  info.pSetLayouts = layouts.data();
  const VkResult result = device.vk.vkAllocateDescriptorSets(device.handle, &info, sets_.data());
  if (result != VK_SUCCESS) return vulkan_failure(result, "allocating descriptor sets");
  return {};
}

void Pipelines::write_set(const Device& device, VkDescriptorSet set, const Buffer& frame,
                          const Buffer& draws, const Buffer& glyphs, const Buffer& emitters,
                          const Buffer& shade) const {
  const VkDescriptorBufferInfo frame_info{frame.buffer.get(), 0, VK_WHOLE_SIZE};
  const VkDescriptorBufferInfo draws_info{draws.buffer.get(), 0, VK_WHOLE_SIZE};
  const VkDescriptorBufferInfo glyphs_info{glyphs.buffer.get(), 0, VK_WHOLE_SIZE};
  const VkDescriptorBufferInfo emitters_info{emitters.buffer.get(), 0,
                                             sizeof(shaders::EmitterData)};
  const VkDescriptorBufferInfo shade_info{shade.buffer.get(), 0, VK_WHOLE_SIZE};
  const VkDescriptorBufferInfo materials_info{materials_->buffer().buffer.get(), 0, VK_WHOLE_SIZE};
  const VkDescriptorImageInfo clouds_info{VK_NULL_HANDLE, clouds_.view.get(),
                                          VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  const VkDescriptorImageInfo font_info{VK_NULL_HANDLE, font_.view.get(),
                                        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  const VkDescriptorImageInfo ground_info{VK_NULL_HANDLE, ground_.view(),
                                          VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  const VkDescriptorImageInfo pictures_info{VK_NULL_HANDLE, pictures_->view(),
                                            VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  const VkDescriptorImageInfo shadows_info{VK_NULL_HANDLE, shadows_.all_layers(),
                                           VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL};
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
      write(PSYGEN_BINDING_GLYPHS, storage, &glyphs_info, nullptr),
      write(PSYGEN_BINDING_SHADOWS, texture, nullptr, &shadows_info),
      write(PSYGEN_BINDING_MATERIALS, storage, &materials_info, nullptr),
      write(PSYGEN_BINDING_GROUND, texture, nullptr, &ground_info),
      write(PSYGEN_BINDING_SHADE, storage, &shade_info, nullptr),
      write(PSYGEN_BINDING_PICTURES, texture, nullptr, &pictures_info),
      write(PSYGEN_BINDING_EMITTER, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, &emitters_info,
            nullptr)};
  device.vk.vkUpdateDescriptorSets(device.handle, static_cast<std::uint32_t>(writes.size()),
                                   writes.data(), 0, nullptr);
}

void Pipelines::write_mirror(const Device& device, VkDescriptorSet set,
                             const Mirror& mirror) const {
  if (!mirror.exists()) return;
  const std::array images{VkDescriptorImageInfo{VK_NULL_HANDLE, mirror.colour.view.get(),
                                                VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
                          VkDescriptorImageInfo{VK_NULL_HANDLE, mirror.depth.view.get(),
                                                VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL}};
  std::array<VkWriteDescriptorSet, 2> writes{};
  for (std::size_t i = 0; i < writes.size(); ++i) {
    writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    writes[i].dstSet = set;
    writes[i].dstBinding = i == 0 ? PSYGEN_BINDING_MIRROR : PSYGEN_BINDING_MIRROR_DEPTH;
    writes[i].descriptorCount = 1;
    writes[i].descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    writes[i].pImageInfo = &images[i];
  }
  device.vk.vkUpdateDescriptorSets(device.handle, static_cast<std::uint32_t>(writes.size()),
                                   writes.data(), 0, nullptr);
}

}  // namespace psygen::render
