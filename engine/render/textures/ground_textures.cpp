#include "engine/render/textures/ground_textures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace psygen::render {

namespace {

constexpr std::size_t kTexels = std::size_t{kPatternSide} * kPatternSide;

// A kind of ground before it is packed.
struct Ground {
  Field height = {};            // in about [0, 1]
  Field light = {};             // factor of the albedo, of any mean
  Field warm = {};              // from bluish (−1) to yellowish (1)
  float bump_texels = 1;        // how high a height of 1 is
  float rough = 1;              // where the height is 0 …
  float rough_top = 1;          // … and where it is 1
  std::vector<float> rgb = {};  // in place of `light` and `warm`, if it is not empty
};

// f(texel number) for all texels.
template <class F>
void fill(Field& field, const F& f) {
  for (std::size_t i = 0; i < kTexels; ++i)
    field.values[i] = f(i);
}

// Stretches the field to [0, 1].
void to_unit(Field& field) {
  const auto [low, high] = std::minmax_element(field.values.begin(), field.values.end());
  const float base = *low, scale = 1 / std::max(*high - *low, 1e-6F);
  for (float& v : field.values)
    v = (v - base) * scale;
}

// Blades of grass over earth. Neighbours lean the same way.
struct Blades {
  int count;
  float shortest, longest, width;
  float earth;  // brightness of the earth between them over that of the blades
};

Ground blades(const Blades& b, std::uint32_t stream) {
  Ground out{.bump_texels = 9, .rough = 1, .rough_top = 0.75F};
  const Field lean_x = tiled_noise(8, 8, 2, 0.6F, stream + 1),
              lean_y = tiled_noise(8, 8, 2, 0.6F, stream + 2);
  const Field earth = tiled_noise(32, 32, 3, 0.7F, stream + 3);
  fill(out.height, [&](std::size_t i) { return 0.10F + 0.06F * earth.values[i]; });
  fill(out.warm, [](std::size_t) { return -2.0F; });  // no blade
  Field& tone = out.warm;
  for (int i = 0; i < b.count; ++i) {
    const auto r = [&](std::uint32_t which) {
      return random_share(stream + 10 + which, static_cast<std::uint32_t>(i));
    };
    Stroke s;
    s.x = r(0) * kPatternSide;
    s.y = r(1) * kPatternSide;
    const int x = static_cast<int>(s.x), y = static_cast<int>(s.y);
    const float dx = 2 * r(2) - 1 + lean_x.at(x, y), dy = 2 * r(3) - 1 + lean_y.at(x, y);
    const float length = b.shortest + (b.longest - b.shortest) * r(4);
    const float scale = length / std::sqrt(dx * dx + dy * dy + 0.01F);
    s.dx = dx * scale;
    s.dy = dy * scale;
    s.width = b.width * (0.6F + 0.8F * r(5));
    s.low = 0.12F + 0.2F * r(6);
    s.high = s.low + 0.25F + 0.4F * r(7);
    s.tone = 2 * r(8) - 1;
    draw_stroke(s, out.height, tone);
  }
  const Field above = raised(out.height, 5);
  fill(out.light, [&](std::size_t i) {
    const bool blade = tone.values[i] > -1.5F;
    const float own = blade ? 0.85F + 0.22F * tone.values[i] : b.earth + 0.25F * earth.values[i];
    return own * std::clamp(0.85F + 1.6F * above.values[i], 0.25F, 1.8F);
  });
  fill(tone, [&](std::size_t i) { return tone.values[i] > -1.5F ? tone.values[i] : 0.6F; });
  return out;
}

Ground grass() {
  return blades({.count = 3400, .shortest = 14, .longest = 34, .width = 2.6F, .earth = 0.45F}, 100);
}

Ground dry_grass() {
  return blades({.count = 2100, .shortest = 20, .longest = 48, .width = 2.2F, .earth = 0.75F}, 300);
}

// Leaves and twigs on moss and earth.
Ground forest_floor() {
  constexpr std::uint32_t kStream = 200;
  Ground out{.bump_texels = 6, .rough = 1, .rough_top = 0.7F};
  const Field earth = tiled_noise(16, 16, 5, 0.65F, kStream + 1);
  fill(out.height, [&](std::size_t i) { return 0.18F + 0.09F * earth.values[i]; });
  fill(out.warm, [](std::size_t) { return -2.0F; });
  const auto add = [&](int count, float shortest, float longest, float width, std::uint32_t which) {
    for (int i = 0; i < count; ++i) {
      const auto r = [&](std::uint32_t k) {
        return random_share(kStream + which + k, static_cast<std::uint32_t>(i));
      };
      const float dx = 2 * r(0) - 1, dy = 2 * r(1) - 1;
      const float scale =
          (shortest + (longest - shortest) * r(2)) / std::sqrt(dx * dx + dy * dy + 0.01F);
      const float low = 0.25F + 0.45F * r(3);
      draw_stroke({r(4) * kPatternSide, r(5) * kPatternSide, dx * scale, dy * scale,
                   width * (0.7F + 0.6F * r(6)), low, low + 0.15F * (r(7) - 0.3F), 2 * r(8) - 1},
                  out.height, out.warm);
    }
  };
  add(1500, 5, 9, 6, 20);
  add(60, 20, 55, 3, 40);
  const Field above = raised(out.height, 4);
  fill(out.light, [&](std::size_t i) {
    const bool leaf = out.warm.values[i] > -1.5F;
    const float own = leaf ? 0.95F + 0.4F * out.warm.values[i] : 0.6F + 0.3F * earth.values[i];
    return own * std::clamp(0.9F + 1.8F * above.values[i], 0.3F, 1.6F);
  });
  fill(out.warm, [&](std::size_t i) {
    return out.warm.values[i] > -1.5F ? 0.4F + 0.9F * out.warm.values[i] : -0.3F;
  });
  return out;
}

Ground sand() {
  constexpr std::uint32_t kStream = 400;
  Ground out{.bump_texels = 3, .rough = 0.9F, .rough_top = 0.7F};
  const Field ripples = tiled_noise(4, 16, 2, 0.4F, kStream + 1),
              grain = tiled_noise(128, 128, 2, 1, kStream + 2);
  const Field slow = tiled_noise(8, 8, 3, 0.5F, kStream + 3);
  const Cells pebbles = cells(32, kStream + 4);
  fill(out.height, [&](std::size_t i) {
    const bool pebble = pebbles.tone.values[i] > 0.965F && pebbles.edge.values[i] > 0.25F;
    return 0.4F + 0.18F * ripples.values[i] + 0.10F * slow.values[i] + 0.07F * grain.values[i] +
           (pebble ? 0.5F * std::min(pebbles.edge.values[i] - 0.2F, 0.5F) : 0);
  });
  const Field above = raised(out.height, 6);
  fill(out.light, [&](std::size_t i) {
    return 1 + 0.09F * grain.values[i] + 0.06F * slow.values[i] + 0.9F * above.values[i];
  });
  fill(out.warm, [&](std::size_t i) { return 0.25F * slow.values[i]; });
  return out;
}

// Weathered rock with cracks: the valleys of noise.
Ground rock() {
  constexpr std::uint32_t kStream = 500;
  Ground out{.bump_texels = 20, .rough = 0.95F, .rough_top = 0.6F};
  const Field folds = tiled_noise(4, 4, 5, 0.6F, kStream + 1),
              fine = tiled_noise(8, 8, 5, 0.6F, kStream + 2);
  const Field layers = tiled_noise(4, 16, 4, 0.6F, kStream + 3);
  const Cells chips = cells(16, kStream + 4);
  const Field lichen = tiled_noise(16, 16, 4, 0.7F, kStream + 5);
  fill(out.height, [&](std::size_t i) {
    const float crack = std::min(std::abs(folds.values[i]), 0.16F) / 0.16F;
    const float small = std::min(std::abs(fine.values[i] + 0.3F), 0.10F) / 0.10F;
    return 0.40F * crack + 0.12F * small + 0.25F * folds.values[i] + 0.20F * layers.values[i] +
           0.22F * chips.slope.values[i] + 0.12F * fine.values[i];
  });
  to_unit(out.height);
  const Field above = raised(out.height, 8);
  fill(out.light, [&](std::size_t i) {
    const float spot = std::clamp(lichen.values[i] * 3 - 1.4F, 0.0F, 1.0F);
    return (0.92F + 0.14F * (chips.tone.values[i] - 0.5F) + 0.12F * layers.values[i] +
            0.35F * spot + 0.10F * fine.values[i]) *
           std::clamp(1 + 2.2F * above.values[i], 0.35F, 1.5F);
  });
  fill(out.warm, [&](std::size_t i) {
    return 0.5F * (chips.tone.values[i] - 0.5F) + 0.6F * std::max(lichen.values[i], 0.0F);
  });
  return out;
}

// Stones of two sizes.
Ground scree() {
  constexpr std::uint32_t kStream = 700;
  Ground out{.bump_texels = 12, .rough = 1, .rough_top = 0.65F};
  const Cells large = cells(16, kStream + 1), small = cells(32, kStream + 2);
  const Field rough = tiled_noise(32, 32, 4, 0.7F, kStream + 3);
  Field is_large;
  fill(out.height, [&](std::size_t i) {
    const float stone = large.tone.values[i] > 0.35F
                            ? std::min(3 * (large.edge.values[i] - 0.08F), 0.55F) +
                                  0.9F * large.slope.values[i] + 0.4F * large.tone.values[i]
                            : -1.0F;
    const float gravel = std::min(1.4F * small.edge.values[i], 0.3F) +
                         0.3F * small.slope.values[i] + 0.15F * small.tone.values[i];
    is_large.values[i] = stone > gravel ? 1.0F : 0.0F;
    return std::max(stone, gravel) + 0.05F * rough.values[i];
  });
  to_unit(out.height);
  const Field above = raised(out.height, 6);
  const auto tone = [&](std::size_t i) {
    return (is_large.values[i] > 0 ? large.tone.values[i] : small.tone.values[i]) - 0.5F;
  };
  fill(out.light, [&](std::size_t i) {
    return (0.95F + 0.45F * tone(i) + 0.10F * rough.values[i]) *
           std::clamp(0.95F + 1.8F * above.values[i], 0.3F, 1.5F);
  });
  fill(out.warm, [&](std::size_t i) { return 0.8F * tone(i); });
  return out;
}

Ground snow() {
  constexpr std::uint32_t kStream = 600;
  Ground out{.bump_texels = 5, .rough = 0.75F, .rough_top = 0.5F};
  const Field drifts = tiled_noise(4, 8, 3, 0.5F, kStream + 1),
              grain = tiled_noise(128, 128, 2, 1, kStream + 2);
  fill(out.height,
       [&](std::size_t i) { return 0.5F + 0.28F * drifts.values[i] + 0.03F * grain.values[i]; });
  const Field above = raised(out.height, 8);
  fill(out.light, [&](std::size_t i) {
    return 1 + 0.03F * grain.values[i] + 0.5F * above.values[i] + 0.03F * drifts.values[i];
  });
  fill(out.warm, [&](std::size_t i) { return 0.5F * above.values[i]; });
  return out;
}

// Furrows along the trunk, and cracks across its ridges.
Ground bark() {
  constexpr std::uint32_t kStream = 900;
  Ground out{.bump_texels = 11, .rough = 1, .rough_top = 0.85F};
  const Field plates = tiled_noise(16, 4, 4, 0.6F, kStream + 1),
              cracks = tiled_noise(16, 16, 4, 0.6F, kStream + 2),
              fibres = tiled_noise(64, 8, 3, 0.7F, kStream + 3);
  const Field tones = tiled_noise(8, 4, 4, 0.6F, kStream + 4);
  fill(out.height, [&](std::size_t i) {
    const float furrow = std::min(std::abs(plates.values[i]), 0.3F) / 0.3F;
    const float crack = std::min(std::abs(cracks.values[i] - 0.2F), 0.12F) / 0.12F;
    return furrow * (0.6F + 0.2F * crack) + 0.12F * fibres.values[i] + 0.1F * cracks.values[i];
  });
  to_unit(out.height);
  const Field above = raised(out.height, 8);
  fill(out.light, [&](std::size_t i) {
    return (0.95F + 0.15F * tones.values[i] + 0.12F * fibres.values[i]) *
           std::clamp(1 + 1.6F * above.values[i], 0.4F, 1.4F);
  });
  fill(out.warm, [&](std::size_t i) { return 0.4F * tones.values[i] - 0.5F * above.values[i]; });
  return out;
}

Ground patches() {
  constexpr std::uint32_t kStream = 800;
  Ground out{.bump_texels = 6, .rough = 1, .rough_top = 1};
  const Field even = tiled_noise(4, 4, 7, 0.62F, kStream + 1),
              hue = tiled_noise(4, 4, 4, 0.55F, kStream + 2);
  out.height = even;
  to_unit(out.height);
  fill(out.light, [&](std::size_t i) { return 1 + 0.34F * even.values[i]; });
  fill(out.warm, [&](std::size_t i) { return 0.9F * hue.values[i]; });
  return out;
}

// A picture has its own colours; what is brighter is higher.
Ground pictured(const GroundPicture& picture) {
  Ground out{.bump_texels = 8, .rough = 1, .rough_top = 0.7F, .rgb = picture.rgb};
  fill(out.light, [&](std::size_t i) {
    return 0.2F * picture.rgb[i * 3] + 0.7F * picture.rgb[i * 3 + 1] +
           0.1F * picture.rgb[i * 3 + 2];
  });
  out.height = out.light;
  to_unit(out.height);
  return out;
}

std::uint8_t unorm8(float unit) {
  return static_cast<std::uint8_t>(std::clamp(unit, 0.0F, 1.0F) * 255.0F + 0.5F);
}

// Scales to a mean of `mean` although numbers end at 1.
void set_mean(std::span<float> values, float mean) {
  for (int round = 0; round < 4; ++round) {
    double sum = 0;
    for (float& v : values)
      sum += v = std::clamp(v, 0.0F, 1.0F);
    const auto scale = static_cast<float>(mean * static_cast<double>(values.size()) / sum);
    for (float& v : values)
      v *= scale;
  }
}

using LevelBytes = std::vector<std::uint8_t>;

void pack_colour(const Ground& ground, std::uint8_t* out) {
  constexpr std::array<float, 3> kTint{0.10F, 0.02F, -0.16F};
  std::vector<float> channel(kTexels);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < kTexels; ++i)
      channel[i] = ground.rgb.empty()
                       ? 0.5F * ground.light.values[i] * (1 + kTint[c] * ground.warm.values[i])
                       : ground.rgb[i * 3 + c];
    set_mean(channel, 0.5F);
    for (std::size_t i = 0; i < kTexels; ++i)
      out[i * 4 + c] = unorm8(channel[i]);
  }
  for (std::size_t i = 0; i < kTexels; ++i)
    out[i * 4 + 3] = unorm8(ground.height.values[i]);
}

