// The map of soft dark spots on the ground near the camera, under what stands there: cells around
// the camera with the share of the sun and of the sky that is missing. Shaders read it at vertices
// or pixels of near ground (shaders/ground_shade.glsl). Not shadow maps: a spot is a disc, whatever
// its model looks like. Plain memory, linear in the cells of spots. Main thread. Private to
// engine/render.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "engine/render/types.hpp"
#include "shaders/shared.h"

namespace psygen::render {

// Empty until build().
class ContactShadowMap {
 public:
  // Replaces the map. `camera`: its x and z in metres; cells stay where they are in the world when
  // it moves.
  void build(std::span<const GroundSpot> spots, glm::dvec2 camera);

  // Two cells in each word, row by row along z: of 16 bits each the missing share of the sun in the
  // low byte, of the sky in the high one.
  std::span<const std::uint32_t> words() const { return words_; }
  // The corner of the first cell, relative to the camera, m.
  glm::vec2 corner() const { return corner_; }

 private:
  void add(const GroundSpot& spot);

  std::vector<std::uint32_t> words_ =
      std::vector<std::uint32_t>(PSYGEN_SHADE_SIDE * PSYGEN_SHADE_SIDE / 2);
  glm::vec2 corner_{0.0F};
};

}  // namespace psygen::render
