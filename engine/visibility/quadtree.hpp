// The cut through the quadtree of blocks: the set of nodes that covers the ground in one frame. A
// node of level k covers 2^k × 2^k blocks; node (x, z) begins at block (x << k, z << k). Distances
// alone decide, so a level is known before anything is synthesised. Restricted: touching leaves
// differ by at most two levels (proof at split_distances). Knows no entities and no meshes. Linear
// in the nodes of the cut, whose number grows with the logarithm of the view distance; allocates
// only while results grow. Values only; any thread.
#pragma once

#include <compare>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/core/coordinates.hpp"

namespace psygen::visibility {

// The highest level of a node.
inline constexpr std::uint8_t kMaxNodeLevel = 30;

// A level in [0, kMaxNodeLevel] and coordinates in units of the node's side. Canonical: coordinates
// lie in [−2^(31 − level), 2^(31 − level)), as those of node_of() do; block indices wrap at 2^32.
struct NodeCoord {
  core::BlockCoord coord;
  std::uint8_t level = 0;
  friend constexpr auto operator<=>(const NodeCoord&, const NodeCoord&) = default;
};

// The node of a level that contains a block.
constexpr NodeCoord node_of(core::BlockCoord block, std::uint8_t level) {
  return {{block.x >> level, block.z >> level}, level};
}

// The block at the node's corner with the smallest x and z.
constexpr core::BlockCoord corner_block(const NodeCoord& node) {
  const auto shifted = [&node](std::int32_t index) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(index) << node.level);
  };
  return {shifted(node.coord.x), shifted(node.coord.z)};
}

// The node of the next level that contains this one. Its level is below kMaxNodeLevel.
constexpr NodeCoord parent_of(const NodeCoord& node) {
  return {{node.coord.x >> 1, node.coord.z >> 1}, static_cast<std::uint8_t>(node.level + 1)};
}

// Child i in 0 … 3 of a node of level >= 1. Bit 0 of i is the step in x, bit 1 the step in z.
constexpr NodeCoord child_of(const NodeCoord& node, unsigned i) {
  const auto step = [](std::int32_t index, unsigned bit) {
    return static_cast<std::int32_t>((static_cast<std::uint32_t>(index) << 1) | bit);
  };
  return {{step(node.coord.x, i & 1U), step(node.coord.z, i >> 1)},
          static_cast<std::uint8_t>(node.level - 1)};
}

// The node `dx`, `dz` steps away on the same level, across the seam of the block indices if
// necessary.
NodeCoord neighbour_of(const NodeCoord& node, std::int32_t dx, std::int32_t dz);

// ---- From errors to distances ------------------------------------------------------------------

// Distances in metres at which a node of a level changes. 0 < split_m <= merge_m.
struct LevelDistances {
  double split_m = 0;  // a nearer node is split into its four children
  double merge_m = 0;  // once split, it stays split up to this distance
  double morph_m = 0;  // its children begin to take its shape here, and have it at split_m
};

// Conversion of errors in metres to distances. A node's side is 2^level blocks.
struct SplitSettings {
  double block_size_m = 64;
  double pixels_per_radian = 1000;
  double max_error_pixels = 1;  // number of pixels that an error may cover
  // A node nearer than this many of its sides is split, whatever its error.
  double min_ratio = 1;
  // The error of a node alone never splits it at more than this many of its sides.
  double max_ratio = std::numeric_limits<double>::infinity();
  double merge_factor = 1.1;  // merge_m / split_m, >= 1
  double morph_share = 0.7;   // fraction of split_m where morphing begins; above 0, at most 1
};

// One LevelDistances for each level. level_errors_m[k] is the error of the mesh of a node of level
// k. Both spans have the same length, at most kMaxNodeLevel + 1. A node of level 0 that is "split"
// is a block drawn with its finest mesh (CutNode::fine), so level_errors_m[0] is the error of a
// block's coarser mesh.
//
// split(k) = max(min(error(k) · pixels per radian / max error in pixels, max_ratio · side(k)),
//                min_ratio · side(k),
//                merge(k − 1) / morph_share, merge(k − 2) + diagonal(k − 2)).
//
// The last term makes the cut restricted. Let P of level p be split, so d(P) < merge(p), and let B
// of level b > p + 1 touch it. Distances are horizontal distances to squares, or the hypotenuse of
// these and a clearance that does not grow with the level. Hence d(B) <= d(P) + diagonal(p) <
// split(p + 2) <= split(b): B is split as well. A leaf's parent is split, so no leaf that touches
// it is more than two levels above it. merge(k − 1) keeps split nodes within split nodes. Divided
// by morph_share it lets a node that has just replaced its children (at merge(k)) begin without
// morph, and leaves room for morphing: merge(k) <= morph(k + 1) = morph_share · split(k + 1).
void split_distances(std::span<const double> level_errors_m, const SplitSettings& settings,
                     std::span<LevelDistances> levels);