void pack_normal(const Ground& ground, std::uint8_t* out) {
  const std::array<Field, 2> rise = height_gradient(ground.height);
  const Field above = raised(ground.height, 5);
  for (std::size_t i = 0; i < kTexels; ++i) {
    const float x = -rise[0].values[i] * ground.bump_texels;
    const float z = -rise[1].values[i] * ground.bump_texels;
    const float scale = 0.5F / std::sqrt(1 + x * x + z * z);
    const float height = std::clamp(ground.height.values[i], 0.0F, 1.0F);
    out[i * 4] = unorm8(0.5F + x * scale);
    out[i * 4 + 1] = unorm8(0.5F + z * scale);
    out[i * 4 + 2] = unorm8(ground.rough + (ground.rough_top - ground.rough) * height);
    out[i * 4 + 3] = unorm8(0.9F + 1.5F * above.values[i]);
  }
}

// The mip level after `from`, which has `side` texels along each side of each layer.
LevelBytes next_level(const LevelBytes& from, std::size_t side) {
  const std::size_t to = side / 2, layers = from.size() / (side * side * 4);
  LevelBytes out(layers * to * to * 4);
  for (std::size_t row = 0; row < layers * to; ++row) {
    const std::uint8_t* const top = from.data() + 2 * row * side * 4;
    const std::uint8_t* const bottom = top + side * 4;
    for (std::size_t i = 0; i < to * 4; ++i) {
      const std::size_t at = i / 4 * 8 + i % 4;
      const int sum = top[at] + top[at + 4] + bottom[at] + bottom[at + 4];
      out[row * to * 4 + i] = static_cast<std::uint8_t>((sum + 2) / 4);
    }
  }
  return out;
}

