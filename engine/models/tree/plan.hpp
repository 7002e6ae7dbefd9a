// What one tree is grown and meshed from: the grammar as counts of children, and the numbers of
// each kind of branch after all parameters have been put in. Plain values in single precision, made
// once per call (plan_of_tree, SpeciesType) and read by every kernel. Not the user's description of
// a species (species.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

#include "engine/core/coordinates.hpp"
#include "engine/models/model_type.hpp"

namespace psygen::models {

inline constexpr std::size_t kMaxKinds = 8;
inline constexpr std::size_t kMaxRules = 16;
inline constexpr int kMaxTreeIterations = 12;
// A tree stops growing before the iteration that would take it beyond this number of branches.
inline constexpr std::uint32_t kMaxTreeNodes = 3072;
inline constexpr std::uint32_t kMaxChildren = 64;  // of one node
inline constexpr std::uint8_t kNoKind = 0xFF;

// Which branches of a kind bear leaves.
enum class LeavesOn : std::uint8_t { kNone, kTips, kAll };

// One way in which a node becomes branches. Chosen where the lower 16 bits of the node's draw are
// below `until`.
struct GrammarRule {
  std::uint32_t until = 65536;
  std::array<std::uint8_t, kMaxKinds> count{};  // children of each kind
  std::uint32_t fixed = 0;                      // their sum
  std::uint8_t star = kNoKind;                  // this kind fills up to the drawn number
};

struct Grammar {
  std::uint8_t kinds = 0;
  std::array<std::uint8_t, kMaxKinds + 1> first_rule{};  // of each kind; none: it never branches
  std::array<GrammarRule, kMaxRules> rules;
  int spread = 2;  // the number drawn for `star` is within branches ± spread, at least 1
  bool grows(std::size_t kind) const { return first_rule[kind] < first_rule[kind + 1]; }
};

// Angles in turns. "low" is at the lower end of `along`; lengths are relative to the parent's.
struct KindPlan {
  float angle_high, angle_low, angle_variation, whorl;
  float along_low, along_high;
  float length_high, length_foot;  // at the parent's end and at its foot
  float radius;                    // over the parent's there
  float lift, bend_up, curvature;
  bool leader;  // goes on in its parent's direction
  LeavesOn leaves;
};

// Corners of a spray: along its axis, across, and against its normal, in spray lengths.
inline constexpr std::uint32_t kMaxSprayVertices = 10, kMaxSprayTriangles = 8;
struct SprayForm {
  std::uint32_t vertices, triangles;
  float along[kMaxSprayVertices], across[kMaxSprayVertices], droop[kMaxSprayVertices];
  std::uint8_t indices[3 * kMaxSprayTriangles];
};

// Directions of a spray: axis = unit(random · o + out · outwards + branch · along it + up · Y),
// side = unit((side_out · outwards + side_random · o' + side_up · Y) × axis),
// normal = unit(outwards + 0.3 · axis + normal_up · Y).
struct FoliagePlan {
  const SprayForm* near = nullptr;  // levels 0 and 1; null: no foliage
  const SprayForm* far = nullptr;   // levels 2 and 3
  float random, out, branch, up;
  float side_random, side_out, side_up, normal_up;
  float from;         // where on a branch they begin
  float cluster;      // radius of clusters, relative
  float fill;         // size of leaves over the size that just fills the crown
  float density;      // sprays per bearer at level 0
  float hull = 1.0F;  // size of hulls over the size that holds the crown
};

struct TreePlan {
  const Grammar* grammar;
  std::uint8_t axiom;
  std::uint32_t key, salt;  // of the trunk; of all random numbers
  int iterations, branches;
  bool always_complete;  // no seed makes it stop before the last iteration
  // Expected tips of a kind after so many iterations more, [kind][iterations]; null: all equal.
  const std::array<std::array<std::uint32_t, kMaxTreeIterations + 1>, kMaxKinds>* weights;
  std::array<KindPlan, kMaxKinds> kinds;
  float size_m, radius_m, taper, flare;
  float trunk_curvature;
  // The ellipsoid that branches are kept in: centre (0, envelope_y, 0); inverse half axes, 0: none.
  float envelope_y, envelope_across, envelope_up;
  float limit_across, limit_up;
  FoliagePlan foliage;
  // Stored colours of leaves over [0, 1], five of them evenly spaced; `cyclic`: the last is the
  // first.
  std::array<std::array<float, 3>, 5> ramp;
  bool cyclic;
  float hue, colour_variation;
  std::array<float, 3> bark;  // stored colour
  float bark_contrast;
  core::Bounds bounds;
};

}  // namespace psygen::models
