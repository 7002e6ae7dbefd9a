// The texture with the pictures of models (core/vertex_layout.hpp) and its sampler. Layer 0 is
// white, for what has no picture. It knows nothing of models. Main thread; everything waits for the
// device. Private to engine/render.
#pragma once

#include <span>

#include "engine/core/vertex_layout.hpp"
#include "engine/render/memory/memory.hpp"

namespace psygen::render {

// Empty until create(). The device must outlive it.
class ImpostorTextures {
 public:
  // Stores these pictures in place of all that there were. The view is another one then. After a
  // failure everything is as it was.
  core::Result<void> create(const Device& device, std::span<const core::ImpostorTexture> pictures);
  // Replaces a picture that no unfinished commands read.
  core::Result<void> set(const Device& device, std::size_t number,
                         const core::ImpostorTexture& picture);

  std::size_t count() const { return count_; }
  VkImageView view() const { return image_.view.get(); }
  const VkSampler* sampler() const { return sampler_.address(); }
  std::uint64_t bytes() const { return count_ * core::impostor_bytes(); }

 private:
  core::Result<void> fill(const Device& device, std::uint32_t layer, std::uint32_t layers,
                          std::span<const std::uint8_t> texels);

  UniqueSampler sampler_;
  Image image_;
  std::size_t count_ = 0;
};

}  // namespace psygen::render
