#include "engine/render/textures/ground_texture_array.hpp"

#include <span>
#include <utility>
#include <vector>

#include "engine/render/textures/ground_textures.hpp"
#include "shaders/shared.h"

static_assert(PSYGEN_GROUND_SIDE == psygen::render::kPatternSide);
static_assert(PSYGEN_GROUND_TEXTURES == psygen::render::kGroundTextures);
static_assert(PSYGEN_NEAR_GROUND_M == psygen::render::kNearGroundM);
static_assert(PSYGEN_NEAR_MODELS_M == psygen::render::kNearModelsM);

namespace psygen::render {

using core::Result;

Result<void> GroundTextureArray::create(const Device& device, const PresetTraits& traits,
                                        std::span<const GroundPicture> pictures) {
  VkSamplerCreateInfo info{};
  info.magFilter = info.minFilter = VK_FILTER_LINEAR;
  // Two levels at once would cost software devices twice as much.
  info.mipmapMode =
      traits.fine_grain ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
  info.maxLod = VK_LOD_CLAMP_NONE;
  const GroundLevels levels =
      traits.pixel_light ? make_ground_layers(pictures) : make_ground_detail(pictures);
  const std::uint32_t layers = traits.pixel_light ? kGroundLayers : kDetailLayers;
  return make_sampler(device, info)
      .map(into(sampler_))
      .and_then([&] {
        return make_image(
            device, {kPatternSide, kPatternSide}, VK_FORMAT_R8G8B8A8_UNORM,
            VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, VK_IMAGE_ASPECT_COLOR_BIT,
            {.array = true, .layers = layers, .mips = static_cast<std::uint32_t>(levels.size())});
      })
      .map(into(image_))
      .and_then([&] {
        std::vector<std::span<const std::byte>> bytes;
        for (const auto& level : levels)
          bytes.push_back(std::as_bytes(std::span(level)));
        return upload_image(device, image_, {kPatternSide, kPatternSide}, bytes, layers);
      });
}

}  // namespace psygen::render
