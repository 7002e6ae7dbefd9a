#include "engine/render/bindings.hpp"

#include <utility>

#include "engine/render/cloud_texture.hpp"
#include "engine/render/descriptors.hpp"
#include "shaders/shared.h"

namespace psygen::render {

using core::Result;

namespace {

// A binding of the layout. All textures are read by fragment shaders.
struct Binding {
  std::uint32_t number;
  VkDescriptorType type;
  VkShaderStageFlags stages;
};
constexpr VkDescriptorType kTextureType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                           kBufferType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr VkShaderStageFlags kVertex = VK_SHADER_STAGE_VERTEX_BIT,
                             kFragment = VK_SHADER_STAGE_FRAGMENT_BIT, kBoth = kVertex | kFragment;
constexpr std::array kBindings{
    Binding{PSYGEN_BINDING_FRAME, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kBoth},
    Binding{PSYGEN_BINDING_DRAWS, kBufferType, kVertex},
    Binding{PSYGEN_BINDING_COARSE, kTextureType, kFragment},
    Binding{PSYGEN_BINDING_CLOUDS, kTextureType, kFragment},
    Binding{PSYGEN_BINDING_FONT, kTextureType, kFragment},
    Binding{PSYGEN_BINDING_GLYPHS, kBufferType, kVertex},
    Binding{PSYGEN_BINDING_SHADOWS, kTextureType, kFragment},
    Binding{PSYGEN_BINDING_MATERIALS, kBufferType, kBoth},
    Binding{PSYGEN_BINDING_EMITTER, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, kVertex},
    Binding{PSYGEN_BINDING_GROUND, kTextureType, kFragment},
    Binding{PSYGEN_BINDING_SHADE, kBufferType, kBoth},
    Binding{PSYGEN_BINDING_PICTURES, kTextureType, kFragment},
    Binding{PSYGEN_BINDING_MIRROR, kTextureType, kFragment},
    Binding{PSYGEN_BINDING_MIRROR_DEPTH, kTextureType, kFragment}};
static_assert([] {
  for (std::size_t i = 0; i < kBindings.size(); ++i)
    if (kBindings[i].number != i) return false;
  return true;
}());

static_assert(
    [] {
      for (const Binding& binding : kBindings)
        if (binding.type == kTextureType) return binding.number == PSYGEN_BINDING_COARSE;
      return false;
    }(),
    "the coarse landscape is the first texture (shaders/scale_up.frag)");

// What a write of a set names; the other one stays null.
struct Named {
  std::uint32_t binding;
  VkDescriptorBufferInfo buffer{};
  VkDescriptorImageInfo image{};
};
Named named(std::uint32_t binding, const Buffer& buffer, VkDeviceSize bytes = VK_WHOLE_SIZE) {
  return {binding, {buffer.buffer.get(), 0, bytes}, {}};
}
Named named(std::uint32_t binding, VkImageView view,
            VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL) {
  return {binding, {}, {VK_NULL_HANDLE, view, layout}};
}

void write_named(const Device& device, VkDescriptorSet set, std::span<const Named> all) {
  std::array<VkWriteDescriptorSet, kBindings.size()> writes{};
  for (std::size_t i = 0; i < all.size(); ++i) {
    VkWriteDescriptorSet& write = writes[i];
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = set;
    write.dstBinding = all[i].binding;
    write.descriptorCount = 1;
    write.descriptorType = kBindings[all[i].binding].type;
    if (write.descriptorType == kTextureType)
      write.pImageInfo = &all[i].image;
    else
      write.pBufferInfo = &all[i].buffer;
  }
  device.vk.vkUpdateDescriptorSets(device.handle, static_cast<std::uint32_t>(all.size()),
                                   writes.data(), 0, nullptr);
}

Result<void> make_plain_sampler(const Device& device, VkFilter filter, VkSamplerAddressMode mode,
                                UniqueSampler& out) {
  VkSamplerCreateInfo info{};
  info.magFilter = info.minFilter = filter;
  info.addressModeU = info.addressModeV = info.addressModeW = mode;
  Result<UniqueSampler> made = make_sampler(device, info);
  if (!made) return tl::unexpected(made.error());
  out = std::move(*made);
  return {};
}

Result<void> make_texture(const Device& device, core::Extent size, VkFormat format,
                          std::span<const std::byte> texels, Image& out) {
  Result<Image> image =
      make_image(device, size, format, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                 VK_IMAGE_ASPECT_COLOR_BIT);
  if (!image) return tl::unexpected(image.error());
  out = std::move(*image);
  return upload_image(device, out, size, {&texels, 1});
}

}  // namespace

Result<void> Bindings::create(const Device& device, const PresetTraits& traits,
                              const Overlay& overlay, std::uint32_t sets,
                              const MaterialTable& materials, const ModelPictures& pictures,
                              std::span<const GroundPicture> ground) {
  materials_ = &materials;
  pictures_ = &pictures;
  return create_samplers(device)
      .and_then([&] { return create_textures(device, overlay); })
      .and_then([&] { return ground_.create(device, traits, ground); })
      .and_then([&] { return shadows_.create(device, traits); })
      .and_then([&] { return create_sets(device, sets); })
      .and_then([&] { return create_layout(device); });
}

Result<void> Bindings::create_samplers(const Device& device) {
  constexpr VkSamplerAddressMode kClamp = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  return make_plain_sampler(device, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT,
                            cloud_sampler_)
      .and_then(
          [&] { return make_plain_sampler(device, VK_FILTER_LINEAR, kClamp, smooth_sampler_); })
      .and_then(
          [&] { return make_plain_sampler(device, VK_FILTER_NEAREST, kClamp, depth_sampler_); });
}

Result<void> Bindings::create_textures(const Device& device, const Overlay& overlay) {
  const std::vector<std::uint16_t> texels = make_cloud_texture();
  return make_texture(device, {kCloudTextureSize, kCloudTextureSize}, VK_FORMAT_R16G16_SFLOAT,
                      std::as_bytes(std::span(texels)), clouds_)
      .and_then([&] {
        return make_texture(device, overlay.atlas_size(), VK_FORMAT_R8_UNORM, overlay.atlas(),
                            font_);
      });
}

Result<void> Bindings::create_sets(const Device& device, std::uint32_t sets) {
  std::array<const VkSampler*, kBindings.size()> samplers{};
  samplers[PSYGEN_BINDING_CLOUDS] = cloud_sampler_.address();
  for (const std::size_t smooth :
       {PSYGEN_BINDING_FONT, PSYGEN_BINDING_MIRROR, PSYGEN_BINDING_COARSE})
    samplers[smooth] = smooth_sampler_.address();
  samplers[PSYGEN_BINDING_SHADOWS] = shadows_.sampler();
  samplers[PSYGEN_BINDING_GROUND] = ground_.sampler();
  samplers[PSYGEN_BINDING_PICTURES] = pictures_->sampler();
  samplers[PSYGEN_BINDING_MIRROR_DEPTH] = depth_sampler_.address();
  std::array<VkDescriptorSetLayoutBinding, kBindings.size()> bindings{};
  for (std::size_t i = 0; i < kBindings.size(); ++i)
    bindings[i] = {kBindings[i].number, kBindings[i].type, 1, kBindings[i].stages, samplers[i]};
  Result<UniqueSetLayout> layout = make_set_layout(device, bindings);
  if (!layout) return tl::unexpected(layout.error());
  set_layout_ = std::move(*layout);
  Result<UniqueDescriptorPool> pool = make_descriptor_pool(device, bindings, sets);
  if (!pool) return tl::unexpected(pool.error());
  pool_ = std::move(*pool);
  auto allocated = allocate_sets(device, pool_.get(), set_layout_.get(), sets);
  if (!allocated) return tl::unexpected(allocated.error());
  sets_ = std::move(*allocated);
  return {};
}

// The sets of a slot and of a material; the data of a pushed draw, and the number of a cascade.
Result<void> Bindings::create_layout(const Device& device) {
  const VkPushConstantRange push{VK_SHADER_STAGE_VERTEX_BIT, 0,
                                 sizeof(shaders::DrawData) + sizeof(std::uint32_t)};
  const std::array sets{set_layout_.get(), materials_->set_layout()};
  Result<UniquePipelineLayout> layout = make_pipeline_layout(device, sets, push);
  if (!layout) return tl::unexpected(layout.error());
  layout_ = std::move(*layout);
  return {};
}

void Bindings::write(const Device& device, VkDescriptorSet set, const SlotBuffers& buffers) const {
  const std::array all{
      named(PSYGEN_BINDING_FRAME, buffers.frame),
      named(PSYGEN_BINDING_DRAWS, buffers.draws),
      named(PSYGEN_BINDING_CLOUDS, clouds_.view.get()),
      named(PSYGEN_BINDING_FONT, font_.view.get()),
      named(PSYGEN_BINDING_GLYPHS, buffers.glyphs),
      named(PSYGEN_BINDING_SHADOWS, shadows_.all_layers(), VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL),
      named(PSYGEN_BINDING_MATERIALS, materials_->buffer()),
      named(PSYGEN_BINDING_EMITTER, buffers.emitters, sizeof(shaders::EmitterData)),
      named(PSYGEN_BINDING_GROUND, ground_.view()),
      named(PSYGEN_BINDING_SHADE, buffers.shade),
      named(PSYGEN_BINDING_PICTURES, pictures_->view())};
  write_named(device, set, all);
}

void Bindings::write_targets(const Device& device, VkDescriptorSet set,
                             const Targets& targets) const {
  // lavapipe looks at all images of a set, also at those that no shader reads.
  const auto or_clouds = [&](const Image& image) {
    return (image.view.get() != VK_NULL_HANDLE ? image : clouds_).view.get();
  };
  const bool coarse = targets.coarse.view.get() != VK_NULL_HANDLE;
  const std::array all{named(PSYGEN_BINDING_MIRROR, or_clouds(targets.mirror.colour)),
                       named(PSYGEN_BINDING_MIRROR_DEPTH, or_clouds(targets.mirror.depth)),
                       named(PSYGEN_BINDING_COARSE, or_clouds(targets.coarse),
                             coarse ? kCoarseLayout : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL)};
  write_named(device, set, all);
}

}  // namespace psygen::render
