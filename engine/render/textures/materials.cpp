#include "engine/render/textures/materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

namespace psygen::render {

using core::ErrorCode;
using core::Result;

namespace {

constexpr std::uint32_t kSetsInPool = 64;
constexpr std::uint32_t kMapsOfMaterial = 3;

core::Extent half_of(core::Extent size) {
  return {std::max(size.width / 2, 1u), std::max(size.height / 2, 1u)};
}

// The mean of four texels in one channel.
std::uint8_t mean(std::array<std::uint32_t, 4> v, bool squared) {
  if (!squared) return static_cast<std::uint8_t>((v[0] + v[1] + v[2] + v[3] + 2) / 4);
  const double sum = v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3];
  return static_cast<std::uint8_t>(std::lround(std::sqrt(sum / 4)));
}

std::vector<std::uint8_t> half(std::span<const std::uint8_t> from, core::Extent size,
                               bool colours) {
  const core::Extent to = half_of(size);
  std::vector<std::uint8_t> out(std::size_t{to.width} * to.height * 4);
  for (std::uint32_t y = 0; y < to.height; ++y) {
    for (std::uint32_t x = 0; x < to.width; ++x) {
      const auto at = [&](std::uint32_t dx, std::uint32_t dy, std::uint32_t channel) {
        const std::uint32_t px = std::min(2 * x + dx, size.width - 1);
        const std::uint32_t py = std::min(2 * y + dy, size.height - 1);
        return std::uint32_t{from[(std::size_t{py} * size.width + px) * 4 + channel]};
      };
      for (std::uint32_t c = 0; c < 4; ++c) {
        out[(std::size_t{y} * to.width + x) * 4 + c] =
            mean({at(0, 0, c), at(1, 0, c), at(0, 1, c), at(1, 1, c)}, colours && c < 3);
      }
    }
  }
  return out;
}

shaders::MaterialData data_of(const Material& m) {
  std::uint32_t bits = 0;
  if (m.normal_texture != kNoTexture) bits |= PSYGEN_MATERIAL_NORMAL_MAP;
  if (m.two_sided) bits |= PSYGEN_MATERIAL_TWO_SIDED;
  return {.base = {m.base_colour, m.opacity},
          .emissive = {m.emissive, m.min_opacity},
          .options = {static_cast<float>(bits), m.normal_strength, 0, 0}};
}

bool is_valid(const Material& m) {
  constexpr float kMax = 1e6F;
  const auto ok = [](float v) { return v >= 0 && v <= kMax; };
  for (int i = 0; i < 3; ++i) {
    if (!ok(m.base_colour[i]) || !ok(m.emissive[i])) return false;
  }
  return ok(m.opacity) && ok(m.min_opacity) && std::abs(m.normal_strength) <= kMax;
}

}  // namespace

std::vector<std::vector<std::uint8_t>> mip_levels(const TexturePixels& pixels) {
  std::vector<std::vector<std::uint8_t>> levels;
  core::Extent size{pixels.width, pixels.height};
  std::span<const std::uint8_t> above = pixels.rgba;
  while (size.width > 1 || size.height > 1) {
    levels.push_back(half(above, size, pixels.colours));
    above = levels.back();
    size = half_of(size);
  }
  return levels;
}

Result<void> MaterialTable::create(const Device& device, std::uint64_t texture_budget_bytes) {
  texture_budget_bytes_ = texture_budget_bytes;
  return make_buffer(device, PSYGEN_MAX_MATERIALS * sizeof(shaders::MaterialData),
                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryUse::kWrite)
      .map(into(buffer_))
      .and_then([&] {
        return make_sampler(
            device, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT,
            {.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR, .maxLod = VK_LOD_CLAMP_NONE});
      })
      .map(into(sampler_))
      .and_then([&] { return add_sets(device); })
      .and_then([&] {
        // Numbers that no material has yet look like the plain one.
        const shaders::MaterialData plain = data_of(Material{});
        for (std::size_t i = 0; i < PSYGEN_MAX_MATERIALS; ++i)
          std::memcpy(buffer_.mapped + i * sizeof(plain), &plain, sizeof(plain));
        return add(device, {});
      })
      .map([](MaterialId) {});
}

Result<void> MaterialTable::add_sets(const Device& device) {
  std::array<SetBinding, kMapsOfMaterial> maps{};
  maps.fill({VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_SHADER_STAGE_FRAGMENT_BIT,
             sampler_.address()});
  DescriptorSets sets;
  return sets.create(device, maps, kSetsInPool).map([&] { pools_.push_back(std::move(sets)); });
}

