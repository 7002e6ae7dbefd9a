// The blades of a patch of grass (grass.cpp): where each stands, and how it becomes vertices. Not
// for other files. The same bits everywhere: single precision, no functions but square roots.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/coordinates.hpp"
#include "engine/models/kit/packing.hpp"
#include "engine/models/model_type.hpp"

namespace psygen::models {

inline constexpr std::uint32_t kBladeVertices = 5, kBladeTriangles = 3;
inline constexpr std::uint32_t kFlowerVertices = kBladeVertices + 5;
inline constexpr std::uint32_t kFlowerTriangles = kBladeTriangles + 4;
inline constexpr std::uint32_t kFirstStem = 1U << 20;  // blades from here on are stems of flowers
inline constexpr float kTuftSpread = 0.22F;  // of feet about their tuft's middle, of the height
inline constexpr float kBendHeight = 0.55F;  // of a blade's height, where it bends,
inline constexpr float kBendShift = 0.25F;   // and how far it leans there, of what its tip does
inline constexpr float kBroadBlade = 1.3F;   // a triangle as large as a blade is broader by so much

// Metres; albedos as they are stored, their roots.
struct GrassPatch {
  std::uint64_t key = 0;
  glm::vec2 slope{0.0F};
  std::uint32_t tufts = 1;
  float radius = 0, height = 0, width = 0, lean = 0;
  float brightness = 0, dryness = 0;
  glm::vec3 petals{0.0F};
};

constexpr std::uint32_t grass_tufts(std::uint32_t blades) {
  return (blades + 7) / 8;
}
// How deep feet are in the ground: it may be curved.
inline float foot_depth(const GrassPatch& patch) {
  return 0.15F * patch.height + 0.06F * patch.radius;
}

struct GrassBlade {
  glm::vec3 foot{0.0F}, middle{0.0F}, tip{0.0F};
  glm::vec2 across{0.0F};  // half of its width at the foot
  glm::vec2 bend{0.0F};    // unit, where the tip leans to
  glm::vec3 colour{0.0F};
  float sway = 0;
};

// A function of patch and number alone, so that levels have the same blades.
GrassBlade blade_of(const GrassPatch& patch, std::uint32_t number);

class GrassWriter {
 public:
  GrassWriter(const GrassPatch& patch, const core::Bounds& box, const MeshView& out);

  void add_blade(const GrassBlade& blade);
  void add_coarse_blade(const GrassBlade& blade, float broader);
  void add_flower(const GrassBlade& stem);
  void add_coarse_flower(const GrassBlade& stem, float larger);
  core::Bounds tight() const { return tight_; }

 private:
  struct Point {
    glm::vec3 place, normal, colour;
    float ambient, sway;
  };
  Point at_foot(const GrassBlade& blade, float side) const;
  Point at_middle(const GrassBlade& blade, float side) const;
  Point at_tip(const GrassBlade& blade) const;
  void add(const Point& point);
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  const GrassPatch& patch_;
  BoxPacker packer_;
  MeshView out_;
  glm::vec3 up_;  // of the ground
  std::uint32_t vertices_ = 0, indices_ = 0;
  core::Bounds tight_{glm::vec3(1e9F), glm::vec3(-1e9F)};
};

}  // namespace psygen::models
