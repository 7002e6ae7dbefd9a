// The depth pyramid: the furthest depth of squares of pixels, computed from a picture's depth. A
// texel of level l covers 2^(l + 1) pixels per side; the last level is one texel. It tests nothing
// itself (gpu_culling.hpp). Main thread. Private to engine/render.
#pragma once

#include <vector>

#include "engine/render/device/pipeline_build.hpp"
#include "engine/render/memory/memory.hpp"

namespace psygen::render {

// Empty until create() and resize(). The device must outlive it.
class DepthPyramid {
 public:
  // Largest number of levels for a picture of any size.
  static constexpr std::uint32_t kMaxLevels = 16;

  // Creates the pipelines, once, before everything else. `samples` is that of the depth image.
  core::Result<void> create(const Device& device, VkSampleCountFlagBits samples);
  // Creates the image for pictures of this size. `depth` must be usable as a sampled image; with
  // null, record() must not be called. The device must be idle. Waits for it.
  core::Result<void> resize(const Device& device, core::Extent size, const Image* depth);

  // For shaders that read the pyramid: its levels, a nearest sampler, and a view of all levels.
  std::uint32_t level_count() const { return static_cast<std::uint32_t>(views_.size()); }
  VkSampler sampler() const { return sampler_.get(); }
  VkImageView view() const { return image_.view.get(); }  // read in VK_IMAGE_LAYOUT_GENERAL

  // Records the computation. `depth` is an attachment that was drawn to, in its corner of
  // `drawn_size`, at most the size of the pictures. Afterwards it and the pyramid are readable by
  // compute shaders (DEPTH_READ_ONLY_OPTIMAL, GENERAL).
  void record(const Device& device, VkCommandBuffer commands, const Image& depth,
              core::Extent drawn_size) const;

 private:
  void write_sets(const Device& device, const Image* depth) const;

  ComputePipeline first_, next_;  // from the depth; from the previous level
  UniqueSampler sampler_;
  Image image_;
  std::vector<UniqueImageView> views_;  // of each level
};

}  // namespace psygen::render
