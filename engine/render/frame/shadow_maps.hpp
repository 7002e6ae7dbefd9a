// The depth image of the sun's shadow, one layer per cascade, and the renderings on it. Without
// cascades it is one texel that nothing reads. It knows neither meshes (passes/landscape.hpp) nor
// the places of cascades (frame_data.hpp). Main thread. Private to engine/render.
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

  // The comparing sampler, and a view of all layers.
  const VkSampler* sampler() const { return sampler_.address(); }
  VkImageView all_layers() const { return image_.view.get(); }

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
