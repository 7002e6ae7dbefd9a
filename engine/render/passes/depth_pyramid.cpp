#include "engine/render/passes/depth_pyramid.hpp"

#include <bit>
#include <glm/ext/vector_int2.hpp>

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

}  // namespace

Result<void> DepthPyramid::create(const Device& device, VkSampleCountFlagBits samples) {
  const VkDescriptorType target = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  const VkDescriptorType from_depth[] = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, target};
  const VkDescriptorType from_level[] = {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, target};
  const Shader first = samples == VK_SAMPLE_COUNT_1_BIT ? Shader::kDepthPyramidFromDepthComp
                                                        : Shader::kDepthPyramidSamplesComp;
  return make_sampler(device, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                      {.maxLod = VK_LOD_CLAMP_NONE})
      .map(into(sampler_))
      .and_then([&] { return first_.create(device, first, from_depth, sizeof(glm::ivec2), 1); })
      .and_then([&] {
        return next_.create(device, Shader::kDepthPyramidComp, from_level, sizeof(glm::ivec2),
                            kMaxLevels);
      });
}

Result<void> DepthPyramid::resize(const Device& device, core::Extent size, const Image* depth) {
  views_.clear();
  const std::uint32_t levels = levels_for(size);
  // Mip levels are halves rounded down, those of the pyramid are rounded up. With powers of two
  // they are the same.
  Result<void> made =
      make_image(device, {std::bit_ceil(half(size).width), std::bit_ceil(half(size).height)},
                 kFormat, VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                 VK_IMAGE_ASPECT_COLOR_BIT, {.mips = levels})
          .map(into(image_));
  for (std::uint32_t level = 0; made && level < levels; ++level) {
    made =
        make_view(device, image_.image.get(), kFormat, {VK_IMAGE_ASPECT_COLOR_BIT, level, 1, 0, 1})
            .map([this](UniqueImageView view) { views_.push_back(std::move(view)); });
  }
  if (!made) return made;
  write_sets(device, depth);
  // Shaders that could read the image are bound before it is first written.
  return run_once(device, [&](VkCommandBuffer commands) {
    constexpr ImageUse kAny{VK_PIPELINE_STAGE_2_NONE, VK_ACCESS_2_NONE, VK_IMAGE_LAYOUT_GENERAL};
    image_barrier(device, commands,
                  barrier_of(image_.image.get(), VK_IMAGE_ASPECT_COLOR_BIT, {}, kAny));
  });
}

void DepthPyramid::write_sets(const Device& device, const Image* depth) const {
  if (depth == nullptr) return;
  const auto level_image = [&](std::size_t level) -> VkDescriptorImageInfo {
    return {VK_NULL_HANDLE, views_[level].get(), VK_IMAGE_LAYOUT_GENERAL};
  };
  first_.sets().write(device, 0, 0,
                      {sampler_.get(), depth->view.get(), VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL});
  first_.sets().write(device, 0, 1, level_image(0));
  for (std::size_t level = 1; level < views_.size(); ++level) {
    next_.sets().write(device, level, 0, level_image(level - 1));
    next_.sets().write(device, level, 1, level_image(level));
  }
}

void DepthPyramid::record(const Device& device, VkCommandBuffer commands, const Image& depth,
                          core::Extent drawn_size) const {
  constexpr ImageUse kRead{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                           VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                           VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL},
      kDrawn{kDepthAttachment.stages, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
             kDepthAttachment.layout};
  image_barrier(device, commands,
                barrier_of(depth.image.get(), VK_IMAGE_ASPECT_DEPTH_BIT, kDrawn, kRead));
  // The old content is discarded after the last frame has read it.
  constexpr ImageUse kForgotten{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT},
      kWritten{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
               VK_IMAGE_LAYOUT_GENERAL};
  image_barrier(device, commands,
                barrier_of(image_.image.get(), VK_IMAGE_ASPECT_COLOR_BIT, kForgotten, kWritten));

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
