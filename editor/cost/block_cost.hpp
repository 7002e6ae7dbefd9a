// The cost of a world per block at full detail: predicted without synthesis, and measured on a few
// blocks. The editor shows it before an edit is applied. Pure except for clocks; any thread, with
// its own parsed world and cost model.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "editor/document/parsed_world.hpp"
#include "engine/synthesis/cost_model.hpp"
#include "engine/world/files/world_schema.hpp"

namespace psygen::editor {

// Means over some blocks of the world.
struct BlockCost {
  double models = 0, triangles = 0, bytes = 0;
  double seconds = 0;                           // on one core, predicted
  std::optional<double> measured_seconds = {};  // on one core, if blocks were synthesised
};

// Block costs of a series of similar worlds, such as the values of a slider. Keeps the costs of the
// ground and of the scatters that a world has in common with the previous one. One thread.
class BlockSurvey {
 public:
  // Surveys blocks around a block. `learnt` as in block_cost(); it outlives the survey.
  BlockSurvey(core::BlockCoord around, const synthesis::CostModel* learnt)
      : around_(around), learnt_(learnt) {}

  // As block_cost().
  BlockCost cost(const ParsedWorld& parsed, bool measure);

 private:
  BlockCost add_unknown_parts(const ParsedWorld& parsed, const synthesis::CostModel& costs,
                              const std::vector<std::uint64_t>& keys);

  core::BlockCoord around_;
  const synthesis::CostModel* learnt_;
  // Sums over all blocks for the ground and for each scatter of the previous world, by a hash of
  // their inputs.
  std::map<std::uint64_t, BlockCost> known_;
};

// The mean cost of blocks around a block. `learnt`: a cost model of the same program whose
// corrections are used, or null. `measure`: also synthesises one of the blocks, unless that is
// predicted to take over 12.5 ms, and scales the prediction by the ratio of measured to predicted
// time.
BlockCost block_cost(const ParsedWorld& parsed, core::BlockCoord around,
                     const synthesis::CostModel* learnt, bool measure);

// Returns sample block number 0, 1, … around a block. Sample blocks are a few hundred metres apart
// and inside the world. The block is in the middle of each four of them, except at the border of
// the world.
core::BlockCoord block_near(const world::World& world, core::BlockCoord around, int number);

// The cost of one mesh at full detail. Bytes count its vertices and the indices that it does not
// share. Triangles and bytes are 0 if the model type fails to give a size.
struct MeshCost {
  double triangles = 0, bytes = 0;
  double seconds = 0;  // on one core, predicted
};
MeshCost mesh_cost(const ParsedWorld& parsed, models::ModelIndex model, const models::Parameters& p,
                   const synthesis::CostModel& costs);

// True if the cost depends on the numbers of the field, so that it has a cost curve.
bool has_cost_curve(const world::WorldField& field);

// One value of a field and the cost of the world with it.
struct CostPoint {
  double value = 0;
  std::optional<BlockCost> cost = {};  // empty: the value is invalid
  std::string error = {};              // message for an invalid value
};

// Costs over the soft range of a field of numbers, evenly spaced on its scale; of a range, the
// maximum varies. Some values are measured. Empty for other kinds of fields. Stops as soon as
// `go_on`, called between values, returns false. `files` as for parse_world_text(). Takes some
// milliseconds per value.
struct CurveInput {
  const std::string& text;
  const std::string& file;
  const RegisterModels& register_models;
  const world::WorldField& field;
  core::BlockCoord around;
  const synthesis::CostModel* learnt = nullptr;
  const world::ResourceLoader* files = nullptr;
};
std::vector<CostPoint> cost_curve(const CurveInput& input, const std::function<bool()>& go_on);

}  // namespace psygen::editor
