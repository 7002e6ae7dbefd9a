// The materials of objects with their textures: a buffer that all shaders read, and a descriptor
// set for each material with textures. Textures have mip levels, made here. Both live as long as
// the table; nothing is removed from it. Not a cache and no streaming: textures have a budget of
// their own, and what goes beyond it is refused. Main thread; adding a texture waits for the
// device. Private to engine/render.
#pragma once

#include <span>
#include <vector>

#include "engine/render/device/descriptors.hpp"
#include "engine/render/memory/memory.hpp"
#include "engine/render/types.hpp"
#include "shaders/shared.h"

namespace psygen::render {

// Properties of a material that decide how its draws are grouped. Materials are named by their
// place in a span; those beyond its end are plain.
struct MaterialKind {
  bool textured = false;  // its textures are bound
  bool holes = false;     // pixels of little opacity are left out
};
using MaterialKinds = std::span<const MaterialKind>;
inline MaterialKind kind_of(MaterialKinds kinds, MaterialId material) {
  return material < kinds.size() ? kinds[material] : MaterialKind{};
}

// Empty until create(). The device must outlive it.
class MaterialTable {
 public:
  static constexpr std::uint32_t kMaxTextures = 4096;
  static constexpr std::uint32_t kMaxTextureSide = 8192;  // pixels

  // Creates the buffer with the plain material, and the layout of sets. Once.
  core::Result<void> create(const Device& device, std::uint64_t texture_budget_bytes);

  // Stores a texture. Fails with kInvalidArgument for a size of 0, above kMaxTextureSide or that
  // does not match the bytes, kOverBudget beyond the budget or kMaxTextures, and like make_image().
  core::Result<TextureId> add_texture(const Device& device, const TexturePixels& pixels);
  // Stores a material. Fails with kInvalidArgument for values that are not finite or negative, and
  // for unknown textures; kOverBudget beyond PSYGEN_MAX_MATERIALS.
  core::Result<MaterialId> add(const Device& device, const Material& material);

  // A set with white textures, for the warm-up of pipelines. Made with the first call.
  core::Result<VkDescriptorSet> blank_set(const Device& device);

  // The kinds of all materials, by id, for lists of draws.
  MaterialKinds kinds() const { return kinds_; }
  // The set with a material's textures; null for plain ones.
  VkDescriptorSet set(MaterialId material) const { return sets_[material]; }
  VkDescriptorSetLayout set_layout() const { return pools_.front().layout(); }
  const Buffer& buffer() const { return buffer_; }  // of shaders::MaterialData
  std::uint64_t texture_bytes() const { return texture_bytes_; }
  // Sets the budget of textures. Textures that exist stay.
  void set_budget(std::uint64_t bytes) { texture_budget_bytes_ = bytes; }

 private:
  core::Result<void> add_sets(const Device& device);
  core::Result<void> make_white(const Device& device);
  core::Result<TextureId> store(const Device& device, const TexturePixels& pixels);
  core::Result<VkDescriptorSet> make_set(const Device& device, const Material& material);

  Buffer buffer_;
  UniqueSampler sampler_;
  std::vector<DescriptorSets> pools_;  // of the same layout
  std::vector<Image> textures_;        // the first is white
  std::vector<VkDescriptorSet> sets_;
  VkDescriptorSet blank_set_ = VK_NULL_HANDLE;
  std::size_t set_count_ = 0;  // of all pools
  std::vector<MaterialKind> kinds_;
  std::uint64_t texture_budget_bytes_ = 0, texture_bytes_ = 0;
};

// The mip levels of a texture below the first, each the mean of 2 × 2 texels of the one above, down
// to 1 × 1. Colours are averaged as light (by the square of their values), alpha and numbers as
// they are. Pure.
std::vector<std::vector<std::uint8_t>> mip_levels(const TexturePixels& pixels);

}  // namespace psygen::render
