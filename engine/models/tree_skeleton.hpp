// The skeleton of a tree: its branches as a structure of arrays, grown level by level. Every random
// number is keyed on the branch's path from the root, so a branch is the same whichever others are
// grown beside it, and all levels of detail share one skeleton. Not meshed here (tree_mesh.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

#include "engine/models/model_type.hpp"

namespace psygen::models {

inline constexpr int kMaxTreeIterations = 8;
// A tree stops growing before the iteration that would take it beyond this number of branches.
inline constexpr std::uint32_t kMaxTreeNodes = 3072;
inline constexpr std::uint32_t kWholeTree = UINT32_MAX;

// A child is at most this times its parent's length times the length decay.
inline constexpr float kMaxLengthFactor = 1.15F * 1.09F;

// The parameters, as the kernels use them. Angles in turns, lengths in metres.
struct TreeShape {
  explicit TreeShape(const Parameters& p);
  std::uint64_t root_key;
  int iterations;
  int branches;
  float size_m, radius_m;
  float angle_turns, angle_variation;
  float length_decay, radius_decay;
  float tropism, curvature, flare;
  float leaf_scale, leaf_hue, colour_variation, bark_tone;
  // The ellipsoid that branches are kept in: centre (0, envelope_y, 0), half axes in metres.
  float envelope_y, envelope_across, envelope_up;
};

// Number of branches that the node of this key has: m − 2 … m + 2, at least 1.
inline std::uint32_t child_count(std::uint64_t key, int branches) {
  const int drawn = branches - 2 + static_cast<int>(((key >> 48) * 5) >> 16);
  return drawn < 1 ? 1U : static_cast<std::uint32_t>(drawn);
}
inline std::uint64_t child_key(std::uint64_t parent_key, std::uint32_t number) {
  return core::mix64(parent_key + 0xD1B54A32D192ED03ull * (number + 1));
}

// How many branches each depth has; depth 0 is the trunk. Found by hashing alone.
struct TreeCount {
  std::array<std::uint32_t, kMaxTreeIterations + 1> nodes{};
  int depth = 0;  // of the tips; less than `iterations` where the tree stopped growing
  std::uint32_t tips() const { return nodes[static_cast<std::size_t>(depth)]; }
};
TreeCount count_tree(const TreeShape& shape);
// The depth of the tips, which is count_tree(shape).depth, without counting where no draw of
// branches could reach kMaxTreeNodes.
int tip_depth(const TreeShape& shape);

// Branch i runs from base along base + length · (t · direction + t² · bend), t in [0, 1].
// Branches of one depth are contiguous, in order of their parents. About 200 KiB, meant for the
// stack; only the first `count` entries are written.
struct TreeSkeleton {
  std::uint32_t count = 0;
  int depth = 0;
  std::array<std::uint32_t, kMaxTreeIterations + 2> first{};  // of each depth; [depth + 1] = count
  std::array<std::uint64_t, kMaxTreeNodes> key;
  std::array<glm::vec3, kMaxTreeNodes> base, direction, bend;
  std::array<float, kMaxTreeNodes> length, radius_start, radius_end;
  std::array<std::uint32_t, kMaxTreeNodes> parent, budget;

  glm::vec3 point(std::uint32_t i, float t) const {
    return base[i] + length[i] * (t * direction[i] + (t * t) * bend[i]);
  }
  std::uint32_t first_tip() const { return first[static_cast<std::size_t>(depth)]; }
  std::uint32_t tip_count() const { return count - first_tip(); }
  TreeSkeleton() {}  // leaves the arrays unwritten
};

// Grows the skeleton to `depth` (tip_depth()), following at most `max_tips` paths from the root
// to tips (evenly shared out among the children on the way); kWholeTree grows all. The trunk and
// every branch on a path are exactly those of the whole tree.
void grow_tree(const TreeShape& shape, int depth, std::uint32_t max_tips, TreeSkeleton& out);

}  // namespace psygen::models
