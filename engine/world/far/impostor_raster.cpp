#include "engine/world/far/impostor_raster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "engine/world/compass.hpp"

namespace psygen::world {
namespace {

constexpr std::size_t kSide = core::kImpostorSide;
constexpr std::size_t kTexels = kSide * kSide;
constexpr auto kAside = static_cast<float>(kDiagonal);

// Typical light relative to a white surface in the sun (render::Light): from the sky above, from
// the ground below, and from the sun at a typical height, averaged over all sides.
constexpr float kSkyLight = 0.31F, kGroundLight = 0.10F, kSunLight = 2.0F;
constexpr glm::vec2 kSunUp{0.77F, 0.64F};  // horizontal and vertical part of its direction

float of_sky(const glm::vec3& n, float ambient) {
  return ambient * (kGroundLight + (kSkyLight - kGroundLight) * (0.5F + 0.5F * n.y));
}

// The direction to a sun at the typical height. `side` is its horizontal part from the viewer:
// ahead and to the right, a unit vector.
glm::vec3 sun_at(glm::vec2 ahead, glm::vec2 side) {
  const glm::vec2 turned = side.x * ahead + side.y * glm::vec2(-ahead.y, ahead.x);
  return {kSunUp.x * turned.x, kSunUp.y, kSunUp.x * turned.y};
}

// As in shaders/lighting.glsl: the fraction of the sun's light that a surface reflects.
float direct_light(const glm::vec3& n, const glm::vec3& sun, glm::vec2 ahead, bool leaf) {
  const float facing = glm::dot(n, sun);
  if (!leaf) return std::max(facing, 0.0F);
  const float wrapped = std::clamp(facing * 0.5F + 0.5F, 0.0F, 1.0F);
  const float through = std::max(ahead.x * sun.x + ahead.y * sun.z, 0.0F);
  return wrapped * wrapped * 0.85F + 0.35F * through * through * (1 - 0.5F * wrapped);
}

// The mean over four directions of the sun relative to the view.
float usual_light(const glm::vec3& n, glm::vec2 ahead, float ambient, bool leaf) {
  float direct = 0;
  for (const glm::vec2 side :
       {glm::vec2(1, 1), glm::vec2(1, -1), glm::vec2(-1, 1), glm::vec2(-1, -1)})
    direct += 0.25F * direct_light(n, sun_at(ahead, kAside * side), ahead, leaf);
  return of_sky(n, ambient) + kSunLight * direct * (0.35F + 0.65F * ambient);
}

// Brightness of a leaf relative to the whole crown, with the sun behind the viewer's left shoulder.
// It keeps the contrast between leaves, which the mean over directions loses, and does not depend
// on the position of the sun.
float leaf_contrast(const glm::vec3& n, const glm::vec3& crown, glm::vec2 ahead) {
  constexpr float kMin = 0.35F;
  const glm::vec3 sun = sun_at(ahead, glm::vec2(-kAside));
  return (direct_light(n, sun, ahead, true) + kMin) /
         (direct_light(crown, sun, ahead, true) + kMin);
}

// The typical light of the quad that shows the impostor, at its upper or lower edge
// (shaders/model.vert).
float light_of_edge(bool top, glm::vec2 ahead, float ambient) {
  float sum = 0;
  for (const float side : {-1.0F, 1.0F}) {
    const glm::vec2 flat = 0.7F * (side * glm::vec2(-ahead.y, ahead.x) - ahead);
    const glm::vec3 n = glm::normalize(glm::vec3(flat.x, 0.35F + (top ? 0.7F : 0.0F), flat.y));
    sum += 0.5F * usual_light(n, ahead, ambient, true);
  }
  return sum;
}

// The centre of all leaves.
glm::vec3 middle_of_leaves(std::span<const Corner> corners) {
  glm::vec3 sum(0.0F);
  float count = 0;
  for (const Corner& c : corners) {
    if (c.material != kLeaf) continue;
    sum += c.position;
    ++count;
  }
  return sum / std::max(count, 1.0F);
}

// A corner in a view: texels from the upper left corner of the image, and the distance behind the
// axis.
struct Point {
  float x, y, depth;
  glm::vec3 colour;  // linear
};

struct View {
  std::vector<glm::vec4> texels;  // linear colour, opacity
  std::vector<float> depth;
};

void draw(const Point& a, const Point& b, const Point& c, View& view) {
  const float area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  if (!(std::abs(area) > 1e-9F)) return;
  const auto low = [](float v) { return static_cast<int>(std::max(std::ceil(v - 0.5F), 0.0F)); };
  const auto high = [](float v) {
    return static_cast<int>(std::min(std::floor(v - 0.5F), static_cast<float>(kSide) - 1));
  };
  const int left = low(std::min({a.x, b.x, c.x})), right = high(std::max({a.x, b.x, c.x}));
  const int first = low(std::min({a.y, b.y, c.y})), last = high(std::max({a.y, b.y, c.y}));
  for (int row = first; row <= last; ++row) {
    for (int column = left; column <= right; ++column) {
      const float x = static_cast<float>(column) + 0.5F, y = static_cast<float>(row) + 0.5F;
      const float u = ((b.x - x) * (c.y - y) - (b.y - y) * (c.x - x)) / area;
      const float v = ((c.x - x) * (a.y - y) - (c.y - y) * (a.x - x)) / area;
      const float w = 1 - u - v;
      if (u < 0 || v < 0 || w < 0) continue;
      const float depth = u * a.depth + v * b.depth + w * c.depth;
      const auto at = static_cast<std::size_t>(row) * kSide + static_cast<std::size_t>(column);
      if (depth >= view.depth[at]) continue;
      view.depth[at] = depth;
      view.texels[at] = glm::vec4(u * a.colour + v * b.colour + w * c.colour, 1);
    }
  }
}

View draw_view(std::span<const Corner> corners, std::span<const std::uint16_t> indices,
               const ImpostorFrame& frame, glm::vec2 ahead) {
  const float side = static_cast<float>(kSide);
  const float high = light_of_edge(true, ahead, frame.ambient);
  const float low = light_of_edge(false, ahead, frame.ambient);
  const glm::vec3 middle = middle_of_leaves(corners);
  std::vector<Point> points;
  points.reserve(corners.size());
  for (const Corner& c : corners) {
    const float right = -ahead.y * c.position.x + ahead.x * c.position.z;
    const float down = (frame.top_m - c.position.y) / (frame.top_m - frame.bottom_m);
    const float edge = high + (low - high) * std::clamp(down, 0.0F, 1.0F);
    const bool leaf = c.material == kLeaf;
    float light = usual_light(c.normal, ahead, c.ambient, leaf) / edge;
    const glm::vec3 out = c.position - middle;
    if (leaf && glm::dot(out, out) > 0)
      light *= leaf_contrast(c.normal, glm::normalize(out), ahead);
    points.push_back({(right / frame.half_width_m * 0.5F + 0.5F) * side, down * side,
                      ahead.x * c.position.x + ahead.y * c.position.z,
                      c.colour * c.colour * light});
  }
  View view{std::vector<glm::vec4>(kTexels, glm::vec4(0.0F)), std::vector<float>(kTexels, 1e30F)};
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    draw(points[indices[i]], points[indices[i + 1]], points[indices[i + 2]], view);
  return view;
}

// The next smaller level: mean opacity, and the mean colour of the opaque parts.
std::vector<glm::vec4> half(const std::vector<glm::vec4>& from, std::size_t side) {
  std::vector<glm::vec4> to(side * side / 4);
  for (std::size_t y = 0; y < side / 2; ++y) {
    for (std::size_t x = 0; x < side / 2; ++x) {
      glm::vec4 sum(0.0F);
      for (const std::size_t at : {2 * y * side + 2 * x, 2 * y * side + 2 * x + 1,
                                   (2 * y + 1) * side + 2 * x, (2 * y + 1) * side + 2 * x + 1}) {
        const glm::vec4& t = from[at];
        sum += glm::vec4(t.x * t.w, t.y * t.w, t.z * t.w, t.w);
      }
      const float scale = sum.w > 0 ? 1 / sum.w : 0;
      to[y * (side / 2) + x] = {sum.x * scale, sum.y * scale, sum.z * scale, sum.w * 0.25F};
    }
  }
  return to;
}

// The factor on all opacities at which the fraction `covered` of the texels is drawn.
float opacity_factor(const std::vector<glm::vec4>& texels, float covered) {
  std::vector<float> opacities;
  for (const glm::vec4& t : texels)
    opacities.push_back(t.w);
  const auto drawn =
      static_cast<std::size_t>(std::floor(covered * static_cast<float>(opacities.size()) + 0.5F));
  if (drawn == 0) return 1;
  std::ranges::nth_element(opacities, opacities.begin() + static_cast<std::ptrdiff_t>(drawn - 1),
                           std::ranges::greater());
  constexpr float kDrawn = 128.25F / 255;  // gives a byte of 128 after any rounding
  return kDrawn / std::max(opacities[drawn - 1], 0.02F);
}

std::uint8_t byte_of(float v) {
  return static_cast<std::uint8_t>(std::clamp(v, 0.0F, 1.0F) * 255 + 0.5F);
}

void write(const std::vector<glm::vec4>& texels, const glm::vec3& around, float opacity,
           std::uint8_t* out) {
  for (const glm::vec4& t : texels) {
    const glm::vec3 c = t.w > 0 ? glm::vec3(t) : around;
    for (int k = 0; k < 3; ++k)
      *out++ = byte_of(std::sqrt(std::max(c[k], 0.0F)));
    *out++ = byte_of(t.w * opacity);
  }
}

}  // namespace

core::ImpostorTexture bake_impostor(std::span<const Corner> corners,
                                    std::span<const std::uint16_t> indices,
                                    const ImpostorFrame& frame, std::uint32_t views) {
  static_assert(kCompass.size() == core::kImpostorViews);
  core::ImpostorTexture picture(core::impostor_bytes());
  for (std::uint32_t k = 0; k < views; ++k) {
    View view = draw_view(corners, indices, frame, glm::vec2(kCompass[k]));
    glm::vec4 sum(0.0F);
    for (const glm::vec4& t : view.texels)
      sum += t;
    // The colour of transparent texels shows in filtered edges.
    const glm::vec3 around = glm::vec3(sum) / std::max(sum.w, 1.0F);
    const float covered = sum.w / static_cast<float>(kTexels);
    std::size_t at = 0, side = kSide;
    for (std::uint32_t level = 0; level < core::kImpostorLevels; ++level) {
      const float opacity = level == 0 ? 1 : opacity_factor(view.texels, covered);
      for (std::uint32_t same = k; same < core::kImpostorViews; same += views)
        write(view.texels, around, opacity, picture.data() + at + same * side * side * 4);
      at += core::impostor_level_bytes(level);
      if (level + 1 < core::kImpostorLevels) view.texels = half(view.texels, side);
      side /= 2;
    }
  }
  return picture;
}

}  // namespace psygen::world
