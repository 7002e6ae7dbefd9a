#include "engine/render/passes/depth_pyramid.hpp"

#include <bit>
#include <glm/ext/vector_int2.hpp>

#include "engine/render/device/shaders.hpp"

namespace psygen::render {

using core::Result;

namespace {

constexpr VkFormat kFormat = VK_FORMAT_R32_SFLOAT;
constexpr std::uint32_t kThreads = 8;  // per side of a workgroup, as in depth_pyramid.comp

core::Extent half(core::Extent size) {
  return {(size.width + 1) / 2, (size.height + 1) / 2};
}

std::uint32_t levels_for(core::Extent picture) {
  std::uint32_t levels = 1;
  for (core::Extent size = half(picture); size.width > 1 || size.height > 1; size = half(size))
    ++levels;
  return levels;
}

Result<UniqueSampler> make_nearest_sampler(const Device& device) {
  VkSamplerCreateInfo info{};
  info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  info.maxLod = VK_LOD_CLAMP_NONE;
  return make_sampler(device, info);
}

Result<UniqueImageView> make_view(const Device& device, VkImage image, std::uint32_t first_level,
                                  std::uint32_t levels) {
  VkImageViewCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  info.image = image;
  info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  info.format = kFormat;
  info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, first_level, levels, 0, 1};
  VkImageView view = VK_NULL_HANDLE;
  const VkResult result = device.vk.vkCreateImageView(device.handle, &info, nullptr, &view);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating an image view");
  return UniqueImageView(device.vk, device.handle, view);
}

}  // namespace

Result<void> DepthPyramid::create(const Device& device, VkSampleCountFlagBits samples) {
  const VkDescriptorType target = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  const VkDescriptorType from_depth[] = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, target};
  const VkDescriptorType from_level[] = {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, target};
  const Shader first = samples == VK_SAMPLE_COUNT_1_BIT ? Shader::kDepthPyramidFromDepthComp
                                                        : Shader::kDepthPyramidSamplesComp;
  Result<UniqueSampler> sampler = make_nearest_sampler(device);
  if (!sampler) return tl::unexpected(sampler.error());
  sampler_ = std::move(*sampler);
  return first_.create(device, code_of(first), from_depth, sizeof(glm::ivec2), 1).and_then([&] {
    return next_.create(device, code_of(Shader::kDepthPyramidComp), from_level, sizeof(glm::ivec2),
                        kMaxLevels);
  });
}

Result<void> DepthPyramid::resize(const Device& device, core::Extent size, const Image* depth) {
  views_.clear();
  const std::uint32_t levels = levels_for(size);
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = kFormat;
  // Mip levels are halves rounded down, those of the pyramid are rounded up. With powers of two
  // they are the same.
  info.extent = {std::bit_ceil(half(size).width), std::bit_ceil(half(size).height), 1};
  info.mipLevels = levels;
  info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  VkImage image = VK_NULL_HANDLE;
  const VkResult result = device.vk.vkCreateImage(device.handle, &info, nullptr, &image);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating an image");
  whole_ = {};
  image_ = UniqueImage(device.vk, device.handle, image);
  Result<UniqueMemory> memory = bind_image_memory(device, image);
  if (!memory) return tl::unexpected(memory.error());
  memory_ = std::move(*memory);
  Result<UniqueImageView> whole = make_view(device, image, 0, levels);
  if (!whole) return tl::unexpected(whole.error());
  whole_ = std::move(*whole);
  for (std::uint32_t level = 0; level < levels; ++level) {
    Result<UniqueImageView> view = make_view(device, image, level, 1);
    if (!view) return tl::unexpected(view.error());
    views_.push_back(std::move(*view));
  }
  write_sets(device, depth);
  // Shaders that could read the image are bound before it is first written.
  return run_once(device, [&](VkCommandBuffer commands) {
    VkImageMemoryBarrier2 barrier = barrier_of(image, VK_IMAGE_ASPECT_COLOR_BIT);
    barrier.subresourceRange.levelCount = levels;
    barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
    image_barrier(device, commands, barrier);
  });
}

void DepthPyramid::write_sets(const Device& device, const Image* depth) const {
  if (depth == nullptr) return;
  first_.write_image(device, 0, 0, sampler_.get(), depth->view.get(),
                     VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL);
  first_.write_image(device, 0, 1, VK_NULL_HANDLE, views_[0].get(), VK_IMAGE_LAYOUT_GENERAL);
  for (std::size_t level = 1; level < views_.size(); ++level) {
    next_.write_image(device, level, 0, VK_NULL_HANDLE, views_[level - 1].get(),
                      VK_IMAGE_LAYOUT_GENERAL);
    next_.write_image(device, level, 1, VK_NULL_HANDLE, views_[level].get(),
                      VK_IMAGE_LAYOUT_GENERAL);
  }
}

void DepthPyramid::record(const Device& device, VkCommandBuffer commands, const Image& depth,
                          core::Extent drawn_size) const {
  VkImageMemoryBarrier2 drawn = barrier_of(depth.image.get(), VK_IMAGE_ASPECT_DEPTH_BIT);
  drawn.srcStageMask =
      VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
  drawn.srcAccessMask = VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
  drawn.dstStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  drawn.dstAccessMask = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
  drawn.oldLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  drawn.newLayout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL;
  image_barrier(device, commands, drawn);
  // The old content is discarded after the last frame has read it.
  VkImageMemoryBarrier2 own = barrier_of(image_.get(), VK_IMAGE_ASPECT_COLOR_BIT);
  own.subresourceRange.levelCount = level_count();
  own.srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  own.dstStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  own.dstAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
  own.newLayout = VK_IMAGE_LAYOUT_GENERAL;
  image_barrier(device, commands, own);

  core::Extent source = drawn_size;
  for (std::size_t level = 0; level < views_.size(); ++level) {
    const ComputePipeline& pipeline = level == 0 ? first_ : next_;
    const core::Extent target = half(source);
    const glm::ivec2 push(source.width, source.height);
    pipeline.bind(device, commands, level);
    pipeline.dispatch(device, commands, &push, (target.width + kThreads - 1) / kThreads,
                      (target.height + kThreads - 1) / kThreads);
    memory_barrier(device, commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                   VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                   VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT);
    source = target;
  }
}

}  // namespace psygen::render
