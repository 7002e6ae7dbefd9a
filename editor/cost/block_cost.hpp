// What a world costs at full detail, per block: predicted without synthesis, and measured by making
// some blocks. From this comes the cost of a value before anybody commits to it. Pure but for
// clocks; any thread, with a parsed world and a cost model of its own.
#pragma once

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
  double seconds = 0;                      // of one core, predicted
  std::optional<double> measured_seconds;  // of one core, if blocks were made
};

// The cost of a world, of some blocks around one. `learnt`: what a cost model of the same program
// knows (null: nothing). `measure`: also makes one of the blocks, unless that is predicted to take
// over 12.5 ms, and takes what that took, in parts of what was predicted, for all.
BlockCost block_cost(const ParsedWorld& parsed, core::BlockCoord around,
                     const synthesis::CostModel* learnt, bool measure);

// Blocks of which means are taken: number 0, 1, … around a block, a few hundred metres apart,
// within the world. The block is in the middle of each four of them, unless the world ends there.
core::BlockCoord block_near(const world::World& world, core::BlockCoord around, int number);

// What a mesh takes at full detail. Bytes are those of its vertices and of the indices that are its
// own; without a size, as of a type that fails, they are 0.
struct MeshCost {
  double triangles = 0, bytes = 0;
  double seconds = 0;  // of one core, predicted
};
MeshCost mesh_cost(const ParsedWorld& parsed, models::ModelIndex model, const models::Parameters& p,
                   const synthesis::CostModel& costs);

// Whether numbers of a field change what is made, so that there is a curve of it.
bool has_cost_curve(const world::WorldField& field);

// One value of a field and what the world would cost with it.
struct CostPoint {
  double value = 0;
  std::optional<BlockCost> cost;  // nothing: the value is refused
  std::string refusal;            // then why
};

// Costs over the soft range of a field of numbers, evenly on its scale; of ranges the highest end
// varies. Some values are measured. Empty for other kinds of fields. `go_on` is asked between
// values. `files` as for parse_world_text(). Some milliseconds a value.
std::vector<CostPoint> cost_curve(const std::string& text, const std::string& file,
                                  const RegisterModels& register_models,
                                  const world::WorldField& field, core::BlockCoord around,
                                  const synthesis::CostModel* learnt,
                                  const std::function<bool()>& go_on,
                                  const world::FilesBeside* files = nullptr);

}  // namespace psygen::editor
