// The furthest depth of squares of pixels, from 2 x 2 upwards by doubling, made from a picture's
// depth. Its level l covers 2^(l + 1) pixels a side; the last level is one texel. Private to
// engine/render.
#pragma once

#include <vector>

#include "engine/render/compute_pipeline.hpp"

namespace psygen::render {

class DepthPyramid {
 public:
  // Most levels that a picture of any size has.
  static constexpr std::uint32_t kMaxLevels = 16;

  // Once, before everything else; for depth with so many samples per pixel.
  core::Result<void> create(const Device& device, VkSampleCountFlagBits samples);
  // For pictures of this size with this depth, which has been made to be sampled; null: nothing is
  // recorded. The device must
  // be idle.
  core::Result<void> resize(const Device& device, core::Extent size, const Image* depth);

  std::uint32_t level_count() const { return static_cast<std::uint32_t>(views_.size()); }
  VkSampler sampler() const { return sampler_.get(); }
  VkImageView view() const { return whole_.get(); }  // read in VK_IMAGE_LAYOUT_GENERAL

  // Takes the depth as an attachment that was drawn to and leaves it, and the pyramid, readable by
  // compute shaders (DEPTH_READ_ONLY_OPTIMAL, GENERAL).
  void record(const Device& device, VkCommandBuffer commands, const Image& depth) const;

 private:
  void write_sets(const Device& device, const Image* depth) const;

  ComputePipeline first_, next_;  // from the depth; from the level below
  UniqueSampler sampler_;
  UniqueMemory memory_;
  UniqueImage image_;
  UniqueImageView whole_;
  std::vector<UniqueImageView> views_;  // of each level
  core::Extent size_;                   // of the picture
};

}  // namespace psygen::render
