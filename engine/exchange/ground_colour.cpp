#include "engine/exchange/ground_colour.hpp"

#include <glm/common.hpp>

#include "engine/world/ground_blends.hpp"

namespace psygen::exchange {

glm::vec3 ground_albedo(const world::Palette& palette, float height_m, const glm::vec3& normal,
                        glm::vec2 pattern_place_m, std::uint16_t packed_height, float road) {
  const world::GroundBlends blends =
      world::ground_blends(palette, height_m, normal, pattern_place_m, road);
  const glm::vec3* const kinds[world::kGroundKinds] = {
      &palette.grass, &palette.forest, &palette.dry, &palette.sand, &palette.rock, &palette.snow};
  glm::vec3 c = *kinds[0];
  for (std::size_t i = 1; i < world::kGroundKinds; ++i)
    c = glm::mix(c, *kinds[i], blends[i]);
  const std::uint32_t grain = (packed_height * 0x9E3779B1u) >> 24;
  return c * (0.9F + 0.2F * static_cast<float>(grain) * (1.0F / 255.0F));
}

}  // namespace psygen::exchange
