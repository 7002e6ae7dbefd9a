// The broadleaf tree: a stochastic L-system whose nodes draw their own number of branches, meshed
// at six levels of detail from one skeleton (paper, section 5.2, eq. 4; docs/models.md, "Tree").
// Leaf triangles are visible from both sides, so trees are drawn without back-face culling.
// Parameters determine its appearance; trees with a grammar as data are species (species.hpp).
#pragma once

#include <cstddef>
#include <iterator>
#include <memory>

#include "engine/models/model_type.hpp"
#include "engine/models/tree/plan.hpp"

namespace psygen::models {

// Indices into kTreeSchema.
enum TreeParameter : std::size_t {
  kTreeSeed = 0,
  kTreeIterations,
  kTreeBranches,
  kTreeSizeM,
  kTreeRadiusM,
  kTreeBranchAngle,
  kTreeAngleVariation,
  kTreeLengthDecay,
  kTreeRadiusDecay,
  kTreeTropism,
  kTreeCurvature,
  kTreeFlare,
  kTreeLeafScale,
  kTreeLeafHue,
  kTreeColourVariation,
  kTreeBarkTone,
  kTreeParameterCount
};
inline constexpr int kTreeMaxIterations = 8;

// The schema of the type "tree", by TreeParameter.
inline constexpr ParameterSpec kTreeSchema[] = {
    placed(
        integer_parameter("seed", "", 1, {-9.3e18, 9.3e18}, {0, 1e6}, "selects one of all trees")),
    integer_parameter("iterations", "1", 4, {1, kTreeMaxIterations}, {2, 5},
                      "number of times that every branch end branches again"),
    integer_parameter(
        "branches", "1", 3, {1, 6}, {2, 4},
        "branches of each node on average: each draws from two less to two more, at least 1"),
    real_parameter("size_m", "m", 2.4, {0.1, 30}, {1, 6}, "length of the trunk up to its end"),
    real_parameter("radius_m", "m", 0.17, {0.005, 3}, {0.05, 0.6},
                   "radius of the trunk above its flare"),
    real_parameter("branch_angle", "rad", 0.8, {0, 2.5}, {0.3, 1.3},
                   "between a branch and its parent"),
    real_parameter("angle_variation", "1", 0.35, {0, 1}, {0, 0.8}, "spread of the angles"),
    real_parameter("length_decay", "1", 0.76, {0.3, 1}, {0.55, 0.9},
                   "length of a branch over its parent's"),
    real_parameter("radius_decay", "1", 0.62, {0.2, 1}, {0.4, 0.8},
                   "radius of a side branch over its parent's"),
    real_parameter("tropism", "1", 0.18, {-1, 1}, {-0.3, 0.5},
                   "bends branches up, or down where negative"),
    real_parameter("curvature", "1", 0.4, {0, 1}, {0, 0.8}, "crookedness of the branches"),
    real_parameter("flare", "1", 0.7, {0, 3}, {0, 1.5}, "widening of the trunk at its base"),
    real_parameter("leaf_scale", "1", 1, {0.1, 3}, {0.5, 1.5},
                   "size of leaves over the size that just fills the crown"),
    real_parameter("leaf_hue", "1", 0.14, {0, 1}, {0, 1},
                   "from deep green (0) over green, yellow and orange to red (1)"),
    real_parameter("colour_variation", "1", 0.5, {0, 1}, {0, 1},
                   "spread of colour between leaves and trees"),
    real_parameter("bark_tone", "1", 0.55, {0, 1}, {0, 1}, "from grey (0) to brown (1)"),
};
static_assert(std::size(kTreeSchema) == kTreeParameterCount);

// Returns the plan of one tree. Requires legal parameters. Points to static data only.
TreePlan plan_of_tree(const Parameters& p);

// The model type "tree". Levels 0 … 5 have on average, over the paper's ranges, about 5,000, 1,200,
// 300, 80, 23 and 11 triangles.
std::unique_ptr<ModelType> make_tree_type();

}  // namespace psygen::models
