// The broadleaf tree: a stochastic L-system whose nodes draw their own number of branches, meshed
// at six levels of detail from one skeleton (paper, section 5.2, eq. 4; docs/models.md, "Tree").
// Leaf triangles are visible from both sides, so trees are drawn without back-face culling.
// Parameters determine its appearance; trees with a grammar as data are species (species.hpp).
#pragma once

#include <cstddef>
#include <memory>

#include "engine/models/model_type.hpp"
#include "engine/models/tree/plan.hpp"

namespace psygen::models {

// Indices into the schema of the type "tree".
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

// Returns the plan of one tree. Requires legal parameters. Points to static data only.
TreePlan plan_of_tree(const Parameters& p);

// The model type "tree". Levels 0 … 5 have on average, over the paper's ranges, about 5,000, 1,200,
// 300, 80, 23 and 11 triangles. Synthesis needs about 900 KiB of stack and no heap.
std::unique_ptr<ModelType> make_tree_type();

}  // namespace psygen::models
