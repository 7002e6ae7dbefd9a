// The depth images of the sun's shadow, one layer per cascade, and the place of each cascade.
// Without cascades it is one texel that nothing reads. Draws no meshes itself (passes/shadows.hpp).
// Main thread. Private to engine/render.
#pragma once

#include <functional>

#include "engine/render/memory/memory.hpp"
#include "engine/render/preset.hpp"
#include "shaders/shared.h"

namespace psygen::render {

// Empty until create(). The device must outlive it.
class ShadowMaps {
 public:
  // Creates the images of a preset and makes them readable. Waits for the device.
  core::Result<void> create(const Device& device, const PresetTraits& traits);

  // The comparing sampler, a view of all layers, and their number without the unused texel.
  const VkSampler* sampler() const { return sampler_.address(); }
  VkImageView all_layers() const { return image_.view.get(); }
  std::uint32_t cascades() const { return cascades_; }

  // Records, outside of a rendering: clears every cascade i, calls draw(i) inside its rendering,
  // and makes all of them readable by fragment shaders.
  void record(const Device& device, VkCommandBuffer commands,
              const std::function<void(std::uint32_t)>& draw) const;

 private:
  Image image_;
  std::array<UniqueImageView, PSYGEN_MAX_CASCADES> layers_;
  UniqueSampler sampler_;
  std::uint32_t cascades_ = 0, size_ = 1;
};

}  // namespace psygen::render