// ---- The cut -----------------------------------------------------------------------------------

// A rectangle of blocks. Nodes outside it do not exist. 0 along an axis: endless.
struct BlockArea {
  core::BlockCoord corner;
  std::uint32_t blocks_x = 0, blocks_z = 0;
};

// Input of select_cut. The spans must stay valid during the call.
struct CutInput {
  core::WorldPosition camera;  // within 2^30 blocks of all roots
  double block_size_m = 64;
  std::span<const NodeCoord> roots;        // canonical, of one level, each once
  std::span<const LevelDistances> levels;  // of split_distances, up to the roots' level at least
  // By level: vertical distance in metres of the camera from all ground that nodes of the level
  // could show. It must not grow with the level (see the proof above). Empty: 0 for all.
  std::span<const double> clearances_m;
  double view_distance_m = std::numeric_limits<double>::infinity();  // horizontal, for all nodes
  BlockArea world;
};

// The parent of a root.
inline constexpr std::uint32_t kNoNode = UINT32_MAX;

// A node of the cut with its position relative to the camera.
struct CutNode {
  NodeCoord node;
  bool leaf = true;                // drawn once its mesh is ready; otherwise its children are
  bool fine = false;               // a leaf of level 0 near enough for its finest mesh
  std::uint32_t parent = kNoNode;  // index in Cut::nodes
  std::uint32_t end = 0;  // nodes[i + 1] … nodes[end − 1] are its descendants in the cut
  float corner_x_m = 0, corner_z_m = 0;  // of the node's corner, relative to the camera
  float side_m = 0;
  float distance_m = 0;  // decides the level: horizontal distance combined with the clearance
  // In [0, 1]. 0: the node's own shape. 1: the next coarser shape: a fine block's coarser mesh, or
  // any other node's parent. As the camera moves, leaves appear with 1 when their parent is split,
  // and a node appears with 0 when its children, all at 1, merge.
  float morph = 0;

  // The node's box relative to the camera, given its lowest and highest height relative to the
  // camera.
  core::Bounds box(float low_y_m, float high_y_m) const {
    return {{corner_x_m, low_y_m, corner_z_m},
            {corner_x_m + side_m, high_y_m, corner_z_m + side_m}};
  }
};

// The caller keeps it from tick to tick: nodes that were split before provide the hysteresis.
struct Cut {
  // Parents before their children, and front to back: seen from above, the leaves that any
  // half-line from the camera crosses appear here from near to far.
  std::vector<CutNode> nodes;
  std::vector<NodeCoord> split;  // inner nodes and fine blocks, sorted

  // Working memory.
  std::vector<NodeCoord> split_before, roots;
};

// Replaces the nodes of the cut. A node is split if its distance is below split_m. A node that was
// split in the previous cut stays split while its distance is below merge_m.
void select_cut(const CutInput& input, Cut& cut);

// Replaces the contents of `roots` with the canonical nodes of a level that cover everything up to
// `view_distance_m` around the camera along both axes, as far as they reach into `world`. The
// square must be less than 2^31 blocks wide.
void roots_around(const core::WorldPosition& camera, double block_size_m, double view_distance_m,
                  std::uint8_t level, std::vector<NodeCoord>& roots, const BlockArea& world = {});

// Selects the nodes to draw while meshes are missing: ready[i] tells if cut.nodes[i] has a mesh. A
// ready node is drawn if it is a leaf, or if the ready nodes below it do not cover all of it. Drawn
// nodes never overlap, and all ground under a ready node is covered. Indices into cut.nodes, in
// their order, replace the contents of `drawn`; `scratch` is working memory. O(nodes).
void drawn_nodes(const Cut& cut, std::span<const std::uint8_t> ready,
                 std::vector<std::uint8_t>& scratch, std::vector<std::uint32_t>& drawn);

// ---- LODs of meshes ----------------------------------------------------------------------------

// A coarser level is chosen only if its error is within this fraction of the allowed error: a
// camera on the border between two levels must not flicker.
inline constexpr float kCoarserShare = 0.8F;

// Chooses the LOD of a mesh whose level l has the error level_errors_m[l] (0 at level 0,
// ascending). The distance is that of the mesh's nearest point; 0 or less gives the finest level.
// `current_level` is the level shown now, −1 for none. With −1 the result is the coarsest level up
// to which every error stays within max_error_pixels. A finer level than the current one is chosen
// as soon as it is needed, a coarser one only within kCoarserShare of the allowed error. Level 0 if
// no level suffices. Enforces no budget: a budget raises the allowed error instead. Linear in the
// levels.
int choose_level(std::span<const float> level_errors_m, float distance_m, float pixels_per_radian,
                 float max_error_pixels, int current_level);

}  // namespace psygen::visibility
