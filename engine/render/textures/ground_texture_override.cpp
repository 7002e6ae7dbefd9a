#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "engine/render/textures/ground_patterns.hpp"
#include "engine/render/types.hpp"

namespace psygen::render {

using core::Result;

namespace {

struct Pixels {
  std::uint32_t width, height;
  std::span<const std::uint8_t> rgba;

  const std::uint8_t* at(std::uint32_t x, std::uint32_t y) const {
    return rgba.data() + (std::size_t{y} * width + x) * 4;
  }
};

tl::unexpected<core::Error> refuse_picture(std::string sentence) {
  return core::fail(core::ErrorCode::kInvalidArgument, std::move(sentence));
}

// A display value as light: a polynomial near the sRGB curve, the same on every machine.
float light_of(std::uint8_t value) {
  const float c = static_cast<float>(value) * (1.0F / 255);
  return c * (c * (c * 0.305306011F + 0.682171111F) + 0.012522878F);
}

// Differences between each column and the one before it (the first: the last one, where the picture
// is repeated), summed over rows and colours; of rows if `down`.
std::vector<std::uint64_t> steps_in(const Pixels& image, bool down) {
  const std::uint32_t side = image.width;
  std::vector<std::uint64_t> out(side);
  for (std::uint32_t i = 0; i < side; ++i) {
    const std::uint32_t before = (i + side - 1) % side;
    for (std::uint32_t k = 0; k < side; ++k) {
      const std::uint8_t* const here = down ? image.at(k, i) : image.at(i, k);
      const std::uint8_t* const there = down ? image.at(k, before) : image.at(before, k);
      for (std::size_t c = 0; c < 3; ++c)
        out[i] += static_cast<std::uint64_t>(std::abs(int{here[c]} - int{there[c]}));
    }
  }
  return out;
}

// Returns true if the picture's ends differ more than any neighbours inside.
bool has_seam(const Pixels& image, bool down) {
  const std::vector<std::uint64_t> all = steps_in(image, down);
  const std::uint64_t most = *std::max_element(all.begin() + 1, all.end());
  constexpr std::uint64_t kSpare = 3 * 3;  // of 255 a pixel, in three colours
  return all[0] > most + most / 2 + kSpare * image.width;
}

Result<void> check_picture(const Pixels& image) {
  if (image.width != image.height || image.width < kMinGroundPicture ||
      image.width > kLargestGroundPicture ||
      image.rgba.size() != std::size_t{image.width} * image.height * 4) {
    return refuse_picture(
        fmt::format("the picture is {} x {}; it must be square, with {} to {} pixels a side",
                    image.width, image.height, kMinGroundPicture, kLargestGroundPicture));
  }
  for (std::size_t i = 3; i < image.rgba.size(); i += 4)
    if (image.rgba[i] != 255)
      return refuse_picture("the picture has transparent pixels; ground has none");
  for (const bool down : {false, true}) {
    if (has_seam(image, down))
      return refuse_picture(
          fmt::format("the picture cannot be repeated without a seam: its {} differ",
                      down ? "upper and lower ends" : "left and right ends"));
  }
  return {};
}

// The mean of the pixels that each texel covers, or the pixel that covers the texel.
std::vector<float> resized(const Pixels& image) {
  std::array<float, 256> light{};
  for (std::size_t i = 0; i < light.size(); ++i)
    light[i] = light_of(static_cast<std::uint8_t>(i));
  constexpr std::uint32_t kSide = kPatternSide;
  const auto first = [&](std::uint32_t texel) { return texel * image.width / kSide; };
  const auto end = [&](std::uint32_t texel) {
    return std::max(first(texel + 1), first(texel) + 1);
  };
  std::vector<float> rgb;
  rgb.reserve(std::size_t{kSide} * kSide * 3);
  for (std::uint32_t y = 0; y < kSide; ++y) {
    for (std::uint32_t x = 0; x < kSide; ++x) {
      std::array<float, 3> sum{};
      for (std::uint32_t v = first(y); v < end(y); ++v) {
        for (std::uint32_t u = first(x); u < end(x); ++u) {
          const std::uint8_t* const pixel = image.at(u, v);
          for (std::size_t c = 0; c < 3; ++c)
            sum[c] += light[pixel[c]];
        }
      }
      const auto count = static_cast<float>((end(y) - first(y)) * (end(x) - first(x)));
      for (const float s : sum)
        rgb.push_back(s / count);
    }
  }
  return rgb;
}

}  // namespace

Result<GroundPicture> ground_picture(std::uint32_t width, std::uint32_t height,
                                     std::span<const std::uint8_t> rgba) {
  const Pixels image{width, height, rgba};
  if (Result<void> fit = check_picture(image); !fit) return tl::unexpected(fit.error());
  GroundPicture out{resized(image)};
  std::array<double, 3> sums{};
  for (std::size_t i = 0; i < out.rgb.size(); ++i)
    sums[i % 3] += static_cast<double>(out.rgb[i]);
  constexpr double kMinMean = 1e-3;
  for (const double sum : sums) {
    if (sum < kMinMean * static_cast<double>(out.rgb.size()) / 3)
      return refuse_picture(
          "the picture is black in red, green or blue; its colours cannot be scaled");
  }
  return out;
}

}  // namespace psygen::render