Result<TextureId> MaterialTable::add_texture(const Device& device, const TexturePixels& pixels) {
  const std::uint64_t bytes = std::uint64_t{pixels.width} * pixels.height * 4;
  if (bytes == 0 || pixels.width > kMaxTextureSide || pixels.height > kMaxTextureSide ||
      pixels.rgba.size() != bytes) {
    return core::fail(
        ErrorCode::kInvalidArgument,
        fmt::format("a texture of {} x {} pixels with {} bytes: it has 1 to {} pixels "
                    "a side, and 4 bytes a pixel",
                    pixels.width, pixels.height, pixels.rgba.size(), kMaxTextureSide));
  }
  if (texture_bytes_ + bytes + bytes / 3 > texture_budget_bytes_ ||
      textures_.size() > kMaxTextures) {
    return core::fail(ErrorCode::kOverBudget,
                      fmt::format("a texture of {} x {} pixels goes beyond the budget: {} of {} "
                                  "bytes and {} of {} textures are used",
                                  pixels.width, pixels.height, texture_bytes_,
                                  texture_budget_bytes_, textures_.size(), kMaxTextures));
  }
  if (Result<void> white = make_white(device); !white) return tl::unexpected(white.error());
  return store(device, pixels);
}

// The texture of maps that a material does not have.
Result<void> MaterialTable::make_white(const Device& device) {
  if (!textures_.empty()) return {};
  constexpr std::array<std::uint8_t, 4> kWhite{255, 255, 255, 255};
  return store(device, {1, 1, kWhite, false}).map([](TextureId) {});
}

Result<VkDescriptorSet> MaterialTable::blank_set(const Device& device) {
  if (blank_set_ != VK_NULL_HANDLE) return blank_set_;
  return make_white(device).and_then([&] { return make_set(device, {}); }).map([&](auto set) {
    return blank_set_ = set;
  });
}

Result<TextureId> MaterialTable::store(const Device& device, const TexturePixels& pixels) {
  const std::vector<std::vector<std::uint8_t>> smaller = mip_levels(pixels);
  std::vector<std::span<const std::byte>> levels{std::as_bytes(std::span(pixels.rgba))};
  for (const auto& level : smaller)
    levels.push_back(std::as_bytes(std::span(level)));
  const core::Extent size{pixels.width, pixels.height};
  Result<Image> image =
      make_image(device, size, pixels.colours ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM,
                 VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                 VK_IMAGE_ASPECT_COLOR_BIT, {.mips = static_cast<std::uint32_t>(levels.size())});
  if (!image) return tl::unexpected(image.error());
  if (Result<void> filled = upload_image(device, *image, size, levels); !filled)
    return tl::unexpected(filled.error());
  for (const auto& level : levels)
    texture_bytes_ += level.size();
  textures_.push_back(std::move(*image));
  return static_cast<TextureId>(textures_.size() - 1);
}

Result<VkDescriptorSet> MaterialTable::make_set(const Device& device, const Material& material) {
  const std::size_t set = set_count_ % kSetsInPool;
  if (pools_.size() * kSetsInPool <= set_count_) {
    if (Result<void> added = add_sets(device); !added) return tl::unexpected(added.error());
  }
  ++set_count_;
  const std::array maps{material.base_texture, material.normal_texture, material.emissive_texture};
  for (std::uint32_t i = 0; i < kMapsOfMaterial; ++i) {
    pools_.back().write(
        device, set, i,
        {VK_NULL_HANDLE, textures_[maps[i]].view.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
  }
  return pools_.back()[set];
}

Result<MaterialId> MaterialTable::add(const Device& device, const Material& material) {
  if (!is_valid(material)) {
    return core::fail(ErrorCode::kInvalidArgument,
                      "the numbers of a material are finite, and its colours at least 0");
  }
  bool textured = false;
  for (const TextureId map :
       {material.base_texture, material.normal_texture, material.emissive_texture}) {
    if (map != kNoTexture && map >= textures_.size()) {
      return core::fail(ErrorCode::kInvalidArgument,
                        fmt::format("a material names texture {}, which does not exist", map));
    }
    textured = textured || map != kNoTexture;
  }
  if (kinds_.size() >= PSYGEN_MAX_MATERIALS) {
    return core::fail(ErrorCode::kOverBudget,
                      fmt::format("there are {} materials already", PSYGEN_MAX_MATERIALS));
  }
  VkDescriptorSet set = VK_NULL_HANDLE;
  if (textured) {
    const Result<VkDescriptorSet> made = make_set(device, material);
    if (!made) return tl::unexpected(made.error());
    set = *made;
  }
  const shaders::MaterialData data = data_of(material);
  std::memcpy(buffer_.mapped + kinds_.size() * sizeof(data), &data, sizeof(data));
  sets_.push_back(set);
  kinds_.push_back({textured, material.min_opacity > 0});
  return static_cast<MaterialId>(kinds_.size() - 1);
}

}  // namespace psygen::render
