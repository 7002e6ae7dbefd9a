// The blades of a patch of grass: the position of each blade, and its vertices. Internal to
// grass.cpp. Functions are pure; a GrassWriter belongs to one thread. Constant time a blade, no
// allocation. Results have the same bits on every CPU: single precision, and no library function
// but the square root. docs/models.md, "Grass".
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/coordinates.hpp"
#include "engine/models/kit/packing.hpp"
#include "engine/models/model_type.hpp"

namespace psygen::models {

// Sizes at level 0 of a blade, and of a flower with its stem.
inline constexpr std::uint32_t kBladeVertices = 5, kBladeTriangles = 3;
inline constexpr std::uint32_t kFlowerVertices = kBladeVertices + 5;
inline constexpr std::uint32_t kFlowerTriangles = kBladeTriangles + 4;
// Blade numbers from here on are the stems of flowers.
inline constexpr std::uint32_t kFirstStem = 1U << 20;
// Largest distance of a blade's base from its tuft's middle, relative to the patch's height.
inline constexpr float kTuftSpread = 0.22F;
inline constexpr float kBendHeight = 0.55F;  // height of the bend, relative to the blade's height
inline constexpr float kBendShift = 0.25F;   // lean at the bend, relative to the lean of the tip
inline constexpr float kBroadBlade = 1.3F;   // width of a one-triangle blade over a blade's own

// The numbers of one patch, in metres. Colours are square roots of albedos, as vertices store them.
struct GrassPatch {
  std::uint64_t key = 0;  // of all random numbers of the patch
  glm::vec2 slope{0.0F};  // rise of the ground per metre along x and z
  std::uint32_t tufts = 1;
  // `height` is the height of the highest blades, `width` a blade's width at its base, `lean` the
  // shift of a tip over its blade's height.
  float radius = 0, height = 0, width = 0, lean = 0;
  float brightness = 0, dryness = 0;  // square root of the mean albedo; 0 green … 1 straw
  glm::vec3 petals{0.0F};
};

// Tufts of a patch: one for every eight blades, rounded up.
constexpr std::uint32_t grass_tufts(std::uint32_t blades) {
  return (blades + 7) / 8;
}
// Metres by which blades extend below the sloping plane, so that curved ground shows no gaps.
inline float foot_depth(const GrassPatch& patch) {
  return 0.15F * patch.height + 0.06F * patch.radius;
}

// One blade or stem, in metres from the patch's middle.
struct GrassBlade {
  glm::vec3 foot{0.0F}, middle{0.0F}, tip{0.0F};
  glm::vec2 across{0.0F};  // half of its width at the base, along x and z
  glm::vec2 bend{0.0F};    // unit vector in x and z, in the direction of the lean
  glm::vec3 colour{0.0F};  // stored colour (GrassPatch)
  float sway = 0;          // at the tip, 0 … 1
};

// Returns blade `number` of the patch, or stem `number` − kFirstStem of a flower. Depends on
// nothing else, so all levels have the same blades.
GrassBlade blade_of(const GrassPatch& patch, std::uint32_t number);

// Appends blades and flowers to a mesh. The caller has checked that `out` has room for all of them.
class GrassWriter {
 public:
  // Positions are packed in `box`. `patch` and the memory of `out` must outlive the writer.
  GrassWriter(const GrassPatch& patch, const core::Bounds& box, const MeshView& out);

  // Level 0 has whole blades, and flowers with their stems. Coarser levels have one triangle of
  // three vertices each: a blade `broader` times as wide, or a flower's head `larger` times as
  // wide.
  void add_blade(const GrassBlade& blade);
  void add_coarse_blade(const GrassBlade& blade, float broader);
  void add_flower(const GrassBlade& stem);
  void add_coarse_flower(const GrassBlade& stem, float larger);
  // Box of the vertices added so far, in metres; empty (min > max) before the first.
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
  glm::vec3 up_;  // normal of the ground
  std::uint32_t vertices_ = 0, indices_ = 0;
  core::Bounds tight_{glm::vec3(1e9F), glm::vec3(-1e9F)};
};

}  // namespace psygen::models
