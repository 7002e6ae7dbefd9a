// The skeleton of a tree: its branches as a structure of arrays, grown level by level. Every random
// number is keyed on the branch's path from the root, so a branch is the same whichever others are
// grown beside it, and all levels of detail share one skeleton. Not meshed here (mesh.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

#include "engine/models/tree/plan.hpp"

namespace psygen::models {

inline constexpr std::uint32_t kWholeTree = UINT32_MAX;
inline constexpr std::uint32_t kTreeLanes = 16;  // groups begin at multiples of this
inline constexpr std::size_t kMaxTreeGroups = kMaxKinds * kMaxTreeIterations + 1;
inline constexpr std::uint32_t kMaxTreeSlots =
    kMaxTreeNodes + kTreeLanes * static_cast<std::uint32_t>(kMaxTreeGroups + 4);

// Branches of one kind and depth.
struct TreeGroup {
  std::uint32_t first = 0, count = 0;
  std::uint8_t kind = 0, depth = 0;
  bool tip = false;  // they end in points: nothing grows from them
};

// How many branches each kind has at each depth. Found by hashing alone.
struct TreeCount {
  std::array<TreeGroup, kMaxTreeGroups> groups;  // `first` is unused
  std::size_t group_count = 0;
  int depth = 0;
  std::uint32_t bearers = 0;  // branches with leaves
  std::uint32_t nodes = 0;
  std::uint32_t tips = 0;
  TreeCount() {}
};
// Of the branches on at most `max_tips` paths; `depth` as for grow_tree, `last` the deepest that is
// wanted.
TreeCount count_tree(const TreePlan& plan, int depth, std::uint32_t max_tips = kWholeTree,
                     int last = kMaxTreeIterations);
// The iteration after which the whole tree stops growing.
int tree_depth(const TreePlan& plan);

// Rows of numbers that branches have: places and directions take three each; the radius is that at
// the foot (at the end times the taper, or 0 at tips).
enum TreeRow : std::size_t {
  kBase = 0,
  kDirection = 3,
  kBend = 6,
  kLength = 9,
  kRadius = 10,
  kTreeRows = 11
};

// Branch i runs from base along base + length · (t · direction + t² · bend), t in [0, 1].
// Groups are in order of depth, then kind; branches in order of their parents, then their rank
// among siblings of their kind. About 470 KiB, meant for the stack; what lies between groups is not
// meant to be read.
struct TreeSkeleton {
  using Row = std::array<float, kMaxTreeSlots>;
  using Words = std::array<std::uint32_t, kMaxTreeSlots>;
  alignas(64) Row rows[kTreeRows];
  alignas(64) Words key;
  alignas(64) Words draw;
  alignas(64) Words parent;  // its slot
  alignas(64) Words rank;    // among siblings of the kind
  alignas(64) Row share;     // 1 / number of siblings of the kind
  alignas(64) Words budget;  // paths
  // Of the whole tree only: the first child of each kind, and how many there are of the kind that
  // fills up, where the grammar has one rule for the branch.
  Words child[kMaxKinds], stars;
  std::array<TreeGroup, kMaxTreeGroups> groups;
  std::size_t group_count;
  int depth;

  glm::vec3 point(std::uint32_t i, float t) const {
    const float q = t * t;
    const auto along = [&](std::size_t c) {
      return rows[kBase + c][i] +
             rows[kLength][i] * (t * rows[kDirection + c][i] + q * rows[kBend + c][i]);
    };
    return {along(0), along(1), along(2)};
  }
  TreeSkeleton() {}  // leaves the arrays unwritten
};

// Grows the skeleton to `depth` (tree_depth(); with the whole tree also plan.iterations), following
// at most `max_tips` paths from the root to tips, shared out by the expected number of tips. The
// trunk and every branch on a path are exactly those of the whole tree.
void grow_tree(const TreePlan& plan, int depth, std::uint32_t max_tips, TreeSkeleton& out);

// The branches on some paths of a tree, in order of depth, kind and parents.
inline constexpr std::uint32_t kMaxPaths = 64;
struct TreePaths {
  struct Node {
    std::uint32_t slot, budget;
    std::uint8_t kind, depth;
  };
  std::array<Node, kMaxPaths*(kMaxTreeIterations + 1)> nodes;
  std::uint32_t count;
  int depth;
  TreePaths() {}
};
// Finds in the whole tree `s` what grow_tree() with this depth and `max_tips` <= kMaxPaths grows.
void find_paths(const TreePlan& plan, const TreeSkeleton& s, std::uint32_t max_tips,
                TreePaths& out);

}  // namespace psygen::models