// The texture of a number: from its picture, if there is one.
Ground ground_of(std::size_t number, Ground (*make)(), std::span<const GroundPicture> pictures) {
  const bool has_picture = number < pictures.size() && !pictures[number].rgb.empty();
  return has_picture ? pictured(pictures[number]) : make();
}

GroundLevels with_mips(LevelBytes first) {
  GroundLevels levels;
  levels.push_back(std::move(first));
  for (std::size_t side = kPatternSide; side > 1; side /= 2)
    levels.push_back(next_level(levels.back(), side));
  return levels;
}

// Leaves in clumps, so that gaps between these are left where leaves are smaller than pixels.
Ground leaves_of_models() {
  Ground out = forest_floor();
  const Field clumps = tiled_noise(8, 8, 3, 0.6F, 1000);
  fill(out.height, [&](std::size_t i) { return out.height.values[i] + 0.35F * clumps.values[i]; });
  return out;
}

// `channels` four at a time, each as a layer.
LevelBytes as_layers(std::span<const Field> channels) {
  LevelBytes layers(kTexels * channels.size());
  for (std::size_t c = 0; c < channels.size(); ++c) {
    for (std::size_t i = 0; i < kTexels; ++i)
      layers[(c / 4 * kTexels + i) * 4 + c % 4] = unorm8(channels[c].values[i]);
  }
  return layers;
}

