// The predicted cost of a world's most expensive model and of a block, from parameters alone:
// without placing models or synthesising meshes. The editor asks for confirmation of edits whose
// cost is beyond a limit. Pure; any thread.
#pragma once

#include <QString>
#include <string>

#include "editor/document/parsed_world.hpp"
#include "engine/synthesis/cost_model.hpp"

namespace psygen::editor {

// At full detail, on one core.
struct EditCost {
  std::string model;  // type of the most expensive model
  double model_seconds = 0;
  double block_seconds = 0, block_bytes = 0;  // of the ground and of all instances of the scatters
};

// Edits beyond these limits need confirmation.
struct CostLimits {
  double model_seconds = 0.1, block_seconds = 0.25;
  // The cache must hold this number of blocks at full detail: those around the camera.
  double cache_bytes = 512 << 20, blocks = 16;
};

// The cost of a world. `learnt`: a cost model of the same program whose corrections are used, or
// null. Asks each model type for the sizes of a few meshes.
EditCost edit_cost(const ParsedWorld& parsed, const synthesis::CostModel* learnt);

// Returns the question to confirm an edit: not empty if `after` is beyond a limit and more
// expensive than `before`.
QString confirmation_for(const EditCost& before, const EditCost& after, const CostLimits& limits);

}  // namespace psygen::editor
