// The depth images of the sun's shadow, one layer per cascade, and where each cascade lies. Without
// cascades one texel that nothing reads. Private to engine/render.
#pragma once

#include <functional>

#include "engine/render/memory.hpp"
#include "engine/render/preset.hpp"
#include "shaders/shared.h"

namespace psygen::render {

class ShadowMaps {
 public:
  core::Result<void> create(const Device& device, const PresetTraits& traits);

  const VkSampler* sampler() const { return sampler_.address(); }
  VkImageView all_layers() const { return image_.view.get(); }
  std::uint32_t cascades() const { return cascades_; }

  // Clears every cascade, lets `draw(i)` fill it, and leaves all readable by fragment shaders.
  // Outside of a pass.
  void record(const Device& device, VkCommandBuffer commands,
              const std::function<void(std::uint32_t)>& draw) const;

 private:
  Image image_;
  std::array<UniqueImageView, PSYGEN_MAX_CASCADES> layers_;
  UniqueSampler sampler_;
  std::uint32_t cascades_ = 0, size_ = 1;
};

// Sets the frame's shadow matrices: each cascade is a square around the camera, seen from the sun,
// that moves in whole texels, so that shadows stand still. No cascades with the sun below the
// horizon.
void set_shadows(const FrameInput& input, const PresetTraits& traits, shaders::FrameData& out);

}  // namespace psygen::render
