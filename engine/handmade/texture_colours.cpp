#include "engine/handmade/texture_colours.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "engine/models/kit/exact_math.hpp"

namespace psygen::handmade {
namespace {

constexpr int kMaxSteps = 8;            // maximum number of samples along a side of a triangle
constexpr float kWhole = 8'388'608.0F;  // from here on, floats have no fraction

// The pixel at a point of the texture: linear colour, opacity.
glm::vec4 pixel_at(const image::Image& image, glm::vec2 uv) {
  const auto p = pixel_of(image, uv);
  const std::array<float, 256>& light = models::linear_light();
  return {light[p[0]], light[p[1]], light[p[2]], static_cast<float>(p[3]) / 255};
}

// About one sample per two texels.
int steps_of(const image::Image& image, const glm::vec2 (&uv)[3]) {
  const glm::vec2 size(image.width, image.height);
  float most = 0;
  for (int k = 0; k < 3; ++k)
    most = std::max(most, glm::length((uv[(k + 1) % 3] - uv[k]) * size));
  return static_cast<int>(std::clamp(0.5F * most, 1.0F, static_cast<float>(kMaxSteps)));
}

// Points inside a triangle, by the weights of its corners: its texture may have other content
// beyond its border.
std::vector<glm::vec3> points_of(int steps) {
  std::vector<glm::vec3> points;
  for (int a = 0; a < steps; ++a) {
    for (int b = 0; a + b < steps; ++b) {
      const float u = (static_cast<float>(a) + 1.0F / 3) / static_cast<float>(steps);
      const float v = (static_cast<float>(b) + 1.0F / 3) / static_cast<float>(steps);
      points.emplace_back(u, v, 1 - u - v);
    }
  }
  return points;
}

struct Sum {
  glm::vec4 drawn{0.0F}, all{0.0F};  // colour; weight
  void add(const glm::vec4& pixel, float weight, float min_opacity) {
    const glm::vec4 part(glm::vec3(pixel) * weight, weight);
    all += part;
    if (pixel.w >= min_opacity) drawn += part;
  }
  void add(const Sum& other) {
    all += other.all;
    drawn += other.drawn;
  }
  // The mean here; `others`, the mean of the whole mesh, if no pixel is drawn here.
  glm::vec3 mean(const Sum& others) const {
    for (const glm::vec4& sum : {drawn, others.drawn, all})
      if (sum.w > 0) return glm::vec3(sum) / sum.w;
    return glm::vec3(1.0F);
  }
};

}  // namespace

std::span<const std::uint8_t, 4> pixel_of(const image::Image& image, glm::vec2 uv) {
  const auto along = [](float v, std::uint32_t size) {
    if (!(std::abs(v) < kWhole)) return 0U;
    // Truncates: without SSE4.1, std::floor() is a function call.
    const auto towards_zero = static_cast<float>(static_cast<std::int32_t>(v));
    const float part = v - (towards_zero > v ? towards_zero - 1 : towards_zero);
    return std::min(static_cast<std::uint32_t>(part * static_cast<float>(size)), size - 1);
  };
  return image.pixel(along(uv.x, image.width), along(uv.y, image.height));
}

std::vector<glm::vec3> texture_colours(const core::MeshData& mesh, const image::Image& image,
                                       float min_opacity) {
  static const std::array<std::vector<glm::vec3>, kMaxSteps + 1> points = [] {
    std::array<std::vector<glm::vec3>, kMaxSteps + 1> of_steps;
    for (int steps = 1; steps <= kMaxSteps; ++steps)
      of_steps[static_cast<std::size_t>(steps)] = points_of(steps);
    return of_steps;
  }();
  std::vector<Sum> sums(mesh.positions.size());
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t* corner = &mesh.indices[i];
    const glm::vec2 uv[3] = {mesh.uvs[corner[0]], mesh.uvs[corner[1]], mesh.uvs[corner[2]]};
    for (const glm::vec3& w : points[static_cast<std::size_t>(steps_of(image, uv))]) {
      const glm::vec4 pixel = pixel_at(image, w.x * uv[0] + w.y * uv[1] + w.z * uv[2]);
      for (int k = 0; k < 3; ++k)
        sums[corner[k]].add(pixel, w[k], min_opacity);
    }
  }
  Sum whole;
  for (const Sum& sum : sums)
    whole.add(sum);
  std::vector<glm::vec3> colours;
  colours.reserve(sums.size());
  for (const Sum& sum : sums)
    colours.push_back(sum.mean(whole));
  return colours;
}

}  // namespace psygen::handmade
