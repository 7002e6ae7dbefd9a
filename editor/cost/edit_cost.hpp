// What the most expensive model and a block of a world would cost, from its parameters alone:
// nothing is placed and no mesh is made, so a value can be judged before anything is made with it.
// From this comes the question that a costly edit asks first. Pure; any thread.
#pragma once

#include <QString>
#include <string>

#include "editor/document/parsed_world.hpp"
#include "engine/synthesis/cost_model.hpp"

namespace psygen::editor {

// At full detail, on one core.
struct EditCost {
  std::string model;  // the type of the most expensive model
  double model_seconds = 0;
  double block_seconds = 0, block_bytes = 0;  // of ground and all models that may stand on it
};

// What is asked beyond.
struct CostLimits {
  double model_seconds = 0.1, block_seconds = 0.25;
  // The cache shall have room for so many blocks at full detail: those around the camera.
  double cache_bytes = 512 << 20, blocks = 16;
};

// The cost of a world. `learnt`: what a cost model of the same program knows (null: nothing). Asks
// each model type for the sizes of some meshes.
EditCost edit_cost(const ParsedWorld& parsed, const synthesis::CostModel* learnt);

// A sentence if `after` is beyond a limit and more expensive than `before`, else empty.
QString cost_question(const EditCost& before, const EditCost& after, const CostLimits& limits);

}  // namespace psygen::editor
