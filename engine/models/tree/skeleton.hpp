// The skeleton of a tree: its branches as a structure of arrays, grown depth by depth. Every random
// number is keyed on the branch's path from the root. So a branch does not depend on the others
// that are grown, and all levels of detail share one skeleton. It makes no mesh (mesh.hpp).
// Functions are pure, for any thread, and linear in the branches. docs/models.md, "Tree".
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

#include "engine/models/tree/plan.hpp"

namespace psygen::models {

inline constexpr std::uint32_t kWholeTree = UINT32_MAX;  // for `max_tips`: all paths
inline constexpr std::uint32_t kTreeLanes = 16;          // groups begin at multiples of this
inline constexpr std::size_t kMaxTreeGroups = kMaxKinds * kMaxTreeIterations + 1;
inline constexpr std::uint32_t kMaxTreeSlots =
    kMaxTreeNodes + kTreeLanes * static_cast<std::uint32_t>(kMaxTreeGroups + 4);

// The branches of one kind and depth: slots [first, first + count) of a skeleton.
struct TreeGroup {
  std::uint32_t first = 0, count = 0;
  std::uint8_t kind = 0, depth = 0;
  bool tip = false;  // nothing grows from them, so they end in points
};

// The number of branches of each kind at each depth.
struct TreeCount {
  std::array<TreeGroup, kMaxTreeGroups> groups;  // `first` is unused
  std::size_t group_count = 0;
  int depth = 0;
  std::uint32_t bearers = 0;  // branches with leaves
  std::uint32_t nodes = 0;    // branches
  std::uint32_t tips = 0;
  TreeCount() {}  // leaves `groups` unwritten
};
// Counts the branches on at most `max_tips` paths by hashing, without growing them. `depth` as for
// grow_tree; branches deeper than `last` are not counted.
TreeCount count_tree(const TreePlan& plan, int depth, std::uint32_t max_tips = kWholeTree,
                     int last = kMaxTreeIterations);
// Returns the iteration after which the whole tree stops growing.
int tree_depth(const TreePlan& plan);

// Rows of numbers of a skeleton, in metres. Positions and directions take three rows each. The
// radius is the radius at the base; at the end it is multiplied by the taper, or 0 at tips.
enum TreeRow : std::size_t {
  kBase = 0,
  kDirection = 3,
  kBend = 6,
  kLength = 9,
  kRadius = 10,
  kTreeRows = 11
};

// The branches of a tree. Branch i is the curve base + length · (t · direction + t² · bend), t in
// [0, 1], in metres from the tree's base point. Groups are in order of depth, then kind. Branches
// are in order of their parents, then their rank among siblings of their kind. Slots between groups
// have no meaning. About 470 KiB: too large for a stack (Scratch).
struct TreeSkeleton {
  // One number for each slot.
  using Row = std::array<float, kMaxTreeSlots>;
  using Words = std::array<std::uint32_t, kMaxTreeSlots>;
  alignas(64) Row rows[kTreeRows];
  alignas(64) Words key;     // random.hpp
  alignas(64) Words draw;    // random number that determines the children
  alignas(64) Words parent;  // slot of the parent
  alignas(64) Words rank;    // among siblings of the kind
  alignas(64) Row share;     // 1 / number of siblings of the kind
  alignas(64) Words budget;  // paths through the branch
  // Only for the whole tree: the slot of the first child of each kind, and, if the grammar has one
  // rule for the branch, the number of children of its starred kind.
  Words child[kMaxKinds], stars;
  std::array<TreeGroup, kMaxTreeGroups> groups;
  std::size_t group_count;
  int depth;  // of the deepest group

  // The point of branch i at t, 0 base … 1 end.
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

// Grows the skeleton to `depth`, which is tree_depth(), or also plan.iterations for the whole tree.
// It follows kWholeTree or at most `max_tips` <= kMaxPaths paths from the root to tips, distributed
// by the expected number of tips. The trunk and every branch on a path are exactly those of the
// whole tree. A tree stops before the depth that would exceed kMaxTreeNodes.
void grow_tree(const TreePlan& plan, int depth, std::uint32_t max_tips, TreeSkeleton& out);

// The branches on some paths of a tree, in order of depth, kind and parents.
inline constexpr std::uint32_t kMaxPaths = 64;
struct TreePaths {
  // Slot in the whole tree, and paths through the branch.
  struct Node {
    std::uint32_t slot, budget;
    std::uint8_t kind, depth;
  };
  std::array<Node, kMaxPaths*(kMaxTreeIterations + 1)> nodes;
  std::uint32_t count;
  int depth;      // of the last node
  TreePaths() {}  // leaves everything unwritten
};
// Finds in the whole tree `s` the branches that grow_tree() would grow with its depth and
// `max_tips` <= kMaxPaths.
void find_paths(const TreePlan& plan, const TreeSkeleton& s, std::uint32_t max_tips,
                TreePaths& out);

}  // namespace psygen::models
