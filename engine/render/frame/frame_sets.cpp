#include "engine/render/frame/frame_sets.hpp"

#include <utility>

#include "engine/render/device/descriptors.hpp"
#include "engine/render/frame/pass_set.hpp"
#include "engine/render/textures/cloud_texture.hpp"
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
    Binding{PSYGEN_BINDING_CLOUDS, kTextureType, kFragment},
    Binding{PSYGEN_BINDING_SHADOWS, kTextureType, kFragment},
    Binding{PSYGEN_BINDING_MATERIALS, kBufferType, kBoth},
    Binding{PSYGEN_BINDING_GROUND, kTextureType, kFragment},
    Binding{PSYGEN_BINDING_SHADE, kBufferType, kBoth},
    Binding{PSYGEN_BINDING_PICTURES, kTextureType, kFragment}};
static_assert([] {
  for (std::size_t i = 0; i < kBindings.size(); ++i)
    if (kBindings[i].number != i) return false;
  return true;
}());

// A write to a set: of a buffer or an image; the other one stays null.
struct Named {
  std::uint32_t binding;
  VkDescriptorBufferInfo buffer{};
  VkDescriptorImageInfo image{};
};
Named named(std::uint32_t binding, const Buffer& buffer) {
  return {binding, {buffer.buffer.get(), 0, VK_WHOLE_SIZE}, {}};
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

}  // namespace

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
  return create_samplers(device)
      .and_then([&]() -> Result<void> {
        const std::vector<std::uint16_t> texels = make_cloud_texture();
        Result<Image> made =
            make_texture(device, {kCloudTextureSize, kCloudTextureSize}, VK_FORMAT_R16G16_SFLOAT,
                         std::as_bytes(std::span(texels)));
        if (!made) return tl::unexpected(made.error());
        clouds_ = std::move(*made);
        return {};
      })
      .and_then([&] { return ground_.create(device, input.traits, input.ground); })
      .and_then([&] { return shadows_.create(device, input.traits); })
      .and_then([&] { return create_sets(device, static_cast<std::uint32_t>(slots)); });
}

Result<void> FrameSets::create_samplers(const Device& device) {
  constexpr VkSamplerAddressMode kClamp = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  return make_plain_sampler(device, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT,
                            cloud_sampler_)
      .and_then(
          [&] { return make_plain_sampler(device, VK_FILTER_LINEAR, kClamp, smooth_sampler_); })
      .and_then(
          [&] { return make_plain_sampler(device, VK_FILTER_NEAREST, kClamp, nearest_sampler_); });
}

Result<void> FrameSets::create_sets(const Device& device, std::uint32_t count) {
  std::array<const VkSampler*, kBindings.size()> samplers{};
  samplers[PSYGEN_BINDING_CLOUDS] = cloud_sampler_.address();
  samplers[PSYGEN_BINDING_SHADOWS] = shadows_.sampler();
  samplers[PSYGEN_BINDING_GROUND] = ground_.sampler();
  samplers[PSYGEN_BINDING_PICTURES] = pictures_->sampler();
  std::array<VkDescriptorSetLayoutBinding, kBindings.size()> bindings{};
  for (std::size_t i = 0; i < kBindings.size(); ++i)
    bindings[i] = {kBindings[i].number, kBindings[i].type, 1, kBindings[i].stages, samplers[i]};
  Result<UniqueSetLayout> set_layout = make_set_layout(device, bindings);
  if (!set_layout) return tl::unexpected(set_layout.error());
  set_layout_ = std::move(*set_layout);
  Result<UniqueDescriptorPool> pool = make_descriptor_pool(device, bindings, count);
  if (!pool) return tl::unexpected(pool.error());
  pool_ = std::move(*pool);
  auto allocated = allocate_sets(device, pool_.get(), set_layout_.get(), count);
  if (!allocated) return tl::unexpected(allocated.error());
  sets_ = std::move(*allocated);
  Result<UniquePipelineLayout> layout = make_pipeline_layout(device, shared(), push_range());
  if (!layout) return tl::unexpected(layout.error());
  layout_ = std::move(*layout);
  return {};
}

VkDescriptorImageInfo FrameSets::any_image() const {
  return {VK_NULL_HANDLE, clouds_.view.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

void FrameSets::write(const Device& device, std::size_t slot, const SlotBuffers& buffers) const {
  const std::array all{
      named(PSYGEN_BINDING_FRAME, buffers.frame),
      named(PSYGEN_BINDING_DRAWS, buffers.draws),
      named(PSYGEN_BINDING_CLOUDS, clouds_.view.get()),
      named(PSYGEN_BINDING_SHADOWS, shadows_.all_layers(), VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL),
      named(PSYGEN_BINDING_MATERIALS, materials_->buffer()),
      named(PSYGEN_BINDING_GROUND, ground_.view()),
      named(PSYGEN_BINDING_SHADE, buffers.shade),
      named(PSYGEN_BINDING_PICTURES, pictures_->view())};
  write_named(device, sets_[slot], all);
}

void FrameSets::write_draws(const Device& device, std::size_t slot, const Buffer& draws) const {
  write_named(device, sets_[slot], std::array{named(PSYGEN_BINDING_DRAWS, draws)});
}

void FrameSets::bind(const Device& device, VkCommandBuffer commands, std::size_t slot) const {
  device.vk.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.get(), 0, 1,
                                    &sets_[slot], 0, nullptr);
}

void FrameSets::bind_textures(const Device& device, VkCommandBuffer commands,
                              VkDescriptorSet textures) const {
  device.vk.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.get(), 1, 1,
                                    &textures, 0, nullptr);
}

}  // namespace psygen::render
