// The image with the textures of the ground (ground_textures.hpp) and its sampler: for presets with
// light per pixel all textures as layers, else those of brightness. Main thread. Private to
// engine/render.
#pragma once

#include <span>

#include "engine/render/memory/memory.hpp"
#include "engine/render/preset.hpp"

namespace psygen::render {

// Empty until create(). The device must outlive it.
class GroundTextureArray {
 public:
  // Computes and uploads the textures that the preset needs. Once; waits for the device.
  // `pictures`: RendererOptions::ground.
  core::Result<void> create(const Device& device, const PresetTraits& traits,
                            std::span<const GroundPicture> pictures);
  VkImageView view() const { return image_.view.get(); }
  const VkSampler* sampler() const { return sampler_.address(); }

 private:
  Image image_;
  UniqueSampler sampler_;
};

}  // namespace psygen::render
