#include "engine/render/textures/model_pictures.hpp"

#include <array>
#include <utility>
#include <vector>

#include "engine/core/assert.hpp"
#include "engine/core/vertex_layout.hpp"
#include "shaders/shared.h"

static_assert(PSYGEN_PICTURE_BIT == psygen::core::kImpostorBit);
static_assert(PSYGEN_PICTURE_VIEWS == psygen::core::kImpostorViews);

namespace psygen::render {

using core::Result;

namespace {

constexpr core::Extent kLayerSize{core::kImpostorSide, core::kImpostorSide};

}  // namespace

Result<void> ImpostorTextures::create(const Device& device,
                                      std::span<const core::ImpostorTexture> pictures) {
  PSYGEN_CHECK(pictures.size() <= core::kMaxImpostors, "a byte names the picture");
  if (!sampler_.exists()) {
    // Two levels at once would cost software devices twice as much.
    const VkSamplerMipmapMode between =
        device.info.software() ? VK_SAMPLER_MIPMAP_MODE_NEAREST : VK_SAMPLER_MIPMAP_MODE_LINEAR;
    const Result<void> made =
        make_sampler(device, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                     {.mipmapMode = between, .maxLod = VK_LOD_CLAMP_NONE})
            .map(into(sampler_));
    if (!made) return made;
  }
  const auto layers = static_cast<std::uint32_t>(1 + pictures.size() * core::kImpostorViews);
  Result<Image> image = make_image(
      device, kLayerSize, VK_FORMAT_R8G8B8A8_UNORM,
      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, VK_IMAGE_ASPECT_COLOR_BIT,
      {.array = true, .layers = layers, .mips = core::kImpostorLevels});
  if (!image) return tl::unexpected(image.error());
  std::swap(image_, *image);
  const std::size_t count_before = std::exchange(count_, pictures.size());
  const std::vector<std::uint8_t> white(core::impostor_bytes() / core::kImpostorViews, 255);
  Result<void> filled = fill(device, 0, 1, white);
  for (std::size_t i = 0; filled && i < pictures.size(); ++i)
    filled = set(device, i, pictures[i]);
  if (!filled) {  // as it was
    std::swap(image_, *image);
    count_ = count_before;
  }
  return filled;
}

Result<void> ImpostorTextures::set(const Device& device, std::size_t number,
                                   const core::ImpostorTexture& picture) {
  PSYGEN_CHECK(number < count_ && picture.size() == core::impostor_bytes(),
               "a picture that exists, of its size");
  return fill(device, static_cast<std::uint32_t>(1 + number * core::kImpostorViews),
              core::kImpostorViews, picture);
}

Result<void> ImpostorTextures::fill(const Device& device, std::uint32_t layer, std::uint32_t layers,
                                    std::span<const std::uint8_t> texels) {
  std::array<std::span<const std::byte>, core::kImpostorLevels> levels;
  std::size_t at = 0;
  for (std::uint32_t level = 0; level < core::kImpostorLevels; ++level) {
    const std::size_t bytes = core::impostor_level_bytes(level) / core::kImpostorViews * layers;
    levels[level] = std::as_bytes(texels.subspan(at, bytes));
    at += bytes;
  }
  return upload_image(device, image_, kLayerSize, levels, layers, layer);
}

}  // namespace psygen::render
