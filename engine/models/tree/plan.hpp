// The input for growing and meshing one tree: the grammar as counts of children, and the numbers of
// each kind of branch with all parameters applied. Plain values in single precision, made once per
// call (plan_of_tree, SpeciesType) and read by every kernel. Not the user's description of a
// species (species.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

#include "engine/core/coordinates.hpp"
#include "engine/models/model_type.hpp"

namespace psygen::models {

// Limits of a grammar.
inline constexpr std::size_t kMaxKinds = 8;
inline constexpr std::size_t kMaxRules = 16;
inline constexpr int kMaxTreeIterations = 12;
// A tree stops growing before the iteration that would take it beyond this number of branches.
inline constexpr std::uint32_t kMaxTreeNodes = 3072;
inline constexpr std::uint32_t kMaxChildren = 64;  // of one node
inline constexpr std::uint8_t kNoKind = 0xFF;

// The branches of a kind that bear leaves.
enum class LeavesOn : std::uint8_t { kNone, kTips, kAll };

// One replacement of a node by branches. The first rule of a kind applies whose `until` is above
// the lower 16 bits of the node's draw.
struct GrammarRule {
  std::uint32_t until = 65536;
  std::array<std::uint8_t, kMaxKinds> count{};  // children of each kind
  std::uint32_t fixed = 0;                      // their sum
  std::uint8_t star = kNoKind;                  // the kind that fills up to the drawn number
};

// A grammar: kinds of branches, and the rules of each. A kind without rules never branches.
struct Grammar {
  std::uint8_t kinds = 0;
  std::array<std::uint8_t, kMaxKinds + 1> first_rule{};  // of each kind; the last is the end
  std::array<GrammarRule, kMaxRules> rules;
  int spread = 2;  // the number drawn for `star` is within branches ± spread, at least 1
  // True if branches of a kind branch again.
  bool grows(std::size_t kind) const { return first_rule[kind] < first_rule[kind + 1]; }
};

// The numbers of one kind of branch. Angles are in turns; lengths are relative to the parent's.
struct KindPlan {
  // Angle to the parent at `along_high` and `along_low`, its relative variation, and the turn
  // around the parent from one sibling to the next.
  float angle_high, angle_low, angle_variation, whorl;
  float along_low, along_high;     // range of positions on the parent, 0 base … 1 end
  float length_high, length_foot;  // at the parent's end and at its base
  float radius;                    // over the parent's radius at that position
  // Added to the direction along Y; bend along Y; strength of the random bend.
  float lift, bend_up, curvature;
  bool leader;  // continues its parent from the end, in its direction
  LeavesOn leaves;
};

// The shape of a spray of leaves. Corners are given along its axis, across, and against its normal,
// in spray lengths.
inline constexpr std::uint32_t kMaxSprayVertices = 10, kMaxSprayTriangles = 8;
struct SprayForm {
  std::uint32_t vertices, triangles;
  struct {
    float along[kMaxSprayVertices], across[kMaxSprayVertices], droop[kMaxSprayVertices];
  } corners;
  std::uint8_t indices[3 * kMaxSprayTriangles];
};

// The foliage. The directions of a spray are, with random vectors o and o',
// axis = unit(random · o + out · outwards + branch · (direction of the branch) + up · Y),
// side = unit((side_out · outwards + side_random · o' + side_up · Y) × axis),
// normal = unit(outwards + 0.3 · axis + normal_up · Y).
struct FoliagePlan {
  const SprayForm* near = nullptr;  // levels 0 and 1; null: no foliage
  const SprayForm* far = nullptr;   // levels 2 and 3
  float random, out, branch, up;
  float side_random, side_out, side_up, normal_up;
  float from;         // lowest position of leaves on a branch, 0 base … 1 end
  float cluster;      // radius of clusters, relative
  float fill;         // size of leaves over the size that just fills the crown
  float density;      // sprays per bearer at level 0
  float hull = 1.0F;  // size of hulls over the size that holds the crown
};

// One tree. The objects that it points to must outlive it.
struct TreePlan {
  const Grammar* grammar;
  std::uint8_t axiom;        // kind of the trunk
  std::uint32_t key, salt;   // key of the trunk; salt of all random numbers
  int iterations, branches;  // branches: mean number that starred kinds fill up to
  bool always_complete;      // no seed exceeds kMaxTreeNodes before the last iteration
  // Expected tips of a kind after more iterations, [kind][iterations]; null: all equal.
  const std::array<std::array<std::uint32_t, kMaxTreeIterations + 1>, kMaxKinds>* weights;
  std::array<KindPlan, kMaxKinds> kinds;
  // Length and radius of the trunk, radius of a branch at its end over that at its base, widening
  // of the trunk at its base.
  float size_m, radius_m, taper, flare;
  float trunk_curvature;
  // The ellipsoid around the crown in metres: centre (0, envelope_y, 0), half axes across and up.
  // Branches are kept inside if the inverse half axes `limit_` are not 0.
  float envelope_y, envelope_across, envelope_up;
  float limit_across, limit_up;
  FoliagePlan foliage;
  // Five stored colours of leaves, evenly spaced over hues 0 … 1. In a cyclic ramp the last equals
  // the first.
  std::array<std::array<float, 3>, 5> ramp;
  bool cyclic;
  float hue, colour_variation;
  std::array<float, 3> bark;  // stored colour
  float bark_contrast;        // largest change of brightness, ±
  core::Bounds bounds;        // ModelType::bounds()
};

}  // namespace psygen::models
