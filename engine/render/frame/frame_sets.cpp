#include "engine/render/frame/frame_sets.hpp"

#include "engine/render/textures/cloud_texture.hpp"
#include "engine/render/textures/ground_textures.hpp"
#include "shaders/shared.h"

static_assert(PSYGEN_GROUND_SIDE == psygen::render::kPatternSide);
static_assert(PSYGEN_GROUND_TEXTURES == psygen::render::kGroundTextures);
static_assert(PSYGEN_NEAR_GROUND_M == psygen::render::kNearGroundM);
static_assert(PSYGEN_NEAR_MODELS_M == psygen::render::kNearModelsM);

namespace psygen::render {

using core::Result;

VkPushConstantRange push_range() {
  return {VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(shaders::DrawData) + sizeof(std::uint32_t)};
}

Result<Image> make_texture(const Device& device, core::Extent size, VkFormat format,
                           std::span<const std::byte> texels) {
  Result<Image> image =
      make_image(device, size, format, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                 VK_IMAGE_ASPECT_COLOR_BIT);
  if (!image) return image;
  if (Result<void> filled = upload_image(device, *image, size, {&texels, 1}); !filled)
    return tl::unexpected(filled.error());
  return image;
}

Result<void> FrameSets::create(const Device& device, std::size_t slots,
                               const FrameSetsInput& input) {
  materials_ = &input.materials;
  pictures_ = &input.pictures;
  const std::vector<std::uint16_t> clouds = make_cloud_texture();
  return create_samplers(device)
      .and_then([&] {
        return make_texture(device, {kCloudTextureSize, kCloudTextureSize}, VK_FORMAT_R16G16_SFLOAT,
                            std::as_bytes(std::span(clouds)));
      })
      .map(into(clouds_))
      .and_then([&] { return create_ground(device, input); })
      .and_then([&] { return shadows_.create(device, input.traits); })
      .and_then([&] { return create_sets(device, slots); })
      .and_then([&] { return make_pipeline_layout(device, shared(), push_range()); })
      .map(into(layout_));
}

Result<void> FrameSets::create_samplers(const Device& device) {
  constexpr VkSamplerAddressMode kClamp = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  return make_sampler(device, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT)
      .map(into(cloud_sampler_))
      .and_then([&] { return make_sampler(device, VK_FILTER_LINEAR, kClamp); })
      .map(into(smooth_sampler_))
      .and_then([&] { return make_sampler(device, VK_FILTER_NEAREST, kClamp); })
      .map(into(nearest_sampler_));
}

// The textures of the ground: for presets with light per pixel all of them as layers, else those of
// brightness.
Result<void> FrameSets::create_ground(const Device& device, const FrameSetsInput& input) {
  // Two levels at once would cost software devices twice as much.
  const VkSamplerMipmapMode between =
      input.traits.fine_grain ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
  const GroundLevels levels = input.traits.pixel_light ? make_ground_layers(input.ground)
                                                       : make_ground_detail(input.ground);
  const std::uint32_t layers = input.traits.pixel_light ? kGroundLayers : kDetailLayers;
  return make_sampler(device, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT,
                      {.mipmapMode = between, .maxLod = VK_LOD_CLAMP_NONE})
      .map(into(ground_sampler_))
      .and_then([&] {
        return make_image(
            device, {kPatternSide, kPatternSide}, VK_FORMAT_R8G8B8A8_UNORM,
            VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, VK_IMAGE_ASPECT_COLOR_BIT,
            {.array = true, .layers = layers, .mips = static_cast<std::uint32_t>(levels.size())});
      })
      .map(into(ground_))
      .and_then([&] {
        std::vector<std::span<const std::byte>> bytes;
        for (const auto& level : levels)
          bytes.push_back(std::as_bytes(std::span(level)));
        return upload_image(device, ground_, {kPatternSide, kPatternSide}, bytes, layers);
      });
}

Result<void> FrameSets::create_sets(const Device& device, std::size_t count) {
  constexpr VkDescriptorType kTexture = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                             kBuffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  constexpr VkShaderStageFlags kVertex = VK_SHADER_STAGE_VERTEX_BIT,
                               kFragment = VK_SHADER_STAGE_FRAGMENT_BIT,
                               kBoth = kVertex | kFragment;
  std::array<SetBinding, 8> bindings{};
  bindings[PSYGEN_BINDING_FRAME] = {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kBoth};
  bindings[PSYGEN_BINDING_DRAWS] = {kBuffer, kVertex};
  bindings[PSYGEN_BINDING_CLOUDS] = {kTexture, kFragment, cloud_sampler_.address()};
  bindings[PSYGEN_BINDING_SHADOWS] = {kTexture, kFragment, shadows_.sampler()};
  bindings[PSYGEN_BINDING_MATERIALS] = {kBuffer, kBoth};
  bindings[PSYGEN_BINDING_GROUND] = {kTexture, kFragment, ground_sampler_.address()};
  bindings[PSYGEN_BINDING_SHADE] = {kBuffer, kBoth};
  bindings[PSYGEN_BINDING_PICTURES] = {kTexture, kFragment, pictures_->sampler()};
  return sets_.create(device, bindings, count);
}

VkDescriptorImageInfo FrameSets::any_image() const {
  return {VK_NULL_HANDLE, clouds_.view.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

void FrameSets::write(const Device& device, std::size_t slot, const SlotBuffers& buffers) const {
  const auto buffer = [&](std::uint32_t binding, const Buffer& named) {
    sets_.write(device, slot, binding, named.buffer.get());
  };
  const auto image = [&](std::uint32_t binding, VkImageView view,
                         VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL) {
    sets_.write(device, slot, binding, {VK_NULL_HANDLE, view, layout});
  };
  buffer(PSYGEN_BINDING_FRAME, buffers.frame);
  buffer(PSYGEN_BINDING_DRAWS, buffers.draws);
  buffer(PSYGEN_BINDING_MATERIALS, materials_->buffer());
  buffer(PSYGEN_BINDING_SHADE, buffers.shade);
  image(PSYGEN_BINDING_CLOUDS, clouds_.view.get());
  image(PSYGEN_BINDING_SHADOWS, shadows_.all_layers(), VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL);
  image(PSYGEN_BINDING_GROUND, ground_.view.get());
  image(PSYGEN_BINDING_PICTURES, pictures_->view());
}

void FrameSets::write_draws(const Device& device, std::size_t slot, const Buffer& draws) const {
  sets_.write(device, slot, PSYGEN_BINDING_DRAWS, draws.buffer.get());
}

void FrameSets::bind(const Device& device, VkCommandBuffer commands, std::size_t slot) const {
  device.vk.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.get(), 0, 1,
                                    &sets_[slot], 0, nullptr);
  constexpr std::array<std::byte, sizeof(shaders::DrawData) + sizeof(std::uint32_t)> kZeros{};
  device.vk.vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_VERTEX_BIT, 0,
                               kZeros.size(), kZeros.data());
}

void FrameSets::bind_textures(const Device& device, VkCommandBuffer commands,
                              VkDescriptorSet textures) const {
  device.vk.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.get(), 1, 1,
                                    &textures, 0, nullptr);
}

}  // namespace psygen::render