// Factors of the albedo over 2.
Field brightness(Field light) {
  for (float& v : light.values)
    v *= 0.5F;
  set_mean(light.values, 0.5F);
  return light;
}

}  // namespace

GroundLevels make_ground_layers(std::span<const GroundPicture> pictures) {
  constexpr std::array kMade{grass, forest_floor, dry_grass, sand, rock,
                             snow,  scree,        patches,   bark, forest_floor};
  static_assert(kMade.size() == kGroundTextures);
  LevelBytes layers(kGroundLayers * kTexels * 4);
  for (std::size_t k = 0; k < kMade.size(); ++k) {
    const Ground ground = ground_of(k, kMade[k], pictures);
    pack_colour(ground, layers.data() + k * kTexels * 4);
    pack_normal(ground, layers.data() + (kGroundTextures + k) * kTexels * 4);
  }
  return with_mips(std::move(layers));
}

GroundLevels make_ground_detail(std::span<const GroundPicture> pictures) {
  constexpr std::size_t kGrass = 0, kForest = 1, kSand = 3, kRock = 4;  // of the pictures
  const Ground leaves = leaves_of_models();
  const std::array<Field, kDetailLayers * 4> channels{
      brightness(ground_of(kGrass, grass, pictures).light),
      brightness(ground_of(kForest, forest_floor, pictures).light),
      brightness(ground_of(kRock, scree, pictures).light),
      brightness(ground_of(kSand, sand, pictures).light),
      leaves.height,
      brightness(bark().light),
      brightness(ground_of(kRock, rock, pictures).light),
      brightness(leaves.light)};
  return with_mips(as_layers(channels));
}

}  // namespace psygen::render
